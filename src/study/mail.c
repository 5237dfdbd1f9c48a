#include "mail.h"

/* Frees what has left. */
static PetscErrorCode Tidy(LamMail *mail)
{
  PetscInt kept = 0;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < mail->n; i++) {
    int left = 0;

    PetscCallMPI(MPI_Test(&mail->sent[i].request, &left, MPI_STATUS_IGNORE));
    if (left)
      PetscCall(PetscFree(mail->sent[i].bytes));
    else
      mail->sent[kept++] = mail->sent[i];
  }
  mail->n = kept;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMailSend(LamMail *mail, PetscMPIInt rank, PetscMPIInt tag, LamBundle *bundle)
{
  LamLetter *letter;
  PetscMPIInt n;

  PetscFunctionBeginUser;
  if (mail->n == mail->room) PetscCall(Tidy(mail));
  if (mail->n == mail->room) {
    mail->room = PetscMax(16, 2 * mail->room);
    PetscCall(PetscRealloc((size_t)mail->room * sizeof(*mail->sent), &mail->sent));
  }
  PetscCall(PetscMPIIntCast((PetscInt)bundle->n, &n));
  letter = &mail->sent[mail->n++];
  letter->bytes = bundle->bytes;
  PetscCallMPI(MPI_Isend(letter->bytes, n, MPI_BYTE, rank, tag, mail->comm, &letter->request));
  *bundle = (LamBundle){0};
  PetscFunctionReturn(0);
}

PetscErrorCode LamMailReceive(LamMail *mail, PetscBool *found, PetscMPIInt *rank, PetscMPIInt *tag, LamBundle *bundle)
{
  MPI_Message message;
  MPI_Status status;
  PetscMPIInt n;
  int waiting;

  PetscFunctionBeginUser;
  *found = PETSC_FALSE;
  PetscCallMPI(MPI_Improbe(MPI_ANY_SOURCE, MPI_ANY_TAG, mail->comm, &waiting, &message, &status));
  if (!waiting) PetscFunctionReturn(0);
  PetscCallMPI(MPI_Get_count(&status, MPI_BYTE, &n));
  if ((size_t)n > bundle->room) {
    bundle->room = (size_t)n;
    PetscCall(PetscRealloc(bundle->room, &bundle->bytes));
  }
  PetscCallMPI(MPI_Mrecv(bundle->bytes, n, MPI_BYTE, &message, &status));
  bundle->n = (size_t)n;
  *rank = status.MPI_SOURCE;
  *tag = status.MPI_TAG;
  *found = PETSC_TRUE;
  PetscFunctionReturn(0);
}

PetscErrorCode LamMailDestroy(LamMail *mail)
{
  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < mail->n; i++) {
    PetscCallMPI(MPI_Wait(&mail->sent[i].request, MPI_STATUS_IGNORE));
    PetscCall(PetscFree(mail->sent[i].bytes));
  }
  PetscCall(PetscFree(mail->sent));
  *mail = (LamMail){.comm = mail->comm};
  PetscFunctionReturn(0);
}
