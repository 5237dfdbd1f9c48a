/*
  Pictures are drawn, and tissue is made, by the Python package (python/lamella), in a process of its own.
*/
#define _GNU_SOURCE /* environ */
#include "app.h"
#include <errno.h>
#include <spawn.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

/* Debian's, which has Debian's packages; others are named by LAMELLA_PYTHON. */
#define PYTHON "/usr/bin/python3"

const LamPython LamPythonPlot = {"lamella.plot.__main__", "pictures need", "matplotlib"},
                LamPythonTissue = {"lamella.tissue.__main__", "tissue needs", "scipy"},
                LamPythonCalibrate = {"lamella.calibration", "calibration needs", "scipy"},
                LamPythonSensitivity = {"lamella.sensitivity", "sensitivity needs", "scipy"},
                LamPythonRealisations = {"lamella.tissue.realise", "realisations need", "scipy"},
                LamPythonValidate = {"lamella.validation.__main__", "validation needs", "scipy"},
                LamPythonUncertainty = {"lamella.uncertainty", "samples need", "scipy"};

/* A package that is missing is found when it is imported, here or where a file is opened. */
static const char Program[] =
    "import sys\n"
    "sys.path = [sys.argv[2]] * bool(sys.argv[2]) + sys.path[1:]\n" /* its own folder, not that where it is started */
    "try:\n"
    "    from importlib import import_module\n"
    "    sys.exit(import_module(sys.argv[3]).main(sys.argv[1]))\n"
    "except ModuleNotFoundError as error:\n"
    "    if error.name.startswith('lamella'):\n"
    "        print(f'lamella: {sys.argv[4]} the Python package lamella, the folder python of the sources', "
    "file=sys.stderr)\n"
    "    else:\n"
    "        print(f'lamella: {sys.argv[4]} the Python package {error.name} (Debian: python3-{error.name})', "
    "file=sys.stderr)\n"
    "except ImportError as error:\n"
    "    print(f'lamella: {sys.argv[4]} the Python package lamella: {error}', file=sys.stderr)\n"
    "sys.exit(4)\n";

/* The folder of the program, without a slash behind it; "" if it is not known. */
static void ProgramFolder(char folder[PETSC_MAX_PATH_LEN])
{
  const ssize_t length = readlink("/proc/self/exe", folder, PETSC_MAX_PATH_LEN - 1);
  char *slash;

  folder[length > 0 ? length : 0] = '\0';
  slash = strrchr(folder, '/');
  if (slash) *slash = '\0';
}

/* The first of these folders, from that of the program, that has the file; "" if none has. */
static void FindFolder(const char program[], const char *const folders[], const char file[],
                       char folder[PETSC_MAX_PATH_LEN])
{
  char path[2 * PETSC_MAX_PATH_LEN];

  folder[0] = '\0';
  for (int i = 0; folders[i] && !folder[0]; i++) {
    snprintf(path, sizeof(path), "%s/%s/%s", program, folders[i], file);
    if (!access(path, R_OK)) snprintf(folder, PETSC_MAX_PATH_LEN, "%.3000s/%s", program, folders[i]);
  }
}

/* Where the package is: beside the program, or where it is installed with it; an installed one has its library inside.
   The program that it runs is this one. */
static void FindPackage(char package[PETSC_MAX_PATH_LEN])
{
  static const char *const packages[] = {"python", "../share/lamella/python", NULL}, *const libraries[] = {".", NULL};
  char program[PETSC_MAX_PATH_LEN], library[PETSC_MAX_PATH_LEN], itself[PETSC_MAX_PATH_LEN];

  ProgramFolder(program);
  FindFolder(program, packages, "lamella/plot/__main__.py", package);
  FindFolder(program, libraries, "liblamella.so", library);
  if (library[0]) setenv("LAMELLA_LIBRARY", library, 0);
  if (realpath("/proc/self/exe", itself)) setenv("LAMELLA_PROGRAM", itself, 0);
}

/* The child is no rank of this job. */
static PetscBool IsOfLauncher(const char variable[])
{
  static const char *const heads[] = {"OMPI_COMM_", "OMPI_UNIVERSE", "PMIX_", "PMI_"};

  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(heads); i++)
    if (!strncmp(variable, heads[i], strlen(heads[i]))) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscErrorCode Environment(char ***environment)
{
  size_t count = 0, n = 0;

  PetscFunctionBeginUser;
  while (environ[count]) count++;
  PetscCall(PetscMalloc1(count + 1, environment));
  for (size_t i = 0; i < count; i++)
    if (!IsOfLauncher(environ[i])) (*environment)[n++] = environ[i];
  (*environment)[n] = NULL;
  PetscFunctionReturn(0);
}

/* Exit status of the child, which has said what is wrong. */
static int Await(pid_t child)
{
  int status;

  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return LAM_EXIT_FAULT;
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

PetscBool LamPythonStudyFits(const char command[], const char study[], const char unused[], int *exit_status)
{
  const char *ranks = getenv("OMPI_COMM_WORLD_SIZE");

  if (unused) return LamUsageError(command, exit_status, "--%s does not go with --%s; leave it out", unused, study);
  if (ranks && atoi(ranks) > 1)
    return LamUsageError(command, exit_status, "--%s has processes of its own (--processes): leave mpirun out", study);
  return PETSC_TRUE;
}

PetscErrorCode LamPythonRun(const LamPython *run, json_t *request, int *exit_status)
{
  const char *named = getenv("LAMELLA_PYTHON"), *python = named && *named ? named : PYTHON;
  char *text = json_dumps(request, 0), **environment, package[PETSC_MAX_PATH_LEN];
  char *const argv[] = {(char *)python,    "-c", (char *)Program, text, package, (char *)run->module,
                        (char *)run->need, NULL};
  pid_t child;
  int failed;

  PetscFunctionBeginUser;
  json_decref(request);
  PetscCheck(text, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "an argument is not in UTF-8");
  FindPackage(package);
  PetscCall(Environment(&environment));
  fflush(stdout);
  failed = posix_spawnp(&child, python, NULL, NULL, argv, environment);
  free(text);
  PetscCall(PetscFree(environment));
  PetscCheck(!failed, PETSC_COMM_SELF, PETSC_ERR_FILE_OPEN,
             "%s Python 3 with the package %s (Debian: python3-%s): %s: %s; LAMELLA_PYTHON names another one",
             run->need, run->package, run->package, python, strerror(failed));
  *exit_status = Await(child);
  PetscFunctionReturn(0);
}
