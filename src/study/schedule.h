/*
  Which piece of work is given to whom, and when.

  The schedule knows neither MPI nor a clock nor what the work is: whoever runs it tells it what happens and at what
  time. The dispatcher does so with messages, bench_schedule with events of a simulation, on the same code.

  Method
    A child is a rank that computes, or a rank that hands out to others in its turn: `capacity` ranks compute below it.
    The piece of the longest predicted cost goes first. A child has pieces ahead of the one it works on, so that it does
    not wait for an answer: as many as it takes the time to answer, fewer where hardly anything is left. A child that
    has turned out to be slow gets the shortest piece where the others would be done with all the rest before it is done
    with the longest. When nothing is left a child that has nothing to do is given what another has not begun, or what a
    slow one has, too: nobody can know how long the piece will take that is in the way.

  References
    P. Graham, Bounds on multiprocessing timing anomalies, SIAM J. Appl. Math. 17 (1969) 416-429 (longest first).
    J. Dean, S. Ghemawat, MapReduce, OSDI 2004, Section 3.6 (second copies of the last pieces).
*/
#ifndef LAM_SCHEDULE_H
#define LAM_SCHEDULE_H

#include <petscsys.h>

typedef struct LamSchedule_s *LamSchedule;

/* capacity[children]. `answer`: the time from a result to the next piece at the child, s; a guess is enough. */
PetscErrorCode LamScheduleCreate(PetscInt children, const PetscInt capacity[], PetscReal answer, LamSchedule *schedule);
PetscErrorCode LamScheduleDestroy(LamSchedule *schedule);

/* Pieces first .. first + count - 1, each of about this predicted cost (> 0, in any unit that all pieces share). */
PetscErrorCode LamScheduleAdd(LamSchedule schedule, PetscInt64 first, PetscInt64 count, PetscReal cost);
/*
  The pieces that `child` is given at time `now` (s), at most `most`; *n = 0: none for the moment. Ask when it has been
  created, when pieces were added and when a result of it has come.
*/
PetscErrorCode LamScheduleTake(LamSchedule schedule, PetscInt child, PetscReal now, PetscInt most, PetscInt *n,
                               PetscInt64 pieces[]);
/* The result of a piece has come from `child`. *first: nobody was faster; the results of second copies are dropped. */
PetscErrorCode LamScheduleDone(LamSchedule schedule, PetscInt child, PetscReal now, PetscInt64 piece, PetscBool *first);

/* A child that has the piece, or -1; asked after a first result: one whose work on it is not wanted any more. */
PetscInt LamScheduleHolder(LamSchedule schedule, PetscInt64 piece);
/* Pieces that children have although their results have come. */
PetscInt64 LamScheduleStale(LamSchedule schedule);
/* The predicted cost of a piece that the child has. */
PetscReal LamScheduleCost(LamSchedule schedule, PetscInt child, PetscInt64 piece);
/* Pieces that nobody has yet, and those that children have. */
PetscInt64 LamScheduleWaiting(LamSchedule schedule);
PetscInt64 LamScheduleOut(LamSchedule schedule);

#endif
