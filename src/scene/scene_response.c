/*
  `macro.response` of a scene: where the responses of material points come from.
*/
#include "scene_rows.h"
#include "quantity_text.h"
#include <string.h>

const char *const LamOutsideNames[] = {LAM_OUTSIDES(LAM_NAME_ENTRY)};

static const LamKey response_keys[] = {
    {MAP("macro.response"), .default_words = "as below", .example = "{outside: stop, accuracy: 0.003}",
     .help = "Where the responses of material points come from."},
    {NAME("macro.response.outside", LamOutsideNames), INTO(LamResponsePolicy, outside), .default_value = "solve",
     .help = "What a cache does with a state outside its table: `solve` it, and add it to the database, or `stop` the "
             "run where smaller steps do not avoid it."},
    {REAL("macro.response.accuracy"), INTO(LamResponsePolicy, accuracy), ABOVE(0), TO(0.5),
     .default_words = "the scene's `accuracy`; a tenth of it where a cache serves cells in contact with 12 or more "
                      "elements along a face",
     .example = "0.001", .help = "Relative error of P, by its estimate, that a response from a database may have."},
    {TEXT("macro.response.warm_start_memory"), .default_words = "2 GB", .example = "500 MB",
     .help = "Memory of a rank for the states from which direct solves start; material points that find no room start "
             "from the reference. With law `lamella`, whose states are its history, all find room."},
};
LAM_KEY_TABLE(LamResponseKeys, response_keys);

/* Units of memory, which udunits does not have. */
static const struct {
  const char *name;
  PetscReal bytes;
} units[] = {{"kB", 1e3}, {"MB", 1e6}, {"GB", 1e9}, {"TB", 1e12}};

/* Reads "2 GB"; 0: keep no states. */
static PetscErrorCode ReadMemory(const LamNode *node, PetscReal *bytes)
{
  const char *end;
  const PetscReal number = LamNumberScan(node->text, &end);

  PetscFunctionBeginUser;
  *bytes = -1;
  for (size_t k = 0; end > node->text && k < PETSC_STATIC_ARRAY_LENGTH(units); k++)
    if (!strcmp(end + strspn(end, " "), units[k].name)) *bytes = number * units[k].bytes;
  LamSceneCheck(*bytes >= 0 && *bytes < 1e18, node,
                "is no size of memory; write a number with kB, MB, GB or TB, such as 2 GB");
  PetscFunctionReturn(0);
}

PetscErrorCode LamSceneBuildResponse(const LamNode *root, LamScene *scene)
{
  const LamNode *memory = LamNodeFind(root, "macro.response.warm_start_memory");

  PetscFunctionBeginUser;
  scene->response.warm_start_memory = LAM_WARM_START_MEMORY;
  PetscCall(LamSceneFill(root, &scene->scales, LamResponsePolicy, &scene->response));
  if (memory) PetscCall(ReadMemory(memory, &scene->response.warm_start_memory));
  PetscFunctionReturn(0);
}
