/*
  The canonical description of a microstructure: nondimensional, with 12 digits, without parameters that have no
  effect. Scenes in different units that describe the same tissue have the same text and the same hash.
*/
#include <lamella/tissue.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "hash.h"
#include "tissue_json.h"

const char *const LamInterfaceLawNames[] = {LAM_INTERFACE_LAWS(LAM_NAME_ENTRY)};
const char *const LamSofteningNames[] = {LAM_SOFTENINGS(LAM_NAME_ENTRY)};
const char *const LamStrategyNames[] = {LAM_STRATEGIES(LAM_NAME_ENTRY)};
const char *const LamSharpnessNames[] = {LAM_SHARPNESSES(LAM_NAME_ENTRY)};
const char *const LamPatchSidesNames[] = {LAM_PATCH_SIDES(LAM_NAME_ENTRY)};

/* Unit conversion has rounding errors of about 1e-16, also around zero. */
static double Clean(PetscReal value)
{
  return fabs(value) < 1e-13 ? 0.0 : (double)value;
}

/* The wall. Parameters that its law does not have are left out, and optional ones that are 0. */
static void DescribeWall(const LamWall *wall, FILE *out)
{
  fprintf(out, "\"wall\": {\"law\": \"%s\", ", LamWallLawNames[wall->law]);
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++)
    if (LamWallLawHas(wall->law, k) && !(LamWallParameterIsOptional(k) && LamWallGet(wall, k) == 0))
      fprintf(out, "\"%s\": %.12g, ", LamWallParameterNames[k], Clean(LamWallGet(wall, k)));
  if (LamWallLawHasFibres(wall->law)) fprintf(out, "\"fibres\": \"%s\", ", LamFibresNames[wall->fibres]);
  if (wall->fibre_angle != 0) fprintf(out, "\"fibre_angle\": %.12g, ", Clean(wall->fibre_angle));
  fprintf(out, "\"bulk_modulus\": %.12g}", Clean(wall->bulk_modulus));
}

/* What is left out where walls have no memory: "relaxation": [[share, time in s], ...] */
static void DescribeRelaxation(const LamRelaxation *relaxation, FILE *out)
{
  if (!relaxation->terms) return;
  fprintf(out, ", \"relaxation\": [");
  for (PetscInt i = 0; i < relaxation->terms; i++)
    fprintf(out, "%s[%.12g, %.12g]", i ? ", " : "", Clean(relaxation->share[i]), (double)relaxation->time[i]);
  fprintf(out, "]");
}

/* {"strength": ..., "fracture_energy": ...}, of `size` factors each. */
static void DescribeFactors(const char name[], PetscInt size, const PetscReal strength[], const PetscReal energy[],
                            FILE *out)
{
  const PetscReal *const factors[] = {strength, energy};

  fprintf(out, ", \"%s\": {", name);
  for (int f = 0; f < 2; f++) {
    fprintf(out, f ? ", \"fracture_energy\": [" : "\"strength\": [");
    for (PetscInt k = 0; k < size; k++) fprintf(out, "%s%.12g", k ? ", " : "", Clean(factors[f][k]));
    fprintf(out, "]");
  }
  fprintf(out, "}");
}

/* The lamella; what has no effect is left out. */
static void DescribeLamella(const LamLamella *l, FILE *out)
{
  PetscBool alike = PETSC_TRUE;

  fprintf(out, ", \"softening\": \"%s\", \"stiffness\": %.12g, \"strength\": %.12g, \"fracture_energy\": %.12g",
          LamSofteningNames[l->softening], Clean(l->stiffness), Clean(l->strength), Clean(l->energy));
  fprintf(out, ", \"shear_strength\": %.12g", Clean(l->shear_strength));
  if (l->shear_strength > 0 && l->shear_energy != l->energy)
    fprintf(out, ", \"shear_energy\": %.12g, \"mixing\": %.12g", Clean(l->shear_energy), Clean(l->mixing));
  if (l->junction_length > 0) {
    fprintf(out, ", \"junction_length\": %.12g", Clean(l->junction_length));
    DescribeFactors("junction", 1, &l->junction_strength, &l->junction_energy, out);
  }
  for (int k = 0; k < 3; k++)
    if (l->face_strength[k] != 1 || l->face_energy[k] != 1) alike = PETSC_FALSE;
  if (!alike) DescribeFactors("faces", 3, l->face_strength, l->face_energy, out);
  if (l->between_strength != 1 || l->between_energy != 1)
    DescribeFactors("between_clusters", 1, &l->between_strength, &l->between_energy, out);
}

/* Cells that differ, in their order. Bonded cells have no cohesion. */
static void DescribeCells(const LamMicrostructure *micro, FILE *out)
{
  for (PetscInt c = 0; c < micro->cells[0] * micro->cells[1]; c++) {
    const LamCell *cell = &micro->cell[c];

    fprintf(out, "%s{\"wall_thickness\": %.12g, ", c ? ", " : "", Clean(cell->wall_thickness));
    DescribeWall(&cell->wall, out);
    fprintf(out, ", \"turgor\": %.12g", Clean(cell->turgor));
    if (LamCellsPart(micro->interface)) fprintf(out, ", \"cohesion\": %.12g", Clean(cell->cohesion));
    if (micro->interface == LAM_INTERFACE_LAMELLA)
      fprintf(out, ", \"lamella_strength\": %.12g, \"lamella_energy\": %.12g, \"cluster\": %d",
              Clean(cell->lamella_strength), Clean(cell->lamella_energy), (int)cell->cluster);
    fprintf(out, "}");
  }
}

static void Describe(const LamMicrostructure *micro, FILE *out)
{
  fprintf(out, "{\"wall_thickness\": %.12g, \"orientation\": %.12g, \"cells\": [%d, %d], ",
          Clean(micro->wall_thickness), Clean(micro->orientation), (int)micro->cells[0], (int)micro->cells[1]);
  if (micro->length > 0) fprintf(out, "\"length\": %.12g, ", Clean(micro->length));
  if (micro->is_patch) fprintf(out, "\"patch\": {\"sides\": \"%s\"", LamPatchSidesNames[micro->sides]);
  if (micro->is_patch && micro->notch_columns)
    fprintf(out, ", \"notch\": [%d, %d]", (int)micro->notch_row, (int)micro->notch_columns);
  if (micro->is_patch) fprintf(out, "}, ");
  if (micro->tissue) {
    fprintf(out, "\"tissue\": ");
    LamTissueDescribe(micro->tissue, out);
    fprintf(out, ", ");
  }
  fprintf(out, "\"mesh\": {\"along\": %d, \"through\": %d", (int)micro->along, (int)micro->through);
  if (micro->grading != 0) fprintf(out, ", \"grading\": %.12g", Clean(micro->grading));
  fprintf(out, "}, ");
  DescribeWall(&micro->wall, out);
  DescribeRelaxation(&micro->relaxation, out);
  fprintf(out, ", \"interface\": {\"law\": \"%s\"", LamInterfaceLawNames[micro->interface]);
  if (LamCellsPart(micro->interface)) fprintf(out, ", \"clearance\": %.12g", Clean(micro->clearance));
  if (LamCellsPart(micro->interface) && micro->sharpness == LAM_SHARPNESS_SMOOTH)
    fprintf(out, ", \"width\": %.12g", Clean(micro->contact_width));
  if (micro->interface == LAM_INTERFACE_LAMELLA) DescribeLamella(&micro->lamella, out);
  fprintf(out, "}");
  if (LamWallsTear(micro))
    fprintf(out, ", \"tearing\": {\"strength\": %.12g, \"fracture_energy\": %.12g, \"stiffness\": %.12g}",
            Clean(micro->tearing.strength), Clean(micro->tearing.energy), Clean(micro->tearing.stiffness));
  if (micro->cell) {
    fprintf(out, ", \"cell\": [");
    DescribeCells(micro, out);
    fprintf(out, "]");
  }
  fprintf(out, "}");
}

PetscErrorCode LamMicrostructureDescribe(const LamMicrostructure *micro, char **json, char hash[LAM_HASH_LENGTH])
{
  char *text = NULL;
  size_t length;
  FILE *out = open_memstream(&text, &length);
  PetscErrorCode ierr;

  PetscFunctionBeginUser;
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the description of a microstructure");
  Describe(micro, out);
  PetscCheck(!fclose(out), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the description of a microstructure");
  snprintf(hash, LAM_HASH_LENGTH, "%016llx", (unsigned long long)LamHashBytes(LAM_HASH_START, text, strlen(text)));
  ierr = PetscStrallocpy(text, json);
  free(text);
  PetscCall(ierr);
  PetscFunctionReturn(0);
}

PetscErrorCode LamMicrostructureHashTissue(const LamMicrostructure *micro, char hash[LAM_HASH_LENGTH])
{
  LamMicrostructure tissue = *micro;
  char *text;

  PetscFunctionBeginUser;
  tissue.along = tissue.through = 0;
  tissue.grading = 0;
  PetscCall(LamMicrostructureDescribe(&tissue, &text, hash));
  PetscCall(PetscFree(text));
  PetscFunctionReturn(0);
}

LamStressScale LamStressScaleOf(const LamMicrostructure *micro)
{
  const PetscInt cells = micro->cell ? micro->cells[0] * micro->cells[1] : 1;
  PetscReal plane = 0, axial = 0;

  for (PetscInt k = 0; k < cells; k++) {
    const LamWall *wall = micro->cell ? &micro->cell[k].wall : &micro->wall;
    const PetscReal t = LamWallThickness(micro, k), shear = wall->C1 + wall->C2;

    plane += t * (4 * shear + 2 * LamWallFibreModulus(wall)) / pow(1 - t, 1.2);
    axial += 8 * t * shear;
  }
  return (LamStressScale){0.01 * plane / (PetscReal)cells, 0.01 * axial / (PetscReal)cells};
}

PetscErrorCode LamMicrostructureCopy(const LamMicrostructure *micro, LamMicrostructure *copy)
{
  const PetscInt count = micro->cells[0] * micro->cells[1];

  PetscFunctionBeginUser;
  *copy = *micro;
  copy->cell = NULL;
  PetscCall(LamTissueCopy(micro->tissue, &copy->tissue));
  if (!micro->cell) PetscFunctionReturn(0);
  PetscCall(PetscMalloc1(count, &copy->cell));
  PetscCall(PetscArraycpy(copy->cell, micro->cell, count));
  PetscFunctionReturn(0);
}

PetscErrorCode LamMicrostructureDestroy(LamMicrostructure *micro)
{
  PetscFunctionBeginUser;
  PetscCall(PetscFree(micro->cell));
  PetscCall(LamTissueDestroy(&micro->tissue));
  PetscFunctionReturn(0);
}

PetscBool LamWallsTilt(const LamMicrostructure *micro)
{
  if (!micro->cell) return (PetscBool)(micro->wall.fibre_angle != 0.0);
  for (PetscInt c = 0; c < micro->cells[0] * micro->cells[1]; c++)
    if (micro->cell[c].wall.fibre_angle != 0.0) return PETSC_TRUE;
  return PETSC_FALSE;
}

static PetscBool AreEqual(PetscReal a, PetscReal b, PetscReal tolerance)
{
  return (PetscBool)(fabs(a - b) <= tolerance * fabs(b));
}

static PetscBool AreSameWalls(const LamWall *a, const LamWall *b, PetscReal tolerance)
{
  if (a->law != b->law || !AreEqual(a->bulk_modulus, b->bulk_modulus, tolerance)) return PETSC_FALSE;
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++)
    if (!AreEqual(LamWallGet(a, k), LamWallGet(b, k), tolerance)) return PETSC_FALSE;
  return (PetscBool)(!LamWallLawHasFibres(a->law) ||
                     (a->fibres == b->fibres && AreEqual(a->fibre_angle, b->fibre_angle, tolerance)));
}

PetscBool LamCellsAgree(const LamCell *a, const LamCell *b, PetscReal tolerance)
{
  return (PetscBool)(AreEqual(a->wall_thickness, b->wall_thickness, tolerance) &&
                     AreEqual(a->turgor, b->turgor, tolerance) && AreEqual(a->cohesion, b->cohesion, tolerance) &&
                     AreEqual(a->lamella_strength, b->lamella_strength, tolerance) &&
                     AreEqual(a->lamella_energy, b->lamella_energy, tolerance) && a->cluster == b->cluster &&
                     AreSameWalls(&a->wall, &b->wall, tolerance));
}

/* Index of `text` in a list of names; -1: not found. */
static int Find(int count, const char *const names[], const char text[])
{
  for (int i = 0; i < count; i++)
    if (!strcmp(names[i], text)) return i;
  return -1;
}

static PetscBool ParseWall(json_t *object, LamWall *wall)
{
  const char *law, *fibres = LamFibresNames[LAM_FIBRES_BOTH];
  int found[2];

  if (json_unpack(object, "{s:s, s?s, s?F, s:F}", "law", &law, "fibres", &fibres, "fibre_angle", &wall->fibre_angle,
                  "bulk_modulus", &wall->bulk_modulus))
    return PETSC_FALSE;
  found[0] = Find(LAM_WALL_LAW_COUNT, LamWallLawNames, law);
  found[1] = Find(LAM_FIBRES_COUNT, LamFibresNames, fibres);
  if (found[0] < 0 || found[1] < 0) return PETSC_FALSE;
  wall->law = (LamWallLawType)found[0];
  wall->fibres = (LamFibres)found[1];
  for (PetscInt k = 0; k < LAM_WALL_PARAMETER_COUNT; k++) {
    if (!LamWallLawHas(wall->law, k)) continue;
    if (json_unpack(object, LamWallParameterIsOptional(k) ? "{s?F}" : "{s:F}", LamWallParameterNames[k],
                    LamWallAt(wall, k)))
      return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

static PetscBool ParseCell(json_t *object, LamCell *cell)
{
  json_t *wall;
  int cluster = 0;

  *cell = (LamCell){.cohesion = 1.0, .lamella_strength = 1.0, .lamella_energy = 1.0};
  if (json_unpack(object, "{s:F, s:o, s:F, s?F, s?F, s?F, s?i}", "wall_thickness", &cell->wall_thickness, "wall", &wall,
                  "turgor", &cell->turgor, "cohesion", &cell->cohesion, "lamella_strength", &cell->lamella_strength,
                  "lamella_energy", &cell->lamella_energy, "cluster", &cluster))
    return PETSC_FALSE;
  cell->cluster = cluster;
  return ParseWall(wall, &cell->wall);
}

/* Allocates m->cell. */
static PetscBool ParseCells(json_t *array, LamMicrostructure *m)
{
  const size_t count = json_array_size(array);

  if ((size_t)m->cells[0] * (size_t)m->cells[1] != count || PetscMalloc1(count, &m->cell)) return PETSC_FALSE;
  for (size_t c = 0; c < count; c++)
    if (!ParseCell(json_array_get(array, c), &m->cell[c])) return PETSC_FALSE;
  return PETSC_TRUE;
}

static PetscBool ParsePatch(json_t *object, LamMicrostructure *m)
{
  const char *sides;
  int found, row = 0, columns = 0;

  if (json_unpack(object, "{s:s, s?[i, i]}", "sides", &sides, "notch", &row, &columns)) return PETSC_FALSE;
  m->notch_row = row;
  m->notch_columns = columns;
  found = Find(LAM_PATCH_SIDES_COUNT, LamPatchSidesNames, sides);
  m->is_patch = PETSC_TRUE;
  m->sides = (LamPatchSides)found;
  return (PetscBool)(found >= 0);
}

static PetscBool ParseLamella(json_t *object, LamLamella *l)
{
  const char *softening;
  int found;

  *l = LAM_LAMELLA_UNIFORM;
  if (json_unpack(object, "{s:s, s:F, s:F, s:F, s:F}", "softening", &softening, "stiffness", &l->stiffness, "strength",
                  &l->strength, "fracture_energy", &l->energy, "shear_strength", &l->shear_strength))
    return PETSC_FALSE;
  l->shear_energy = l->energy;
  if (json_unpack(object, "{s?F, s?F, s?F, s?{s:[F], s:[F]}, s?{s:[F,F,F], s:[F,F,F]}, s?{s:[F], s:[F]}}",
                  "shear_energy", &l->shear_energy, "mixing", &l->mixing, "junction_length", &l->junction_length,
                  "junction", "strength", &l->junction_strength, "fracture_energy", &l->junction_energy, "faces",
                  "strength", &l->face_strength[0], &l->face_strength[1], &l->face_strength[2], "fracture_energy",
                  &l->face_energy[0], &l->face_energy[1], &l->face_energy[2], "between_clusters", "strength",
                  &l->between_strength, "fracture_energy", &l->between_energy))
    return PETSC_FALSE;
  found = Find(LAM_SOFTENING_COUNT, LamSofteningNames, softening);
  l->softening = (LamSoftening)found;
  return (PetscBool)(found >= 0);
}

static PetscBool ParseInterface(json_t *object, LamMicrostructure *m)
{
  const char *law;
  int found;

  if (json_unpack(object, "{s:s, s?F, s?F}", "law", &law, "clearance", &m->clearance, "width", &m->contact_width))
    return PETSC_FALSE;
  found = Find(LAM_INTERFACE_LAW_COUNT, LamInterfaceLawNames, law);
  m->interface = (LamInterfaceLawType)found;
  m->sharpness = m->contact_width > 0 ? LAM_SHARPNESS_SMOOTH : LAM_SHARPNESS_EXACT;
  if (m->interface == LAM_INTERFACE_LAMELLA) return ParseLamella(object, &m->lamella);
  return (PetscBool)(found >= 0);
}

static PetscBool ParseRelaxation(json_t *array, LamRelaxation *relaxation)
{
  const size_t terms = json_array_size(array);

  if (terms < 1 || terms > LAM_RELAXATION_TERMS) return PETSC_FALSE;
  for (size_t i = 0; i < terms; i++)
    if (json_unpack(json_array_get(array, i), "[F,F]", &relaxation->share[i], &relaxation->time[i])) return PETSC_FALSE;
  relaxation->terms = (PetscInt)terms;
  return PETSC_TRUE;
}

static PetscBool ParseObject(json_t *root, LamMicrostructure *m)
{
  json_t *wall, *interface, *patch = NULL, *tissue = NULL, *cells_that_differ = NULL, *relaxation = NULL;
  int cells[2], along, through;

  if (json_unpack(root, "{s:F, s:F, s?F, s:[i,i], s?o, s?o, s:{s:i, s:i, s?F}, s:o, s:o, s?o, s?o, s?{s:F, s:F, s:F}}",
                  "wall_thickness", &m->wall_thickness, "orientation", &m->orientation, "length", &m->length, "cells",
                  &cells[0], &cells[1], "patch", &patch, "tissue", &tissue, "mesh", "along", &along, "through",
                  &through, "grading", &m->grading, "wall", &wall, "interface", &interface, "relaxation", &relaxation,
                  "cell", &cells_that_differ, "tearing", "strength", &m->tearing.strength, "fracture_energy",
                  &m->tearing.energy, "stiffness", &m->tearing.stiffness))
    return PETSC_FALSE;
  if (cells[0] < 1 || cells[1] < 1) return PETSC_FALSE;
  for (int i = 0; i < 2; i++) m->cells[i] = cells[i];
  if (tissue && (!LamTissueParse(tissue, &m->tissue) || m->tissue->cells != cells[0] || cells[1] != 1))
    return PETSC_FALSE;
  m->along = along;
  m->through = through;
  return (PetscBool)(ParseWall(wall, &m->wall) && ParseInterface(interface, m) && (!patch || ParsePatch(patch, m)) &&
                     (!relaxation || ParseRelaxation(relaxation, &m->relaxation)) &&
                     (!cells_that_differ || ParseCells(cells_that_differ, m)));
}

PetscErrorCode LamMicrostructureParse(const char path[], const char json[], LamMicrostructure *micro)
{
  json_t *root = json_loads(json, 0, NULL);
  PetscBool good;

  PetscFunctionBeginUser;
  memset(micro, 0, sizeof(*micro));
  good = (PetscBool)(root && ParseObject(root, micro));
  json_decref(root);
  if (!good) PetscCall(LamMicrostructureDestroy(micro));
  PetscCheck(good, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the description of the microstructure is damaged: %.1000s", path, json);
  PetscFunctionReturn(0);
}
