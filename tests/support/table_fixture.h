/* A file with a table, filled by a tissue with known answers (synthetic_responder.h). */
#ifndef LAM_SUPPORT_TABLE_FIXTURE_H
#define LAM_SUPPORT_TABLE_FIXTURE_H

#include "synthetic_responder.h"
#include <lamella/database.h>
#include <stdio.h>

/* Solves what the table lacks to respond to the load, until it does or nothing helps. */
PetscErrorCode RefineTable(LamDatabase database, LamResponder solver, const LamLoad *load, PetscReal accuracy);
/* A database of bonded tissue that answers these loads. */
PetscErrorCode TableFixtureWrite(const char path[], const LamScene *scene, const Synthetic *material, PetscInt n,
                                 const LamLoad loads[], PetscReal accuracy);

#endif
