/* One state of the map of extremes: solved, then held against second routes. */
#ifndef LAM_EXTREMES_JUDGE_H
#define LAM_EXTREMES_JUDGE_H

#include "extremes_case.h"
#include <lamella/lamella.h>

#define EXTREMES_VERDICTS(X)                                                                                           \
  X(EXTREMES_CONFIRMED, "confirmed")     /* converged; a second route agrees, none differs */                          \
  X(EXTREMES_BRANCH, "another branch")   /* converged; a second route ends in another stable equilibrium */            \
  X(EXTREMES_UNCONFIRMED, "unconfirmed") /* converged; no second route came to an end */                               \
  X(EXTREMES_REASON, "reason")           /* a physical reason, with its certificate */                                 \
  X(EXTREMES_NUMERICAL, "numerical")     /* not_converged */                                                           \
  X(EXTREMES_WRONG, "wrong")             /* converged; a finer mesh differs by more than 3 estimates */                \
  X(EXTREMES_NOT_FINITE, "not finite")   /* a number that should be there is not */                                    \
  X(EXTREMES_SLOW, "slow")               /* beyond EXTREMES_SECONDS */                                                 \
  X(EXTREMES_CRASH, "crash")
typedef enum { EXTREMES_VERDICTS(EXTREMES_ENTRY) EXTREMES_VERDICT_COUNT } ExtremesVerdict;
extern const char *const ExtremesVerdictNames[];

#define EXTREMES_SECONDS 60.0       /* of processor time that a state may take */
#define EXTREMES_ROUTE_SECONDS 20.0 /* that a second route is given */
#define EXTREMES_TEXT 2000          /* of a scene */

typedef struct {
  LamResponse state, path, other, finer; /* finer: on twice the elements each way */
  PetscReal path_error, other_error;     /* of P, relative; NaN: no such route, or it did not end */
  PetscReal mesh_error;
  PetscReal seconds; /* of processor time, the state alone */
  ExtremesVerdict verdict;
} ExtremesResult;

/* `routes`: with second routes. */
PetscErrorCode ExtremesJudge(const ExtremesCase *c, PetscBool routes, ExtremesResult *result);

#endif
