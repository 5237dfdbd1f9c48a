/* Record files that are damaged, foreign, full or held by another writer: refused with the reason. */
#define _GNU_SOURCE /* memmem */
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include "record_bytes.h"

/* HDF5 1.14 refuses a type that no value can fill before it asks for memory. */
#if H5_VERSION_GE(1, 14, 0)
#define REFUSED "unusually large"
#else
#define REFUSED "memory allocation failed"
#endif

/* ---- damage ---- */

FILE_TEST(a_changed_byte_is_found_and_the_record_named)
{
  WriteFile(4);
  DamageRecord(2);
  AssertUnreadable("record 2 is damaged");
}

/* Whole responses of nodes are not loaded, and the file is read in blocks; all of it is checked. */
FILE_TEST(a_changed_byte_is_found_in_any_node)
{
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);

  Commit(writer, LAM_NODE_KEY, 1200);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  DamageRecord(1199);
  AssertUnreadable("record 1199 is damaged");
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
  AssertUnreadable(REFUSED);
  getrusage(RUSAGE_SELF, &after);
  assert_true(after.ru_maxrss - before.ru_maxrss < 300000); /* kB */
}

FILE_TEST(a_damaged_file_is_not_appended_to)
{
  WriteFile(4);
  DamageRecord(3);
  AssertNotOpened(LAM_WRITE_APPEND, PETSC_ERR_USER_INPUT, "record 3 is damaged");
}

FILE_TEST(a_missing_file_is_named_with_the_reason)
{
  LamDatabase db;

  assert_int_equal(LamDatabaseOpen(path, &db), PETSC_ERR_FILE_OPEN);
  AssertMessage("No such file or directory");
  AssertMessage(path);
}

FILE_TEST(a_file_that_is_not_hdf5_is_refused)
{
  FILE *file = fopen(path, "w");

  fputs("version: 1\n", file);
  fclose(file);
  AssertUnreadable("not an HDF5 file");
}

FILE_TEST(a_foreign_hdf5_file_is_refused)
{
  H5Fclose(H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  AssertUnreadable("not written by lamella");
}

/* Cut anywhere, a file is refused; it never crashes the reader and never passes. */
FILE_TEST(a_cut_file_is_refused)
{
  struct stat info;

  for (int part = 1; part < 16; part++) {
    WriteFile(80);
    stat(path, &info);
    assert_int_equal(truncate(path, info.st_size * part / 16), 0);
    AssertUnreadable("");
    unlink(path); /* the next writer would not replace it */
  }
}

FILE_TEST(another_format_version_is_refused)
{
  const int version = 99;

  WriteFile(1);
  SetNumber(path, "/", "format_version", H5T_NATIVE_INT, &version);
  AssertUnreadable("format version 99");
}

/* A file of two records of another type. */
static void WriteTyped(hid_t type, const LamResponse records[2])
{
  WriteFile(1);
  ReplaceRecords(path, type, 2, (PetscInt64[]){0, 1}, records);
}

FILE_TEST(members_added_by_later_versions_are_passed_over)
{
  const LamResponse wanted[2] = {Response(0), Response(1)}, *records;

  WriteTyped(ChangedType("", "added"), wanted);
  records = OpenRecords(NULL, NULL);
  for (int i = 0; i < 2; i++) AssertSame(&records[i], &wanted[i]);
}

static const char indicators[] =
    " opening_by_face open_by_face debonded_spread open_spread min_gap mean_gap max_penetration fabric gap_place "
    "opening_moment normal_place shear_place max_lamella_shear max_fibre_stretch max_wall_energy max_wall_tension "
    "wall_place mean_wall_tension wall_ellipticity kink_place kinked_fraction ellipticity localisation_normal "
    "localisation_mode turgor_mean turgor_spread energy_turgor energy_cohesion zero_modes cell_clusters "
    "percolating_directions indicators_trusted ";

/* What a file of before the indicators of contact gives back of a response. */
static LamResponse WithoutIndicators(LamResponse r)
{
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    void *member = (char *)&r + m->offset;
    char word[80];

    snprintf(word, sizeof(word), " %s ", m->name);
    if (!strstr(indicators, word)) continue;
    for (PetscInt i = 0; m->type == LAM_MEMBER_REAL && i < m->count; i++) ((PetscReal *)member)[i] = NAN;
    if (m->type == LAM_MEMBER_INT) *(PetscInt *)member = LAM_UNKNOWN_COUNT;
  }
  r.energy_turgor = -r.lumen_fraction;
  r.energy_cohesion = r.opening_fraction;
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

  written[1].indicators_trusted = PETSC_FALSE;
  WriteTyped(ChangedType(indicators, NULL), written);
  records = OpenRecords(NULL, NULL);
  for (int i = 0; i < 2; i++) AssertSameNumbers(records[i], WithoutIndicators(written[i]));
}

FILE_TEST(an_older_file_is_not_appended_to)
{
  const LamResponse written[2] = {Response(0), Response(1)};

  WriteTyped(ChangedType(indicators, NULL), written);
  AssertNotOpened(LAM_WRITE_APPEND, PETSC_ERR_USER_INPUT, "go on with the version that wrote it");
}

FILE_TEST(a_member_that_every_file_has_may_not_be_missing)
{
  const LamResponse written[2] = {Response(0), Response(1)};

  WriteTyped(ChangedType(" P ", NULL), written);
  AssertUnreadable("member \"P\" of /records is missing");
}

/* The bytes of a record could then be read twice, or behind its end. */
FILE_TEST(members_that_do_not_lie_one_behind_the_other_are_refused)
{
  const LamResponse written[2] = {Response(0), Response(1)};
  hid_t type = ChangedType("", NULL), wider;
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
  AssertUnreadable("member 6 of /records does not lie behind the one before it");
}

FILE_TEST(a_counter_beyond_the_extent_is_refused)
{
  const long long count = 1000;

  WriteFile(1);
  SetNumber(path, "/records", "committed", H5T_NATIVE_LLONG, &count);
  AssertUnreadable("1000 records");
}

FILE_TEST(another_microstructure_is_not_appended_to)
{
  LamScene scene = Scene();
  LamRecordWriter writer;

  WriteFile(1);
  scene.micro.wall_thickness = 0.2;
  assert_int_equal(LamRecordWriterOpen(path, "database", LAM_WRITE_APPEND, &scene, &writer), PETSC_ERR_USER_INPUT);
  AssertMessage("microstructure");
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
  assert_non_null(strstr(ErrorMessage, "File too large"));
  LamRecordWriterClose(&writer);
  assert_int_equal(CountRecords(), 3);
  free(r);
  free(keys);
}

/* ---- lock ---- */

FILE_TEST(a_second_writer_is_told_who_holds_the_lock)
{
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);
  char pid[32];

  snprintf(pid, sizeof(pid), "process %d ", (int)getpid());
  AssertNotOpened(LAM_WRITE_CREATE, PETSC_ERR_FILE_OPEN, pid);
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
  FILE *file = fopen(lock_path, "w");

  fputs("elsewhere 1 1 2026-01-01T00:00:00Z\n", file);
  fclose(file);
  AssertNotOpened(LAM_WRITE_CREATE, PETSC_ERR_FILE_OPEN, "elsewhere");
}
