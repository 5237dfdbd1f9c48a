/*
  Fields on meshes of nine-node quadrilaterals and six-node triangles, and the view in which they are drawn.

  Method. Each element is cut into small quadrilaterals whose corners lie on its quadratic surface. Each of these is
  filled as two triangles, with the value interpolated linearly and coloured pixel by pixel, so colours change smoothly.
  The result is one image of fixed size in every output format; edges drawn over it remain vectors.
*/
#include "plot.h"
#include <math.h>
#include <stdint.h>
#include <stdio.h>

void LamViewFit(LamRect frame, const PetscReal box[4], LamView *view)
{
  const PetscReal width = box[2] - box[0], height = box[3] - box[1];

  view->frame = frame;
  view->scale = PetscMin(frame.width / PetscMax(width, 1e-30), frame.height / PetscMax(height, 1e-30));
  view->origin[0] = 0.5 * (box[0] + box[2]) - 0.5 * frame.width / view->scale;
  view->origin[1] = 0.5 * (box[1] + box[3]) - 0.5 * frame.height / view->scale;
}

void LamViewPoint(const LamView *view, PetscReal x, PetscReal y, double point[2])
{
  point[0] = view->frame.x + (x - view->origin[0]) * view->scale;
  point[1] = view->frame.y + view->frame.height - (y - view->origin[1]) * view->scale;
}

void LamBoxExtend(PetscReal box[4], PetscInt n, const PetscReal points[], const PetscReal shift[2])
{
  for (PetscInt i = 0; i < n; i++) {
    for (int k = 0; k < 2; k++) {
      const PetscReal x = points[2 * i + k] + (shift ? shift[k] : 0);

      box[k] = PetscMin(box[k], x);
      box[2 + k] = PetscMax(box[2 + k], x);
    }
  }
}

void LamBoxWiden(PetscReal box[4], PetscReal margin)
{
  for (int k = 0; k < 2; k++) {
    box[k] -= margin;
    box[2 + k] += margin;
  }
}

PetscBool LamViewShows(const LamView *view, const PetscReal box[4], const PetscReal shift[2])
{
  const PetscReal size[2] = {view->frame.width / view->scale, view->frame.height / view->scale};

  for (int k = 0; k < 2; k++) {
    if (box[2 + k] + shift[k] < view->origin[k] || box[k] + shift[k] > view->origin[k] + size[k]) return PETSC_FALSE;
  }
  return PETSC_TRUE;
}

/* Biquadratic shape functions at (r, s) in [-1, 1]^2: corners, mid-edges, centre. */
static void ShapeFunctions(PetscReal r, PetscReal s, PetscReal N[9])
{
  const PetscReal a[3] = {0.5 * r * (r - 1), 0.5 * r * (r + 1), 1 - r * r};
  const PetscReal b[3] = {0.5 * s * (s - 1), 0.5 * s * (s + 1), 1 - s * s};
  static const int at[9][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {2, 0}, {1, 2}, {2, 1}, {0, 2}, {2, 2}};

  for (int i = 0; i < 9; i++) N[i] = a[at[i][0]] * b[at[i][1]];
}

/* Quadratic shape functions of a triangle, whose third corner is the collapsed side s = 1 of the square: neighbours
   share the same points of an edge, as squares do. */
static void TriangleFunctions(PetscReal r, PetscReal s, PetscReal N[6])
{
  const PetscReal u = 0.5 * (1 + r), v = 0.5 * (1 + s), L[3] = {(1 - u) * (1 - v), u * (1 - v), v};

  for (int i = 0; i < 3; i++) {
    N[i] = L[i] * (2 * L[i] - 1);
    N[3 + i] = 4 * L[i] * L[(i + 1) % 3];
  }
}

#define COLOUR_COUNT 1024
#define MAX_CUTS 24
#define MOST_COVERS 100  /* limit of the visits per pixel, on average; elements side by side need less than ten */
#define LEAST_WORK 20000 /* pixels added to the limit, for a small page */
typedef struct {
  uint32_t *pixels; /* [height][stride], owned by the surface */
  int width, height, stride;
  double dots;                    /* pixels per point */
  int cuts;                       /* pieces of an element per direction */
  double work;                    /* remaining pixel visits; below zero nothing more is painted */
  uint32_t colours[COLOUR_COUNT]; /* of the image being painted */
} Raster;

typedef struct {
  double x, y, value; /* pixels; fraction of the colour range */
} Vertex;

static void FillColours(Raster *raster, PetscReal fade)
{
  for (int i = 0; i < COLOUR_COUNT; i++) {
    const LamColour c = LamColourMap(i / (COLOUR_COUNT - 1.0));
    const double rgb[3] = {c.r, c.g, c.b};
    uint32_t pixel = 0xff;

    for (int k = 0; k < 3; k++) pixel = pixel << 8 | (uint32_t)lround(255 * (rgb[k] * (1 - fade) + fade));
    raster->colours[i] = pixel;
  }
}

/* Fills the pixels whose centres lie inside or on the edges, so that no seam is left between neighbours. */
static void FillTriangle(Raster *raster, const Vertex a, const Vertex b, const Vertex c)
{
  const double area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
  const double first[2] = {PetscMin(a.x, PetscMin(b.x, c.x)), PetscMin(a.y, PetscMin(b.y, c.y))};
  const double last[2] = {PetscMax(a.x, PetscMax(b.x, c.x)), PetscMax(a.y, PetscMax(b.y, c.y))};
  int left, right, top, bottom;

  raster->work -= 1;
  if (area == 0 || !isfinite(area) || !isfinite(a.value + b.value + c.value)) return;
  left = (int)PetscClipInterval(floor(first[0] - 0.5), 0.0, (double)raster->width);
  right = (int)PetscClipInterval(ceil(last[0] - 0.5), -1.0, raster->width - 1.0);
  top = (int)PetscClipInterval(floor(first[1] - 0.5), 0.0, (double)raster->height);
  bottom = (int)PetscClipInterval(ceil(last[1] - 0.5), -1.0, raster->height - 1.0);
  if (right >= left && bottom >= top) raster->work -= (1.0 + right - left) * (1.0 + bottom - top);
  if (raster->work < 0) return;
  for (int j = top; j <= bottom; j++) {
    for (int i = left; i <= right; i++) {
      const double x = i + 0.5, y = j + 0.5;
      const double u = ((x - a.x) * (c.y - a.y) - (c.x - a.x) * (y - a.y)) / area;
      const double v = ((b.x - a.x) * (y - a.y) - (x - a.x) * (b.y - a.y)) / area;
      double share;

      if (u < -1e-9 || v < -1e-9 || u + v > 1 + 1e-9) continue;
      share = PetscClipInterval(a.value + u * (b.value - a.value) + v * (c.value - a.value), 0.0, 1.0);
      raster->pixels[j * raster->stride + i] = raster->colours[(int)lround(share * (COLOUR_COUNT - 1))];
    }
  }
}

/* Vertex of element e at (r, s), in pixels of the raster. */
static Vertex ElementVertex(const LamField *field, const LamColourRange *range, const LamView *view, double dots,
                            PetscInt e, const PetscReal shift[2], PetscReal r, PetscReal s)
{
  const int nodes = LamElementNodes(&field->elements[9 * e]);
  PetscReal N[9], x = shift[0], y = shift[1], value = field->per_element ? field->values[e] : 0;
  double point[2];

  if (nodes == 6)
    TriangleFunctions(r, s, N);
  else
    ShapeFunctions(r, s, N);
  for (int i = 0; i < nodes; i++) {
    const PetscInt node = field->elements[9 * e + i];

    x += N[i] * field->x[2 * node];
    y += N[i] * field->x[2 * node + 1];
    if (!field->per_element) value += N[i] * field->values[node];
  }
  LamViewPoint(view, x, y, point);
  return (Vertex){(point[0] - view->frame.x) * dots, (point[1] - view->frame.y) * dots, LamColourShare(range, value)};
}

/* Cuts per direction, for pieces of about four pixels, so that curved edges and quadratic fields look smooth; equal
   for all elements, so that neighbours share the same points. */
static int FieldCuts(const LamField *field, const LamView *view, double dots)
{
  PetscReal largest = 0;

  for (PetscInt e = 0; e < field->element_count; e++) {
    PetscReal box[4] = LAM_EMPTY_BOX;

    for (int i = 0; i < LamElementNodes(&field->elements[9 * e]); i++)
      LamBoxExtend(box, 1, &field->x[2 * field->elements[9 * e + i]], NULL);
    largest = PetscMax(largest, PetscMax(box[2] - box[0], box[3] - box[1]));
  }
  return (int)PetscClipInterval(largest * view->scale * dots / 4, 1.0, (double)MAX_CUTS);
}

static void PaintElement(Raster *raster, const LamView *view, const LamField *field, const LamColourRange *range,
                         PetscInt e, const PetscReal shift[2])
{
  const int cuts = raster->cuts;
  Vertex rows[2][MAX_CUTS + 1];

  for (int j = 0; j <= cuts; j++) {
    Vertex *below = rows[(j + 1) % 2], *row = rows[j % 2];

    for (int i = 0; i <= cuts; i++)
      row[i] = ElementVertex(field, range, view, raster->dots, e, shift, -1 + 2.0 * i / cuts, -1 + 2.0 * j / cuts);
    if (!j) continue;
    for (int i = 0; i < cuts; i++) {
      FillTriangle(raster, below[i], below[i + 1], row[i + 1]);
      FillTriangle(raster, below[i], row[i + 1], row[i]);
    }
  }
}

PetscErrorCode LamFieldPaint(LamCanvas canvas, const LamView *view, const LamField *field, const LamColourRange *range,
                             PetscInt image_count, const LamImage images[])
{
  cairo_t *cr = LamCanvasCairo(canvas);
  const LamRect frame = view->frame;
  cairo_surface_t *surface;
  Raster raster;

  PetscFunctionBeginUser;
  raster.dots = LamCanvasDots(canvas);
  raster.cuts = FieldCuts(field, view, raster.dots);
  raster.width = (int)ceil(frame.width * raster.dots);
  raster.height = (int)ceil(frame.height * raster.dots);
  raster.work = LEAST_WORK + (double)MOST_COVERS * raster.width * raster.height;
  surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, raster.width, raster.height);
  PetscCheck(!cairo_surface_status(surface), PETSC_COMM_SELF, PETSC_ERR_LIB, "cairo: %s",
             cairo_status_to_string(cairo_surface_status(surface)));
  cairo_surface_flush(surface);
  raster.pixels = (uint32_t *)(void *)cairo_image_surface_get_data(surface);
  raster.stride = cairo_image_surface_get_stride(surface) / (int)sizeof *raster.pixels;
  for (PetscInt k = 0; k < image_count; k++) {
    if (!k || images[k].fade != images[k - 1].fade) FillColours(&raster, images[k].fade);
    for (PetscInt e = 0; e < field->element_count && raster.work >= 0; e++)
      PaintElement(&raster, view, field, range, e, images[k].shift);
  }
  cairo_surface_mark_dirty(surface);
  cairo_save(cr);
  cairo_translate(cr, frame.x, frame.y);
  cairo_scale(cr, 1 / raster.dots, 1 / raster.dots);
  cairo_set_source_surface(cr, surface, 0, 0);
  cairo_pattern_set_filter(cairo_get_source(cr), CAIRO_FILTER_BILINEAR);
  cairo_paint(cr);
  cairo_restore(cr);
  cairo_surface_destroy(surface);
  if (raster.work < 0) LamCanvasRefuse(canvas, "elements lie on one another, many times all over it");
  PetscFunctionReturn(0);
}

double LamScaleBar(LamCanvas canvas, const LamView *view, double x, double y, double width, PetscReal unit_length,
                   const char unit[])
{
  const PetscReal longest = width / (view->scale * unit_length); /* in units */
  const PetscReal power = PetscPowReal(10, PetscFloorReal(PetscLog10Real(longest)));
  const PetscReal length = power * (longest >= 5 * power ? 5 : longest >= 2 * power ? 2 : 1);
  const double bar = length * unit_length * view->scale;
  char label[64];

  snprintf(label, sizeof label, "%g %s", (double)length, unit);
  LamCanvasLine(canvas, x, y, x + bar, y);
  LamCanvasStroke(canvas, LamInk, 2, NULL);
  LamCanvasText(canvas, x + bar + 4, y, 0, 0, LAM_TICK_SIZE, label);
  return bar + 4 + LamCanvasTextWidth(canvas, LAM_TICK_SIZE, label);
}
