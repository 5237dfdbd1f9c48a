/* What a picture shows at a place: plates, indenters, walls thinner than a line. */
#include "support/test.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "plot_fe2.h"

#define FILE_NAME "test_plot_shapes.png"

/* A page of 400 x 400 pixels, its view from -2 to 2. */
static LamCanvas page(LamView *view)
{
  const PetscReal box[4] = {-2, -2, 2, 2};
  LamCanvas canvas;

  CHECK(LamCanvasCreate(FILE_NAME, 72, 72, &canvas));
  LamViewFit((LamRect){0, 0, 72, 72}, box, view);
  return canvas;
}

/* The colours of the page at n points. */
static void read_pixels(LamCanvas canvas, int n, const PetscReal at[][2], uint32_t colour[])
{
  cairo_surface_t *surface;

  CHECK(LamCanvasFinish(&canvas));
  surface = cairo_image_surface_create_from_png(FILE_NAME);
  remove(FILE_NAME);
  for (int i = 0; i < n; i++)
    colour[i] = 0xffffff & *(const uint32_t *)(const void *)(cairo_image_surface_get_data(surface) +
                                                             (int)(100 * (2 - at[i][1])) *
                                                                 cairo_image_surface_get_stride(surface) +
                                                             4 * (int)(100 * (at[i][0] + 2)));
  cairo_surface_destroy(surface);
}

static const uint32_t White = 0xffffff;

/* Colours beside an obstacle that points downwards, at and above (0, 0.5), and below it. */
static void obstacle_pixels(PetscReal row[5], uint32_t colour[3])
{
  const PetscReal at[3][2] = {{0, 0.6}, {1.5, 0.6}, {0, 0.4}};
  LamView view;
  LamCanvas canvas = page(&view);

  LamObstaclesDraw(canvas, &view, &(LamObstacles){1, row});
  read_pixels(canvas, 3, at, colour);
}

TEST(a_plate_is_drawn_behind_its_face)
{
  PetscReal row[5] = {7, 0.5, 0, -1, 0};
  uint32_t colour[3];

  obstacle_pixels(row, colour);
  assert_int_not_equal(colour[0], White);
  assert_int_equal(colour[1], colour[0]);
  assert_int_equal(colour[2], White);
}

TEST(an_indenter_is_drawn_where_it_is)
{
  PetscReal row[5] = {0, 1.5, 0, -1, 1};
  uint32_t colour[3];

  obstacle_pixels(row, colour);
  assert_int_not_equal(colour[0], White);
  assert_int_equal(colour[1], White);
  assert_int_equal(colour[2], White);
}

TEST(a_picture_has_room_for_an_indenter_above_the_body)
{
  PetscReal row[5] = {0, 6, 0, -1, 1}, box[4] = {-5, -5, 5, 5};

  LamObstaclesExtend(&(LamObstacles){1, row}, 10, box);
  assert_true(box[3] == 7 && box[0] == -5 && box[1] == -5 && box[2] == 5);
}

/* A square cell of half width 1, its wall `thickness` thick: one element per side, nodes on three squares. */
static void make_cell(PetscReal thickness, PetscReal x[24][2], PetscInt elements[4][9])
{
  static const PetscReal square[8][2] = {{-1, -1}, {0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}};

  for (int i = 0; i < 48; i++) x[i / 2][i % 2] = square[i / 2 % 8][i % 2] * (1 - 0.5 * thickness * (2 - i / 16));
  for (int e = 0; e < 4; e++) {
    const PetscInt a = 2 * e, m = a + 1, b = (a + 2) % 8,
                   list[9] = {a, 16 + a, 16 + b, b, 8 + a, 16 + m, 8 + b, m, 8 + m};

    memcpy(elements[e], list, sizeof list);
  }
}

/* The colour one point inside the outer edge of a cell (18 points per unit) whose walls carry the largest value. */
static uint32_t wall_pixel(PetscReal thickness)
{
  const LamColourRange range = {.low = 0, .high = 1};
  const PetscReal inside[1][2] = {{1 - 1. / 18, 0.3}};
  PetscReal x[24][2], values[24], period[4] = {0};
  PetscInt elements[4][9], cell_of[4] = {0};
  LamTissue tissue = {.F = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .node_count = 24, .element_count = 4};
  LamView view;
  LamCanvas canvas = page(&view);
  uint32_t colour;

  make_cell(thickness, x, elements);
  for (int i = 0; i < 24; i++) values[i] = 1;
  tissue.nodes = tissue.x = &x[0][0];
  tissue.values = values;
  tissue.elements = &elements[0][0];
  tissue.cell_of = cell_of;
  tissue.period = period;
  CHECK(LamOutlineCreate(4, tissue.elements, cell_of, &tissue.outline));
  CHECK(LamTissueDraw(canvas, &view, &tissue, &range, NULL));
  read_pixels(canvas, 1, inside, &colour);
  CHECK(LamOutlineDestroy(&tissue.outline));
  return colour;
}

TEST(a_wall_thinner_than_a_line_shows_its_colour)
{
  const uint32_t thin = wall_pixel(0.01), thick = wall_pixel(0.2);

  for (int shift = 0; shift < 24; shift += 8) /* but for rounding */
    assert_true(abs((int)(thin >> shift & 0xff) - (int)(thick >> shift & 0xff)) <= 1);
}

TEST_GROUP();
