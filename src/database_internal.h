/*
  Private to the database: what is in memory of the records, and the expansions made from them.
*/
#ifndef LAM_DATABASE_INTERNAL_H
#define LAM_DATABASE_INTERNAL_H

#include "node_data.h"
#include "record_internal.h"

/*
  Second-order expansion of Phi = Psi + p J about a record, in x = (c0, c1, c2, p) with c0 = (C11 + C22)/2,
  c1 = (C11 - C22)/2, c2 = C12. P33 + p J and the opening dPsi/dg are scalars of C and p too and are expanded to first
  order.
*/
typedef struct {
  PetscReal x[4];
  PetscReal energy, gradient[4], hessian[4][4];
  PetscReal P33, P33_gradient[4]; /* of P33 + p J */
  PetscReal opening, opening_gradient[4];
} LamExpansion;

#define LAM_MAX_IMAGES 6

/* The rotations and mirrors that map the lattice to itself, acting on (c1, c2); image 0 is the identity. */
typedef struct {
  PetscInt count;
  PetscReal map[LAM_MAX_IMAGES][2][2];
  PetscInt face[LAM_MAX_IMAGES][3]; /* face family k of the question is family face[k] of the record */
} LamImages;

/*
  Records 0 .. n-1 are those of the file and, behind them, those added in memory. Of nodes of the grid the database
  keeps what the table needs, of all others the whole response; the whole responses of nodes in the file are loaded when
  LamDatabaseGetRecords first asks for them.
*/
struct LamDatabase_s {
  LamHeader header; /* owned; its `committed` is that of the file, not n */
  char *path;       /* owned; NULL: there is no file */
  LamImages images;
  PetscInt n, capacity;
  PetscInt64 *keys; /* [n] owned */

  PetscInt node_count, node_capacity;
  LamNodeData *nodes; /* [node_count] owned: records with the key of a node, in their order */
  PetscInt scattered_count, scattered_capacity;
  LamResponse *scattered;   /* [scattered_count] owned: all other records, in their order */
  LamExpansion *expansions; /* [scattered_count] owned; x[0] is infinite for records that cannot be used */

  PetscInt records_first,
      records_capacity; /* records_first: of the file's records before LamDatabaseGetRecords, 0 after */
  LamResponse *records; /* [n - records_first] owned: number records_first and on */
  char *info;           /* owned */

  LamGrid grid;   /* owned; NULL: records of no grid only */
  LamTable table; /* the newest, of table_count records; NULL: none yet */
  PetscInt table_count;
};

/* ---- query.c ---- */
/* PETSC_FALSE, with status and reason, for a question that has no answer in plane strain. */
PetscBool LamQuestionIsGood(const LamLoad *load, LamResponse *r);
void LamImagesMake(const LamMicrostructure *micro, LamImages *images);
void LamExpansionMake(const LamResponse *record, LamExpansion *expansion);

/* ---- query_indicators.c ---- */
/* `face`: the record's name of each face family of the question; `own`: the question is the record's own state. */
void LamIndicatorsCopy(const LamResponse *record, const PetscInt face[3], PetscBool own, LamInterfaceLawType interface,
                       LamResponse *r);

/* ---- table_make.c ---- */
PetscErrorCode LamTableMake(LamDatabase database, LamTable *table);
LamTable LamTableReference(LamTable table); /* one more reference */

/* ---- database_info.c ---- */
PetscErrorCode LamDatabaseDescribe(LamDatabase database, char **json);

#endif
