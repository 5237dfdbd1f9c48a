/*
  The part of a node's record that the table needs: a third of a response, so that a million fit in memory. Extracted
  from a response or from the bytes of the file. The full responses stay in the file until they are requested.
*/
#ifndef LAM_NODE_DATA_H
#define LAM_NODE_DATA_H

#include <lamella/response.h>

/* The indicators of a node, in the order of LamResponseMembers. ONE: scalars; THREE: per face, axis or place. */
#define LAM_NODE_INDICATORS(ONE, THREE)                                                                                \
  ONE(lumen_fraction)                                                                                                  \
  ONE(opening_fraction)                                                                                                \
  THREE(opening_by_face)                                                                                               \
  ONE(debonded_fraction)                                                                                               \
  THREE(debonded_by_face)                                                                                              \
  ONE(open_fraction)                                                                                                   \
  THREE(open_by_face)                                                                                                  \
  ONE(debonded_spread)                                                                                                 \
  ONE(open_spread)                                                                                                     \
  ONE(max_gap)                                                                                                         \
  THREE(gap_place)                                                                                                     \
  ONE(min_gap)                                                                                                         \
  ONE(mean_gap)                                                                                                        \
  ONE(max_penetration)                                                                                                 \
  THREE(fabric)                                                                                                        \
  THREE(opening_moment)                                                                                                \
  ONE(max_traction)                                                                                                    \
  THREE(normal_place)                                                                                                  \
  ONE(max_lamella_shear)                                                                                               \
  THREE(shear_place)                                                                                                   \
  THREE(mean_face_traction)                                                                                            \
  ONE(max_fibre_stretch)                                                                                               \
  ONE(max_wall_energy)                                                                                                 \
  ONE(max_wall_tension)                                                                                                \
  THREE(wall_place)                                                                                                    \
  THREE(mean_wall_tension)                                                                                             \
  ONE(wall_ellipticity)                                                                                                \
  ONE(kinked_fraction)

#define LAM_NODE_ONE(name) float name;
#define LAM_NODE_THREE(name) float name[3];

/*
  Names, signs and units of LamResponse. In-plane parts in the order 11 12 21 22, the tangent row-major:
  tangent[4 (2 i + j) + 2 k + l] = dP_ij/dF_kl. Unknown numbers are NaN, unknown counts LAM_UNKNOWN_COUNT.
*/
typedef struct {
  PetscInt64 key;
  LamStatus status;
  PetscBool stable;
  PetscInt branch;
  PetscInt floating_cells, zero_modes, cell_clusters, percolating_directions;

  /* reals, contiguous from F to energy_turgor_cohesion */
  PetscReal F[4], turgor, cohesion; /* the load */
  PetscReal energy;
  PetscReal P[4], P33;
  PetscReal tangent[16];
  PetscReal P33_F[4], P33_F33; /* row 33 of the tangent: dP33/dF_kl, dP33/dF33 */
  PetscReal P_turgor[4], P33_turgor;
  PetscReal energy_turgor, energy_turgor2;
  PetscReal P_cohesion[4], P33_cohesion;
  PetscReal energy_cohesion, energy_cohesion2, energy_turgor_cohesion;

  /* indicators, contiguous from lumen_fraction to kinked_fraction */
  LAM_NODE_INDICATORS(LAM_NODE_ONE, LAM_NODE_THREE)
} LamNodeData;

#define LAM_NODE_REALS 48
#define LAM_NODE_FLOATS 50

/* Byte offsets of a node's numbers in a record. */
typedef struct {
  size_t real[LAM_NODE_REALS], indicator[LAM_NODE_FLOATS]; /* LAM_NOT_IN_FILE: unknown */
  size_t key, status, stable, branch, floating_cells, zero_modes, cell_clusters, percolating_directions;
} LamNodeLayout;

/* Nodes in memory; owned by the code that fills the set. */
typedef struct {
  PetscInt count, capacity;
  LamNodeData *data; /* [count] */
} LamNodeSet;

/* key: byte offset of the key in a record; member: those of LamResponseMembers, in their order. */
void LamNodeLayoutMake(size_t key, const size_t member[], LamNodeLayout *layout);
void LamNodeDataFromBytes(const LamNodeLayout *layout, const unsigned char *bytes, LamNodeData *node);
void LamNodeDataFromResponse(const LamResponse *response, PetscInt64 key, LamNodeData *node);

#endif
