#include "analytic_table.h"
#include "test.h"

LamScene AnalyticScene(const AnalyticTissue *tissue)
{
  LamScene scene = {.path = "analytic", .has_sample = PETSC_TRUE, .scales = {1, 1}};

  scene.micro = (LamMicrostructure){.wall_thickness = 0.15, .cells = {1, 1}, .along = 6, .through = 2};
  scene.micro.wall.bulk_modulus = 1000;
  scene.micro.orientation = tissue->orientation;
  scene.micro.interface = tissue->contact ? LAM_INTERFACE_CONTACT : LAM_INTERFACE_BONDED;
  scene.cohesion = tissue->contact ? TISSUE_G0 : 0;
  scene.sample = (LamSample){.stretch_min = -0.05, .stretch_max = 0.25, .turgor_min = 0, .turgor_max = 2 * TISSUE_P0};
  if (tissue->contact) {
    scene.sample.turgor_min = 0.1 * TISSUE_SUCTION - TISSUE_G0;
    scene.sample.turgor_max = TISSUE_SUCTION - TISSUE_G0;
  }
  if (tissue->axial) {
    scene.sample.F33_min = 0.85;
    scene.sample.F33_max = 1.25;
  }
  return scene;
}

PetscErrorCode AnalyticGridCreate(const LamScene *scene, AnalyticTissue *tissue, LamGrid *grid)
{
  const LamResponderFunctions functions = {.respond = TissueRespond};
  LamResponder solver;
  PetscErrorCode ierr;

  CHECK(LamResponderCreate(&functions, tissue, NULL, &solver));
  ierr = LamGridCreate(scene, solver, grid);
  CHECK(LamResponderDestroy(&solver));
  return ierr;
}

AnalyticTable AnalyticTableOpenScene(AnalyticTissue tissue, LamScene scene)
{
  AnalyticTable t = {.tissue = tissue, .scene = scene};
  const LamResponse *records;
  const PetscInt64 *keys;
  LamGrid grid;
  PetscInt n;

  CHECK(AnalyticGridCreate(&t.scene, &t.tissue, &grid));
  CHECK(LamDatabaseCreateEmpty(&t.scene, &t.database));
  CHECK(LamGridGetRecords(grid, &n, &keys, &records));
  CHECK(LamDatabaseAdd(t.database, n, keys, records));
  t.grid = grid;
  CHECK(LamDatabaseSetGrid(t.database, &grid));
  return t;
}

AnalyticTable AnalyticTableOpen(PetscBool contact, double orientation)
{
  const AnalyticTissue tissue = {contact, orientation, PETSC_FALSE};

  return AnalyticTableOpenScene(tissue, AnalyticScene(&tissue));
}

void AnalyticTableClose(AnalyticTable *t)
{
  CHECK(LamDatabaseClose(&t->database));
}

PetscInt64 KeyOf(const AnalyticTable *t, const int i[3], int j)
{
  return KeyAt(t, i, j, 0);
}

PetscInt64 KeyAt(const AnalyticTable *t, const int i[3], int j, int z)
{
  LamNodePlace place = {{i[0], i[1], i[2]}, j, z};

  for (int pass = 0; pass < 2 && t->grid->symmetric; pass++)
    for (int k = 0; k < 2; k++)
      if (place.i[k] > place.i[k + 1]) {
        const int larger = place.i[k];

        place.i[k] = place.i[k + 1];
        place.i[k + 1] = larger;
      }
  return LamNodeKeyOf(&place);
}

LamResponse AnswerOf(const AnalyticTable *t, PetscInt64 key)
{
  LamLoad load;

  CHECK(LamGridNodeLoad(t->grid, key, &load));
  return TissueAnswer(&t->tissue, &load);
}

PetscBool HasKey(const AnalyticTable *t, PetscInt64 key)
{
  const PetscInt64 *keys;
  PetscInt n;

  CHECK(LamDatabaseGetRecords(t->database, &n, NULL, &keys));
  for (PetscInt k = 0; k < n; k++)
    if (keys[k] == key) return PETSC_TRUE;
  return PETSC_FALSE;
}

void AddKey(AnalyticTable *t, PetscInt64 key)
{
  const LamResponse r = AnswerOf(t, key);

  if (!HasKey(t, key)) CHECK(LamDatabaseAdd(t->database, 1, &key, &r));
}

void AddPlace(AnalyticTable *t, const int i[3], int j)
{
  const int knots = t->grid->z_cells ? (int)t->grid->z_cells + 1 : 0;

  if (LamPlaceIsFloating(t->grid, i)) return;
  for (int z = knots ? 1 : 0; z <= knots; z++) AddKey(t, KeyAt(t, i, j, z));
}

void AddFailed(AnalyticTable *t, const int i[3], int j)
{
  const PetscInt64 key = KeyAt(t, i, j, t->grid->z_cells ? 2 : 0);
  LamResponse r;
  LamLoad load;

  if (LamPlaceIsFloating(t->grid, i) || HasKey(t, key)) return;
  CHECK(LamGridNodeLoad(t->grid, key, &load));
  CHECK(LamResponseInit(&load, &r));
  CHECK(LamDatabaseAdd(t->database, 1, &key, &r));
}

void AddBlock(AnalyticTable *t, int level, const int first[3], int cells, int along)
{
  const int size = LAM_ROOT >> level, n = cells + 1;

  for (int at = 0; at < n * n * n; at++) {
    const int i[3] = {first[0] + size * (at % n), first[1] + size * (at / n % n), first[2] + size * (at / n / n)};

    for (int j = 0; j <= LAM_ROOT * t->grid->tau_cells; j += along) AddPlace(t, i, j);
  }
}

LamLoad LoadAt(const AnalyticTable *t, const double u[3], double v, double angle)
{
  return LoadAtF33(t, u, v, 0, angle);
}

LamLoad LoadAtF33(const AnalyticTable *t, const double u[3], double v, double w, double angle)
{
  const double c = cos(angle), s = sin(angle);
  LamLoad load = {.turgor = t->grid->turgor};
  double shift = t->grid->origin, a[6] = {0}, U[4], x[3];

  if (t->grid->contact) {
    const double suction = t->grid->suction_scale * expm1(t->grid->tau_min + t->grid->tau_step * v / LAM_ROOT);

    LamGridFreeStrain(t->grid, suction, w, a);
    load.cohesion = t->grid->cohesion;
    load.turgor = suction - load.cohesion;
    shift += a[0];
  }
  for (int k = 0; k < 3; k++) x[k] = shift + t->grid->step * u[k] / LAM_ROOT;
  if (!LamLatticeStretch(&t->grid->axes, x, U)) memset(U, 0, sizeof(U));
  load.F[0] = c * U[0] - s * U[2];
  load.F[1] = c * U[1] - s * U[3];
  load.F[3] = s * U[0] + c * U[2];
  load.F[4] = s * U[1] + c * U[3];
  load.F[8] = t->grid->z_cells ? exp(t->grid->z_min + t->grid->z_step * w) : 1;
  return load;
}

LamResponse AskFor(const AnalyticTable *t, const LamLoad *load, double accuracy)
{
  LamResponse r;
  LamTable table;

  CHECK(LamDatabaseGetTable(t->database, &table));
  CHECK(LamTableQuery(table, load, accuracy, &r));
  CHECK(LamTableDestroy(&table));
  return r;
}

LamResponse Ask(const AnalyticTable *t, const LamLoad *load)
{
  return AskFor(t, load, PETSC_INFINITY);
}

static void AddSome(AnalyticTable *t, const int i[3], int j, uint64_t *seed)
{
  for (int z = 1; z <= t->grid->z_cells + 1; z++)
    if (!LamPlaceIsFloating(t->grid, i) && RandomReal(seed, 0, 1) < 0.75) AddKey(t, KeyAt(t, i, j, z));
}

PetscBool Answers(const AnalyticTable *t, const LamLoad *load, LamResponse *r)
{
  *r = Ask(t, load);
  return (PetscBool)(r->status == LAM_CONVERGED);
}

void AnswerPair(const AnalyticTable *t, const LamLoad *load, size_t offset, double h, LamResponse pair[2])
{
  for (int side = 0; side < 2; side++) {
    LamLoad moved = *load;

    *(PetscReal *)((char *)&moved + offset) += side ? h : -h;
    assert_true(Answers(t, &moved, &pair[side]));
  }
}

void AddRough(AnalyticTable *t, int cells, double failing, uint64_t *seed)
{
  const int corner = t->grid->contact ? -LAM_ROOT * cells : 0, first[3] = {corner, corner, corner};

  AddBlock(t, 0, first, t->grid->contact ? cells + 1 : cells, LAM_ROOT);
  for (int level = 1; level <= 2; level++) {
    const int size = LAM_ROOT >> level, n = cells * (1 << level) + 1;

    for (int at = 0; at < n * n * n; at++) {
      const int i[3] = {first[0] + size * (at % n), first[1] + size * (at / n % n), first[2] + size * (at / n / n)};

      if (RandomReal(seed, 0, 1) > 0.25) continue;
      for (int j = 0; j <= LAM_ROOT * t->grid->tau_cells; j += LAM_ROOT / 4)
        if (RandomReal(seed, 0, 1) < (j % LAM_ROOT ? 0.3 : 0.9)) {
          if (RandomReal(seed, 0, 1) < failing)
            AddFailed(t, i, j);
          else if (t->grid->z_cells)
            AddSome(t, i, j, seed);
          else
            AddPlace(t, i, j);
        }
    }
  }
  /* columns of root cells with more states than their neighbours' */
  for (int at = 0; at < 27 && t->grid->contact; at++) {
    const int i[3] = {-LAM_ROOT * (at % 3), -LAM_ROOT * (at / 3 % 3), -LAM_ROOT * (at / 9)};

    if (at % 2) AddPlace(t, i, LAM_ROOT / 2);
  }
}
