/* Failure of the default tissue: what tests assert and the bench program prints. */
#ifndef LAM_SUPPORT_FAILING_TISSUE_H
#define LAM_SUPPORT_FAILING_TISSUE_H

#include "failure.h"
#include "tissue.h"

/* Strengths at which all criteria of bonded tissue are met on the way of PullLoads, C1 + C2. */
static const LamStrength failing_strength = {
    .wall = 0.3 / TISSUE_STRESS, .lamella_normal = 0.1 / TISSUE_STRESS, .lamella_shear = 0.015 / TISSUE_STRESS};

/* Turgid tissue, stretched a little and then pulled along X1 while it shrinks across. */
#define PULL_STATES 5
void PullLoads(LamLoad loads[PULL_STATES]);
/* Sheared under turgor, with a cohesion that contact alone feels. */
#define SHEAR_STATES 5
void ShearLoads(double cohesion, LamLoad loads[SHEAR_STATES]);
/* Follows a program on new meshes: one, for contact tissue two. */
PetscErrorCode FollowProgram(const LamMicrostructure *micro, LamFailureProgram program, LamFailure *failure);

#endif
