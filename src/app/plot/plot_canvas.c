/*
  The page of a picture: output formats, text with subscripts, markers, line colours.
*/
#include "plot.h"
#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include "utf8.h"

double LamPlotDPI = 400, LamPlotVectorDPI = 300;
void (*LamPlotTextVisit)(const char text[], LamRect box);
enum { MOST_TEXTS = 1024 }; /* remembered of a page, which has about a hundred */

typedef enum { FORMAT_PNG, FORMAT_SVG, FORMAT_PDF, FORMAT_COUNT } Format;
static const char *const FormatExtensions[] = {".png", ".svg", ".pdf"};

struct LamCanvas_s {
  char path[PETSC_MAX_PATH_LEN];
  Format format;
  double width; /* of the page */
  double dots;  /* pixels per point of images on this page */
  LamRect texts[MOST_TEXTS];
  int text_count;
  cairo_surface_t *surface; /* owned */
  cairo_t *cr;              /* owned */
  cairo_t *page;            /* the page's context while `cr` draws an image, else NULL; owned */
  LamRect image;            /* frame of that image */
  const char *refused;      /* why the numbers of the file cannot be drawn; NULL: they can */
  unsigned char *bytes;     /* the file's contents so far; owned */
  size_t size, capacity;
};

static PetscErrorCode FormatOfPath(const char path[], Format *format)
{
  const size_t length = strlen(path);

  PetscFunctionBeginUser;
  for (int i = 0; i < FORMAT_COUNT; i++) {
    const size_t n = strlen(FormatExtensions[i]);

    if (length <= n || strcasecmp(path + length - n, FormatExtensions[i])) continue;
    *format = (Format)i;
    PetscFunctionReturn(0);
  }
  SETERRQ(PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: a picture's name must end in .png, .svg or .pdf", path);
}

PetscErrorCode LamCanvasCheckPath(const char path[])
{
  Format format;

  PetscFunctionBeginUser;
  PetscCall(FormatOfPath(path, &format));
  PetscFunctionReturn(0);
}

/* Cairo delivers the file in pieces. */
static cairo_status_t CollectBytes(void *ctx, const unsigned char *data, unsigned int length)
{
  LamCanvas canvas = (LamCanvas)ctx;

  if (canvas->size + length > canvas->capacity) {
    size_t capacity = 2 * canvas->capacity + length + 65536;

    if (PetscRealloc(capacity, &canvas->bytes)) return CAIRO_STATUS_NO_MEMORY;
    canvas->capacity = capacity;
  }
  memcpy(canvas->bytes + canvas->size, data, length);
  canvas->size += length;
  return CAIRO_STATUS_SUCCESS;
}

PetscErrorCode LamCanvasCreate(const char path[], double width, double height, LamCanvas *canvas)
{
  LamCanvas c;
  cairo_font_options_t *font;

  PetscFunctionBeginUser;
  PetscCall(PetscNew(&c));
  PetscCall(FormatOfPath(path, &c->format));
  PetscCall(PetscStrncpy(c->path, path, sizeof c->path));
  c->width = width;
  c->dots = (c->format == FORMAT_PNG ? LamPlotDPI : LamPlotVectorDPI) / 72;
  if (c->format == FORMAT_PNG)
    c->surface =
        cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)lround(width * c->dots), (int)lround(height * c->dots));
  else if (c->format == FORMAT_SVG)
    c->surface = cairo_svg_surface_create_for_stream(CollectBytes, c, width, height);
  else
    c->surface = cairo_pdf_surface_create_for_stream(CollectBytes, c, width, height);
  c->cr = cairo_create(c->surface);
  if (c->format == FORMAT_PNG) cairo_scale(c->cr, c->dots, c->dots);
  cairo_set_source_rgb(c->cr, 1, 1, 1);
  cairo_paint(c->cr);
  /* Unhinted metrics, so that the layout is the same in all formats. */
  font = cairo_font_options_create();
  cairo_font_options_set_hint_metrics(font, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_hint_style(font, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_antialias(font, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(c->cr, font);
  cairo_font_options_destroy(font);
  cairo_set_line_join(c->cr, CAIRO_LINE_JOIN_ROUND);
  PetscCheck(cairo_status(c->cr) == CAIRO_STATUS_SUCCESS, PETSC_COMM_SELF, PETSC_ERR_LIB, "cairo: %s",
             cairo_status_to_string(cairo_status(c->cr)));
  *canvas = c;
  PetscFunctionReturn(0);
}

static PetscErrorCode WriteBytes(const char path[], size_t size, const unsigned char bytes[])
{
  FILE *file = fopen(path, "wb");
  PetscBool written;

  PetscFunctionBeginUser;
  PetscCheck(file, PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: cannot write the picture: %s", path, strerror(errno));
  written = (PetscBool)(fwrite(bytes, 1, size, file) == size);
  if (fclose(file)) written = PETSC_FALSE;
  if (!written) {
    const char *why = strerror(errno);

    remove(path); /* delete a partial file */
    SETERRQ(PETSC_COMM_SELF, PETSC_ERR_FILE_WRITE, "%s: cannot write the picture: %s", path, why);
  }
  PetscFunctionReturn(0);
}

void LamCanvasRefuse(LamCanvas canvas, const char reason[])
{
  canvas->refused = reason;
}

/* Writes the file of the page, or fails with the reason why it cannot be drawn. */
static PetscErrorCode WritePage(LamCanvas c)
{
  cairo_status_t status = cairo_status(c->cr);

  PetscFunctionBeginUser;
  if (!status && !c->refused && c->format == FORMAT_PNG)
    status = cairo_surface_write_to_png_stream(c->surface, CollectBytes, c);
  cairo_destroy(c->cr);
  cairo_surface_finish(c->surface);
  if (!status) status = cairo_surface_status(c->surface);
  cairo_surface_destroy(c->surface);
  PetscCheck(!status || status == CAIRO_STATUS_NO_MEMORY, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT,
             "%s: the numbers of the file cannot be drawn (cairo: %s); they are too large, or alike", c->path,
             cairo_status_to_string(status));
  PetscCheck(!status, PETSC_COMM_SELF, PETSC_ERR_MEM, "cairo: %s", cairo_status_to_string(status));
  PetscCheck(!c->refused, PETSC_COMM_SELF, PETSC_ERR_USER_INPUT, "%s: the numbers of the file cannot be drawn: %s",
             c->path, c->refused);
  PetscCall(WriteBytes(c->path, c->size, c->bytes));
  PetscFunctionReturn(0);
}

PetscBool LamCanvasHasPages(const char path[])
{
  Format format = FORMAT_PNG;

  return (PetscBool)(!FormatOfPath(path, &format) && format == FORMAT_PDF);
}

void LamCanvasNextPage(LamCanvas canvas)
{
  canvas->text_count = 0;
  cairo_show_page(canvas->cr);
  cairo_set_source_rgb(canvas->cr, 1, 1, 1);
  cairo_paint(canvas->cr);
}

PetscErrorCode LamCanvasFinish(LamCanvas *canvas)
{
  PetscErrorCode error;

  PetscFunctionBeginUser;
  error = WritePage(*canvas);
  PetscCall(PetscFree((*canvas)->bytes));
  PetscCall(PetscFree(*canvas));
  PetscCall(error);
  PetscFunctionReturn(0);
}

cairo_t *LamCanvasCairo(LamCanvas canvas)
{
  return canvas->cr;
}

double LamCanvasDots(LamCanvas canvas)
{
  return canvas->dots;
}

PetscErrorCode LamCanvasBeginImage(LamCanvas canvas, LamRect rect)
{
  const double dots = canvas->dots;
  cairo_surface_t *surface =
      cairo_image_surface_create(CAIRO_FORMAT_ARGB32, (int)ceil(rect.width * dots), (int)ceil(rect.height * dots));

  PetscFunctionBeginUser;
  canvas->page = canvas->cr;
  canvas->image = rect;
  canvas->cr = cairo_create(surface);
  cairo_surface_destroy(surface); /* its context holds a reference */
  PetscCheck(!cairo_status(canvas->cr), PETSC_COMM_SELF, PETSC_ERR_LIB, "cairo: %s",
             cairo_status_to_string(cairo_status(canvas->cr)));
  cairo_scale(canvas->cr, dots, dots);
  cairo_translate(canvas->cr, -rect.x, -rect.y);
  PetscFunctionReturn(0);
}

void LamCanvasEndImage(LamCanvas canvas)
{
  const double dots = canvas->dots;
  cairo_t *image = canvas->cr;

  canvas->cr = canvas->page;
  canvas->page = NULL;
  cairo_save(canvas->cr);
  cairo_translate(canvas->cr, canvas->image.x, canvas->image.y);
  cairo_scale(canvas->cr, 1 / dots, 1 / dots);
  cairo_set_source_surface(canvas->cr, cairo_get_target(image), 0, 0);
  cairo_paint(canvas->cr);
  cairo_restore(canvas->cr);
  cairo_destroy(image);
}

void LamCanvasSetColour(LamCanvas canvas, LamColour colour)
{
  cairo_set_source_rgb(canvas->cr, colour.r, colour.g, colour.b);
}

void LamCanvasLine(LamCanvas canvas, double x0, double y0, double x1, double y1)
{
  cairo_move_to(canvas->cr, x0, y0);
  cairo_line_to(canvas->cr, x1, y1);
}

void LamCanvasBox(LamCanvas canvas, LamRect r)
{
  cairo_rectangle(canvas->cr, r.x, r.y, r.width, r.height);
}

void LamCanvasStroke(LamCanvas canvas, LamColour colour, double width, const double dash[2])
{
  LamCanvasSetColour(canvas, colour);
  cairo_set_line_width(canvas->cr, width);
  cairo_set_dash(canvas->cr, dash, dash ? 2 : 0, 0);
  cairo_stroke(canvas->cr);
  cairo_set_dash(canvas->cr, NULL, 0, 0);
}

void LamCanvasFill(LamCanvas canvas, LamColour colour)
{
  LamCanvasSetColour(canvas, colour);
  cairo_fill(canvas->cr);
}

void LamCanvasClip(LamCanvas canvas, LamRect rect)
{
  cairo_save(canvas->cr);
  LamCanvasBox(canvas, rect);
  cairo_clip(canvas->cr);
}

/* Names come from files, and cairo fails on bytes that are not UTF-8, such as a truncated last character. */
static void MendText(char text[])
{
  for (char *c = text; *c;) {
    const size_t length = LamCharacterLength((const unsigned char *)c);

    if (!length) *c = '?';
    c += length ? length : 1;
  }
}

/* Draws or measures one run of text in one style and advances the current point. Returns the advance. */
static double TextRun(cairo_t *cr, double size, PetscBool italic, int script, size_t n, const char text[],
                      PetscBool show)
{
  char run[256];
  cairo_text_extents_t extents;

  if (!n) return 0;
  n = PetscMin(n, sizeof run - 1);
  memcpy(run, text, n);
  run[n] = 0;
  MendText(run);
  cairo_select_font_face(cr, "sans", italic ? CAIRO_FONT_SLANT_ITALIC : CAIRO_FONT_SLANT_NORMAL,
                         CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, script ? 0.72 * size : size);
  cairo_text_extents(cr, run, &extents);
  if (show) {
    const double rise = script < 0 ? 0.16 * size : script > 0 ? -0.36 * size : 0;

    cairo_rel_move_to(cr, 0, rise);
    cairo_show_text(cr, run);
    cairo_rel_move_to(cr, 0, -rise);
  }
  return extents.x_advance;
}

/* Splits marked-up text into runs of one style. */
static double TextRuns(cairo_t *cr, double size, const char text[], PetscBool show)
{
  PetscBool italic = PETSC_FALSE;
  int script = 0; /* -1 subscript, 1 superscript */
  double width = 0;
  const char *start = text;

  for (const char *p = text;; p++) {
    const PetscBool opens = (PetscBool)(!script && (*p == '_' || *p == '^') && p[1] == '{');
    const PetscBool closes = (PetscBool)(script && *p == '}');

    if (*p && *p != '$' && !opens && !closes) continue;
    width += TextRun(cr, size, italic, script, (size_t)(p - start), start, show);
    if (!*p) return width;
    if (*p == '$') italic = (PetscBool)!italic;
    if (closes) script = 0;
    if (opens) script = *p++ == '_' ? -1 : 1;
    start = p + 1;
  }
}

double LamCanvasTextWidth(LamCanvas canvas, double size, const char text[])
{
  return TextRuns(canvas->cr, size, text, PETSC_FALSE);
}

static const double CapitalHeight = 0.729; /* of the font size; DejaVu Sans, and within 3 % most sans fonts */

/* The box of the capitals of a text that runs to the right or, at an angle, upwards. */
static LamRect TextBox(LamCanvas canvas, double x, double y, double align, double angle, double size, const char text[])
{
  const double width = LamCanvasTextWidth(canvas, size, text), height = CapitalHeight * size;

  return angle == 0 ? (LamRect){x - align * width, y - 0.5 * height, width, height}
                    : (LamRect){x - 0.5 * height, y - (1 - align) * width, height, width};
}

void LamCanvasText(LamCanvas canvas, double x, double y, double align, double angle, double size, const char text[])
{
  const LamRect box = TextBox(canvas, x, y, align, angle, size, text);

  if (canvas->text_count < MOST_TEXTS) canvas->texts[canvas->text_count++] = box;
  if (LamPlotTextVisit) LamPlotTextVisit(text, box);
  cairo_save(canvas->cr);
  cairo_translate(canvas->cr, x, y);
  cairo_rotate(canvas->cr, -angle);
  cairo_move_to(canvas->cr, -align * LamCanvasTextWidth(canvas, size, text), 0.5 * CapitalHeight * size);
  TextRuns(canvas->cr, size, text, PETSC_TRUE);
  cairo_restore(canvas->cr);
  cairo_new_path(canvas->cr);
}

void LamCanvasTextFit(LamCanvas canvas, double x, double y, double align, double angle, double size, double room,
                      const char text[])
{
  const double width = LamCanvasTextWidth(canvas, size, text);

  LamCanvasText(canvas, x, y, align, angle, width > room ? size * room / width : size, text);
}

PetscBool LamCanvasTextFree(LamCanvas canvas, double x, double y, double align, double angle, double size,
                            const char text[])
{
  const LamRect a = TextBox(canvas, x, y, align, angle, size, text);

  for (int k = 0; k < canvas->text_count; k++) {
    const LamRect b = canvas->texts[k];

    if (a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height) return PETSC_FALSE;
  }
  LamCanvasText(canvas, x, y, align, angle, size, text);
  return PETSC_TRUE;
}

void LamCanvasTitle(LamCanvas canvas, double x, double y, const char title[])
{
  LamCanvasSetColour(canvas, LamDarkInk);
  LamCanvasTextFit(canvas, x, y, 0, 0, LAM_TEXT_SIZE + 0.75, canvas->width - 2 * x, title);
}

static void MarkerPath(LamCanvas canvas, double x, double y, double h, LamMarker marker)
{
  cairo_t *cr = canvas->cr;

  switch (marker) {
  case LAM_MARKER_SQUARE:
    cairo_rectangle(cr, x - 0.88 * h, y - 0.88 * h, 1.76 * h, 1.76 * h);
    return;
  case LAM_MARKER_TRIANGLE:
  case LAM_MARKER_TRIANGLE_DOWN: {
    const double up = marker == LAM_MARKER_TRIANGLE ? 1 : -1;

    cairo_move_to(cr, x, y - 1.2 * up * h);
    cairo_line_to(cr, x + 1.1 * h, y + 0.75 * up * h);
    cairo_line_to(cr, x - 1.1 * h, y + 0.75 * up * h);
    break;
  }
  case LAM_MARKER_DIAMOND:
    cairo_move_to(cr, x, y - 1.3 * h);
    cairo_line_to(cr, x + 1.3 * h, y);
    cairo_line_to(cr, x, y + 1.3 * h);
    cairo_line_to(cr, x - 1.3 * h, y);
    break;
  case LAM_MARKER_RING:
    cairo_new_sub_path(cr);
    cairo_arc(cr, x, y, 1.9 * h, 0, 2 * M_PI);
    return;
  case LAM_MARKER_CROSS:
    LamCanvasLine(canvas, x - h, y - h, x + h, y + h);
    LamCanvasLine(canvas, x - h, y + h, x + h, y - h);
    return;
  default:
    cairo_new_sub_path(cr);
    cairo_arc(cr, x, y, h, 0, 2 * M_PI);
  }
  cairo_close_path(cr);
}

void LamCanvasMarker(LamCanvas canvas, double x, double y, double size, LamMarker marker, PetscBool hollow)
{
  cairo_t *cr = canvas->cr;
  const PetscBool open = (PetscBool)(marker == LAM_MARKER_CROSS || marker == LAM_MARKER_RING);

  cairo_save(cr);
  cairo_set_dash(cr, NULL, 0, 0);
  cairo_set_line_width(cr, marker == LAM_MARKER_CROSS ? 1.2 : 0.8);
  cairo_new_path(cr);
  MarkerPath(canvas, x, y, 0.5 * size, marker);
  if (!open && hollow) {
    cairo_pattern_t *colour = cairo_pattern_reference(cairo_get_source(cr));

    cairo_set_source_rgb(cr, 1, 1, 1);
    cairo_fill_preserve(cr);
    cairo_set_source(cr, colour);
    cairo_pattern_destroy(colour);
  } else if (!open)
    cairo_fill_preserve(cr);
  cairo_stroke(cr);
  cairo_restore(cr);
}

LamColour LamColourOfLine(PetscInt index)
{
  /* M. Okabe and K. Ito, Color Universal Design (2008), without the yellow, which is too light for lines. */
  static const LamColour colours[] = {{0, 0.447, 0.698},     {0.835, 0.369, 0}, {0, 0.620, 0.451}, {0.8, 0.475, 0.655},
                                      {0.337, 0.706, 0.914}, {0.902, 0.624, 0}, {0, 0, 0}};

  return colours[index % (PetscInt)PETSC_STATIC_ARRAY_LENGTH(colours)];
}

void LamFormatNumber(PetscReal value, char text[32])
{
  char plain[24];
  size_t n = 0;

  snprintf(plain, sizeof plain, "%.4g", (double)value);
  for (const char *p = plain; *p && n < 28; p++) {
    if (*p == '-') {
      memcpy(text + n, "\u2212", 3);
      n += 3;
    } else
      text[n++] = *p;
  }
  text[n] = 0;
}

void LamFormatRatio(PetscReal value, char text[32])
{
  LamFormatNumber(PetscAbsReal(value) < 5e-13 ? 0 : value, text);
}
