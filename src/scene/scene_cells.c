/*
  Variation between cells, and checks of a patch of cells between grips.
*/
#include <lamella/tissue.h>
#include "scene_rows.h"
#include <math.h>
#include <string.h>

#define OWN "that of the scene's own cell"

/* The properties that a field varies. */
enum { FIELD_WALL, FIELD_THICKNESS, FIELD_TURGOR, FIELD_COHESION, FIELD_LAMELLA, FIELD_COUNT };
typedef struct {
  PetscReal variation[FIELD_COUNT]; /* coefficients */
  PetscReal correlation;
  PetscInt seed;
} Field;

static const LamKey variation_keys[] = {
    {MAP("rve.variation"), .default_words = "all cells alike",
     .example = "{kinds: [{turgor: 0.5}], pattern: [[0, 1], [1, 0]]}",
     .help = "Cells that differ: `kinds` with one of `list`, `pattern` and `random`, or a `field`. Cell (i, j) is the "
             "j-th along lattice vector 1, or row of a patch, of the i-th along lattice vector 0, or column."},
    {LIST("rve.variation.kinds"), .example = "[{wall_thickness: 8 um, turgor: 0.5}]",
     .help = "Kinds 1, 2, ... of cells; kind 0 is the scene's own cell."},
    {MAP("rve.variation.kinds[]"), .example = "{wall_thickness: 8 um, turgor: 0.5}",
     .help = "One kind; what it leaves out is that of the scene's own cell."},
    {MAP("rve.variation.kinds[].wall"), .example = "{C1: 0.05 MPa}", .help = "Its wall, as `rve.wall`."},
    LAM_OTHER_WALL("rve.variation.kinds[].wall", OWN),
    {LENGTH("rve.variation.kinds[].wall_thickness", "um"), INTO(LamCell, wall_thickness), ABOVE(0),
     .default_words = OWN, .example = "8 um", .help = "Thickness of its wall, less than the apothem."},
    {REAL("rve.variation.kinds[].turgor"), INTO(LamCell, turgor), FROM(0), TO(1000), .default_value = "1",
     .example = "0.5", .help = "Its turgor over that of the load."},
    {REAL("rve.variation.kinds[].cohesion"), INTO(LamCell, cohesion), FROM(0), TO(1000), .default_value = "1",
     .example = "0.8",
     .help = "Its cohesion over that of the load; between two cells the smaller one holds. Not with law `bonded`."},
    {REAL("rve.variation.kinds[].lamella_strength"), INTO(LamCell, lamella_strength), FROM(0), TO(1000),
     .default_value = "1", .example = "0.5",
     .help = "Factor of the strengths of its lamella; between two cells the smaller one holds. Only with law "
             "`lamella`, as the two below."},
    {REAL("rve.variation.kinds[].lamella_energy"), INTO(LamCell, lamella_energy), FROM(0), TO(1000),
     .default_value = "1", .example = "0.5", .help = "Factor of the energies of fracture, likewise."},
    {INTEGER("rve.variation.kinds[].cluster"), INTO(LamCell, cluster), FROM(0), TO(999999999), .default_value = "0",
     .example = "1",
     .help = "Number of a cluster of cells, which `rve.interface.between_clusters` parts from others; the scene's own "
             "cell is of cluster 0."},
    {LIST("rve.variation.list"), .example = "[0, 1, 1, 0]",
     .help = "The kind of each cell, in the order (0, 0), (0, 1), ..., (1, 0), ..."},
    {INTEGER("rve.variation.list[]"), FROM(0), .example = "1", .help = "Kind of one cell."},
    {LIST("rve.variation.pattern"), .example = "[[0, 1], [1, 0]]",
     .help = "Kinds that repeat over the block: cell (i, j) has entry j of entry i, counted from 0 and repeated."},
    {LIST("rve.variation.pattern[]"), .example = "[0, 1]", .help = "All of the same length."},
    {INTEGER("rve.variation.pattern[][]"), FROM(0), .example = "1", .help = "Kind of one cell."},
    {MAP("rve.variation.random"), .example = "{shares: [0.2], seed: 7}",
     .help = "Kinds dealt out at random, the same on every machine."},
    {LIST("rve.variation.random.shares"), REQUIRED, .example = "[0.2]",
     .help = "The share of each kind in all cells, rounded to whole cells; the rest are the scene's own."},
    {REAL("rve.variation.random.shares[]"), FROM(0), TO(1), .example = "0.2", .help = "Share of one kind."},
    {INTEGER("rve.variation.random.seed"), FROM(0), TO(999999999), .default_value = "1", .example = "7",
     .help = "Another number deals them out differently."},
    {MAP("rve.variation.field"), .example = "{wall_thickness: 0.1, turgor: 0.3, seed: 7}",
     .help =
         "Every cell differs: independent lognormal factors with mean 1, given by their coefficients of variation."},
    {REAL("rve.variation.field.wall"), INTO(Field, variation[FIELD_WALL]), FROM(0), TO(1), .default_value = "0",
     .example = "0.2", .help = "Of all moduli of a cell's wall together."},
    {REAL("rve.variation.field.wall_thickness"), INTO(Field, variation[FIELD_THICKNESS]), FROM(0), TO(1),
     .default_value = "0", .example = "0.1", .help = "Of its thickness."},
    {REAL("rve.variation.field.turgor"), INTO(Field, variation[FIELD_TURGOR]), FROM(0), TO(1), .default_value = "0",
     .example = "0.3", .help = "Of its turgor."},
    {REAL("rve.variation.field.cohesion"), INTO(Field, variation[FIELD_COHESION]), FROM(0), TO(1), .default_value = "0",
     .example = "0.3", .help = "Of its cohesion; not with law `bonded`."},
    {REAL("rve.variation.field.lamella"), INTO(Field, variation[FIELD_LAMELLA]), FROM(0), TO(1), .default_value = "0",
     .example = "0.3", .help = "Of strength and fracture energy of its lamella together; only with law `lamella`."},
    {REAL("rve.variation.field.correlation"), INTO(Field, correlation), FROM(0), TO(20), .default_value = "0",
     .example = "2",
     .help = "Correlation length l in distances of neighbours: the logarithms of the factors of two cells r apart have "
             "about the correlation exp(-(r/l)^2). 0: cells independent of each other."},
    {INTEGER("rve.variation.field.seed"), INTO(Field, seed), FROM(0), TO(999999999), .default_value = "1",
     .example = "7", .help = "Another number gives other cells."},
};
LAM_KEY_TABLE(LamVariationKeys, variation_keys);

typedef struct {
  const LamNode *block; /* rve.variation */
  PetscInt kind_count;  /* besides kind 0, the scene's own cell */
  PetscInt kind_of[LAM_MAX_CELLS * LAM_MAX_CELLS];
} Variation;

static LamCell OwnCell(const LamMicrostructure *micro)
{
  return (LamCell){.wall_thickness = micro->wall_thickness,
                   .wall = micro->wall,
                   .turgor = 1.0,
                   .cohesion = 1.0,
                   .lamella_strength = 1.0,
                   .lamella_energy = 1.0};
}

/* ---- kinds of cells ---- */

static PetscErrorCode CheckLamella(const LamNode *kind, const LamMicrostructure *micro)
{
  static const char *const own[] = {"lamella_strength", "lamella_energy", "cluster"};
  const LamNode *cluster = LamNodeFind(kind, "cluster");

  PetscFunctionBeginUser;
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(own); i++) {
    const LamNode *node = LamNodeFind(kind, own[i]);

    LamSceneCheckName(!node || micro->interface == LAM_INTERFACE_LAMELLA, node, LAM_NOT_LAMELLA,
                      LamInterfaceLawNames[micro->interface]);
  }
  LamSceneCheckName(!cluster || LamNodeFind(kind->document->root, "rve.interface.between_clusters"), cluster,
                    "says nothing without rve.interface.between_clusters; write that, or leave it out");
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadKind(const LamNode *kind, const LamScene *scene, LamCell *cell)
{
  const LamNode *wall = LamNodeFind(kind, "wall"), *cohesion = LamNodeFind(kind, "cohesion");
  const LamMicrostructure *micro = &scene->micro;

  PetscFunctionBeginUser;
  *cell = OwnCell(micro);
  PetscCall(LamSceneFill(kind, &scene->scales, LamCell, cell));
  LamSceneCheck(cell->wall_thickness < 1.0, LamNodeFind(kind, "wall_thickness"),
                "the wall fills the cell; write a thickness less than the apothem");
  if (wall) PetscCall(LamSceneReadWall(wall, &scene->scales, &micro->wall, &cell->wall));
  LamSceneCheck(!cohesion || LamCellsPart(micro->interface), cohesion, LAM_BONDED_PARTS);
  PetscCall(CheckLamella(kind, micro));
  PetscFunctionReturn(0);
}

static PetscErrorCode KindNumber(const Variation *v, const LamNode *node, PetscInt *kind)
{
  PetscFunctionBeginUser;
  *kind = 0;
  LamSceneCheck(node->value.number[0] <= (PetscReal)v->kind_count, node,
                "kinds has only %d; write a number from 0, the scene's own cell, to %d", (int)v->kind_count,
                (int)v->kind_count);
  *kind = (PetscInt)node->value.number[0];
  PetscFunctionReturn(0);
}

static PetscErrorCode AssignList(Variation *v, const LamNode *list, const PetscInt cells[2])
{
  PetscInt cell = 0;

  PetscFunctionBeginUser;
  LamSceneCheck(list->count == cells[0] * cells[1], list, "has %d entries; write one for each of the %d x %d cells",
                (int)list->count, (int)cells[0], (int)cells[1]);
  for (const LamNode *item = list->first; item; item = item->next) PetscCall(KindNumber(v, item, &v->kind_of[cell++]));
  PetscFunctionReturn(0);
}

static PetscErrorCode AssignPattern(Variation *v, const LamNode *pattern, const PetscInt cells[2])
{
  const PetscInt rows = pattern->count, columns = pattern->first->count;

  PetscFunctionBeginUser;
  LamSceneCheckName(!LamNodeFind(pattern->document->root, "rve.tissue"), pattern,
                    "the cells of a tissue file are in no rows; write a list, or classes in the file");
  for (const LamNode *row = pattern->first; row; row = row->next) {
    PetscInt j = 0;

    LamSceneCheck(row->count == columns, row, "has %d entries, the first one %d; write lists of the same length",
                  (int)row->count, (int)columns);
    for (const LamNode *item = row->first; item; item = item->next, j++) {
      PetscInt kind;

      PetscCall(KindNumber(v, item, &kind));
      for (PetscInt i = row->index - 1; i < cells[0]; i += rows)
        for (PetscInt at = j; at < cells[1]; at += columns) v->kind_of[i * cells[1] + at] = kind;
    }
  }
  PetscFunctionReturn(0);
}

/* Fractions of all cells, rounded so that they add up, then shuffled. */
static PetscErrorCode AssignRandom(Variation *v, const LamNode *random, const PetscInt cells[2])
{
  const PetscInt count = cells[0] * cells[1];
  const LamNode *shares = LamNodeFind(random, "shares"), *node;
  PetscReal sum = 0.0;
  PetscInt cell = 0, kind = 1;
  LamValue seed;

  PetscFunctionBeginUser;
  PetscCall(LamSceneGet(v->block, "rve.variation.random.seed", &node, &seed));
  LamSceneCheck(shares->count == v->kind_count, shares, "has %d entries; write one for each of the %d kinds",
                (int)shares->count, (int)v->kind_count);
  for (const LamNode *item = shares->first; item; item = item->next, kind++) {
    sum += item->value.number[0];
    LamSceneCheck(sum <= 1.0 + 1e-9, shares, "adds up to more than 1; lower the shares");
    while (cell < PetscMin(count, (PetscInt)floor(sum * (PetscReal)count + 0.5))) v->kind_of[cell++] = kind;
  }
  LamRandomShuffle((PetscInt)seed.number[0], count, v->kind_of);
  PetscFunctionReturn(0);
}

/* The classes of a tissue file. */
static PetscErrorCode AssignClasses(Variation *v, const PetscInt class[], PetscInt cells)
{
  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < cells; c++) {
    LamSceneCheckName(class[c] <= v->kind_count, LamNodeFind(v->block, "kinds"),
                      "has %d kinds, and the file of the tissue has a cell of class %d; write that kind, too",
                      (int)v->kind_count, (int)class[c]);
    v->kind_of[c] = class[c];
  }
  PetscFunctionReturn(0);
}

/* Exactly one of list, pattern and random is given, or the classes of a tissue file. */
static PetscErrorCode AssignKinds(Variation *v, const PetscInt class[], const PetscInt cells[2])
{
  static const struct {
    const char *name;
    PetscErrorCode (*assign)(Variation *, const LamNode *, const PetscInt[2]);
  } methods[] = {{"list", AssignList}, {"pattern", AssignPattern}, {"random", AssignRandom}};
  const LamNode *found = NULL;
  PetscInt method = 0;

  PetscFunctionBeginUser;
  for (PetscInt m = 0; m < (PetscInt)PETSC_STATIC_ARRAY_LENGTH(methods); m++) {
    const LamNode *node = LamNodeFind(v->block, methods[m].name);

    if (!node) continue;
    LamSceneCheckName(!found, node, "given together with %s; a variation has one of them", found->name);
    LamSceneCheckName(!class, node, "the file of the tissue says of which class each cell is; leave it out");
    found = node;
    method = m;
  }
  if (class) {
    PetscCall(AssignClasses(v, class, cells[0] * cells[1]));
    PetscFunctionReturn(0);
  }
  LamSceneRequire(found, v->block, "list", "missing; write which cell is of which kind as a list, a pattern or random");
  PetscCall(methods[method].assign(v, found, cells));
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildKinds(const LamNode *block, const LamNode *kinds, const LamSceneTissue *tissue,
                                 LamScene *scene)
{
  LamMicrostructure *micro = &scene->micro;
  Variation v = {.block = block, .kind_count = kinds->count};
  LamCell cell = OwnCell(micro);
  PetscInt k = 0; /* the kind of `cell` */

  PetscFunctionBeginUser;
  PetscCall(AssignKinds(&v, tissue->class, micro->cells));
  for (const LamNode *kind = kinds->first;; kind = kind->next, k++) {
    for (PetscInt c = 0; c < micro->cells[0] * micro->cells[1]; c++)
      if (v.kind_of[c] == k) micro->cell[c] = cell;
    if (!kind) break;
    LamSceneCheckName(!tissue->thickness || !LamNodeFind(kind, "wall_thickness"), LamNodeFind(kind, "wall_thickness"),
                      "the file of the tissue has the thickness of walls; leave it out");
    PetscCall(ReadKind(kind, scene, &cell));
  }
  PetscFunctionReturn(0);
}

/* ---- fields ---- */

static PetscErrorCode ApplyFactors(const LamNode *field, const PetscReal factors[], LamMicrostructure *micro)
{
  const PetscInt count = micro->cells[0] * micro->cells[1];

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < count; c++) {
    LamCell *cell = &micro->cell[c];

    *cell = OwnCell(micro);
    LamWallScale(&cell->wall, factors[FIELD_WALL * count + c], 1.0);
    cell->wall_thickness *= factors[FIELD_THICKNESS * count + c];
    cell->turgor = factors[FIELD_TURGOR * count + c];
    cell->cohesion = factors[FIELD_COHESION * count + c];
    cell->lamella_strength = cell->lamella_energy = factors[FIELD_LAMELLA * count + c];
    LamSceneCheck(cell->wall_thickness < 1.0, field,
                  "the wall of cell (%d, %d) becomes %.3g apothems thick and fills it; write a smaller wall_thickness "
                  "here, thinner walls, or another seed",
                  (int)(c / micro->cells[1]), (int)(c % micro->cells[1]), (double)cell->wall_thickness);
  }
  PetscFunctionReturn(0);
}

static PetscErrorCode BuildField(const LamNode *node, LamScene *scene)
{
  const LamNode *wall = LamNodeFind(node, "wall"), *thickness = LamNodeFind(node, "wall_thickness");
  const LamNode *turgor = LamNodeFind(node, "turgor"), *cohesion = LamNodeFind(node, "cohesion");
  const LamNode *lamella = LamNodeFind(node, "lamella");
  LamMicrostructure *micro = &scene->micro;
  PetscReal *factors;
  PetscErrorCode ierr;
  Field field;

  PetscFunctionBeginUser;
  PetscCall(LamSceneFill(node, &scene->scales, Field, &field));
  LamSceneCheck(!cohesion || LamCellsPart(micro->interface), cohesion, LAM_BONDED_PARTS);
  LamSceneCheckName(!lamella || micro->interface == LAM_INTERFACE_LAMELLA, lamella, LAM_NOT_LAMELLA,
                    LamInterfaceLawNames[micro->interface]);
  LamSceneCheckName(wall || thickness || turgor || cohesion || lamella, node,
                    "varies nothing; write a coefficient of variation, such as wall: 0.2, or leave out variation");
  PetscCall(PetscMalloc1(FIELD_COUNT * micro->cells[0] * micro->cells[1], &factors));
  ierr = LamRandomFactors(micro, field.seed, field.correlation, FIELD_COUNT, field.variation, factors);
  if (!ierr) ierr = ApplyFactors(node, factors, micro);
  PetscCall(PetscFree(factors));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

/* ---- variation ---- */

/* Removes a variation in which all cells equal the scene's own. */
static PetscErrorCode DropVariation(LamMicrostructure *micro)
{
  const LamCell own = OwnCell(micro);

  PetscFunctionBeginUser;
  for (PetscInt c = 0; c < micro->cells[0] * micro->cells[1]; c++) {
    if (!LamCellsAgree(&micro->cell[c], &own, 1e-12)) PetscFunctionReturn(0); /* rounding of unit conversion */
  }
  PetscCall(PetscFree(micro->cell));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneSetThickness(const LamNode *node, const PetscReal thickness[], PetscReal length,
                                    LamMicrostructure *micro)
{
  const PetscInt cells = micro->cells[0] * micro->cells[1];

  PetscFunctionBeginUser;
  if (!micro->cell) {
    PetscCall(PetscMalloc1(cells, &micro->cell));
    for (PetscInt c = 0; c < cells; c++) micro->cell[c] = OwnCell(micro);
  }
  for (PetscInt c = 0; c < cells; c++) {
    const PetscReal factor = micro->cell[c].wall_thickness / micro->wall_thickness;

    micro->cell[c].wall_thickness = factor * thickness[c] / length;
    LamSceneCheck(micro->cell[c].wall_thickness < 1.0, node, "the walls of cell %d, %.3g um, fill it", (int)c,
                  (double)(1e6 * factor * thickness[c]));
  }
  PetscCall(DropVariation(micro));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildCells(const LamNode *root, const LamSceneTissue *tissue, LamScene *scene)
{
  const LamNode *block = LamNodeFind(root, "rve.variation");
  const LamNode *kinds = LamNodeFind(block, "kinds"), *field = LamNodeFind(block, "field");
  const LamNode *file = LamNodeFind(root, "rve.tissue");
  LamMicrostructure *micro = &scene->micro;

  PetscFunctionBeginUser;
  for (PetscInt c = 0; !kinds && tissue->class && c < micro->cells[0]; c++)
    LamSceneCheck(tissue->class[c] == 0, file,
                  "cell %d is of class %d; write rve.variation.kinds, which says what its cells have", (int)c,
                  (int)tissue->class[c]);
  if (!block && tissue->thickness)
    PetscCall(LamSceneSetThickness(file, tissue->thickness, scene->scales.length, micro));
  if (!block) PetscFunctionReturn(0);
  LamSceneCheckName(!field || block->count == 1, field,
                    "given together with %s; a variation has a field alone, or kinds and one of list, pattern and "
                    "random",
                    field == block->first ? block->last->name : block->first->name);
  LamSceneRequire(field || kinds, block, "kinds",
                  "missing; write the kinds of cells, such as [{turgor: 0.5}], or a field, such as {turgor: 0.3}");
  PetscCall(PetscCalloc1(micro->cells[0] * micro->cells[1], &micro->cell));
  if (field)
    PetscCall(BuildField(field, scene));
  else
    PetscCall(BuildKinds(block, kinds, tissue, scene));
  if (tissue->thickness)
    PetscCall(LamSceneSetThickness(file, tissue->thickness, scene->scales.length, micro));
  else
    PetscCall(DropVariation(micro));
  PetscFunctionReturn(0);
}

/* ---- checks of patches ---- */

/*
  In contact without cohesion a wall only pushes. A cell between the grips with a free outer wall is pushed out by its
  neighbours and by its own turgor, and no force restores it.
*/
static PetscErrorCode CheckHold(const LamNode *root, const LamNode *node, PetscReal cohesion)
{
  const char *remedy = "without cohesion nothing holds the outer cells of a patch whose sides are free: their "
                       "neighbours push them out; write a cohesion larger than 0 MPa, law: bonded, or sides: affine";

  PetscFunctionBeginUser;
  if (cohesion > 0.0) PetscFunctionReturn(0);
  if (!node) node = LamNodeFind(root, "rve.interface.cohesion");
  LamSceneCheck(!node, node, "%s", remedy);
  PetscCall(LamSceneRaise(LamNodeFind(root, "rve.interface"), LAM_MISTAKE_MISSING, "cohesion", "%s", remedy));
  PetscFunctionReturn(0);
}

/* True if the cohesion of a neighbour holds a cell: between two cells the smaller cohesion acts. */
static PetscBool IsHeldByNeighbour(const LamMicrostructure *micro, PetscInt cell)
{
  for (PetscInt face = 0; face < LamCellFaces(micro, cell); face++) {
    const PetscInt other = LamCellAcross(micro, cell, face);

    if (other >= 0 && PetscMin(micro->cell[cell].cohesion, micro->cell[other].cohesion) > 0.0) return PETSC_TRUE;
  }
  return PETSC_FALSE;
}

PetscBool LamSceneNeedsCohesion(const LamMicrostructure *micro)
{
  /* in a patch of two rows a grip holds every cell */
  return (PetscBool)(micro->is_patch && micro->interface == LAM_INTERFACE_CONTACT && micro->sides == LAM_SIDES_FREE &&
                     micro->cells[1] > 2);
}

PetscErrorCode LamSceneCheckPatch(const LamNode *root, LamScene *scene)
{
  static const char *const others[] = {"sample", "macro"};
  const LamMicrostructure *micro = &scene->micro;
  const LamNode *loads = LamNodeFind(root, "load"), *file = LamNodeFind(root, "rve.tissue");
  const LamNode *patch = file ? file : LamNodeFind(root, "rve.patch");
  const PetscInt columns = micro->cells[0], rows = micro->cells[1];

  PetscFunctionBeginUser;
  if (!micro->is_patch) PetscFunctionReturn(0);
  for (PetscInt i = 0; i < 2; i++) {
    const LamNode *node = LamNodeFind(root, others[i]);

    LamSceneCheckName(!node, node,
                      "a patch (line %d) is a body between grips, no material point, and is solved by lamella rve and "
                      "map; leave %s out, or %s",
                      patch->name_line, others[i],
                      file ? "name a file whose tissue has a period" : "write rve.cells instead of the patch");
  }
  if (!LamSceneNeedsCohesion(micro)) PetscFunctionReturn(0);
  if (!loads) PetscCall(CheckHold(root, NULL, scene->cohesion));
  for (const LamNode *entry = loads ? loads->first : NULL; entry; entry = entry->next) {
    const LamNode *node = LamNodeFind(entry, "cohesion");

    PetscCall(CheckHold(root, node, node ? node->value.number[0] : scene->cohesion));
  }
  for (PetscInt row = 1; micro->cell && row < rows - 1; row++)
    for (PetscInt column = 0; column < columns; column += PetscMax(columns - 1, 1))
      LamSceneCheckName(IsHeldByNeighbour(micro, column * rows + row), LamNodeFind(root, "rve.variation"),
                        "cell (%d, %d) at a free side has no cohesion with any neighbour, and they push it out; give "
                        "it some, or write sides: affine",
                        (int)column, (int)row);
  PetscFunctionReturn(0);
}
