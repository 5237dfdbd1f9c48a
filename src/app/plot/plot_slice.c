/*
  Data of a slice through a table: its responses on a raster of deformations, and the nodes that lie in it.

  Method

  F = U has principal logarithmic strains e1, e2 along two fixed axes. With n = (cos a, sin a) along the first, U =
  exp(e1) n(x)n + exp(e2) m(x)m, m normal to n. A node with mean strain m, isochoric strain r and first axis at the
  angle b lies r sin 2(b - a) out of the slice and is drawn at e1, e2 = m +- r cos 2(b - a). The rotations and mirrors
  of a regular lattice give six images of it.
*/
#include "plot_slice.h"
#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define FACE_ANGLE (PETSC_PI / 3)
#define REACH 0.02  /* of the width of the slice: distance of nodes to the slice up to which they are drawn */
#define TINY 1e-9   /* rounding of a suction, C1 + C2 */
#define MARGIN 0.12 /* of the sample's width: margin drawn around it */

void LamPrincipalStrains(const PetscReal F[9], PetscReal strain[2], PetscReal *angle)
{
  PetscReal C[3] = {0, 0, 0}, mean, radius;

  for (int k = 0; k < 3; k++) {
    C[0] += F[3 * k] * F[3 * k];
    C[1] += F[3 * k] * F[3 * k + 1];
    C[2] += F[3 * k + 1] * F[3 * k + 1];
  }
  mean = 0.5 * (C[0] + C[2]);
  radius = hypot(0.5 * (C[0] - C[2]), C[1]);
  strain[0] = 0.5 * PetscLogReal(mean + radius);
  strain[1] = mean > radius ? 0.5 * PetscLogReal(mean - radius) : NAN;
  *angle = 0.5 * atan2(2 * C[1], C[0] - C[2]);
}

PetscReal LamStressNorm(const PetscReal P[9])
{
  PetscReal square = 0;

  for (int k = 0; k < 9; k++)
    if (isfinite(P[k])) square += PetscSqr(P[k]);
  return PetscSqrtReal(square);
}

PetscReal LamSliceStrain(const LamSlice *slice, PetscInt i)
{
  return slice->low + (slice->high - slice->low) * ((PetscReal)i + 0.5) / LAM_SLICE_SAMPLES;
}

static LamLoad LoadAt(const LamSlice *s, const LamScales *scales, PetscReal e1, PetscReal e2)
{
  const PetscReal angle = s->orientation + s->angle, c = cos(angle), n = sin(angle), u1 = exp(e1), u2 = exp(e2);
  const PetscReal U12 = c * n * (u1 - u2), MPa = 1e6 / scales->stress;

  return (LamLoad){.F = {c * c * u1 + n * n * u2, U12, 0, U12, n * n * u1 + c * c * u2, 0, 0, 0, 1},
                   .turgor = s->turgor * MPa,
                   .cohesion = s->cohesion * MPa};
}

/* What the database holds. */
typedef struct {
  LamGrid grid;
  LamPlotRecords of;
} Nodes;

/* ---- choice of the slice ---- */

PetscErrorCode LamSliceRefuse(const LamPlotRequest *request)
{
  char accuracy[32];
  const struct {
    const char *option, *value;
  } options[] = {{"angle", request->angle},
                 {"suction", request->suction},
                 {"turgor", request->turgor},
                 {"accuracy", request->accuracy > 0 ? accuracy : NULL}};

  PetscFunctionBeginUser;
  PetscCall(PetscSNPrintf(accuracy, sizeof accuracy, "%g", (double)request->accuracy));
  for (size_t i = 0; i < PETSC_STATIC_ARRAY_LENGTH(options); i++)
    PetscCheck(!options[i].value, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "--%s %s: chooses a slice through the table of a database; what is drawn of %s has none",
               options[i].option, options[i].value, request->input);
  PetscFunctionReturn(0);
}

/* That of the request, or else of the file. */
static PetscErrorCode ReadAccuracy(const LamPlotRequest *request, LamDatabase database, PetscReal *accuracy)
{
  const char *text;
  json_t *info;

  PetscFunctionBeginUser;
  *accuracy = request->accuracy;
  if (*accuracy > 0) PetscFunctionReturn(0);
  PetscCall(LamDatabaseGetInfo(database, &text));
  info = json_loads(text, 0, NULL);
  *accuracy = json_number_value(json_object_get(info, "accuracy"));
  json_decref(info);
  PetscFunctionReturn(0);
}

static PetscReal Suction(const LamLoad *load)
{
  return load->turgor + load->cohesion;
}

/* Whether a record is a solved node; states of floating cells are stored beside them. */
static PetscBool IsNode(const Nodes *nodes, PetscInt i)
{
  return (PetscBool)(LamKeyIsNode(nodes->of.keys[i]) && LamGridNodeLevel(nodes->grid, nodes->of.keys[i]) >= 0);
}

/* Smallest and largest suction of the nodes; PETSC_FALSE: there are no nodes. */
static PetscBool SuctionRange(const Nodes *nodes, PetscReal range[2])
{
  range[0] = PETSC_INFINITY;
  range[1] = -PETSC_INFINITY;
  for (PetscInt i = 0; i < nodes->of.n; i++) {
    if (!IsNode(nodes, i)) continue;
    range[0] = PetscMin(range[0], Suction(&nodes->of.records[i].load));
    range[1] = PetscMax(range[1], Suction(&nodes->of.records[i].load));
  }
  return (PetscBool)(range[0] <= range[1]);
}

/* The load of the node with the nearest suction; `coarsest`: only nodes of the coarsest level. NULL: there is none. */
static const LamLoad *NearestLoad(const Nodes *nodes, PetscReal suction, PetscBool coarsest)
{
  const LamLoad *nearest = NULL;

  for (PetscInt i = 0; i < nodes->of.n; i++) {
    const LamLoad *load = &nodes->of.records[i].load;

    if (!IsNode(nodes, i) || (coarsest && LamGridNodeParent(nodes->grid, nodes->of.keys[i]) >= 0)) continue;
    if (!nearest || fabs(Suction(load) - suction) < fabs(Suction(nearest) - suction)) nearest = load;
  }
  return nearest;
}

/* Turgor and cohesion of the slice, and the suction of the nodes in it. */
static PetscErrorCode ChooseLoad(const LamPlotRequest *request, const Nodes *nodes, LamSlice *s)
{
  const PetscReal MPa = nodes->of.scales.stress * 1e-6;
  const PetscBool contact = LamCellsPart(s->interface);
  const char *text = contact ? request->suction : request->turgor;
  const LamLoad *node;
  PetscReal range[2], suction;

  PetscFunctionBeginUser;
  PetscCheck(contact || !request->suction, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "--suction %s: bonded tissue has none; give its --turgor", request->suction);
  PetscCheck(!contact || !request->turgor, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "--turgor %s: slices of contact tissue have a --suction, which is turgor + cohesion", request->turgor);
  PetscCheck(SuctionRange(nodes, range), PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: its table holds no nodes to draw",
             request->input);
  suction = 0.5 * (range[0] + range[1]);
  if (text) {
    PetscCall(LamQuantityParse(text, LAM_DIMENSION_STRESS, &suction));
    suction /= nodes->of.scales.stress;
    PetscCheck(!contact || (suction >= range[0] - TINY && suction <= range[1] + TINY), PETSC_COMM_SELF,
               PETSC_ERR_USER_INPUT, "--suction %s: the nodes of %s cover %.4g to %.4g MPa", text, request->input,
               (double)(range[0] * MPa), (double)(range[1] * MPa));
  }
  node = NearestLoad(nodes, suction, (PetscBool)!text);
  PetscCheck(node, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: its table lacks all coarse nodes", request->input);
  s->node_suction = Suction(node) * MPa;
  s->cohesion = node->cohesion * MPa;
  s->turgor = text ? suction * MPa - s->cohesion : node->turgor * MPa;
  PetscFunctionReturn(0);
}

/* The scene's sample box, else the range of the nodes, with a margin. */
static PetscErrorCode ChooseBox(const char path[], const Nodes *nodes, LamSlice *s)
{
  PetscReal angle, strain[2];
  LamScene *scene = NULL;
  PetscBool found;
  char *text;

  PetscFunctionBeginUser;
  s->low = s->box[0] = s->box[1] = NAN;
  PetscCall(LamFileReadText(path, "/scene", &found, &text));
  if (found) PetscCall(LamSceneReadText(path, text, &scene));
  if (found) PetscCall(PetscFree(text));
  if (scene && scene->has_sample) {
    s->low = s->box[0] = scene->sample.stretch_min;
    s->high = s->box[1] = scene->sample.stretch_max;
  }
  PetscCall(LamSceneDestroy(&scene));
  for (PetscInt i = 0; i < nodes->of.n && isnan(s->box[0]); i++) {
    if (!IsNode(nodes, i)) continue;
    LamPrincipalStrains(nodes->of.records[i].load.F, strain, &angle);
    s->low = isnan(s->low) ? strain[1] : PetscMin(s->low, strain[1]);
    s->high = isnan(s->high) ? strain[0] : PetscMax(s->high, strain[0]);
  }
  angle = MARGIN * PetscMax(s->high - s->low, 1e-3);
  s->low -= angle;
  s->high += angle;
  PetscFunctionReturn(0);
}

/* ---- nodes ---- */

static LamSliceNodeKind KindOf(const LamResponse *record)
{
  if (record->status != LAM_CONVERGED && record->status != LAM_UNSTABLE) return LAM_SLICE_UNSOLVED;
  return record->stable && !record->branch ? LAM_SLICE_SOUND : LAM_SLICE_BUCKLED;
}

/* The images of a node that lie in the slice. */
static void AddImages(LamSlice *s, PetscInt images, const LamSliceNode *node, const LamResponse *record)
{
  PetscReal strain[2], angle;

  LamPrincipalStrains(record->load.F, strain, &angle);
  for (PetscInt i = 0; i < images; i++) {
    const PetscReal own = angle - s->orientation;
    const PetscReal turn = 2 * ((i < 3 ? own : -own) + FACE_ANGLE * (PetscReal)(i % 3) - s->angle);
    const PetscReal mean = 0.5 * (strain[0] + strain[1]), shape = 0.5 * (strain[0] - strain[1]);
    LamSliceNode *image = &s->nodes[s->node_count];

    if (!(fabs(shape * sin(turn)) <= s->reach)) continue;
    *image = *node;
    image->at[0] = mean + shape * cos(turn);
    image->at[1] = mean - shape * cos(turn);
    if (PetscMax(image->at[0], image->at[1]) <= s->high && PetscMin(image->at[0], image->at[1]) >= s->low)
      s->node_count++;
  }
}

static PetscErrorCode CollectNodes(const Nodes *nodes, LamSlice *s)
{
  const LamMicrostructure *micro = &nodes->of.micro;
  const PetscInt images = micro->cells[0] == micro->cells[1] && !micro->cell ? 6 : 1;
  const PetscReal suction = s->node_suction / (nodes->of.scales.stress * 1e-6);

  PetscFunctionBeginUser;
  s->reach = REACH * (s->high - s->low);
  PetscCall(PetscMalloc1(nodes->of.n * images, &s->nodes));
  for (PetscInt i = 0; i < nodes->of.n; i++) {
    const LamSliceNode node = {.kind = KindOf(&nodes->of.records[i]),
                               .level = LamGridNodeLevel(nodes->grid, nodes->of.keys[i])};

    if (!IsNode(nodes, i)) continue;
    s->table_nodes++;
    if (fabs(Suction(&nodes->of.records[i].load) - suction) > TINY) continue;
    AddImages(s, images, &node, &nodes->of.records[i]);
  }
  PetscFunctionReturn(0);
}

/* ---- responses ---- */

static LamSliceVerdict VerdictOf(const LamSlice *s, const LamResponse *response)
{
  if (!LamResponseHasFields(response))
    return strstr(response->reason, "not all of one kind") ? LAM_SLICE_KINK : LAM_SLICE_NOTHING;
  if (response->error_estimate > s->accuracy) return LAM_SLICE_INACCURATE;
  return response->floating_cells > 0 ? LAM_SLICE_FLOATING : LAM_SLICE_RESPONDS;
}

static void KeepResponse(const LamSlice *s, const LamScales *scales, const LamResponse *r, PetscInt at)
{
  const PetscReal MPa = scales->stress * 1e-6;
  const PetscReal share = LamCellsPart(s->interface) ? r->opening_fraction : r->lumen_fraction;

  s->value[LAM_SLICE_POTENTIAL][at] = (r->energy + r->load.turgor * (r->lumen_fraction + r->opening_fraction)) * MPa;
  s->value[LAM_SLICE_STRESS][at] = LamStressNorm(r->P) * MPa;
  s->value[LAM_SLICE_ERROR][at] = log10(PetscMax(100 * r->error_estimate, 1e-12));
  s->value[LAM_SLICE_INDICATOR][at] = 100 * share;
}

static PetscErrorCode QueryRow(LamTable table, const LamScales *scales, LamSlice *s, PetscInt row)
{
  LamResponse response;

  PetscFunctionBeginUser;
  for (PetscInt i = 0; i < LAM_SLICE_SAMPLES; i++) {
    const LamLoad load = LoadAt(s, scales, LamSliceStrain(s, i), LamSliceStrain(s, row));
    const PetscInt at = row * LAM_SLICE_SAMPLES + i;

    PetscCall(LamTableQuery(table, &load, PETSC_INFINITY, &response));
    for (int k = 0; k < LAM_SLICE_PANEL_COUNT; k++) s->value[k][at] = NAN;
    if (LamResponseHasFields(&response)) KeepResponse(s, scales, &response, at);
    s->verdict[at] = VerdictOf(s, &response);
    s->count[s->verdict[at]]++;
  }
  PetscFunctionReturn(0);
}

PetscErrorCode LamSliceRead(const LamPlotRequest *request, LamDatabase database, LamSlice *s)
{
  const PetscInt n = LAM_SLICE_SAMPLES * LAM_SLICE_SAMPLES;
  LamTable table;
  Nodes nodes;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(s, sizeof *s));
  PetscCall(LamPlotGetRecords(database, &nodes.of));
  PetscCall(LamDatabaseGetGrid(database, &nodes.grid));
  s->interface = nodes.of.micro.interface;
  s->orientation = nodes.of.micro.orientation;
  if (request->angle) PetscCall(LamQuantityParse(request->angle, LAM_DIMENSION_ANGLE, &s->angle));
  PetscCall(ReadAccuracy(request, database, &s->accuracy));
  PetscCall(ChooseLoad(request, &nodes, s));
  PetscCall(ChooseBox(request->input, &nodes, s));
  PetscCall(CollectNodes(&nodes, s));
  PetscCall(PetscMalloc1(n, &s->verdict));
  for (int k = 0; k < LAM_SLICE_PANEL_COUNT; k++) PetscCall(PetscMalloc1(n, &s->value[k]));
  PetscCall(LamDatabaseGetTable(database, &table));
  for (PetscInt row = 0; row < LAM_SLICE_SAMPLES; row++) PetscCall(QueryRow(table, &nodes.of.scales, s, row));
  PetscCall(LamTableDestroy(&table));
  PetscFunctionReturn(0);
}

PetscErrorCode LamSliceDestroy(LamSlice *s)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(s->verdict));
  for (int k = 0; k < LAM_SLICE_PANEL_COUNT; k++) PetscCall(PetscFree(s->value[k]));
  PetscCall(PetscFree(s->nodes));
  PetscFunctionReturn(0);
}
