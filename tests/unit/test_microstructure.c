/* The canonical description of a microstructure and its hash. */
#include "record_fixture.h"
#include <database_internal.h>

FILE_TEST(rounding_of_units_does_not_change_the_hash)
{
  LamScene scene = Scene();
  char hash[2][LAM_HASH_LENGTH], *json[2];

  for (int i = 0; i < 2; i++) {
    assert_int_equal(LamMicrostructureDescribe(&scene.micro, &json[i], hash[i]), 0);
    scene.micro.wall.C4 *= 1 + 4e-16;
    scene.micro.orientation = 1e-17;
  }
  assert_string_equal(json[0], json[1]);
  assert_string_equal(hash[0], hash[1]);
  for (int i = 0; i < 2; i++) PetscFree(json[i]);
}

FILE_TEST(another_thickness_changes_the_hash)
{
  LamScene scene = Scene();
  char hash[2][LAM_HASH_LENGTH], *json;

  for (int i = 0; i < 2; i++) {
    assert_int_equal(LamMicrostructureDescribe(&scene.micro, &json, hash[i]), 0);
    scene.micro.wall_thickness += 1e-9;
    PetscFree(json);
  }
  assert_string_not_equal(hash[0], hash[1]);
}

/* A block of six cells, of a period or in a patch, the third one different. */
static LamMicrostructure Uneven(LamCell cell[6], LamInterfaceLawType interface)
{
  LamMicrostructure micro = Scene().micro;

  micro.cells[0] = 2;
  micro.cells[1] = 3;
  micro.interface = interface;
  micro.is_patch = (PetscBool)(interface == LAM_INTERFACE_CONTACT);
  micro.sides = LAM_SIDES_FREE;
  for (int c = 0; c < 6; c++)
    cell[c] = (LamCell){.wall_thickness = 0.15, .wall = micro.wall, .turgor = 1, .cohesion = 1};
  cell[2] = (LamCell){.wall_thickness = 0.1,
                      .wall = {.law = LAM_WALL_MOONEY_RIVLIN, .C1 = 0.5, .C2 = 0.1, .bulk_modulus = 500},
                      .turgor = 0.25,
                      .cohesion = 0.5};
  if (interface == LAM_INTERFACE_BONDED) cell[2].cohesion = 1;
  micro.cell = cell;
  return micro;
}

static void AssertSameCells(const LamMicrostructure *a, const LamMicrostructure *b)
{
  assert_non_null(a->cell);
  for (int c = 0; c < 6; c++) {
    assert_true(fabs(a->cell[c].wall_thickness - b->cell[c].wall_thickness) < 1e-12);
    assert_true(fabs(a->cell[c].wall.C1 - b->cell[c].wall.C1) < 1e-11);
    assert_true(fabs(a->cell[c].wall.C4 - b->cell[c].wall.C4) < 1e-10);
    assert_int_equal(a->cell[c].wall.law, b->cell[c].wall.law);
    assert_true(a->cell[c].turgor == b->cell[c].turgor);
    assert_true(a->cell[c].cohesion == b->cell[c].cohesion);
  }
}

FILE_TEST(a_description_tells_all_and_has_the_same_hash_again)
{
  for (int law = 0; law < LAM_INTERFACE_LAW_COUNT; law++) {
    LamCell cell[6];
    const LamMicrostructure micro = Uneven(cell, (LamInterfaceLawType)law);
    OWNED(LamMicrostructure, LamMicrostructureDestroy) parsed;
    char hash[2][LAM_HASH_LENGTH], *json[2];

    assert_int_equal(LamMicrostructureDescribe(&micro, &json[0], hash[0]), 0);
    assert_int_equal(LamMicrostructureParse("file.h5", json[0], &parsed), 0);
    assert_int_equal(parsed.is_patch, micro.is_patch);
    if (micro.is_patch) assert_int_equal(parsed.sides, micro.sides);
    AssertSameCells(&parsed, &micro);
    assert_int_equal(LamMicrostructureDescribe(&parsed, &json[1], hash[1]), 0);
    assert_string_equal(json[0], json[1]);
    assert_string_equal(hash[0], hash[1]);
    for (int i = 0; i < 2; i++) PetscFree(json[i]);
  }
}

/* Databases of earlier versions keep their name. */
FILE_TEST(tissue_of_equal_cells_keeps_its_hash)
{
  const LamScene scene = Scene();
  char hash[LAM_HASH_LENGTH], *json;

  assert_int_equal(LamMicrostructureDescribe(&scene.micro, &json, hash), 0);
  assert_string_equal(hash, "49573d8214abf19e");
  PetscFree(json);
}

FILE_TEST(a_description_with_a_cell_too_few_is_refused)
{
  LamCell cell[6];
  LamMicrostructure micro = Uneven(cell, LAM_INTERFACE_BONDED), parsed;
  char hash[LAM_HASH_LENGTH], *json, *place;

  assert_int_equal(LamMicrostructureDescribe(&micro, &json, hash), 0);
  place = strstr(json, "\"cells\": [2, 3]");
  assert_non_null(place);
  place[strlen("\"cells\": [2, ")] = '4';
  assert_int_equal(LamMicrostructureParse("file.h5", json, &parsed), PETSC_ERR_USER_INPUT);
  assert_null(parsed.cell);
  assert_non_null(strstr(ErrorMessage, "file.h5"));
  PetscFree(json);
}

FILE_TEST(a_copy_owns_its_cells)
{
  LamCell cell[6];
  const LamMicrostructure micro = Uneven(cell, LAM_INTERFACE_CONTACT);
  OWNED(LamMicrostructure, LamMicrostructureDestroy) copy;

  assert_int_equal(LamMicrostructureCopy(&micro, &copy), 0);
  assert_ptr_not_equal(copy.cell, micro.cell);
  AssertSameCells(&copy, &micro);
}

/* A record answers for its images under the lattice's symmetry: one cell that differs breaks it. */
FILE_TEST(cells_that_differ_leave_no_symmetry)
{
  LamCell cell[6];
  LamMicrostructure micro = Uneven(cell, LAM_INTERFACE_BONDED);
  LamImages images;

  micro.cells[1] = 2;
  LamImagesMake(&micro, &images);
  assert_int_equal(images.count, 1);
  micro.cell = NULL;
  LamImagesMake(&micro, &images);
  assert_int_equal(images.count, LAM_MAX_IMAGES);
}

/* Files, and databases in memory, own what they hold of the scene. */
FILE_TEST(a_file_keeps_the_cells)
{
  LamScene scene = Scene();
  LamRecordWriter writer;
  LamDatabase database;
  LamMicrostructure micro;
  LamCell cell[6];

  scene.micro = Uneven(cell, LAM_INTERFACE_CONTACT);
  assert_int_equal(LamRecordWriterOpen(path, "rve", LAM_WRITE_CREATE, &scene, &writer), 0);
  assert_int_equal(LamRecordWriterCommit(writer, 0, NULL, NULL), 0);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(LamDatabaseOpen(path, &database), 0);
  assert_int_equal(LamDatabaseGetMicrostructure(database, &micro, NULL, NULL), 0);
  AssertSameCells(&micro, &scene.micro);
  assert_int_equal(LamDatabaseClose(&database), 0);
  assert_int_equal(LamDatabaseCreateEmpty(&scene, &database), 0);
  assert_int_equal(LamDatabaseClose(&database), 0);
  AssertSameCells(&scene.micro, &scene.micro);
}
