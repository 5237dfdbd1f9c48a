/*
  lamella info: contents and provenance of a file. Needs no MPI.
*/
#include "app.h"
#include "fe2_summary.h"
#include <math.h>
#include <string.h>

static void PrintText(const char label[], const json_t *value)
{
  if (json_is_string(value) && json_string_length(value)) printf("%-20s %s\n", label, json_string_value(value));
}

static void PrintInteger(const char label[], const json_t *value)
{
  printf("%-20s %lld\n", label, (long long)json_integer_value(value));
}

static void PrintRange(const char label[], const json_t *range, const char unit[])
{
  if (!json_is_array(range)) return;
  printf("%-20s %.4g to %.4g%s\n", label, json_number_value(json_array_get(range, 0)),
         json_number_value(json_array_get(range, 1)), unit);
}

/* One line for each member: statuses, modes. */
static void PrintCounts(const json_t *counts)
{
  char label[64];
  const char *name;
  json_t *count;

  json_object_foreach((json_t *)counts, name, count)
  {
    snprintf(label, sizeof(label), "  %s", name);
    PrintInteger(label, count);
  }
}

static void PrintMicrostructures(const json_t *list)
{
  size_t i;
  json_t *item;

  json_array_foreach(list, i, item)
  {
    const json_t *description = json_object_get(item, "description");
    const char *name;
    json_t *value;

    PrintText("microstructure", json_object_get(item, "hash"));
    printf("  %-18s %.6g um\n", "apothem", 1e6 * json_number_value(json_object_get(item, "apothem_m")));
    printf("  %-18s %.6g MPa\n", "stress unit C1+C2",
           1e-6 * json_number_value(json_object_get(item, "stress_unit_Pa")));
    json_object_foreach((json_t *)description, name, value)
    {
      const size_t faces = json_array_size(json_object_get(value, "partner")); /* of cells of any shape */
      char text[256];
      size_t n;

      if (json_is_array(value) && json_is_object(json_array_get(value, 0))) {
        printf("  %-18s %d that differ (--json lists them)\n", name, (int)json_array_size(value));
        continue;
      }
      n = json_dumpb(value, text, sizeof(text) - 1, JSON_ENCODE_ANY | JSON_REAL_PRECISION(6));
      text[n < sizeof(text) ? n : 0] = '\0';
      if (faces)
        printf("  %-18s %d faces (--json lists them)\n", name, (int)faces);
      else
        printf("  %-18s %s\n", name, n < sizeof(text) ? text : "--json has it");
    }
  }
}

/* A run in progress, or one that was killed, has no status. */
static void PrintRun(const json_t *run)
{
  const json_t *load_factor = json_object_get(run, "load_factor"), *status = json_object_get(run, "status");

  if (!run) return;
  PrintInteger("steps", json_object_get(run, "steps"));
  if (json_is_number(load_factor)) printf("%-20s %.6g\n", "load factor", json_number_value(load_factor));
  printf("%-20s %s\n", "status", json_is_string(status) ? json_string_value(status) : "not finished");
}

static void PrintMap(const json_t *map)
{
  const char *const letters[] = {"x", "y"};

  if (!map) return;
  for (size_t a = 0; a < PETSC_STATIC_ARRAY_LENGTH(letters); a++) {
    const json_t *axis = json_object_get(map, letters[a]);
    const char *unit = json_string_value(json_object_get(axis, "unit"));

    printf("%-20s %s, %.6g to %.6g%s%s, %lld points\n", letters[a],
           json_string_value(json_object_get(axis, "quantity")), json_number_value(json_object_get(axis, "from")),
           json_number_value(json_object_get(axis, "to")), strcmp(unit, "1") ? " " : "", strcmp(unit, "1") ? unit : "",
           (long long)json_integer_value(json_object_get(axis, "points")));
  }
  PrintCounts(json_object_get(map, "modes"));
}

/* Prints integers on one line: one per level, coarsest first. */
static void PrintLevels(const char label[], const json_t *list)
{
  size_t i;
  json_t *item;

  printf("  %-18s", label);
  json_array_foreach(list, i, item)
  {
    printf(" %lld", (long long)json_integer_value(item));
  }
  putchar('\n');
}

static void PrintGrid(const json_t *grid)
{
  const json_t *turgor = json_object_get(grid, "turgor");

  printf("  %-18s step %.4g from %.4g", "grid of strains", json_number_value(json_object_get(grid, "step")),
         json_number_value(json_object_get(grid, "origin")));
  if (turgor) {
    printf(", at turgor %.4g MPa\n", json_number_value(turgor));
    PrintRange("  grid of F33", json_object_get(grid, "F33"), "");
    return;
  }
  printf(" of free cells, at cohesion %.4g MPa\n", json_number_value(json_object_get(grid, "cohesion")));
  PrintRange("  free cells", json_object_get(grid, "free_cell_strain"), " in strain");
  PrintRange("  grid of suction", json_object_get(grid, "suction"), " MPa");
  PrintRange("  grid of F33", json_object_get(grid, "F33"), "");
}

/* Prints the nodes used for interpolation. */
static void PrintNodes(const json_t *table)
{
  const json_t *flags = json_object_get(table, "flags");

  if (!table) return;
  PrintInteger("nodes", json_object_get(table, "nodes"));
  PrintLevels("by level", json_object_get(table, "nodes_by_level"));
  PrintLevels("complete cells", json_object_get(table, "cells_by_level"));
  PrintLevels("of them mixed", json_object_get(table, "mixed_cells_by_level"));
  printf("  %-18s %lld unstable, %lld on another branch, %lld without solution, %lld floating\n", "states",
         (long long)json_integer_value(json_object_get(flags, "unstable")),
         (long long)json_integer_value(json_object_get(flags, "other_branch")),
         (long long)json_integer_value(json_object_get(flags, "failed")),
         (long long)json_integer_value(json_object_get(flags, "floating")));
  PrintRange("  lattice strains", json_object_get(table, "lattice_strain"), "");
  PrintRange("  suction", json_object_get(table, "suction"), " MPa");
  PrintGrid(json_object_get(table, "grid"));
}

static void PrintWriter(const json_t *writer)
{
  const char *host = json_string_value(json_object_get(writer, "host"));
  const char *since = json_string_value(json_object_get(writer, "since"));

  if (!host || !since) return;
  printf("%-20s process %lld on %s, since %s\n", "writer",
         (long long)json_integer_value(json_object_get(writer, "process")), host, since);
}

static void PrintTable(const json_t *info)
{
  const json_t *coverage = json_object_get(info, "coverage"), *libraries = json_object_get(info, "libraries");

  PrintText("kind", json_object_get(info, "kind"));
  PrintWriter(json_object_get(info, "writer"));
  PrintRun(json_object_get(info, "run"));
  LamSummaryPrint(json_object_get(info, "summary"));
  PrintMap(json_object_get(info, "map"));
  PrintInteger("records", json_object_get(info, "records"));
  PrintInteger("failed", json_object_get(info, "failed"));
  PrintCounts(json_object_get(info, "statuses"));
  PrintRange("strain (principal)", json_object_get(coverage, "principal_log_strain"), "");
  PrintRange("turgor", json_object_get(coverage, "turgor"), " MPa");
  PrintRange("cohesion", json_object_get(coverage, "cohesion"), " MPa");
  PrintNodes(json_object_get(info, "table"));
  if (json_object_get(info, "table")) PrintInteger("scattered records", json_object_get(info, "scattered"));
  PrintMicrostructures(json_object_get(info, "microstructures"));
  PrintInteger("format version", json_object_get(info, "format_version"));
  PrintText("written by", json_object_get(info, "creator"));
  PrintText("created", json_object_get(info, "created"));
  PrintText("host", json_object_get(info, "host"));
  PrintText("command", json_object_get(info, "command"));
  PrintText("PETSc", json_object_get(libraries, "PETSc"));
  PrintText("HDF5", json_object_get(libraries, "HDF5"));
  PrintText("MPI", json_object_get(libraries, "MPI"));
}

/* ---- the macroscale run of an fe2 file ---- */

static PetscErrorCode ReadRun(const char path[], json_t *info)
{
  PetscInt rank, dims[4], *steps = NULL, count = 0;
  PetscReal *factor = NULL, reached = NAN;
  PetscBool has_steps, has_factor, has_status, has_summary;
  char *status = NULL, *summary = NULL;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadInts(path, "/macro/steps", &has_steps, &rank, dims, &steps));
  if (has_steps && rank == 1) count = dims[0];
  PetscCall(PetscFree(steps));
  PetscCall(LamFileReadReals(path, "/macro/curve/load_factor", &has_factor, &rank, dims, &factor));
  if (has_factor && rank == 1 && dims[0]) reached = factor[dims[0] - 1];
  PetscCall(PetscFree(factor));
  PetscCall(LamFileReadText(path, "/macro/status", &has_status, &status));
  PetscCall(LamFileReadText(path, "/macro/summary", &has_summary, &summary));
  json_object_set_new(info, "run",
                      json_pack("{s:I, s:o, s:o?}", "steps", (json_int_t)count, "load_factor", LamJSONReal(reached),
                                "status", has_status ? LamJSONText(status) : NULL));
  if (has_summary) json_object_set_new(info, "summary", json_loads(summary, 0, NULL));
  PetscCall(PetscFree(status));
  PetscCall(PetscFree(summary));
  PetscFunctionReturn(0);
}

/* ---- the axes and modes of a map ---- */

/* Adds a text of the file; PETSC_ERR_USER_INPUT: it has none. */
static PetscErrorCode AddText(const char path[], char letter, const char name[], json_t *axis)
{
  char dataset[LAM_NAME_LENGTH], *text;
  PetscBool found;

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(dataset, sizeof(dataset), "/map/%c/%s", letter, name));
  PetscCall(LamFileReadText(path, dataset, &found, &text));
  PetscCheck(found, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: holds no %s; it is damaged, or older than this program",
             path, dataset);
  json_object_set_new(axis, name, LamJSONText(text));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadAxis(const char path[], char letter, json_t *map)
{
  char name[LAM_NAME_LENGTH], key[2] = {letter, '\0'};
  PetscInt rank = 0, dims[4];
  PetscReal *values;
  PetscBool found;
  json_t *axis = json_object();

  PetscFunctionBeginUser;
  json_object_set_new(map, key, axis);
  PetscCall(AddText(path, letter, "quantity", axis));
  PetscCall(AddText(path, letter, "unit", axis));
  PetscCall(PetscSNPrintf(name, sizeof(name), "/map/%c/values", letter));
  PetscCall(LamFileReadReals(path, name, &found, &rank, dims, &values));
  PetscCheck(found && rank == 1 && dims[0] > 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds no %s; it is damaged, or older than this program", path, name);
  json_object_set_new(axis, "from", LamJSONReal(values[0]));
  json_object_set_new(axis, "to", LamJSONReal(values[dims[0] - 1]));
  json_object_set_new(axis, "points", json_integer((json_int_t)dims[0]));
  PetscCall(PetscFree(values));
  PetscFunctionReturn(0);
}

/* Numbers of modes refer to the file's own list of names. */
static PetscErrorCode CountModes(const char path[], json_t *modes)
{
  PetscInt rank = 0, dims[4] = {0}, *number, line = 0, total = 1;
  PetscBool found, has_names;
  char *names, *rest;

  PetscFunctionBeginUser;
  PetscCall(LamFileReadText(path, "/map/modes", &has_names, &names));
  PetscCall(LamFileReadInts(path, "/map/mode", &found, &rank, dims, &number));
  PetscCheck(found && has_names && rank == 2, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: holds no /map/mode or /map/modes; it is damaged, or older than this program", path);
  for (PetscInt i = 0; i < rank; i++) total *= dims[i];
  for (char *name = strtok_r(names, "\n", &rest); name; name = strtok_r(NULL, "\n", &rest), line++) {
    json_int_t count = 0;

    for (PetscInt i = 0; i < total; i++) count += number[i] == line;
    if (count) json_object_set_new(modes, name, json_integer(count));
  }
  PetscCall(PetscFree(number));
  PetscCall(PetscFree(names));
  PetscFunctionReturn(0);
}

static PetscErrorCode ReadMap(const char path[], json_t *info)
{
  json_t *map = json_object(), *modes = json_object();

  PetscFunctionBeginUser;
  json_object_set_new(info, "map", map); /* which owns the rest, also if the file is refused */
  json_object_set_new(map, "modes", modes);
  PetscCall(ReadAxis(path, 'x', map));
  PetscCall(ReadAxis(path, 'y', map));
  PetscCall(CountModes(path, modes));
  PetscFunctionReturn(0);
}

/* ---- intact and damaged parts ---- */

#define MAX_LINES 20 /* of damage, in human-readable output */

static void PrintDamage(const json_t *damaged)
{
  size_t i;
  json_t *item;

  json_array_foreach(damaged, i, item)
  {
    const json_t *record = json_object_get(item, "record"), *key = json_object_get(item, "key");
    const char *reason = json_string_value(json_object_get(item, "reason"));

    if (i == MAX_LINES) {
      printf("%-20s and %d more (--json names them)\n", "", (int)json_array_size(damaged) - MAX_LINES);
      break;
    }
    if (!record)
      printf("%-20s %s: %s\n", "damaged", json_string_value(json_object_get(item, "part")), reason);
    else if (key)
      printf("%-20s record %lld (key %lld): %s\n", "damaged", (long long)json_integer_value(record),
             (long long)json_integer_value(key), reason);
    else
      printf("%-20s record %lld: %s\n", "damaged", (long long)json_integer_value(record), reason);
  }
}

static void PrintCheck(const char path[], const json_t *check)
{
  const json_t *records = json_object_get(check, "records"), *unchecked = json_object_get(check, "unchecked");
  const json_t *sound_records = json_object_get(check, "sound_records");
  const PetscBool sound = (PetscBool)json_is_true(json_object_get(check, "sound"));
  size_t i;
  json_t *part;

  printf("%-20s %s\n", "file", path);
  PrintWriter(json_object_get(check, "writer"));
  if (json_is_integer(records)) PrintInteger("records", records);
  if (json_is_integer(sound_records)) PrintInteger("sound records", sound_records);
  json_array_foreach(unchecked, i, part)
  {
    printf("%-20s %s\n", "without checksum", json_string_value(part));
  }
  PrintDamage(json_object_get(check, "damaged"));
  printf("%-20s %s\n", "state", sound ? "sound" : "damaged");
  if (sound) return;
  printf("%-20s lamella merge NEW.h5 %s --salvage keeps the sound records of a database;\n", "remedy", path);
  printf("%-20s lamella build SCENE -d NEW.h5 --resume solves the others again\n", "");
}

static PetscErrorCode CheckFile(const char path[], LamConsole *console, int *exit_status)
{
  const LamReporter reporter = LamConsoleReporter(console);
  PetscBool sound;
  json_t *check;
  char *text;

  PetscFunctionBeginUser;
  LamActivitySet("records");
  PetscCall(LamFileCheck(path, &reporter, &sound, &text));
  LamConsoleClear();
  check = json_loads(text, 0, NULL);
  PetscCall(PetscFree(text));
  PetscCheck(check, PETSC_COMM_SELF, PETSC_ERR_LIB, "%s: what is damaged is no JSON", path);
  if (console->json) {
    PetscCall(LamPrintJSON(check));
  } else {
    PrintCheck(path, check);
    json_decref(check);
  }
  *exit_status = sound ? LAM_EXIT_OK : LAM_EXIT_INPUT;
  PetscFunctionReturn(0);
}

/* ---- the command ---- */

/* Reads the data other than records, by kind of file. */
static PetscErrorCode ReadKind(const char path[], json_t *info)
{
  const char *kind = json_string_value(json_object_get(info, "kind"));

  PetscFunctionBeginUser;
  PetscCheck(kind, PETSC_COMM_SELF, PETSC_ERR_LIB, "%s: its description is no JSON", path);
  if (!strcmp(kind, "fe2")) PetscCall(ReadRun(path, info));
  if (!strcmp(kind, "map")) PetscCall(ReadMap(path, info));
  PetscFunctionReturn(0);
}

static PetscErrorCode Describe(const char path[], PetscBool as_json)
{
  LamDatabase database;
  PetscErrorCode ierr;
  const char *text;
  json_t *info = NULL;

  PetscFunctionBeginUser;
  PetscCall(LamDatabaseOpen(path, &database));
  ierr = LamDatabaseGetInfo(database, &text);
  if (!ierr) info = json_loads(text, 0, NULL);
  if (!ierr) ierr = ReadKind(path, info);
  if (!ierr && as_json) ierr = LamPrintJSON(json_incref(info));
  if (!ierr && !as_json) PrintTable(info);
  json_decref(info);
  PetscCall(LamDatabaseClose(&database));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandInfo(LamArgs *args, int *exit_status)
{
  LamConsole console = {.command = "info"};
  PetscBool check = PETSC_FALSE, done;
  const char *path;
  const LamOption options[] = {
      {0, "check", LAM_OPTION_FLAG, NULL, "read all of it, name what is damaged; exit status 2 where anything is",
       &check},
      {0, "json", LAM_OPTION_FLAG, NULL, "one JSON object on stdout", &console.json},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &console.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL},
  };

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(args, "info FILE.h5 [--check] [--json] [--quiet]",
                            "Shows what a file holds, who wrote it, with what; or what of it is sound.", options, 1,
                            &path, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  *exit_status = LAM_EXIT_OK;
  if (check)
    PetscCall(CheckFile(path, &console, exit_status));
  else
    PetscCall(Describe(path, console.json));
  PetscFunctionReturn(0);
}
