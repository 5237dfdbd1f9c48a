/*
  Motions that map a periodic tissue onto itself.

  Method. Cells hang together, so the image of one face determines a motion: the next face of a cell goes to the next
  one (of a mirror image to the previous one), a partner to the partner. Each face is tried as the image of face 0, and
  the tissue walked from there until a face, its wall or its cell is unlike its image. Faces are compared as vectors
  between their corners, so that an image may lie in any period. A walk that closes around the period has an image that
  closes, so periods go to periods.
*/
#include <lamella/tissue.h>
#include <math.h>

#define SAME 1e-9 /* apothems, and relative to what a cell has: tissue files have 12 digits */

typedef struct {
  const LamMicrostructure *micro;
  LamTissue tissue;
  PetscInt turn; /* by 60 degrees each */
  PetscBool mirror;
  PetscReal map[2][2];
  PetscInt *image, *queue; /* [face] image: -1: not reached */
} Motion;

static void SetMotion(PetscBool mirror, PetscInt turn, Motion *m)
{
  const PetscReal angle = PETSC_PI / 3.0 * (PetscReal)turn + (mirror ? 2.0 * m->micro->orientation : 0.0);
  const PetscReal c = cos(angle), s = sin(angle), sign = mirror ? -1.0 : 1.0;

  m->turn = turn;
  m->mirror = mirror;
  m->map[0][0] = c;
  m->map[0][1] = -sign * s;
  m->map[1][0] = s;
  m->map[1][1] = sign * c;
}

/* ---- faces ---- */

static void SideOf(LamTissue t, PetscInt face, PetscReal side[2])
{
  const PetscInt next = LamTissueNext(t, face);

  for (int d = 0; d < 2; d++) side[d] = t->corner[next][d] - t->corner[face][d];
}

/* Whether a normal lies midway between two directions, so that which of them it counts to means nothing. */
static PetscBool IsMidway(const Motion *m, PetscInt face)
{
  PetscReal side[2];

  SideOf(m->tissue, face, side);
  return (PetscBool)(fabs(remainder(atan2(-side[0], side[1]) - m->micro->orientation - PETSC_PI / 6.0,
                                    PETSC_PI / 3.0)) < SAME);
}

/* A class of faces goes to a class: responses have means over them, and lamellae strengths. */
static PetscBool AreOfLikeClass(const Motion *m, PetscInt face, PetscInt image)
{
  const PetscInt classes = LAM_DIRECTIONS / 2, from = m->tissue->direction[face] % classes;
  const PetscInt wanted = ((m->mirror ? classes - from : from) + m->turn) % classes;

  if (m->tissue->direction[image] % classes == wanted) return PETSC_TRUE;
  return (PetscBool)(m->micro->interface != LAM_INTERFACE_LAMELLA && IsMidway(m, face));
}

static PetscBool AreNear(PetscReal a, PetscReal b)
{
  return (PetscBool)(fabs(a - b) <= SAME);
}

static PetscBool AreAlike(const Motion *m, PetscInt face, PetscInt image)
{
  const LamTissue t = m->tissue;
  const LamCell *cells = m->micro->cell;
  const PetscReal sign = m->mirror ? -1.0 : 1.0; /* a mirror image is passed from its end to its start */
  PetscReal from[2], to[2];

  SideOf(t, face, from);
  SideOf(t, image, to);
  for (int d = 0; d < 2; d++)
    if (!AreNear(sign * to[d], m->map[d][0] * from[0] + m->map[d][1] * from[1])) return PETSC_FALSE;
  return (PetscBool)(AreNear(t->share[face], t->share[image]) &&
                     AreNear(t->setback[face], t->setback[m->mirror ? LamTissueNext(t, image) : image]) &&
                     (t->partner[face] < 0) == (t->partner[image] < 0) && AreOfLikeClass(m, face, image) &&
                     (!cells || LamCellsAgree(&cells[t->cell[face]], &cells[t->cell[image]], SAME)));
}

/* ---- the walk ---- */

/* Sets the image of a face and enqueues it; PETSC_FALSE: it has another one, or is unlike. */
static PetscBool Reach(Motion *m, PetscInt face, PetscInt image, PetscInt *count)
{
  if (m->image[face] >= 0) return (PetscBool)(m->image[face] == image);
  if (!AreAlike(m, face, image)) return PETSC_FALSE;
  m->image[face] = image;
  m->queue[(*count)++] = face;
  return PETSC_TRUE;
}

static PetscBool Maps(Motion *m, PetscInt image)
{
  const LamTissue t = m->tissue;
  PetscInt count = 0;
  PetscBool good = Reach(m, 0, image, &count);

  for (PetscInt i = 0; good && i < count; i++) {
    const PetscInt face = m->queue[i], at = m->image[face];

    good = Reach(m, LamTissueNext(t, face), m->mirror ? LamTissuePrevious(t, at) : LamTissueNext(t, at), &count);
    if (good && t->partner[face] >= 0) good = Reach(m, t->partner[face], t->partner[at], &count);
  }
  for (PetscInt i = 0; i < count; i++) m->image[m->queue[i]] = -1;
  return good;
}

PetscErrorCode LamMicrostructureSymmetry(const LamMicrostructure *micro, LamSymmetry *symmetry)
{
  Motion m = {.micro = micro};

  PetscFunctionBeginUser;
  *symmetry = (LamSymmetry){.has[0][0] = PETSC_TRUE};
  if (micro->is_patch) PetscFunctionReturn(0);
  PetscCall(LamTissueCreate(micro, &m.tissue));
  PetscCall(PetscMalloc2(m.tissue->faces, &m.image, m.tissue->faces, &m.queue));
  for (PetscInt face = 0; face < m.tissue->faces; face++) m.image[face] = -1;
  for (PetscInt k = 1; k < 2 * LAM_DIRECTIONS; k++) {
    PetscBool *has = &symmetry->has[k / LAM_DIRECTIONS][k % LAM_DIRECTIONS];

    SetMotion((PetscBool)(k >= LAM_DIRECTIONS), k % LAM_DIRECTIONS, &m);
    for (PetscInt face = 0; face < m.tissue->faces && !*has; face++) *has = Maps(&m, face);
  }
  PetscCall(PetscFree2(m.image, m.queue));
  PetscCall(LamTissueDestroy(&m.tissue));
  PetscFunctionReturn(0);
}

PetscBool LamSymmetryOfStrain(const LamSymmetry *symmetry, PetscBool mirror, PetscInt turn)
{
  return (PetscBool)(symmetry->has[mirror][turn] || symmetry->has[mirror][turn + LAM_DIRECTIONS / 2]);
}

PetscBool LamSymmetryIsHexagonal(const LamSymmetry *symmetry)
{
  PetscBool all = PETSC_TRUE;

  for (PetscInt turn = 0; turn < LAM_DIRECTIONS / 2; turn++)
    for (int mirror = 0; mirror < 2; mirror++)
      all = (PetscBool)(all && LamSymmetryOfStrain(symmetry, (PetscBool)mirror, turn));
  return all;
}
