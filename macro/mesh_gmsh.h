/*
  What a Gmsh file holds: nodes, elements, and the physical groups of the entities that elements lie on.
*/
#ifndef LAM_MESH_GMSH_H
#define LAM_MESH_GMSH_H

#include <lamella/scene.h>
#include <petscdmplex.h>

#define LAM_GMSH_WHY 240
enum { LAM_GMSH_NODES = 9 }; /* most of an element */

/* A type of elements. The nodes of a second-order element: corners, middles of edges, centre. */
typedef struct {
  int type, nodes, order, dimension;
  DMPolytopeType polytope;
  const char *edges; /* corners at the ends of edges, in the order of the middle nodes: "011220" of a triangle */
} LamGmshKind;

/* Lists are sorted by their keys, which all items begin with. */
typedef struct {
  int64_t key[2]; /* tag, 0 */
  double X[3];
} LamGmshNode;

typedef struct {
  int64_t key[2]; /* dimension, tag of the physical group */
  char name[LAM_NAME_LENGTH];
} LamGmshName;

typedef struct {
  const LamGmshKind *kind;
  size_t first, groups;        /* of its physical groups in LamGmsh.groups, and how many */
  size_t node[LAM_GMSH_NODES]; /* numbers in the list of nodes */
} LamGmshElement;

/* `count` items, owned. */
typedef struct {
  size_t count, room;
  void *items;
} LamGmshList;

typedef struct {
  LamGmshList nodes, names, elements;
  LamGmshList groups; /* int64_t: tags of physical groups */
} LamGmsh;

/* Appends a zero item of that size, or returns NULL where there is no memory. */
void *LamGmshAppend(LamGmshList *list, size_t size);
void LamGmshSort(LamGmshList *list, size_t size);
/* The item with that key of a sorted list, or NULL. */
void *LamGmshFind(const LamGmshList *list, size_t size, int64_t first, int64_t second);

/* Reads a file, safe against any bytes in it. PETSC_FALSE: `why` says what is wrong, and where. */
PetscBool LamGmshRead(const char path[], LamGmsh *gmsh, char why[LAM_GMSH_WHY]);
void LamGmshFree(LamGmsh *gmsh);

#endif
