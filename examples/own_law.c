/*
  A responder with a user-defined law in the macroscale solver, with the body and boundary conditions of a scene:
  compressible neo-Hookean material (Bonet & Wood, Nonlinear Continuum Mechanics, Section 6.4.3),
    W = mu/2 (F:F - 3 - 2 ln J) + lambda/2 (ln J)^2.

    example_own_law tests/scenes/tissue-block.yaml
*/
#include <lamella/lamella.h>
#include <math.h>
#include <stdio.h>

static const PetscReal Mu = 1, Lambda = 2; /* C1 + C2 of the scene, the unit of stress */

/* P = mu (F - F^-T) + lambda ln J F^-T, and dP_ij/dF_kl; row-major. */
static void Evaluate(const PetscReal F[9], PetscReal P[9], PetscReal A[81])
{
  const PetscReal J =
      F[0] * (F[4] * F[8] - F[5] * F[7]) - F[1] * (F[3] * F[8] - F[5] * F[6]) + F[2] * (F[3] * F[7] - F[4] * F[6]);
  PetscReal G[3][3]; /* F^-T: cofactors over J */

  for (int i = 0; i < 3; i++) {
    const int a = (i + 1) % 3, b = (i + 2) % 3;

    for (int j = 0; j < 3; j++) {
      const int c = (j + 1) % 3, d = (j + 2) % 3;

      G[i][j] = (F[3 * a + c] * F[3 * b + d] - F[3 * a + d] * F[3 * b + c]) / J;
    }
  }
  for (int ij = 0; ij < 9; ij++) {
    const int i = ij / 3, j = ij % 3;

    P[ij] = Mu * (F[ij] - G[i][j]) + Lambda * log(J) * G[i][j];
    for (int kl = 0; kl < 9; kl++) {
      const int k = kl / 3, l = kl % 3;

      A[9 * ij + kl] = Mu * (ij == kl) + Lambda * G[i][j] * G[k][l] + (Mu - Lambda * log(J)) * G[i][l] * G[k][j];
    }
  }
}

/* Responds to a batch of queries. */
static PetscErrorCode Respond(void *ctx, PetscInt n, const LamLoad loads[], const PetscInt points[],
                              LamResponse responses[])
{
  PetscFunctionBeginUser;
  (void)ctx;
  (void)points;
  for (PetscInt i = 0; i < n; i++) {
    PetscCall(LamResponseInit(&loads[i], &responses[i]));
    if (!LamLoadValidate(&loads[i], &responses[i])) continue; /* det F <= 0: the macroscale step is cut back */
    Evaluate(loads[i].F, responses[i].P, responses[i].tangent);
    responses[i].status = LAM_CONVERGED;
  }
  PetscFunctionReturn(0);
}

/* A LamMacroMonitor. */
static PetscErrorCode PrintStep(LamMacro macro, const LamMacroStep *step, PetscBool *stop, void *ctx)
{
  PetscFunctionBeginUser;
  (void)macro;
  (void)ctx;
  *stop = PETSC_FALSE;
  printf("load %.2f: %d Newton iterations, work %.6e\n", (double)step->load_factor, (int)step->newton_iterations,
         (double)step->work);
  PetscFunctionReturn(0);
}

static PetscErrorCode Run(const char path[])
{
  const LamResponderFunctions law = {.respond = Respond}; /* without states that a load step accepts or rejects */
  char message[LAM_MESSAGE_LENGTH];
  LamMacroReason reason;
  LamResponder responder;
  LamScene *scene;
  LamMacro macro;

  PetscFunctionBeginUser;
  PetscCall(LamSceneRead(path, &scene));
  PetscCall(LamMacroCreate(PETSC_COMM_WORLD, &macro));
  PetscCall(LamMacroSetScene(macro, scene));
  PetscCall(LamMacroSetUp(macro));
  PetscCall(LamResponderCreate(&law, NULL, NULL, &responder));
  PetscCall(LamMacroSetResponder(macro, responder));
  PetscCall(LamMacroSetMonitor(macro, PrintStep, NULL));
  PetscCall(LamMacroSolve(macro, &reason, message));
  if (reason != LAM_MACRO_DONE) printf("not to the end: %s\n", message);
  PetscCall(LamMacroDestroy(&macro));
  PetscCall(LamResponderDestroy(&responder));
  PetscCall(LamSceneDestroy(&scene));
  PetscFunctionReturn(0);
}

int main(int argc, char *argv[])
{
  PetscErrorCode ierr;

  if (argc != 2) {
    fprintf(stderr, "usage: %s SCENE.yaml, such as tests/scenes/tissue-block.yaml\n", argv[0]);
    return 1;
  }
  if (LamErrorsKeep() || PetscInitialize(&argc, &argv, NULL, NULL)) return 1;
  ierr = Run(argv[1]);
  if (ierr) fprintf(stderr, "%s\n", LamErrorMessage());
  return ierr || PetscFinalize() ? 1 : 0;
}
