/*
  Writing the records of a build. Rank 0.
*/
#include "build_run.h"
#include "clock.h"

/* Interval between commits: at least COMMIT_SECONDS s, and COMMIT_SHARE times the duration of the last commit, so that
   commits take at most 2 % of the time. */
#define COMMIT_SECONDS 0.1
#define COMMIT_SHARE 50.0
enum { COMMIT_RECORDS = 65536 }; /* so many pending records are committed at once */
#define LATE 30.0                /* s for which an unsolved node may delay the records that follow it in the file */

PetscInt64 LamBuildRecords(const LamBuild *build)
{
  return build->there + build->added;
}

PetscInt64 LamBuildFailed(const LamBuild *build)
{
  return build->rounds.known_failed + build->failed;
}

static PetscErrorCode Commit(LamBuild *b)
{
  const PetscReal begin = LamClock();
  LamPending *p = &b->pending;

  PetscFunctionBeginUser;
  PetscCall(LamRecordWriterCommit(b->writer, p->n, p->keys, p->responses));
  for (PetscInt i = 0; i < p->n; i++) b->failed += p->responses[i].status != LAM_CONVERGED;
  b->added += p->n;
  p->n = 0;
  b->last_commit = LamClock();
  b->commit_seconds = b->last_commit - begin;
  b->all_commits += b->commit_seconds;
  if (b->committed) PetscCall(b->committed(b->reporter.ctx, b));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildTake(LamBuild *b, PetscInt64 key, const LamResponse *response)
{
  LamPending *p = &b->pending;

  PetscFunctionBeginUser;
  if (p->n == p->room) {
    p->room = PetscMax(256, 2 * p->room);
    PetscCall(PetscRealloc((size_t)p->room * sizeof(*p->keys), &p->keys));
    PetscCall(PetscRealloc((size_t)p->room * sizeof(*p->responses), &p->responses));
  }
  p->keys[p->n] = key;
  p->responses[p->n++] = *response;
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildTakeSolved(LamBuild *b, PetscBool in_turn)
{
  PetscFunctionBeginUser;
  for (PetscInt r = 0; r < b->rounds.open; r++) {
    LamRound *round = &b->rounds.round[r];

    for (PetscInt m = round->next; m < round->missing; m++) {
      const PetscInt i = round->order[m];

      if (!round->solved[i] && in_turn) PetscFunctionReturn(0);
      if (round->solved[i] && !round->taken[m]) {
        PetscCall(LamBuildTake(b, round->keys[i], &round->responses[i]));
        round->taken[m] = PETSC_TRUE;
        if (in_turn) b->last_taken = LamClock();
      }
      if (in_turn) round->next = m + 1;
    }
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildCommitInTime(LamBuild *b)
{
  const PetscReal waited = LamClock() - b->last_commit;

  PetscFunctionBeginUser;
  if (LamClock() - b->last_taken > LATE) PetscCall(LamBuildTakeSolved(b, PETSC_FALSE));
  if (b->pending.n >= COMMIT_RECORDS ||
      (b->pending.n && waited >= PetscMax(COMMIT_SECONDS, COMMIT_SHARE * b->commit_seconds)))
    PetscCall(Commit(b));
  PetscFunctionReturn(0);
}

PetscErrorCode LamBuildCommitAll(void *ctx)
{
  LamBuild *b = ctx;

  PetscFunctionBeginUser;
  PetscCall(LamBuildTakeSolved(b, PETSC_FALSE));
  if (b->pending.n) PetscCall(Commit(b));
  PetscFunctionReturn(0);
}
