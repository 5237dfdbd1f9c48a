/* Colours, views, outlines and painted fields of the pictures. */
#include "support/test.h"
#include <stdio.h>
#include <unistd.h>
#include <stdlib.h>
#include "plot.h"

/* A square ring, outer edge 4, inner edge 2, of four trapezia round the origin. */
#define RING_ELEMENTS 4
#define RING_NODES 24
static PetscReal RingX[RING_NODES][2];
static PetscInt Ring[RING_ELEMENTS][9];

static int make_ring(void **state)
{
  for (PetscInt i = 0; i < 8; i++) {
    static const PetscReal corner[8][2] = {{1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}};

    for (PetscInt layer = 0; layer < 3; layer++)
      for (int k = 0; k < 2; k++) RingX[8 * layer + i][k] = corner[i][k] * (1 + 0.5 * layer);
  }
  for (PetscInt e = 0; e < RING_ELEMENTS; e++) {
    const PetscInt a = 2 * e, m = 2 * e + 1, b = (2 * e + 2) % 8;
    const PetscInt nodes[9] = {a, 16 + a, 16 + b, b, 8 + a, 16 + m, 8 + b, m, 8 + m};

    for (int i = 0; i < 9; i++) Ring[e][i] = nodes[i];
  }
  return 0;
}

TEST(brightness_grows_along_the_colour_map)
{
  PetscReal last = 0;

  for (int i = 0; i <= 50; i++) {
    const LamColour c = LamColourMap(i / 50.0);
    const PetscReal luminance = 0.2126 * pow(c.r, 2.2) + 0.7152 * pow(c.g, 2.2) + 0.0722 * pow(c.b, 2.2);

    assert_true(luminance > last);
    last = luminance;
  }
}

TEST(colours_beyond_the_ends_are_those_of_the_ends)
{
  const LamColour end = LamColourMap(1), beyond = LamColourMap(7);

  assert_true(end.r == beyond.r && end.g == beyond.g && end.b == beyond.b);
}

TEST(a_stress_peak_does_not_stretch_the_colour_scale)
{
  PetscReal values[500];
  LamColourRange range;

  for (int i = 0; i < 500; i++) values[i] = i / 500.0;
  values[250] = 1e6;
  assert_int_equal(LamColourRangeFind(500, values, &range), 0);
  assert_true(range.high < 1 && range.clipped[1] && !range.clipped[0]);
}

TEST(a_smooth_field_uses_all_of_the_colour_scale)
{
  PetscReal values[500];
  LamColourRange range;

  for (int i = 0; i < 500; i++) values[i] = i;
  assert_int_equal(LamColourRangeFind(500, values, &range), 0);
  assert_true(range.low == 0 && range.high == 499 && !range.clipped[0] && !range.clipped[1]);
}

TEST(a_constant_field_has_a_colour_scale)
{
  const PetscReal values[3] = {0.7, 0.7, 0.7};
  LamColourRange range;

  assert_int_equal(LamColourRangeFind(3, values, &range), 0);
  assert_true(range.low < 0.7 && range.high > 0.7);
}

TEST(a_view_shows_its_box_in_the_middle)
{
  const LamRect frame = {10, 20, 200, 100};
  const PetscReal box[4] = {-1, -1, 1, 1};
  LamView view;
  double point[2];

  LamViewFit(frame, box, &view);
  LamViewPoint(&view, 0, 1, point);
  assert_true(fabs(point[0] - 110) < 1e-9 && fabs(point[1] - 20) < 1e-9);
}

TEST(a_ring_has_an_outer_loop_and_a_lumen)
{
  OWNED(LamOutline, LamOutlineDestroy) outline;
  PetscReal areas[2];

  assert_int_equal(LamOutlineCreate(RING_ELEMENTS, &Ring[0][0], NULL, &outline), 0);
  assert_int_equal(outline.loop_count, 2);
  for (int k = 0; k < 2; k++) areas[k] = LamOutlineLoopArea(&outline, k, &RingX[0][0]);
  assert_true(fabs(fmin(areas[0], areas[1]) + 4) < 1e-12 && fabs(fmax(areas[0], areas[1]) - 16) < 1e-12);
}

TEST(each_group_has_an_outline_of_its_own)
{
  const PetscInt cells[RING_ELEMENTS] = {0, 0, 1, 1};
  OWNED(LamOutline, LamOutlineDestroy) outline;

  assert_int_equal(LamOutlineCreate(RING_ELEMENTS, &Ring[0][0], cells, &outline), 0);
  assert_int_equal(outline.loop_count, 2);
  for (int k = 0; k < 2; k++) assert_true(fabs(LamOutlineLoopArea(&outline, k, &RingX[0][0]) - 6) < 1e-12);
}

TEST(the_area_of_curved_edges_is_exact)
{
  OWNED(LamOutline, LamOutlineDestroy) outline;
  PetscReal x[RING_NODES][2], area = 0;

  for (int i = 0; i < RING_NODES; i++)
    for (int k = 0; k < 2; k++) x[i][k] = RingX[i][k];
  for (int i = 17; i < RING_NODES; i += 2)
    for (int k = 0; k < 2; k++) x[i][k] *= 1.3; /* the outer edges bulge by 0.6: parabolas of area 2/3 * 4 * 0.6 each */
  assert_int_equal(LamOutlineCreate(RING_ELEMENTS, &Ring[0][0], NULL, &outline), 0);
  for (int k = 0; k < 2; k++) area = fmax(area, LamOutlineLoopArea(&outline, k, &x[0][0]));
  assert_true(fabs(area - (16 + 4 * 1.6)) < 1e-12);
}

/* Paints the ring with nodal values equal to the abscissa, in a PNG of 400 x 400 pixels, and reads the colour at (x,
 * y). */
static uint32_t painted_pixel(PetscReal x, PetscReal y)
{
  const PetscReal box[4] = {-2, -2, 2, 2};
  const LamColourRange range = {.low = -2, .high = 2};
  const LamImage image = {{0, 0}, 0};
  PetscReal values[RING_NODES];
  const LamField field = {RING_ELEMENTS, &RingX[0][0], &Ring[0][0], values, PETSC_FALSE};
  const char path[] = "test_plot_field.png";
  cairo_surface_t *surface;
  LamCanvas canvas;
  LamView view;
  uint32_t pixel;

  for (int i = 0; i < RING_NODES; i++) values[i] = RingX[i][0];
  assert_int_equal(LamCanvasCreate(path, 72, 72, &canvas), 0);
  LamViewFit((LamRect){0, 0, 72, 72}, box, &view);
  assert_int_equal(LamFieldPaint(canvas, &view, &field, &range, 1, &image), 0);
  assert_int_equal(LamCanvasFinish(&canvas), 0);
  surface = cairo_image_surface_create_from_png(path);
  remove(path);
  assert_int_equal(cairo_image_surface_get_width(surface), 400);
  pixel = *(const uint32_t *)(const void *)(cairo_image_surface_get_data(surface) +
                                            (int)(100 * (2 - y)) * cairo_image_surface_get_stride(surface) +
                                            4 * (int)(100 * (x + 2)));
  cairo_surface_destroy(surface);
  return pixel & 0xffffff;
}

TEST(a_painted_field_has_the_colours_of_its_values)
{
  const uint32_t pixel = painted_pixel(1.5, 0.3);
  const LamColour wanted = LamColourMap((1.5 + 2) / 4);

  assert_true(abs((int)(pixel >> 16) - (int)lround(255 * wanted.r)) <= 2);
  assert_true(abs((int)(pixel >> 8 & 0xff) - (int)lround(255 * wanted.g)) <= 2);
  assert_true(abs((int)(pixel & 0xff) - (int)lround(255 * wanted.b)) <= 2);
}

TEST_IS(a_field_leaves_the_lumen_unpainted, assert_int_equal(painted_pixel(0.2, 0.3), 0xffffff));

/* They would be painted for minutes. */
TEST(images_on_one_another_are_refused)
{
  const PetscReal box[4] = {-2, -2, 2, 2};
  const LamColourRange range = {.low = -2, .high = 2};
  static const LamImage images[400];
  const PetscReal values[RING_NODES] = {0};
  const LamField field = {RING_ELEMENTS, &RingX[0][0], &Ring[0][0], values, PETSC_FALSE};
  const char path[] = "test_plot_field_many.png";
  PetscErrorCode error;
  LamCanvas canvas;
  LamView view;

  assert_int_equal(LamCanvasCreate(path, 72, 72, &canvas), 0);
  LamViewFit((LamRect){0, 0, 72, 72}, box, &view);
  assert_int_equal(LamFieldPaint(canvas, &view, &field, &range, PETSC_STATIC_ARRAY_LENGTH(images), images), 0);
  PetscPushErrorHandler(PetscReturnErrorHandler, NULL);
  error = LamCanvasFinish(&canvas);
  PetscPopErrorHandler();
  assert_int_equal(error, PETSC_ERR_USER_INPUT);
  assert_int_not_equal(access(path, F_OK), 0);
}

TEST_GROUP(.setup = make_ring);
