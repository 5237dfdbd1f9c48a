/*
  Messages between ranks that neither side waits for.
*/
#ifndef LAM_MAIL_H
#define LAM_MAIL_H

#include "bundle.h"

typedef struct {
  MPI_Request request;
  char *bytes; /* owned until the message has left */
} LamLetter;

typedef struct {
  MPI_Comm comm; /* used for nothing else */
  PetscInt n, room;
  LamLetter *sent; /* [n] under way; owned */
} LamMail;

/* Sends the bundle and leaves it empty. `tag`: what the message is. */
PetscErrorCode LamMailSend(LamMail *mail, PetscMPIInt rank, PetscMPIInt tag, LamBundle *bundle);
/* The next message that has come in, those of one rank in their order; *found: whether there is one. */
PetscErrorCode LamMailReceive(LamMail *mail, PetscBool *found, PetscMPIInt *rank, PetscMPIInt *tag, LamBundle *bundle);
/* Waits until all has left. */
PetscErrorCode LamMailDestroy(LamMail *mail);

#endif
