/* Record files that are damaged, foreign, full or held by another writer: refused with the reason. */
#define _GNU_SOURCE /* memmem */
#include "support/test.h"
#include "record_fixture.h"
#include <hdf5.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include "record_internal.h"

/* HDF5 1.14 refuses a type that no value can fill before it asks for memory. */
#if H5_VERSION_GE(1, 14, 0)
#define REFUSED "unusually large"
#else
#define REFUSED "memory allocation failed"
#endif

static void AssertUnreadable(PetscErrorCode code, const char part[])
{
  LamDatabase db;

  assert_int_equal(LamDatabaseOpen(path, &db), code);
  if (!strstr(message, part) || !strstr(message, path)) fail_msg("message: %s", message);
}

/* ---- damage ---- */

/* Changes a bit of one of the records of the file. */
static void Damage(size_t record)
{
  unsigned char *bytes;
  hid_t file, dataset, type, space;
  size_t size;

  file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  dataset = H5Dopen2(file, "/records", H5P_DEFAULT);
  type = H5Dget_type(dataset);
  space = H5Dget_space(dataset);
  size = H5Tget_size(type);
  bytes = malloc((size_t)H5Sget_simple_extent_npoints(space) * size);
  H5Dread(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes);
  bytes[record * size + 100] ^= 1;
  H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes);
  free(bytes);
  H5Fclose(file);
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(dataset);
}

FILE_TEST(a_changed_byte_is_found_and_the_record_named)
{
  WriteFile(4);
  Damage(2);
  AssertUnreadable(PETSC_ERR_USER_INPUT, "record 2 is damaged");
}

/* Whole responses of nodes are not loaded, and the file is read in blocks; all of it is checked. */
FILE_TEST(a_changed_byte_is_found_in_any_node)
{
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);

  Commit(writer, LAM_NODE_KEY, 1200);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  Damage(1199);
  AssertUnreadable(PETSC_ERR_USER_INPUT, "record 1199 is damaged");
}

/* The size of the type below a truth, as HDF5 writes it behind the member's name: with one bit more it is 2 GB. */
static void EnlargeTruth(void)
{
  static const unsigned char truth[] = {0x18, 2, 0, 0, 1, 0, 0, 0, 0x10, 8, 0, 0, 1, 0, 0, 0};
  FILE *file = fopen(path, "r+");
  unsigned char bytes[16384];
  const size_t n = fread(bytes, 1, sizeof(bytes), file);
  const unsigned char *place = memmem(bytes, n, truth, sizeof(truth));

  assert_non_null(place);
  fseek(file, (long)(place - bytes) + (long)sizeof(truth) - 1, SEEK_SET);
  fputc(0x80, file);
  fclose(file);
}

/* HDF5 would fill 8 GB, for half a minute. */
FILE_TEST(a_type_of_records_that_became_vast_takes_no_memory)
{
#ifdef __SANITIZE_ADDRESS__ /* the bound is not set there */
  skip();
#endif
  struct rusage before, after;

  WriteFile(4);
  EnlargeTruth();
  getrusage(RUSAGE_SELF, &before);
  AssertUnreadable(PETSC_ERR_USER_INPUT, REFUSED);
  getrusage(RUSAGE_SELF, &after);
  assert_true(after.ru_maxrss - before.ru_maxrss < 300000); /* kB */
}

FILE_TEST(a_damaged_file_is_not_appended_to)
{
  LamScene scene = Scene();
  LamRecordWriter writer;

  WriteFile(4);
  Damage(3);
  assert_int_equal(LamRecordWriterOpen(path, "database", LAM_WRITE_APPEND, &scene, &writer), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, "record 3 is damaged"));
}

FILE_TEST(a_missing_file_is_named_with_the_reason)
{
  AssertUnreadable(PETSC_ERR_FILE_OPEN, "No such file or directory");
}

FILE_TEST(a_file_that_is_not_hdf5_is_refused)
{
  FILE *file = fopen(path, "w");

  fputs("version: 1\n", file);
  fclose(file);
  AssertUnreadable(PETSC_ERR_USER_INPUT, "not an HDF5 file");
}

FILE_TEST(a_foreign_hdf5_file_is_refused)
{
  H5Fclose(H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  AssertUnreadable(PETSC_ERR_USER_INPUT, "not written by lamella");
}

/* Cut anywhere, a file is refused; it never crashes the reader and never passes. */
FILE_TEST(a_cut_file_is_refused)
{
  struct stat info;

  for (int part = 1; part < 16; part++) {
    WriteFile(80);
    stat(path, &info);
    assert_int_equal(truncate(path, info.st_size * part / 16), 0);
    AssertUnreadable(PETSC_ERR_USER_INPUT, "");
    unlink(path); /* the next writer would not replace it */
  }
}

FILE_TEST(another_format_version_is_refused)
{
  const int version = 99;
  hid_t file, attribute;

  WriteFile(1);
  file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  attribute = H5Aopen(file, "format_version", H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_INT, &version);
  H5Aclose(attribute);
  H5Fclose(file);
  AssertUnreadable(PETSC_ERR_USER_INPUT, "format version 99");
}

/* Whether `name` is one of the names, which end with NULL. */
static bool IsOneOf(const char name[], const char *const names[])
{
  while (*names && strcmp(name, *names)) names++;
  return *names;
}

/* Our record type without some members, but with a number named `added` before the checksum, where not NULL. */
static hid_t ChangedType(const char *const removed[], const char added[])
{
  hid_t ours, type;
  size_t end = 0;

  assert_int_equal(LamRecordTypeCreate(&ours), 0);
  type = H5Tcreate(H5T_COMPOUND, H5Tget_size(ours) + sizeof(double));
  for (int i = 0; i + 1 < H5Tget_nmembers(ours); i++) {
    char *name = H5Tget_member_name(ours, (unsigned)i);
    const hid_t member = H5Tget_member_type(ours, (unsigned)i);

    if (!IsOneOf(name, removed)) {
      H5Tinsert(type, name, end, member);
      end += H5Tget_size(member);
    }
    H5Tclose(member);
    H5free_memory(name);
  }
  if (added) {
    H5Tinsert(type, added, end, H5T_IEEE_F64LE);
    end += sizeof(double);
  }
  H5Tinsert(type, "checksum", end, H5T_STD_U32LE);
  H5Tset_size(type, end + sizeof(uint32_t));
  H5Tclose(ours);
  return type;
}

/* A file of two records of another type. */
static void WriteTyped(hid_t type, const LamResponse records[2])
{
  const PetscInt64 keys[2] = {0, 1}, committed = 2;
  const hsize_t count = 2, unlimited = H5S_UNLIMITED, chunk = 64;
  const hid_t space = H5Screate_simple(1, &count, &unlimited), list = H5Pcreate(H5P_DATASET_CREATE);
  hid_t file, dataset, attribute;
  void *bytes;

  WriteFile(1);
  assert_int_equal(LamRecordsPack(2, keys, records, type, &bytes), 0);
  H5Pset_chunk(list, 1, &chunk);
  file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  H5Ldelete(file, "/records", H5P_DEFAULT);
  dataset = H5Dcreate2(file, "/records", type, space, H5P_DEFAULT, list, H5P_DEFAULT);
  H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes);
  attribute = H5Acreate2(dataset, "committed", H5T_STD_I64LE, H5Screate(H5S_SCALAR), H5P_DEFAULT, H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_INT64, &committed);
  H5Aclose(attribute);
  H5Dclose(dataset);
  H5Fclose(file);
  H5Pclose(list);
  H5Sclose(space);
  H5Tclose(type);
  PetscFree(bytes);
}

FILE_TEST(members_added_by_later_versions_are_passed_over)
{
  const LamResponse wanted[2] = {Response(0), Response(1)}, *records;
  const char *const none[] = {NULL};
  LamDatabase db;

  WriteTyped(ChangedType(none, "added"), wanted);
  assert_int_equal(LamDatabaseOpen(path, &db), 0);
  LamDatabaseGetRecords(db, NULL, &records, NULL);
  for (int i = 0; i < 2; i++) AssertSame(&records[i], &wanted[i]);
  LamDatabaseClose(&db);
}

static const char *const indicators[] = {"opening_by_face",
                                         "open_by_face",
                                         "debonded_spread",
                                         "open_spread",
                                         "min_gap",
                                         "mean_gap",
                                         "max_penetration",
                                         "fabric",
                                         "gap_place",
                                         "opening_moment",
                                         "normal_place",
                                         "shear_place",
                                         "max_lamella_shear",
                                         "max_fibre_stretch",
                                         "max_wall_energy",
                                         "max_wall_tension",
                                         "wall_place",
                                         "mean_wall_tension",
                                         "wall_ellipticity",
                                         "kink_place",
                                         "kinked_fraction",
                                         "ellipticity",
                                         "localisation_normal",
                                         "localisation_mode",
                                         "turgor_mean",
                                         "turgor_spread",
                                         "energy_turgor",
                                         "energy_cohesion",
                                         "zero_modes",
                                         "cell_clusters",
                                         "percolating_directions",
                                         "indicators_trusted",
                                         NULL};

/* What a file of before the indicators of contact gives back of a response. */
static LamResponse WithoutIndicators(LamResponse r)
{
  for (int k = 0; k < 3; k++) {
    r.opening_by_face[k] = r.open_by_face[k] = r.fabric[k] = r.opening_moment[k] = r.mean_wall_tension[k] = NAN;
    r.kink_place[k] = r.localisation_normal[k] = r.localisation_mode[k] = NAN;
    r.gap_place[k] = r.normal_place[k] = r.shear_place[k] = r.wall_place[k] = NAN;
  }
  r.debonded_spread = r.open_spread = r.min_gap = r.mean_gap = r.max_penetration = NAN;
  r.max_lamella_shear = r.max_fibre_stretch = r.max_wall_energy = r.max_wall_tension = NAN;
  r.turgor_mean = r.turgor_spread = r.wall_ellipticity = r.kinked_fraction = r.ellipticity = NAN;
  r.energy_turgor = -r.lumen_fraction;
  r.energy_cohesion = r.opening_fraction;
  r.zero_modes = r.cell_clusters = r.percolating_directions = LAM_UNKNOWN_COUNT;
  r.indicators_trusted = PETSC_TRUE;
  return r;
}

static void AssertSameNumbers(LamResponse a, LamResponse b)
{
  for (const LamMember *m = LamResponseMembers; m->name; m++)
    for (PetscInt i = 0; m->type == LAM_MEMBER_REAL && i < m->count; i++) {
      const PetscReal p = ((PetscReal *)((char *)&a + m->offset))[i], q = ((PetscReal *)((char *)&b + m->offset))[i];

      if (p != q && !(isnan(p) && isnan(q))) fail_msg("%s is %g, not %g", m->name, (double)p, (double)q);
    }
  assert_int_equal(a.zero_modes, b.zero_modes);
  assert_int_equal(a.newton_iterations, b.newton_iterations);
  assert_int_equal(a.indicators_trusted, b.indicators_trusted);
  assert_string_equal(a.reason, b.reason);
}

FILE_TEST(members_that_an_older_file_lacks_are_not_known)
{
  LamResponse written[2] = {Response(0), Response(1)};
  const LamResponse *records;
  LamDatabase db;

  written[1].indicators_trusted = PETSC_FALSE;
  WriteTyped(ChangedType(indicators, NULL), written);
  assert_int_equal(LamDatabaseOpen(path, &db), 0);
  LamDatabaseGetRecords(db, NULL, &records, NULL);
  for (int i = 0; i < 2; i++) AssertSameNumbers(records[i], WithoutIndicators(written[i]));
  LamDatabaseClose(&db);
}

FILE_TEST(an_older_file_is_not_appended_to)
{
  const LamResponse written[2] = {Response(0), Response(1)};
  LamScene scene = Scene();
  LamRecordWriter writer;

  WriteTyped(ChangedType(indicators, NULL), written);
  assert_int_equal(LamRecordWriterOpen(path, "database", LAM_WRITE_APPEND, &scene, &writer), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, "go on with the version that wrote it"));
}

FILE_TEST(a_member_that_every_file_has_may_not_be_missing)
{
  const LamResponse written[2] = {Response(0), Response(1)};
  const char *const stress[] = {"P", NULL};

  WriteTyped(ChangedType(stress, NULL), written);
  AssertUnreadable(PETSC_ERR_USER_INPUT, "member \"P\" of /records is missing");
}

/* The bytes of a record could then be read twice, or behind its end. */
FILE_TEST(members_that_do_not_lie_one_behind_the_other_are_refused)
{
  const LamResponse written[2] = {Response(0), Response(1)};
  const char *const none[] = {NULL};
  hid_t type = ChangedType(none, NULL), wider;
  const size_t size = H5Tget_size(type);

  wider = H5Tcreate(H5T_COMPOUND, size + 8);
  for (int i = 0; i < H5Tget_nmembers(type); i++) {
    char *name = H5Tget_member_name(type, (unsigned)i);
    const hid_t member = H5Tget_member_type(type, (unsigned)i);

    H5Tinsert(wider, name, H5Tget_member_offset(type, (unsigned)i) + (i > 5 ? 8 : 0), member);
    H5Tclose(member);
    H5free_memory(name);
  }
  H5Tclose(type);
  WriteTyped(wider, written);
  AssertUnreadable(PETSC_ERR_USER_INPUT, "member 6 of /records does not lie behind the one before it");
}

FILE_TEST(a_counter_beyond_the_extent_is_refused)
{
  const long long count = 1000;
  hid_t file, dataset, attribute;

  WriteFile(1);
  file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  dataset = H5Dopen2(file, "/records", H5P_DEFAULT);
  attribute = H5Aopen(dataset, "committed", H5P_DEFAULT);
  H5Awrite(attribute, H5T_NATIVE_LLONG, &count);
  H5Aclose(attribute);
  H5Dclose(dataset);
  H5Fclose(file);
  AssertUnreadable(PETSC_ERR_USER_INPUT, "1000 records");
}

FILE_TEST(another_microstructure_is_not_appended_to)
{
  LamScene scene = Scene();
  LamRecordWriter writer;

  WriteFile(1);
  scene.micro.wall_thickness = 0.2;
  assert_int_equal(LamRecordWriterOpen(path, "database", LAM_WRITE_APPEND, &scene, &writer), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(message, "microstructure"));
  assert_int_equal(access(lock_path, F_OK), -1);
}

/* The limit on the file's size stands for a full disk. */
FILE_TEST(a_full_disk_is_reported_and_spares_the_records)
{
  struct rlimit old, small;
  LamResponse *r = calloc(2000, sizeof(*r));
  PetscInt64 *keys = calloc(2000, sizeof(*keys));
  LamRecordWriter writer;

  WriteFile(3);
  for (PetscInt i = 0; i < 2000; i++) r[i] = Response(i);
  writer = Open(LAM_WRITE_APPEND);
  getrlimit(RLIMIT_FSIZE, &old);
  small = old;
  small.rlim_cur = 500000;
  signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small);
  assert_int_equal(LamRecordWriterCommit(writer, 2000, keys, r), PETSC_ERR_FILE_WRITE);
  setrlimit(RLIMIT_FSIZE, &old);
  assert_non_null(strstr(message, "File too large"));
  LamRecordWriterClose(&writer);
  assert_int_equal(CountRecords(), 3);
  free(r);
  free(keys);
}

/* ---- lock ---- */

FILE_TEST(a_second_writer_is_told_who_holds_the_lock)
{
  LamScene scene = Scene();
  LamRecordWriter writer = Open(LAM_WRITE_CREATE), second;
  char pid[32];

  snprintf(pid, sizeof(pid), "process %d ", (int)getpid());
  assert_int_equal(LamRecordWriterOpen(path, "database", LAM_WRITE_CREATE, &scene, &second), PETSC_ERR_FILE_OPEN);
  assert_non_null(strstr(message, pid));
  LamRecordWriterClose(&writer);
}

FILE_TEST(the_lock_of_a_dead_process_is_taken_over)
{
  const pid_t child = fork();
  LamRecordWriter writer;

  if (child == 0) {
    Open(LAM_WRITE_CREATE);
    _exit(0);
  }
  waitpid(child, NULL, 0);
  assert_int_equal(access(lock_path, F_OK), 0);
  writer = Open(LAM_WRITE_CREATE);
  Commit(writer, 0, 1);
  LamRecordWriterClose(&writer);
  assert_int_equal(access(lock_path, F_OK), -1);
}

FILE_TEST(the_lock_of_another_host_is_respected)
{
  LamScene scene = Scene();
  LamRecordWriter writer;
  FILE *file = fopen(lock_path, "w");

  fputs("elsewhere 1 1 2026-01-01T00:00:00Z\n", file);
  fclose(file);
  assert_int_equal(LamRecordWriterOpen(path, "database", LAM_WRITE_CREATE, &scene, &writer), PETSC_ERR_FILE_OPEN);
  assert_non_null(strstr(message, "elsewhere"));
}
