/*
  Reads a scene: file, YAML tree, validation against the table of keys, nondimensional data.
*/
#include "scene_keys.h"
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include "utf8.h"

/* Scenes have some kilobytes; a larger file is the wrong file. */
enum { MAX_FILE_SIZE = 1 << 20 };

PetscErrorCode LamSceneDestroy(LamScene **scene)
{
  PetscFunctionBeginUser;
  if (!*scene) PetscFunctionReturn(0);
  PetscCall(PetscFree((*scene)->text));
  for (PetscInt k = 0; k < (*scene)->warning_count; k++) PetscCall(PetscFree((*scene)->warnings[k]));
  PetscCall(PetscFree((*scene)->warnings));
  PetscCall(PetscFree((*scene)->loads));
  PetscCall(PetscFree((*scene)->controls));
  PetscCall(LamMicrostructureDestroy(&(*scene)->micro));
  PetscCall(LamSceneDestroyRegions(*scene));
  PetscCall(LamSceneDestroyFiles(*scene));
  PetscCall(LamSceneDestroyProcess(*scene));
  PetscCall(PetscFree(*scene));
  PetscFunctionReturn(0);
}

/* Rejects bytes that text does not contain: libfyaml's messages for them are less clear, and it never returns from a
   directive that is not UTF-8. */
static PetscErrorCode CheckText(const char name[], const char text[], size_t length)
{
  int line = 1, column = 1;
  size_t step;

  PetscFunctionBeginUser;
  PetscCheck(length <= MAX_FILE_SIZE, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%.200s: larger than %d kB; a scene is a short YAML file", name, (int)MAX_FILE_SIZE / 1024);
  PetscCheck(strncmp(text, "\x89HDF", 4), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%.200s: is an HDF5 file, no scene; `lamella info` says what it holds", name);
  for (const unsigned char *start = (const unsigned char *)text, *c = start; c < start + length; c += step) {
    PetscCheck((*c >= 0x20 && *c != 0x7F) || *c == '\t' || *c == '\n' || *c == '\r', PETSC_COMM_SELF,
               PETSC_ERR_USER_INPUT, "%.200s: byte %d is 0x%02x, which no text has; a scene is a YAML file", name,
               (int)(c - start), *c);
    step = LamCharacterLength(c);
    PetscCheck(step, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%.200s:%d:%d: byte 0x%02x is no UTF-8; save the scene in that encoding", name, line, column, *c);
    line += *c == '\n';
    column = *c == '\n' ? 1 : column + 1;
  }
  PetscFunctionReturn(0);
}

/*
  With law `lamella` a state would be of the exact law of contact or of the smooth one by where it came from, and P of
  one F differs by up to 5e-3 between them: a held body changes, and Newton's method of a body does not converge. Where
  the scene leaves the choice open, all states are of the smooth law.
*/
static void ChooseContact(LamMicrostructure *micro)
{
  if (micro->interface != LAM_INTERFACE_LAMELLA || micro->sharpness != LAM_SHARPNESS_AUTO) return;
  micro->sharpness = LAM_SHARPNESS_SMOOTH;
  micro->contact_width = LAM_USUAL_WIDTH;
}

static PetscErrorCode SceneBuild(LamDocument *document, LamScene *scene)
{
  static PetscErrorCode (*const parts[])(const LamNode *, LamScene *) = {
      LamSceneBuildRVE,    LamSceneBuildStrength, LamSceneBuildLoad,      LamSceneBuildMacro,
      LamSceneBuildSample, LamSceneBuildRegions,  LamSceneBuildResponse,  LamSceneCheckPatch,
      LamSceneBuildMap,    LamSceneBuildProcess,  LamSceneCheckUncertain, LamSceneBuildFiles};

  PetscFunctionBeginUser;
  PetscCall(LamDocumentParse(document->name, document->text, document));
  PetscCall(LamSceneCheckKeys(document));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(parts); i++) PetscCall(parts[i](document->root, scene));
  ChooseContact(&scene->micro);
  for (PetscInt r = 0; r < scene->region_count; r++) ChooseContact(&scene->regions[r].micro);
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneReadText(const char name[], const char text[], LamScene **scene)
{
  LamDocument document = {.name = name, .text = text};
  LamScene *built;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *scene = NULL;
  PetscCall(CheckText(name, text, strlen(text)));
  PetscCheck(strlen(name) < sizeof(built->path), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%.200s...: the file's name is longer than %d bytes", name, (int)sizeof(built->path) - 1);
  PetscCall(PetscNew(&built));
  ierr = SceneBuild(&document, built);
  PetscCall(LamDocumentDestroy(&document));
  if (!ierr) ierr = PetscStrncpy(built->path, name, sizeof(built->path));
  if (!ierr) ierr = PetscStrallocpy(text, &built->text);
  if (ierr) PetscCall(LamSceneDestroy(&built));
  PetscCall(ierr);
  *scene = built;
  PetscFunctionReturn(0);
}

/* Reads a stream, which may be a pipe; at most one byte more than the maximum size of a scene. */
static PetscErrorCode ReadStream(const char path[], char buffer[MAX_FILE_SIZE + 2], size_t *length)
{
  FILE *stream = fopen(path, "rb");
  int error;

  PetscFunctionBeginUser;
  PetscCheck(stream, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%.200s: the scene cannot be opened: %s", path,
             strerror(errno));
  errno = 0;
  *length = fread(buffer, 1, MAX_FILE_SIZE + 1, stream);
  error = ferror(stream) ? (errno ? errno : EIO) : 0;
  buffer[*length] = '\0';
  fclose(stream);
  PetscCheck(!error, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%.200s: the scene cannot be read: %s", path,
             strerror(error));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneRead(const char path[], LamScene **scene)
{
  size_t length;
  char *buffer;
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  *scene = NULL;
  PetscCall(PetscMalloc1(MAX_FILE_SIZE + 2, &buffer));
  ierr = ReadStream(path, buffer, &length);
  if (!ierr) ierr = CheckText(path, buffer, length);
  if (!ierr) ierr = LamSceneReadText(path, buffer, scene);
  PetscCall(PetscFree(buffer));
  PetscCall(ierr);
  PetscFunctionReturn(0);
}
