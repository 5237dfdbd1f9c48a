/* Every instant of commits: the calls that a writer makes on its file are logged and played back one by one, and within
   one (between pages), on a copy. What a kill would leave there must hold all that was committed before, unchanged, and
   go on. Between two syncs the system may bring writes to the disk in any order, sector by sector: any part of them
   must do, too, which stands for a loss of power. */
#include "../unit/record_fixture.h"
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>

enum { PAGE = 4096, SECTOR = 512, SHUFFLES = 12 };

static char copy[160], base[160]; /* the file at an instant; as it was at the last sync */

/* ---- the log ---- */

/* Of what a program does to one file, made by standing in for the system's calls: writes, changes of its length, syncs.
   Played back up to any point, it gives the file as a kill at that instant, or a loss of power, leaves it. */
typedef enum { LOG_WRITE, LOG_LENGTH, LOG_SYNC } LogKind;

typedef struct {
  LogKind kind;
  off_t offset; /* of a write; the new length */
  size_t size;  /* of a write */
  unsigned char *bytes;
} LogEntry;

/* Calls on the file with this number are logged; 0: none. */
static ino_t log_inode;
static LogEntry *log_entries;
static size_t log_n, log_capacity;

static void LogStart(const char file[])
{
  struct stat info;

  log_inode = stat(file, &info) ? 0 : info.st_ino;
}

static void LogClear(void)
{
  for (size_t k = 0; k < log_n; k++) free(log_entries[k].bytes);
  free(log_entries);
  log_entries = NULL;
  log_n = log_capacity = 0;
  log_inode = 0;
}

static void LogAdd(int fd, LogKind kind, off_t offset, size_t size, const void *bytes)
{
  struct stat info;
  LogEntry *e;

  if (!log_inode || fstat(fd, &info) || info.st_ino != log_inode) return;
  if (log_n == log_capacity) {
    log_capacity = 2 * log_capacity + 64;
    log_entries = realloc(log_entries, log_capacity * sizeof(*log_entries));
  }
  e = &log_entries[log_n++];
  *e = (LogEntry){kind, offset, size, NULL};
  if (!size) return;
  e->bytes = malloc(size);
  memcpy(e->bytes, bytes, size);
}

/* ---- the system's calls ---- */

ssize_t pwrite(int fd, const void *bytes, size_t size, off_t offset)
{
  LogAdd(fd, LOG_WRITE, offset, size, bytes);
  return syscall(SYS_pwrite64, fd, bytes, size, offset);
}

int ftruncate(int fd, off_t length)
{
  LogAdd(fd, LOG_LENGTH, length, 0, NULL);
  return (int)syscall(SYS_ftruncate, fd, length);
}

int posix_fallocate(int fd, off_t offset, off_t length)
{
  LogAdd(fd, LOG_LENGTH, offset + length, 0, NULL);
  return syscall(SYS_fallocate, fd, 0, offset, length) ? errno : 0;
}

int fsync(int fd)
{
  LogAdd(fd, LOG_SYNC, 0, 0, NULL);
  return (int)syscall(SYS_fsync, fd);
}

/* ---- playing back ---- */

/* Does to the open file what the entry did; of a write only the first `part` bytes. */
static int LogPlay(int fd, const LogEntry *e, size_t part)
{
  const size_t size = part < e->size ? part : e->size;

  if (e->kind == LOG_LENGTH) return (int)syscall(SYS_ftruncate, fd, e->offset);
  if (e->kind == LOG_WRITE) return syscall(SYS_pwrite64, fd, e->bytes, size, e->offset) == (ssize_t)size ? 0 : -1;
  return 0;
}

static void CopyFile(const char from[], const char to[])
{
  char command[400];

  snprintf(command, sizeof(command), "cp %s %s", from, to);
  assert_int_equal(system(command), 0);
}

/* ---- what must hold ---- */

static void AssertKept(PetscInt least, PetscInt most)
{
  const LamResponse *records;
  const PetscInt64 *keys;
  LamDatabase db;
  PetscInt n;

  if (LamDatabaseOpen(copy, &db)) fail_msg("%s", ErrorMessage);
  LamDatabaseGetRecords(db, &n, &records, &keys);
  assert_in_range(n, least, most);
  for (PetscInt i = 0; i < n; i++) {
    const LamResponse wanted = Response(i);

    assert_int_equal(keys[i], i);
    AssertSame(&records[i], &wanted);
  }
  LamDatabaseClose(&db);
}

/* A writer goes on with the copy. */
static void AssertGoesOn(PetscInt total)
{
  LamScene scene = Scene();
  const PetscInt64 *keys;
  LamRecordWriter writer;
  PetscInt n;

  if (LamRecordWriterOpen(copy, "database", LAM_WRITE_APPEND, &scene, &writer)) fail_msg("%s", ErrorMessage);
  LamRecordWriterGetKeys(writer, &n, &keys);
  Commit(writer, n, total - n);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  AssertKept(total, total);
}

/* ---- instants ---- */

/* A kill within a write: the system stops between pages. */
static void PlayTorn(int fd, const LogEntry *e, PetscInt before, PetscInt after)
{
  for (size_t part = PAGE - (size_t)e->offset % PAGE; part < e->size && part < 5 * PAGE; part += PAGE) {
    assert_int_equal(LogPlay(fd, e, part), 0);
    AssertKept(before, after);
  }
}

/* How much of a write may have reached the disk: a number of its sectors. */
static size_t Part(const LogEntry *e)
{
  const size_t first = SECTOR - (size_t)e->offset % SECTOR, more = e->size > first ? (e->size - first) / SECTOR : 0;

  return rand() % 2 ? first + SECTOR * ((size_t)rand() % (more + 1)) : SIZE_MAX;
}

/* Some of the writes since the last sync, whole or in part. */
static void PlaySome(size_t first, size_t end, PetscInt before, PetscInt after)
{
  for (int k = 0; k < SHUFFLES; k++) {
    int fd;

    CopyFile(base, copy);
    fd = open(copy, O_RDWR);
    for (size_t i = first; i < end; i++)
      if (rand() % 2) assert_int_equal(LogPlay(fd, &log_entries[i], Part(&log_entries[i])), 0);
    close(fd);
    AssertKept(before, after);
  }
}

/* Plays the log back on the copy, which is the file as it was before. */
static void PlayAll(PetscInt before, PetscInt after)
{
  const int fd = open(copy, O_RDWR);

  for (size_t i = 0; i < log_n; i++) {
    PlayTorn(fd, &log_entries[i], before, after);
    assert_int_equal(LogPlay(fd, &log_entries[i], SIZE_MAX), 0);
    AssertKept(before, after);
  }
  close(fd);
}

/* The same for a loss of power; `base` is the file as it was before. */
static void PlayPowerLoss(PetscInt before, PetscInt after)
{
  size_t first = 0;

  for (size_t i = 0; i <= log_n; i++) {
    if (i < log_n && log_entries[i].kind != LOG_SYNC) continue;
    PlaySome(first, i, before, after);
    for (int fd = open(base, O_RDWR); fd >= 0; close(fd), fd = -1)
      for (; first < i; first++) assert_int_equal(LogPlay(fd, &log_entries[first], SIZE_MAX), 0);
  }
}

/* ---- a folder for each ---- */

static int EnterCommits(void **state)
{
  if (Enter(state)) return -1;
  snprintf(copy, sizeof(copy), "%s/copy.h5", directory);
  snprintf(base, sizeof(base), "%s/base.h5", directory);
  srand(1);
  return 0;
}

static int LeaveCommits(void **state)
{
  LogClear();
  unlink(copy);
  unlink(base);
  return Leave(state);
}

#define COMMITS_TEST(name) TEST_WITH(name, EnterCommits, LeaveCommits)

/* ---- tests ---- */

typedef void (*Play)(PetscInt before, PetscInt after);

/* Commits `n` records at a time to a file of `start`; those are played whose room was there. */
static void PlayCommits(PetscInt start, PetscInt n, int commits, Play play)
{
  LamRecordWriter writer;
  int played = 0;

  WriteFile(start);
  writer = Open(LAM_WRITE_APPEND);
  for (PetscInt before = start; played < commits; before += n) {
    CopyFile(path, copy);
    CopyFile(path, base);
    LogStart(path);
    Commit(writer, before, n);
    if (log_n) {
      play(before, before + n);
      AssertGoesOn(before + 2 * n);
      played++;
    }
    LogClear();
  }
  assert_int_equal(LamRecordWriterClose(&writer), 0);
}

COMMITS_TEST(a_kill_at_any_instant_of_a_commit_loses_nothing)
{
  PlayCommits(100, 7, 4, PlayAll);
  PlayCommits(70, 64, 2, PlayAll);
}

/* HDF5 has a node of its index for 64 chunks. */
COMMITS_TEST(a_kill_loses_nothing_where_the_index_grows)
{
  PlayCommits(64 * 63, 64, 2, PlayAll);
}

COMMITS_TEST(a_loss_of_power_within_a_commit_loses_nothing)
{
  PlayCommits(100, 7, 4, PlayPowerLoss);
  PlayCommits(70, 64, 2, PlayPowerLoss);
}

/* Room is made in a copy: what has a name is written over, never made longer or shorter. */
COMMITS_TEST(a_file_that_has_its_name_keeps_its_length)
{
  LamRecordWriter writer;
  struct stat info;

  WriteFile(1);
  writer = Open(LAM_WRITE_APPEND);
  for (PetscInt n = 1, k = 1; n < 6000; n += k, k = k * 3 / 2 + 1) {
    stat(path, &info);
    LogStart(path);
    Commit(writer, n, k);
    for (size_t i = 0; i < log_n; i++) {
      assert_int_not_equal(log_entries[i].kind, LOG_LENGTH);
      assert_true(log_entries[i].offset + (off_t)log_entries[i].size <= info.st_size);
    }
    LogClear();
  }
  assert_int_equal(LamRecordWriterClose(&writer), 0);
}

/* A run that is killed while it makes room leaves any part of a copy. */
COMMITS_TEST(a_copy_that_was_left_is_removed)
{
  char temporary[160];
  LamRecordWriter writer;
  FILE *file;

  WriteFile(3);
  snprintf(temporary, sizeof(temporary), "%s.tmp", path);
  file = fopen(temporary, "w");
  fputs("part of a copy", file);
  fclose(file);
  writer = Open(LAM_WRITE_APPEND);
  Commit(writer, 3, 200);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(access(temporary, F_OK), -1);
  assert_int_equal(CountRecords(), 203);
}

COMMITS_TEST(another_file_in_its_place_is_not_written_to)
{
  LamScene scene = Scene();
  LamRecordWriter writer, other;
  LamResponse r = Response(3);
  PetscInt64 key = 3;

  WriteFile(3);
  assert_int_equal(LamRecordWriterOpen(copy, "database", LAM_WRITE_CREATE, &scene, &other), 0);
  Commit(other, 0, 5);
  assert_int_equal(LamRecordWriterClose(&other), 0);
  writer = Open(LAM_WRITE_APPEND);
  assert_int_equal(rename(copy, path), 0);
  assert_int_equal(LamRecordWriterCommit(writer, 1, &key, &r), PETSC_ERR_FILE_WRITE);
  assert_non_null(strstr(ErrorMessage, "another program has changed it"));
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(CountRecords(), 5);
}

/* A writer that is killed before its lock says whose it is. */
COMMITS_TEST(a_lock_without_its_line_is_taken_over)
{
  LamRecordWriter writer;

  WriteFile(1);
  fclose(fopen(lock_path, "w"));
  writer = Open(LAM_WRITE_APPEND);
  Commit(writer, 1, 1);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
}

/* As in a container whose first process waits for no one. */
COMMITS_TEST(the_lock_of_a_process_that_no_one_has_waited_for_is_taken_over)
{
  const pid_t child = fork();
  LamRecordWriter writer;
  siginfo_t info;

  if (child == 0) {
    Open(LAM_WRITE_CREATE);
    _exit(0);
  }
  waitid(P_PID, (id_t)child, &info, WEXITED | WNOWAIT);
  assert_int_equal(access(lock_path, F_OK), 0);
  writer = Open(LAM_WRITE_CREATE);
  Commit(writer, 0, 1);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  waitpid(child, NULL, 0);
}
