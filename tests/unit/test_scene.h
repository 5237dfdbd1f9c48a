/* For tests of scene reading: the usual tissue as text, and scenes of texts. */
#ifndef LAM_TEST_SCENE_H
#define LAM_TEST_SCENE_H

#include <lamella/scene.h>

#define CELL "version: 1\nrve:\n  cell: {apothem: 75 um, wall_thickness: 11.25 um}\n"
#define WALL "  wall: {law: fibre_mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa, C4: 1 MPa}\n"
#define RVE CELL WALL

static inline void LeaveScene(LamScene **scene)
{
  assert_int_equal(LamSceneDestroy(scene), 0);
}
#define OwnedScene LamScene __attribute__((cleanup(LeaveScene))) /* destroyed where its block ends */

static inline LamScene *Read(const char text[])
{
  LamScene *scene = NULL;

  assert_int_equal(LamSceneReadText("scene.yaml", text, &scene), 0);
  return scene;
}

#endif
