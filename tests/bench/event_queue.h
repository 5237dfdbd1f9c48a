/* What happens next in a simulation: a heap of four branches, the earliest event on top. */
#ifndef LAM_EVENT_QUEUE_H
#define LAM_EVENT_QUEUE_H

#include <petscsys.h>

typedef struct {
  double time; /* s */
  PetscInt64 what;
  int kind, whom;
} Event;

typedef struct {
  PetscInt64 n, room;
  Event *events; /* [n]; owned */
} EventQueue;

static inline PetscErrorCode EventPush(EventQueue *queue, Event event)
{
  PetscInt64 i = queue->n++;

  PetscFunctionBeginUser;
  if (i == queue->room) {
    queue->room = PetscMax(1024, 2 * queue->room);
    PetscCall(PetscRealloc((size_t)queue->room * sizeof(*queue->events), &queue->events));
  }
  for (; i && queue->events[(i - 1) / 4].time > event.time; i = (i - 1) / 4)
    queue->events[i] = queue->events[(i - 1) / 4];
  queue->events[i] = event;
  PetscFunctionReturn(0);
}

/* There must be one. */
static inline Event EventPop(EventQueue *queue)
{
  const Event top = queue->events[0], last = queue->events[--queue->n];
  PetscInt64 i = 0;

  for (PetscInt64 child = 1; child < queue->n; child = 4 * i + 1) {
    PetscInt64 first = child;

    for (PetscInt64 k = child + 1; k < PetscMin(child + 4, queue->n); k++)
      if (queue->events[k].time < queue->events[first].time) first = k;
    if (queue->events[first].time >= last.time) break;
    queue->events[i] = queue->events[first];
    i = first;
  }
  queue->events[i] = last;
  return top;
}

#endif
