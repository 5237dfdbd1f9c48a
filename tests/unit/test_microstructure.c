/* The canonical description of a microstructure and its hash. */
#include "record_fixture.h"
#include <database_internal.h>
#include <microstructure_compare.h>

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
    cell[c] = (LamCell){.wall_thickness = 0.15,
                        .wall = micro.wall,
                        .turgor = 1,
                        .cohesion = 1,
                        .lamella_strength = 1,
                        .lamella_energy = 1};
  cell[2] = (LamCell){.wall_thickness = 0.1,
                      .wall = {.law = LAM_WALL_MOONEY_RIVLIN, .C1 = 0.5, .C2 = 0.1, .bulk_modulus = 500},
                      .turgor = 0.25,
                      .cohesion = 0.5,
                      .lamella_strength = 1,
                      .lamella_energy = 1};
  if (interface == LAM_INTERFACE_BONDED) cell[2].cohesion = 1;
  if (interface == LAM_INTERFACE_LAMELLA) {
    cell[2].lamella_strength = 0.5;
    cell[2].lamella_energy = 0.75;
    cell[2].cluster = 3;
  }
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
    assert_true(a->cell[c].lamella_strength == b->cell[c].lamella_strength);
    assert_true(a->cell[c].lamella_energy == b->cell[c].lamella_energy);
    assert_int_equal(a->cell[c].cluster, b->cell[c].cluster);
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

static const LamLamella every = {.softening = LAM_SOFTENING_EXPONENTIAL,
                                 .stiffness = 2000,
                                 .strength = 0.5,
                                 .energy = 0.125,
                                 .shear_strength = 0.25,
                                 .shear_energy = 0.375,
                                 .mixing = 1.5,
                                 .junction_length = 0.0625,
                                 .junction_strength = 2,
                                 .junction_energy = 3,
                                 .face_strength = {1, 0.75, 0.5},
                                 .face_energy = {1, 2, 0.25},
                                 .between_strength = 0.375,
                                 .between_energy = 0.875};

static void HashOf(const LamMicrostructure *micro, char hash[LAM_HASH_LENGTH])
{
  char *json;

  assert_int_equal(LamMicrostructureDescribe(micro, &json, hash), 0);
  PetscFree(json);
}

FILE_TEST(a_description_tells_all_of_a_lamella)
{
  const LamLamella lamellae[] = {every, LAM_LAMELLA_UNIFORM};

  for (int k = 0; k < 2; k++) {
    LamMicrostructure micro = Scene().micro;
    OWNED(LamMicrostructure, LamMicrostructureDestroy) parsed;
    char hash[LAM_HASH_LENGTH], *json;

    micro.interface = LAM_INTERFACE_LAMELLA;
    micro.lamella = lamellae[k];
    assert_int_equal(LamMicrostructureDescribe(&micro, &json, hash), 0);
    assert_int_equal(LamMicrostructureParse("file.h5", json, &parsed), 0);
    assert_memory_equal(&parsed.lamella, &micro.lamella, sizeof(micro.lamella));
    PetscFree(json);
  }
}

FILE_TEST(a_description_leaves_out_what_of_a_lamella_has_no_effect)
{
  LamMicrostructure micro = Scene().micro, other;
  char hash[2][LAM_HASH_LENGTH];

  micro.interface = LAM_INTERFACE_LAMELLA;
  micro.lamella = LAM_LAMELLA_UNIFORM;
  other = micro;
  other.lamella.mixing = 3;
  other.lamella.junction_strength = 3;
  HashOf(&micro, hash[0]);
  HashOf(&other, hash[1]);
  assert_string_equal(hash[0], hash[1]);
}

FILE_TEST(other_laws_have_no_lamella)
{
  LamMicrostructure micro = Scene().micro, other = micro;
  char hash[2][LAM_HASH_LENGTH];

  for (int law = 0; law < LAM_INTERFACE_LAW_COUNT; law++) {
    micro.interface = other.interface = (LamInterfaceLawType)law;
    other.lamella = every;
    HashOf(&micro, hash[0]);
    HashOf(&other, hash[1]);
    assert_int_equal(!strcmp(hash[0], hash[1]), law != LAM_INTERFACE_LAMELLA);
  }
}

FILE_TEST(differences_of_lamellae_are_told_in_keys_of_the_scene)
{
  LamMicrostructure micro = Scene().micro, other;
  char text[LAM_DIFFERENCE_LENGTH];

  micro.interface = LAM_INTERFACE_LAMELLA;
  micro.lamella = every;
  other = micro;
  other.lamella.energy = 0.25;
  other.lamella.face_strength[0] = 0.5;
  assert_int_equal(LamMicrostructureCompare(&micro, &other, "the scene", text), 0);
  assert_string_equal(text, "rve.interface.fracture_energy over (C1 + C2) apothem is 0.125, in the scene 0.25; "
                            "rve.interface.faces.strength is [1, 0.75, 0.5], in the scene [0.5, 0.75, 0.5]");
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

/* A record answers for its images under the symmetry of the tissue. */
FILE_TEST(images_are_those_of_the_tissue_s_symmetry)
{
  LamCell cell[6];
  LamMicrostructure micro = Uneven(cell, LAM_INTERFACE_BONDED);
  LamImages images;

  CHECK(LamImagesMake(&micro, &images));
  assert_int_equal(images.count, 1);
  micro.cells[1] = 2;
  CHECK(LamImagesMake(&micro, &images));
  assert_int_equal(images.count, LAM_MAX_IMAGES); /* one odd cell of 2 x 2 is the centre of all motions */
  cell[1].turgor = 0.5;
  CHECK(LamImagesMake(&micro, &images));
  assert_int_equal(images.count, 2); /* the mirror between the two that are alike */
  cell[0].turgor = 0.75;
  CHECK(LamImagesMake(&micro, &images));
  assert_int_equal(images.count, 1);
  micro.cell = NULL;
  CHECK(LamImagesMake(&micro, &images));
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
