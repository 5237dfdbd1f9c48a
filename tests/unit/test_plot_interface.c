/* Gaps, contact pressure and the lamella in pictures: where they are drawn, and in which colour. */
#include "support/test.h"
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "plot.h"

/* A face along the X axis from -1.5 to 1.5: a gap of 0.5 to the left of the origin, contact to the right, where the
   pressure grows with X up to 2 MPa. */
#define POINTS 7
typedef struct {
  PetscReal from[POINTS][2], to[POINTS][2], gap[POINTS], pressure[POINTS];
  PetscBool has_lamella;
  PetscReal broken[POINTS]; /* of a lamella that joins from and to */
} Samples;

static Samples HalfOpen(void)
{
  Samples s = {.has_lamella = PETSC_FALSE};

  for (int i = 0; i < POINTS; i++) {
    const PetscReal x = -1.5 + 0.5 * i;

    s.from[i][0] = s.to[i][0] = x;
    s.from[i][1] = 0;
    s.gap[i] = s.to[i][1] = x < 0 ? 0.5 : 0;
    s.pressure[i] = x > 0 ? x * 2 / 1.5 : 0;
  }
  return s;
}

/* Without pressure, with a lamella of which this share is broken. */
static Samples Held(PetscReal broken)
{
  Samples s = HalfOpen();

  s.has_lamella = PETSC_TRUE;
  for (int i = 0; i < POINTS; i++) {
    s.broken[i] = broken;
    s.pressure[i] = 0;
  }
  return s;
}

#define LINE 2.0 /* width of the lamella, points; one is 1/18 of a unit */

/* Draws the face in a PNG of 400 x 400 pixels, and reads the colour at (x, y). */
static uint32_t Pixel(Samples *s, PetscReal x, PetscReal y)
{
  const PetscReal box[4] = {-2, -2, 2, 2}, none[2] = {0, 0};
  const LamInterface interface = {.faces = 1,
                                  .points = POINTS,
                                  .from = &s->from[0][0],
                                  .to = &s->to[0][0],
                                  .gap = s->gap,
                                  .pressure = s->pressure,
                                  .has_lamella = s->has_lamella,
                                  .across = &s->to[0][0],
                                  .broken = s->broken,
                                  .largest_pressure = 2,
                                  .is_open = PETSC_TRUE,
                                  .gaps = {0, 0.5, {PETSC_FALSE, PETSC_FALSE}}};
  const char path[] = "test_plot_interface.png";
  cairo_surface_t *surface;
  LamCanvas canvas;
  LamView view;
  uint32_t pixel;

  assert_int_equal(LamCanvasCreate(path, 72, 72, &canvas), 0);
  LamViewFit((LamRect){0, 0, 72, 72}, box, &view);
  LamInterfaceDrawPressure(canvas, &view, &interface, none, LINE);
  LamInterfaceDrawLamella(canvas, &view, &interface, none, LINE);
  LamInterfaceDrawGaps(canvas, &view, &interface, none);
  assert_int_equal(LamCanvasFinish(&canvas), 0);
  surface = cairo_image_surface_create_from_png(path);
  remove(path);
  pixel = *(const uint32_t *)(const void *)(cairo_image_surface_get_data(surface) +
                                            (int)(100 * (2 - y)) * cairo_image_surface_get_stride(surface) +
                                            4 * (int)(100 * (x + 2)));
  cairo_surface_destroy(surface);
  return pixel & 0xffffff;
}

static void HasColour(Samples *s, PetscReal x, PetscReal y, LamColour wanted)
{
  const uint32_t pixel = Pixel(s, x, y);

  assert_true(abs((int)(pixel >> 16) - (int)lround(255 * wanted.r)) <= 2);
  assert_true(abs((int)(pixel >> 8 & 0xff) - (int)lround(255 * wanted.g)) <= 2);
  assert_true(abs((int)(pixel & 0xff) - (int)lround(255 * wanted.b)) <= 2);
}

static const uint32_t white = 0xffffff;

TEST(an_open_face_is_filled_with_the_colour_of_its_gap)
{
  Samples s = HalfOpen();

  HasColour(&s, -1, 0.25, LamGapColour(1));
}

TEST(a_closed_face_shows_no_gap)
{
  Samples s = HalfOpen();

  assert_int_equal(Pixel(&s, 1, 0.25), white);
}

TEST(a_gap_thinner_than_a_line_is_seen)
{
  Samples s = HalfOpen();

  for (int i = 0; i < POINTS; i++) s.gap[i] = s.to[i][1] = 2 * LAM_VISIBLE_GAP;
  assert_int_not_equal(Pixel(&s, -1, 0.02), white);
}

TEST(a_gap_too_small_to_count_is_not_drawn)
{
  Samples s = HalfOpen();

  for (int i = 0; i < POINTS; i++) s.gap[i] = s.to[i][1] = 0.9 * LAM_VISIBLE_GAP;
  assert_int_equal(Pixel(&s, -1, 0.005), white);
}

TEST(samples_that_face_no_wall_show_no_gap)
{
  Samples s = HalfOpen();

  for (int i = 0; i < 3; i++) s.gap[i] = s.to[i][0] = s.to[i][1] = NAN;
  assert_int_equal(Pixel(&s, -1, 0.25), white);
}

TEST(the_ribbon_is_as_wide_as_the_pressure)
{
  Samples s = HalfOpen();

  assert_int_not_equal(Pixel(&s, 1.4, 0.1), white);
  assert_int_not_equal(Pixel(&s, 1.4, -0.1), white);
  assert_int_equal(Pixel(&s, 0.5, 0.1), white);
  assert_int_not_equal(Pixel(&s, 0.5, 0.03), white);
}

TEST(an_intact_lamella_is_a_dark_line)
{
  Samples s = Held(0);

  HasColour(&s, 1, 0, LamDarkInk);
  assert_int_equal(Pixel(&s, 1, 0.1), white);
}

TEST(a_damaged_lamella_is_a_line_of_its_colour)
{
  Samples s = Held(0.5);

  HasColour(&s, 1, 0, LamLamellaColour(0.5));
}

TEST(a_broken_lamella_is_a_white_line_between_dark_ones)
{
  Samples s = Held(1);

  assert_int_equal(Pixel(&s, 1, 0), white);
  HasColour(&s, 1, 1.2 / 18, LamDarkInk);
  HasColour(&s, 1, -1.2 / 18, LamDarkInk);
}

TEST(what_still_holds_crosses_the_gap_in_threads)
{
  Samples s = Held(0.5);

  HasColour(&s, -1, 0.25, LamLamellaColour(0.5));
  HasColour(&s, -0.75, 0.25, LamGapColour(1));
}

TEST(nothing_crosses_the_gap_of_a_broken_lamella)
{
  Samples s = Held(1);

  HasColour(&s, -1, 0.25, LamGapColour(1));
}

TEST(pressure_is_seen_beside_the_lamella)
{
  Samples s = Held(0);

  s.pressure[5] = 0.2; /* a tenth of the largest */
  assert_int_not_equal(Pixel(&s, 1, 1.75 / 18), white);
}

TEST(brightness_rises_as_the_lamella_breaks)
{
  for (int i = 1; i <= 50; i++) assert_true(LamLamellaColour(i / 50.0).g > LamLamellaColour((i - 1) / 50.0).g);
}

TEST(brightness_falls_along_the_colours_of_gaps)
{
  PetscReal last = 1;

  for (int i = 0; i <= 50; i++) {
    const LamColour c = LamGapColour(i / 50.0);
    const PetscReal luminance = 0.2126 * pow(c.r, 2.2) + 0.7152 * pow(c.g, 2.2) + 0.0722 * pow(c.b, 2.2);

    assert_true(luminance < last);
    last = luminance;
  }
}

static char message[512];

static PetscErrorCode KeepMessage(MPI_Comm comm, int line, const char *function, const char *file, PetscErrorCode code,
                                  PetscErrorType type, const char *text, void *ctx)
{
  if (type == PETSC_ERROR_INITIAL) snprintf(message, sizeof message, "%s", text);
  return code;
}

TEST(a_file_without_samples_is_refused)
{
  LamScene scene = {.text = "version: 1\n",
                    .micro = {.wall_thickness = 0.5,
                              .cells = {1, 1},
                              .along = 1,
                              .through = 1,
                              .wall = {.C1 = 0.9, .C2 = 0.1, .bulk_modulus = 1000},
                              .interface = LAM_INTERFACE_CONTACT},
                    .scales = {.length = 75e-6, .stress = 0.11e6},
                    .accuracy = 0.01};
  const char path[] = "test_plot_interface.h5";
  LamRecordWriter writer;
  LamInterface interface;

  assert_int_equal(LamRecordWriterOpen(path, "rve", LAM_WRITE_CREATE, &scene, &writer), 0);
  assert_int_equal(LamRecordWriterText(writer, "/note", "no samples"), 0);
  assert_int_equal(LamRecordWriterClose(&writer), 0);
  PetscErrorHandlingInitialized = PETSC_TRUE; /* before PetscInitialize PETSc calls no handler else */
  PetscPushErrorHandler(KeepMessage, NULL);
  assert_int_equal(LamInterfaceRead(path, "/fields/1", &interface), PETSC_ERR_USER_INPUT);
  PetscPopErrorHandler();
  remove(path);
  assert_non_null(strstr(message, "/fields/1/interface/from is missing"));
}
