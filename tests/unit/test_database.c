/* What a database keeps of its records: compact nodes, whole responses of the others and of those requested. */
#include "record_fixture.h"
#include "database_internal.h"

/* ---- nodes ---- */

static LamRecordLayout Packed(const LamResponse *response, PetscInt64 key, unsigned char **bytes)
{
  LamRecordLayout layout;
  hid_t type;

  assert_int_equal(LamRecordTypeCreate(&type), 0);
  assert_int_equal(LamRecordsPack(1, &key, response, type, (void **)bytes), 0);
  assert_int_equal(LamRecordLayoutMake(type, &layout), 0);
  H5Tclose(type);
  return layout;
}

TEST(a_node_from_bytes_is_the_node_from_the_response)
{
  LamResponse response = Response(3);
  LamNodeData wanted = {0}, node = {0};
  LamNodeLayout layout;
  unsigned char *bytes;
  LamRecordLayout records;

  response.branch = 2;
  response.floating_cells = 4;
  response.cell_clusters = 5;
  records = Packed(&response, LAM_NODE_KEY + 17, &bytes);
  LamNodeLayoutMake(records.key, records.member, &layout);
  LamNodeDataFromBytes(&layout, bytes, &node);
  LamNodeDataFromResponse(&response, LAM_NODE_KEY + 17, &wanted);
  assert_memory_equal(&node, &wanted, sizeof(node));
  assert_int_equal(wanted.branch, 2);
  PetscFree(bytes);
}

TEST(a_node_holds_the_in_plane_parts_and_33)
{
  const LamResponse r = Response(3);
  LamNodeData node;

  LamNodeDataFromResponse(&r, LAM_NODE_KEY, &node);
  for (int i = 0; i < 2; i++)
    for (int j = 0; j < 2; j++) {
      assert_true(node.F[2 * i + j] == r.load.F[3 * i + j]);
      assert_true(node.P[2 * i + j] == r.P[3 * i + j]);
      assert_true(node.P_turgor[2 * i + j] == r.P_turgor[3 * i + j]);
      assert_true(node.P_cohesion[2 * i + j] == r.P_cohesion[3 * i + j]);
      assert_true(node.P33_F[2 * i + j] == r.tangent[72 + 3 * i + j]);
      for (int k = 0; k < 2; k++)
        for (int l = 0; l < 2; l++) {
          const PetscReal wanted = r.tangent[27 * i + 9 * j + 3 * k + l], got = node.tangent[8 * i + 4 * j + 2 * k + l];

          assert_true(got == wanted || (isnan(got) && isnan(wanted)));
        }
    }
  assert_true(node.P33 == r.P[8] && node.P33_F33 == r.tangent[80]);
  assert_true(node.P33_turgor == r.P_turgor[8] && node.P33_cohesion == r.P_cohesion[8]);
  assert_true(node.energy_turgor_cohesion == r.energy_turgor_cohesion && node.turgor == r.load.turgor);
}

/* From lumen_fraction to kinked_fraction, so that the block may be gone through with the table of members. */
TEST(indicators_are_in_the_order_of_the_members)
{
  const LamResponse r = Response(3);
  const LamMember *m = LamResponseMembers;
  const float *got;
  LamNodeData node;

  LamNodeDataFromResponse(&r, LAM_NODE_KEY, &node);
  got = &node.lumen_fraction;
  while (m->offset != offsetof(LamResponse, lumen_fraction)) m++;
  for (; m->offset != offsetof(LamResponse, lowest_eigenvalue); m++)
    for (PetscInt i = 0; i < m->count; i++)
      if (*got++ != (float)((const PetscReal *)((const char *)&r + m->offset))[i]) fail_msg("%s differs", m->name);
  assert_ptr_equal(got, &node.lumen_fraction + LAM_NODE_FLOATS);
}

TEST(what_the_bytes_lack_is_not_known)
{
  const LamResponse response = Response(3);
  LamNodeLayout layout;
  unsigned char *bytes;
  LamRecordLayout records = Packed(&response, LAM_NODE_KEY, &bytes);
  LamNodeData node;

  for (PetscInt k = 0; LamResponseMembers[k].name; k++)
    if (!strcmp(LamResponseMembers[k].name, "min_gap") || !strcmp(LamResponseMembers[k].name, "zero_modes") ||
        !strcmp(LamResponseMembers[k].name, "energy_turgor"))
      records.member[k] = LAM_NOT_IN_FILE;
  LamNodeLayoutMake(records.key, records.member, &layout);
  LamNodeDataFromBytes(&layout, bytes, &node);
  assert_true(isnan(node.min_gap));
  assert_int_equal(node.zero_modes, LAM_UNKNOWN_COUNT);
  assert_true(node.energy_turgor == -response.lumen_fraction);
  assert_true(node.max_gap == (float)response.max_gap);
  PetscFree(bytes);
}

/* ---- the database ---- */

/* A file of 700 nodes, 3 states of no grid, 5 nodes. */
static LamDatabase OpenMixed(void)
{
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);
  LamDatabase db;

  WriteGrid(writer);
  Commit(writer, LAM_NODE_KEY, 700);
  Commit(writer, LAM_CACHE_KEY, 3);
  Commit(writer, LAM_NODE_KEY + 700, 5);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(LamDatabaseOpen(path, &db), 0);
  return db;
}

FILE_TEST(nodes_and_other_records_are_kept_apart)
{
  OWNED(LamDatabase, LamDatabaseClose) db = OpenMixed();
  const PetscInt64 *keys;
  PetscInt n;

  assert_int_equal(LamDatabaseGetRecords(db, &n, NULL, &keys), 0);
  assert_int_equal(n, 708);
  assert_true(keys[701] == LAM_CACHE_KEY + 1 && keys[707] == LAM_NODE_KEY + 704);
  assert_int_equal(db->nodes.count, 705);
  assert_int_equal(db->scatter.n, 3);
  for (PetscInt i = 0; i < 705; i++) {
    const LamResponse wanted = Response(i);

    assert_true(db->nodes.data[i].key == LAM_NODE_KEY + i && db->nodes.data[i].energy == wanted.energy);
  }
  assert_null(db->records);
}

FILE_TEST(whole_responses_come_in_the_order_of_the_file_and_then_of_memory)
{
  const LamResponse added[2] = {Response(11), Response(12)}, *records;
  const PetscInt64 more[2] = {LAM_NODE_KEY + 1000, LAM_NODE_KEY + 1001}, *keys;
  OWNED(LamDatabase, LamDatabaseClose) db = OpenMixed();
  PetscInt n;

  assert_int_equal(LamDatabaseAdd(db, 2, more, added), 0);
  assert_int_equal(LamDatabaseGetRecords(db, &n, &records, &keys), 0);
  assert_int_equal(LamDatabaseAdd(db, 2, NULL, added), 0); /* behind what has been loaded */
  assert_int_equal(LamDatabaseGetRecords(db, &n, &records, &keys), 0);
  assert_int_equal(n, 712);
  for (PetscInt i = 0; i < n; i++) {
    const LamResponse wanted = i < 708 ? Response((PetscInt)keys[i]) : added[i % 2];

    AssertSame(&records[i], &wanted);
  }
  assert_int_equal(db->nodes.count, 707);
  assert_int_equal(db->scatter.n, 5);
}

FILE_TEST(added_records_are_given_without_the_file)
{
  const LamResponse added[2] = {Response(11), Response(12)}, *records;
  OWNED(LamDatabase, LamDatabaseClose) db = OpenMixed();
  PetscInt n;

  assert_int_equal(LamDatabaseAdd(db, 2, NULL, added), 0);
  unlink(path);
  assert_int_equal(LamDatabaseGetAdded(db, 709, &n, &records), 0);
  assert_int_equal(n, 1);
  AssertSame(records, &added[1]);
}

FILE_TEST(a_file_that_was_replaced_is_noticed)
{
  const LamResponse *records;
  OWNED(LamDatabase, LamDatabaseClose) db = OpenMixed();
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);

  Commit(writer, LAM_NODE_KEY + 1, 800);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(LamDatabaseGetRecords(db, NULL, &records, NULL), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(ErrorMessage, "was replaced"));
}

/* The same keys, but of another tissue. */
FILE_TEST(a_file_of_another_tissue_is_noticed)
{
  const LamResponse *records, one = Response(0);
  const PetscInt64 key = LAM_NODE_KEY;
  LamScene scene = Scene();
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);
  OWNED(LamDatabase, LamDatabaseClose) db;

  WriteGrid(writer);
  Commit(writer, LAM_NODE_KEY, 1);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(LamDatabaseOpen(path, &db), 0);
  scene.micro.wall_thickness = 0.2;
  assert_int_equal(LamRecordWriterOpen(path, "database", LAM_WRITE_CREATE, &scene, &writer), 0);
  assert_int_equal(LamRecordWriterCommit(writer, 1, &key, &one), 0);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(LamDatabaseGetRecords(db, NULL, &records, NULL), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(ErrorMessage, "was replaced"));
}

FILE_TEST(a_file_that_has_shrunk_is_noticed)
{
  const LamResponse *records;
  OWNED(LamDatabase, LamDatabaseClose) db = OpenMixed();
  LamRecordWriter writer = Open(LAM_WRITE_CREATE);

  Commit(writer, LAM_NODE_KEY, 600);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  assert_int_equal(LamDatabaseGetRecords(db, NULL, &records, NULL), PETSC_ERR_USER_INPUT);
  assert_non_null(strstr(ErrorMessage, "was replaced"));
}

FILE_TEST(info_counts_nodes_too)
{
  OWNED(LamDatabase, LamDatabaseClose) db = OpenMixed();
  const char *json;

  assert_int_equal(LamDatabaseGetInfo(db, &json), 0);
  assert_non_null(strstr(json, "\"records\":708,\"failed\":589")); /* one in six has converged: 118 nodes, one other */
}
