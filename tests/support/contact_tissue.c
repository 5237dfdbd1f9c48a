#include "contact_tissue.h"

LamMicrostructure ContactTissue(PetscInt along, PetscInt through)
{
  LamMicrostructure micro = DefaultTissue();

  micro.interface = LAM_INTERFACE_CONTACT;
  micro.along = along;
  micro.through = through;
  return micro;
}

LamLoad ContactLoad(double F11, double F12, double F21, double F22, double turgor, double cohesion)
{
  LamLoad load = PlaneLoad(F11, F12, F21, F22, turgor / TISSUE_STRESS);

  load.cohesion = cohesion / TISSUE_STRESS;
  return load;
}

void ListContactStates(ContactState list[CONTACT_STATES])
{
  static const char *const names[CONTACT_STATES] = {"pressurised",       "with cohesion", "partly open",
                                                    "turned, F33 not 1", "2 x 1 cells",   "with clearance"};

  for (int k = 0; k < CONTACT_STATES; k++) {
    list[k].name = names[k];
    list[k].micro = ContactTissue(6, 2);
    list[k].step = CONTACT_STEP;
  }
  list[0].load = ContactLoad(1, 0.15, 0, 1, 0.03, 0.0002);
  list[1].load = ContactLoad(1, 0.2, 0, 1, 0.02, 0.005);
  list[2].load = ContactLoad(1.06, 0.05, 0, 1.01, 0.01, 0.005);
  list[3].load = ContactLoad(1.02, 0.08, -0.03, 0.99, 0.03, 0.002);
  list[3].load.F[8] = 1.03;
  list[3].micro.orientation = 0.3;
  list[3].micro.wall_thickness = 0.2;
  list[4].load = ContactLoad(1.01, -0.08, 0.05, 1, 0.02, 0.001);
  list[4].micro.cells[0] = 2;
  list[5].load = ContactLoad(1.02, 0.1, 0, 1, 0.02, 0.002);
  list[5].micro.clearance = 0.01;
}

ContactState RandomState(int number)
{
  ContactState s = {.name = "bonded, random", .micro = DefaultTissue(), .load = PlaneLoad(1, 0, 0, 1, 0), .step = 1e-3};
  uint64_t seed = (uint64_t)(100 + number);

  s.micro.wall_thickness = RandomReal(&seed, 0.06, 0.25);
  s.micro.orientation = RandomReal(&seed, 0.0, 1.0);
  s.micro.grading = 0.7 * s.micro.orientation; /* any */
  s.load.F[0] += RandomReal(&seed, 0.0, 0.12);
  s.load.F[1] += RandomReal(&seed, -0.12, 0.12);
  s.load.F[3] += RandomReal(&seed, -0.12, 0.12);
  s.load.F[4] += RandomReal(&seed, 0.0, 0.12);
  s.load.F[8] += RandomReal(&seed, -0.02, 0.04);
  s.load.turgor = RandomReal(&seed, 0.1, 0.4);
  return s;
}

/* Number of hats whose contact or merging differs between the last solve and the centre's; only the exact law has any.
 */
static int ContactChanges(LamRVE rve, const PetscBool active[], const LamContactFace faces[])
{
  const LamContact *contact = rve->contact;
  int changes = 0;

  if (!LamIsExact(rve)) return 0;
  for (PetscInt h = 0; h < contact->count; h++) changes += contact->active[h] != active[h];
  for (PetscInt f = 0; f < contact->face_count; f++)
    changes += contact->faces[f].first != faces[f].first || contact->faces[f].last != faces[f].last;
  return changes;
}

static PetscErrorCode ContactSweepColumn(ContactCentre *at, int column, double size, ContactSweep *sweep)
{
  static const double step[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};

  PetscFunctionBeginUser;
  for (int k = 0; k < 4; k++) {
    const double w = weight[k] / (12.0 * size);
    LamLoad load = sweep->response.load;
    LamResponse moved;

    if (column == CONTACT_TURGOR)
      load.turgor += step[k] * size;
    else if (column == CONTACT_COHESION)
      load.cohesion += step[k] * size;
    else
      load.F[contact_components[column]] += step[k] * size;
    PetscCall(LamRVEStateCopy(at->centre, at->state));
    PetscCall(LamRVESolve(at->rve, &load, at->state, &moved));
    sweep->switches += moved.status != LAM_CONVERGED ||
                       (at->rve->contact && moved.contact_width != sweep->response.contact_width) ||
                       ContactChanges(at->rve, at->active, at->faces) > 0;
    sweep->energy[column] += w * moved.energy;
    sweep->by_turgor[column] += w * moved.energy_turgor;
    sweep->by_cohesion[column] += w * moved.energy_cohesion;
    for (int i = 0; i < 9; i++) sweep->P[column][i] += w * moved.P[i];
  }
  PetscFunctionReturn(0);
}

PetscErrorCode SweepColumns(ContactCentre *at, double step, ContactSweep *sweep)
{
  const LamContact *contact = at->rve->contact;

  PetscFunctionBeginUser;
  PetscCall(PetscMalloc2(contact ? contact->count : 0, &at->active, contact ? contact->face_count : 0, &at->faces));
  if (contact) {
    PetscCall(PetscArraycpy(at->active, contact->active, contact->count));
    PetscCall(PetscArraycpy(at->faces, contact->faces, contact->face_count));
  }
  for (int c = 0; c < (contact ? CONTACT_COLUMNS : CONTACT_COHESION); c++)
    PetscCall(ContactSweepColumn(at, c, step, sweep));
  PetscCall(PetscFree2(at->active, at->faces));
  PetscFunctionReturn(0);
}

PetscErrorCode SweepContact(const ContactState *point, ContactSweep *sweep)
{
  ContactCentre at;

  PetscFunctionBeginUser;
  PetscCall(PetscMemzero(sweep, sizeof(*sweep)));
  PetscCall(NewTissue(&point->micro, &at.rve, &at.centre));
  PetscCall(LamRVEStateCreate(at.rve, &at.state));
  PetscCall(LamRVESolve(at.rve, &point->load, at.centre, &sweep->response));
  PetscCall(SweepColumns(&at, point->step, sweep));
  PetscCall(LamRVEStateDestroy(&at.state));
  PetscCall(DestroyTissue(&at.rve, &at.centre));
  PetscFunctionReturn(0);
}

double TangentScale(const LamResponse *r)
{
  double largest = 0.0;

  for (int k = 0; k < 5; k++) largest = PetscMax(largest, PetscAbsReal(r->tangent[10 * contact_components[k]]));
  return largest;
}

ContactDerivativeError DerivativeError(const ContactSweep *s)
{
  const LamResponse *r = &s->response;
  const double scale = TangentScale(r);
  ContactDerivativeError e = {0};

  e.turgor = PetscAbsReal(r->energy_turgor - s->energy[CONTACT_TURGOR]);
  e.cohesion = PetscAbsReal(r->energy_cohesion - s->energy[CONTACT_COHESION]);
  e.lumen = PetscAbsReal(r->lumen_fraction + s->energy[CONTACT_TURGOR]);
  e.opening = PetscAbsReal(r->opening_fraction - s->energy[CONTACT_COHESION]);
  for (int i = 0; i < 5; i++) {
    const int a = contact_components[i];

    e.stress = PetscMax(e.stress, PetscAbsReal(r->P[a] - s->energy[i]));
    e.turgor_coupling = PetscMax(e.turgor_coupling, PetscAbsReal(r->P_turgor[a] - s->P[CONTACT_TURGOR][a]));
    e.turgor_coupling = PetscMax(e.turgor_coupling, PetscAbsReal(r->P_turgor[a] - s->by_turgor[i]));
    e.cohesion_coupling = PetscMax(e.cohesion_coupling, PetscAbsReal(r->P_cohesion[a] - s->P[CONTACT_COHESION][a]));
    e.cohesion_coupling = PetscMax(e.cohesion_coupling, PetscAbsReal(r->P_cohesion[a] - s->by_cohesion[i]));
    for (int k = 0; k < 5; k++) {
      const int b = contact_components[k];

      e.tangent = PetscMax(e.tangent, PetscAbsReal(r->tangent[9 * a + b] - s->P[k][a]) / scale);
      e.symmetry = PetscMax(e.symmetry, PetscAbsReal(s->P[k][a] - s->P[i][b]) / scale);
    }
  }
  e.volumes = PetscAbsReal(r->energy_turgor2 - s->by_turgor[CONTACT_TURGOR]);
  e.volumes = PetscMax(e.volumes, PetscAbsReal(r->energy_cohesion2 - s->by_cohesion[CONTACT_COHESION]));
  e.volumes = PetscMax(e.volumes, PetscAbsReal(r->energy_turgor_cohesion - s->by_turgor[CONTACT_COHESION]));
  e.volumes = PetscMax(e.volumes, PetscAbsReal(r->energy_turgor_cohesion - s->by_cohesion[CONTACT_TURGOR]));
  return e;
}
