/*
  The second-order model of a material point whose lamella breaks: its last solve, continued at the history that the
  point has.

  At a frozen history tissue is hyperelastic, up to where a point of the lamella changes its branch: from elastic to
  breaking, or back. The model is the expansion of Psi at the solve (expansion.h), with what loaded there on its
  softening branch, and the jumps along the lamella with their rates. What the law has at the jumps of another load,
  with the history of the last accepted one, but its tangent has not, is the error of the model's branch; it bounds how
  far a point may go back after it has broken, or on past what has broken it. The rest is of third order.
*/
#ifndef LAM_RVE_POINT_MODEL_H
#define LAM_RVE_POINT_MODEL_H

#include "measure.h"

typedef struct {
  PetscBool known;
  LamResponse response;    /* of the solve */
  LamBondRate *bond;       /* [point of the lamella]; owned */
  LamBondHistory *history; /* [point of the lamella] at which it is a model; owned */
  PetscReal spent;         /* dissipated until then, per V0 */
  PetscReal curvature;     /* relative error of P over the square of the distance, of third order */
} LamPointModel;

typedef struct {
  PetscReal distance2;      /* square of the distance from the solve, a strain */
  PetscReal branch, smooth; /* relative errors of P: of points of the lamella on another branch, and of third order */
} LamModelError;

PetscErrorCode LamPointModelCreate(LamRVE rve, LamPointModel *model);
PetscErrorCode LamPointModelDestroy(LamPointModel *model);
PetscErrorCode LamPointModelCopy(LamRVE rve, const LamPointModel *from, LamPointModel *to);
/* Takes the response of the last solve, with rve->rates; `known` is false if it has none of its own. The history is
   that from which the last part of the step has gone. */
PetscErrorCode LamPointModelTake(LamRVE rve, const LamResponse *response, LamPointModel *model);
/* Of a load that the model had this error for, and then was solved with an actual error: learns the curvature. */
void LamPointModelLearn(const LamModelError *error, PetscReal actual, PetscReal *curvature);
/* The model's response, with its error. */
PetscErrorCode LamPointModelRespond(LamRVE rve, const LamPointModel *model, const LamLoad *load, LamResponse *response,
                                    LamModelError *error);
/* The history at a load becomes that of the model. */
void LamPointModelAccept(LamRVE rve, const LamLoad *load, LamPointModel *model);

#endif
