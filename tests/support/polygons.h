/* Periodic tissue of polygons: hexagons whose vertices are displaced. */
#ifndef LAM_SUPPORT_POLYGONS_H
#define LAM_SUPPORT_POLYGONS_H

#include <lamella/tissue.h>

/* Moves a vertex of the lattice of hexagons of apothem 1, face normal 0 along X1. It must be affine plus a field of the
   period 2 n along the lattice's vectors. */
typedef void (*Displacement)(PetscInt n, PetscReal X[2]);

void NotDisplaced(PetscInt n, PetscReal X[2]);
void Stretched(PetscInt n, PetscReal X[2]);     /* 1.5 times along X1 */
void Sheared(PetscInt n, PetscReal X[2]);       /* half turns are left */
void Waves(PetscInt n, PetscReal X[2]);         /* no motion is left */
void MirroredWaves(PetscInt n, PetscReal X[2]); /* a mirror along X1 is left */
void OddWaves(PetscInt n, PetscReal X[2]);      /* half turns are left */

/* n x n cells. */
PetscErrorCode PolygonsCreate(PetscInt n, Displacement displace, LamTissue *tissue);

#endif
