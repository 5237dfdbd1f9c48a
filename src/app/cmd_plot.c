/*
  lamella plot: a picture of a file's contents. The package in python/lamella/plot draws it.
*/
#include "app.h"
#include <stdio.h>
#include <string.h>

/* What --field may name: those of python/lamella/plot, which a test compares. */
static const char *const Fields[] = {"wall_stress",
                                     "fibre_stretch",
                                     "von_mises",
                                     "mean_stress",
                                     "cauchy_11",
                                     "cauchy_12",
                                     "cauchy_22",
                                     "P_11",
                                     "P_12",
                                     "P_21",
                                     "P_22",
                                     "J",
                                     "lumen_fraction",
                                     "opening_fraction",
                                     "debonded_fraction",
                                     "turgor",
                                     "open_fraction",
                                     "max_gap",
                                     "max_gap_max",
                                     "face_unloading_max",
                                     "wall_tension",
                                     "wall_tension_max",
                                     "lamella_normal",
                                     "lamella_normal_max",
                                     "lamella_shear",
                                     "lamella_shear_max",
                                     "ellipticity_min",
                                     "wall_tension_ratio_max",
                                     "lamella_normal_ratio_max",
                                     "lamella_shear_ratio_max",
                                     "water_potential",
                                     "apoplast_potential",
                                     "broken_fraction",
                                     "broken_fraction_max",
                                     "broken_face_max",
                                     "stored",
                                     "dissipated",
                                     "released",
                                     "error_estimate",
                                     "interpolated",
                                     "stress",
                                     "load_factor"};

void LamPlotVisitFields(void (*visit)(void *ctx, const char name[]), void *ctx)
{
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(Fields); i++) visit(ctx, Fields[i]);
  for (const LamMember *m = LamResponseMembers; m->name; m++) /* of maps */
    if (m->count == 1 && (m->type == LAM_MEMBER_REAL || m->type == LAM_MEMBER_INT)) visit(ctx, m->name);
}

/* Replaces the ending of the file by .png. */
static PetscErrorCode DefaultOutput(const char input[], size_t size, char output[])
{
  const char *slash = strrchr(input, '/'), *dot = strrchr(slash ? slash : input, '.');
  const size_t length = dot ? (size_t)(dot - input) : strlen(input);

  PetscFunctionBeginUser;
  PetscCheck(length + 5 <= size, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: the name is too long", input);
  snprintf(output, size, "%.*s.png", (int)length, input);
  PetscFunctionReturn(0);
}

/* What the command line says; texts are NULL where it says nothing. */
typedef struct {
  const char *output, *field, *map, *angle, *suction, *turgor, *title, *size, *range, *x, *y;
  PetscInt state, dpi;
  PetscBool strip, forces, film, no_title, quiet;
  PetscReal accuracy;
} Request;

/* Adds two numbers, as "0,1"; PETSC_FALSE: the text is something else. */
static PetscBool AddPair(json_t *object, const char name[], const char text[], const char separator[], int *exit_status)
{
  double a, b;
  char between[2], rest;

  if (!text) return PETSC_TRUE;
  if (sscanf(text, "%lf%1[,x]%lf%c", &a, between, &b, &rest) != 3 || strcmp(between, separator) ||
      PetscIsInfOrNanReal(a) || PetscIsInfOrNanReal(b) || !(a < b || *separator == 'x'))
    return LamUsageError("plot", exit_status, "--%s \"%s\": two numbers are wanted, such as %s", name, text,
                         *separator == 'x' ? "7x3.5, in inches" : "0,1, the lower one first");
  if (*separator == 'x' && !(a >= 2 && b >= 2 && a <= 100 && b <= 100))
    return LamUsageError("plot", exit_status, "--%s \"%s\": a page is 2 to 100 inches wide and high", name, text);
  json_object_set_new(object, name, json_pack("[f,f]", a, b));
  return PETSC_TRUE;
}

static void AddText(json_t *object, const char name[], const char text[])
{
  if (text) json_object_set_new(object, name, json_string(text));
}

static PetscErrorCode Draw(const char input[], const Request *r, int *exit_status)
{
  char name[PETSC_MAX_PATH_LEN];
  json_t *o;

  PetscFunctionBeginUser;
  if (!r->output) PetscCall(DefaultOutput(input, sizeof(name), name));
  o = json_pack("{s:s, s:[s], s:b, s:b, s:b, s:b}", "input", input, "outputs", r->output ? r->output : name, "strip",
                r->strip, "forces", r->forces, "film", r->film, "quiet", r->quiet);
  PetscCheck(o, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: a name is not in UTF-8", input);
  if (r->state >= 0) json_object_set_new(o, "state", json_integer(r->state));
  if (r->state == LAM_STATE_LAST) json_object_set_new(o, "state", json_string("last"));
  AddText(o, "field", r->field);
  AddText(o, "map", r->map);
  AddText(o, "angle", r->angle);
  AddText(o, "suction", r->suction);
  AddText(o, "turgor", r->turgor);
  AddText(o, "title", r->title);
  if (r->no_title) json_object_set_new(o, "title", json_false());
  if (r->accuracy > 0) json_object_set_new(o, "accuracy", json_real(r->accuracy));
  if (r->dpi > 0) json_object_set_new(o, "dpi", json_integer(r->dpi));
  if (AddPair(o, "size", r->size, "x", exit_status) && AddPair(o, "range", r->range, ",", exit_status) &&
      AddPair(o, "x", r->x, ",", exit_status) && AddPair(o, "y", r->y, ",", exit_status))
    PetscCall(LamPythonRun(&LamPythonPlot, o, exit_status));
  else
    json_decref(o);
  PetscFunctionReturn(0);
}

PetscErrorCode LamCommandPlot(LamArgs *args, int *exit_status)
{
  Request r = {.state = LAM_STATE_PEAK};
  const char *input;
  const LamOption options[] = {
      {'o', "output", LAM_OPTION_TEXT, "FIG.png|.svg|.pdf", "the picture (default: FILE.png)", &r.output},
      {0, "state", LAM_OPTION_STATE, "N|last", "state of an RVE file, step of an fe2 file (default: at the peak load)",
       &r.state},
      {0, "field", LAM_OPTION_TEXT, "NAME", "field that gives the colours (docs/reference/pictures.md lists them)",
       &r.field},
      {0, "strip", LAM_OPTION_FLAG, NULL, "up to eight states beside each other, with one colour scale", &r.strip},
      {0, "forces", LAM_OPTION_FLAG, NULL,
       "of an RVE file whose cells can part: lines between cells, as wide as the normal force is large", &r.forces},
      {0, "film", LAM_OPTION_FLAG, NULL,
       "of a process: a page (PDF) or a numbered file for each state whose cells, or body, the file has", &r.film},
      {0, "map", LAM_OPTION_TEXT, "MAP.h5", "of a process: its way over this map of failure", &r.map},
      {0, "angle", LAM_OPTION_TEXT, "ANGLE",
       "slice through a table: first principal axis to the normal of face 0, \"15 deg\" (default: 0)", &r.angle},
      {0, "suction", LAM_OPTION_TEXT, "PRESSURE",
       "slice of contact tissue: turgor + cohesion, \"0.02 MPa\" (default: in the middle)", &r.suction},
      {0, "turgor", LAM_OPTION_TEXT, "PRESSURE", "slice of bonded tissue, \"0.02 MPa\" (default: that of the nodes)",
       &r.turgor},
      {0, "accuracy", LAM_OPTION_ACCURACY, "SHARE", "slice: the error that is asked for (default: that of the file)",
       &r.accuracy},
      {0, "size", LAM_OPTION_TEXT, "WIDTHxHEIGHT", "of the page, inches (default: 7 wide)", &r.size},
      {0, "title", LAM_OPTION_TEXT, "TEXT", "in place of the state and its load", &r.title},
      {0, "no-title", LAM_OPTION_FLAG, NULL, "none", &r.no_title},
      {0, "range", LAM_OPTION_TEXT, "LOW,HIGH", "limits of the colour scale, in the unit that it shows", &r.range},
      {0, "x", LAM_OPTION_TEXT, "LOW,HIGH", "limits of the horizontal axis of charts", &r.x},
      {0, "y", LAM_OPTION_TEXT, "LOW,HIGH", "limits of the vertical axis of the chart", &r.y},
      {0, "dpi", LAM_OPTION_FROM_1, "N", "dots per inch: of PNG (default: 400), of fields in SVG and PDF (300)",
       &r.dpi},
      {0, "quiet", LAM_OPTION_FLAG, NULL, "no progress on stderr", &r.quiet},
      {0, NULL, LAM_OPTION_FLAG, NULL, NULL, NULL}};
  PetscBool done;

  PetscFunctionBeginUser;
  PetscCall(LamOptionsParse(
      args,
      "plot FILE.h5|.json [-o FIG.png|.svg|.pdf] [--state N|last | --strip] [--field NAME] [--forces]\n"
      "                    [--film] [--map MAP.h5] [--angle ANGLE] [--suction PRESSURE | --turgor PRESSURE]\n"
      "                    [--accuracy SHARE] [--size WIDTHxHEIGHT] [--title TEXT | --no-title] [--range LOW,HIGH]\n"
      "                    [--x LOW,HIGH] [--y LOW,HIGH] [--dpi N] [--quiet]",
      "Draws what the file holds, with Python and its package matplotlib.", options, 1, &input, &done, exit_status));
  if (done) PetscFunctionReturn(0);
  if (r.title && r.no_title)
    (void)LamUsageError("plot", exit_status, "--title and --no-title: one of them");
  else
    PetscCall(Draw(input, &r, exit_status));
  PetscFunctionReturn(0);
}
