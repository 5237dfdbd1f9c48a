/*
  The type of a record in the file, generated from the table of response members.
*/
#include "record_internal.h"
#include <string.h>

static const char *const bool_names[] = {"FALSE", "TRUE", NULL}; /* h5py's names */

static PetscErrorCode EnumType(const char *const names[], hid_t *type)
{
  PetscFunctionBeginUser;
  LamCallHDF5("enumeration", PETSC_ERR_LIB, *type = H5Tenum_create(H5T_STD_I8LE));
  for (signed char value = 0; names[value]; value++)
    LamCallHDF5(names[value], PETSC_ERR_LIB, H5Tenum_insert(*type, names[value], &value));
  PetscFunctionReturn(0);
}

/* 3 reals are a vector, 9 a second-order tensor, 81 a fourth-order tensor. */
static PetscErrorCode RealType(PetscInt count, hid_t *type)
{
  const hsize_t dims[4] = {3, 3, 3, 3};
  unsigned rank = 0;

  PetscFunctionBeginUser;
  for (PetscInt c = count; c > 1; c /= 3) rank++;
  if (rank)
    LamCallHDF5("array type", PETSC_ERR_LIB, *type = H5Tarray_create2(H5T_IEEE_F64LE, rank, dims));
  else
    LamCallHDF5("real type", PETSC_ERR_LIB, *type = H5Tcopy(H5T_IEEE_F64LE));
  PetscFunctionReturn(0);
}

static PetscErrorCode MemberType(const LamMember *m, hid_t *type)
{
  PetscFunctionBeginUser;
  switch (m->type) {
  case LAM_MEMBER_REAL:
    PetscCall(RealType(m->count, type));
    break;
  case LAM_MEMBER_BOOL:
    PetscCall(EnumType(bool_names, type));
    break;
  case LAM_MEMBER_ENUM:
    PetscCall(EnumType(m->names, type));
    break;
  case LAM_MEMBER_INT:
    LamCallHDF5(m->name, PETSC_ERR_LIB, *type = H5Tcopy(H5T_STD_I64LE));
    break;
  case LAM_MEMBER_TEXT:
    LamCallHDF5(m->name, PETSC_ERR_LIB, *type = H5Tcopy(H5T_C_S1));
    LamCallHDF5(m->name, PETSC_ERR_LIB, H5Tset_size(*type, (size_t)m->count));
    break;
  }
  PetscFunctionReturn(0);
}

/* Appends a member. Closes `type`. */
static PetscErrorCode Insert(hid_t compound, const char name[], hid_t type, size_t *end)
{
  PetscFunctionBeginUser;
  LamCallHDF5(name, PETSC_ERR_LIB, H5Tinsert(compound, name, *end, type));
  *end += H5Tget_size(type);
  LamCallHDF5(name, PETSC_ERR_LIB, H5Tclose(type));
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordTypeCreate(hid_t *type)
{
  const size_t most = 2 * sizeof(LamResponse); /* space for members that are wider in the file; truncated below */
  const char *const numbers[] = {"key", "microstructure"};
  size_t end = 0;
  hid_t member;

  PetscFunctionBeginUser;
  LamCallHDF5("record type", PETSC_ERR_LIB, *type = H5Tcreate(H5T_COMPOUND, most));
  for (int i = 0; i < 2; i++) {
    LamCallHDF5(numbers[i], PETSC_ERR_LIB, member = H5Tcopy(H5T_STD_I64LE));
    PetscCall(Insert(*type, numbers[i], member, &end));
  }
  for (const LamMember *m = LamResponseMembers; m->name; m++) {
    PetscCall(MemberType(m, &member));
    PetscCall(Insert(*type, m->name, member, &end));
  }
  LamCallHDF5("record type", PETSC_ERR_LIB, member = H5Tcopy(H5T_STD_U32LE));
  PetscCall(Insert(*type, "checksum", member, &end));
  LamCallHDF5("record type", PETSC_ERR_LIB, H5Tset_size(*type, end));
  PetscFunctionReturn(0);
}

/*
  Members that were added to format version 1 later: if one is missing it is unknown (NaN, for a count
  LAM_UNKNOWN_COUNT). Bonded tissue has no gaps, so such files are complete. Cells did not differ then, so that
  dPsi/dp and dPsi/dg are the fractions.
*/
static const char added_members[] =
    " opening_by_face open_by_face debonded_spread open_spread mean_gap max_penetration "
    "fabric zero_modes cell_clusters percolating_directions energy_turgor energy_cohesion "
    "gap_place opening_moment normal_place shear_place max_lamella_shear max_fibre_stretch "
    "max_wall_energy max_wall_tension wall_place mean_wall_tension min_gap "
    "indicators_trusted turgor_mean turgor_spread wall_ellipticity kink_place "
    "kinked_fraction ellipticity localisation_normal localisation_mode tangent_error_estimate ";

static PetscBool WasAdded(const char name[])
{
  char word[LAM_NAME_LENGTH + 2];

  snprintf(word, sizeof(word), " %s ", name);
  return (PetscBool)(strstr(added_members, word) != NULL);
}

/* Members are contiguous, in their order, with the checksum last. */
static PetscErrorCode CheckPacked(const char path[], hid_t file_type)
{
  const int members = H5Tget_nmembers(file_type), last = H5Tget_member_index(file_type, "checksum");
  size_t end = 0;

  PetscFunctionBeginUser;
  for (int i = 0; i < members; i++) {
    const hid_t member = H5Tget_member_type(file_type, (unsigned)i);
    const PetscBool follows = (PetscBool)(H5Tget_member_offset(file_type, (unsigned)i) == end);

    end += H5Tget_size(member);
    H5Tclose(member);
    PetscCheck(follows, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
               "%s: member %d of /records does not lie behind the one before it" LAM_FOREIGN, path, i);
  }
  PetscCheck(end == H5Tget_size(file_type) && end <= LAM_MAX_RECORD_BYTES, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: a record of /records has %zu bytes, its members %zu; the file is damaged", path,
             H5Tget_size(file_type), end);
  PetscCheck(last == members - 1, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the checksum is not the last member of /records", path);
  PetscFunctionReturn(0);
}

/* Compares member i of our type; *problem: the difference in the file's type, NULL: none. */
static PetscErrorCode CompareMember(const char path[], hid_t ours, int i, hid_t file_type, char name[LAM_NAME_LENGTH],
                                    const char **problem)
{
  char *own_name = H5Tget_member_name(ours, (unsigned)i);
  const int at = H5Tget_member_index(file_type, own_name);
  hid_t wanted, found;

  PetscFunctionBeginUser;
  snprintf(name, LAM_NAME_LENGTH, "%s", own_name);
  H5free_memory(own_name);
  *problem = at >= 0 || WasAdded(name) ? NULL : "missing";
  if (at < 0) PetscFunctionReturn(0);
  LamCallHDF5(path, PETSC_ERR_USER_INPUT, found = H5Tget_member_type(file_type, (unsigned)at));
  wanted = H5Tget_member_type(ours, (unsigned)i);
  if (H5Tequal(wanted, found) <= 0) *problem = "of another type than lamella writes";
  H5Tclose(wanted);
  H5Tclose(found);
  PetscFunctionReturn(0);
}

PetscErrorCode LamRecordTypeCheck(const char path[], hid_t file_type)
{
  char name[LAM_NAME_LENGTH] = "";
  const char *problem = NULL;
  PetscErrorCode ierr = 0;
  PetscBool same;
  hid_t ours;

  PetscFunctionBeginUser;
  PetscCheck(H5Tget_class(file_type) == H5T_COMPOUND, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: /records is not a table of records; the file is damaged or no Lamella file", path);
  PetscCall(LamRecordTypeCreate(&ours));
  same = (PetscBool)(H5Tequal(ours, file_type) > 0); /* same version: names, offsets and types agree */
  for (int i = 0; !same && i < H5Tget_nmembers(ours) && !problem && !ierr; i++)
    ierr = CompareMember(path, ours, i, file_type, name, &problem);
  H5Tclose(ours);
  PetscCall(ierr);
  PetscCheck(!problem, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: member \"%s\" of /records is %s" LAM_FOREIGN, path, name, problem);
  if (!same) PetscCall(CheckPacked(path, file_type));
  PetscFunctionReturn(0);
}
