/*
  The part of a node's record that the table needs: a third of a response, so that a million fit in memory. Extracted
  from a response or from the bytes of the file. The full responses stay in the file until they are requested.
*/
#ifndef LAM_NODE_DATA_H
#define LAM_NODE_DATA_H

#include <lamella/response.h>

/*
  The indicators of a node, in the order of LamResponseMembers, and how they are interpolated (table_indicators.c).
  FRAME: places and tensors in the frame of the cell, which are not. ONE: scalars; THREE: per face, axis or place.
*/
typedef enum { LAM_RULE_MEAN, LAM_RULE_TENSION, LAM_RULE_TRACTION, LAM_RULE_MAX_TRACTION, LAM_RULE_FRAME } LamNodeRule;
#define LAM_NODE_INDICATORS(ONE, THREE)                                                                                \
  ONE(lumen_fraction, MEAN)                                                                                            \
  ONE(opening_fraction, MEAN)                                                                                          \
  THREE(opening_by_face, MEAN)                                                                                         \
  ONE(debonded_fraction, MEAN)                                                                                         \
  THREE(debonded_by_face, MEAN)                                                                                        \
  ONE(open_fraction, MEAN)                                                                                             \
  THREE(open_by_face, MEAN)                                                                                            \
  ONE(debonded_spread, MEAN)                                                                                           \
  ONE(open_spread, MEAN)                                                                                               \
  ONE(max_gap, MEAN)                                                                                                   \
  THREE(gap_place, FRAME)                                                                                              \
  ONE(min_gap, MEAN)                                                                                                   \
  ONE(mean_gap, MEAN)                                                                                                  \
  ONE(max_penetration, MEAN)                                                                                           \
  THREE(fabric, FRAME)                                                                                                 \
  THREE(opening_moment, FRAME)                                                                                         \
  ONE(max_traction, MAX_TRACTION)                                                                                      \
  THREE(normal_place, FRAME)                                                                                           \
  ONE(max_lamella_shear, TENSION)                                                                                      \
  THREE(shear_place, FRAME)                                                                                            \
  THREE(mean_face_traction, TRACTION)                                                                                  \
  ONE(max_fibre_stretch, MEAN)                                                                                         \
  ONE(max_wall_energy, TENSION)                                                                                        \
  ONE(max_wall_tension, TENSION)                                                                                       \
  THREE(wall_place, FRAME)                                                                                             \
  THREE(mean_wall_tension, TENSION)                                                                                    \
  ONE(wall_ellipticity, MEAN)                                                                                          \
  ONE(kinked_fraction, MEAN)

/* The numbers of cells and directions, and that of branch switches. */
#define LAM_NODE_COUNTS(X) X(branch) X(floating_cells) X(zero_modes) X(cell_clusters) X(percolating_directions)

#define LAM_NODE_COUNT(name) PetscInt name;
#define LAM_NODE_ONE(name, rule) float name;
#define LAM_NODE_THREE(name, rule) float name[3];

/*
  Names, signs and units of LamResponse. In-plane parts in the order 11 12 21 22, the tangent row-major:
  tangent[4 (2 i + j) + 2 k + l] = dP_ij/dF_kl. Unknown numbers are NaN, unknown counts LAM_UNKNOWN_COUNT.
*/
typedef struct {
  PetscInt64 key;
  LamStatus status;
  PetscBool stable;
  LAM_NODE_COUNTS(LAM_NODE_COUNT)

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

#define LAM_NODE_INTS 5
#define LAM_NODE_REALS 48
#define LAM_NODE_FLOATS 50

/* Byte offsets of a node's numbers in a record. */
typedef struct {
  size_t real[LAM_NODE_REALS], indicator[LAM_NODE_FLOATS]; /* LAM_NOT_IN_FILE: unknown */
  size_t key, status, stable, count[LAM_NODE_INTS];
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
