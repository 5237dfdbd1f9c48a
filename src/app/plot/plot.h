/*
  Pictures: what the parts of `lamella plot` share. Only src/app/ uses this header.

    plot_canvas.c    the page: output formats, text, markers
    plot_axes.c      ticks, axes, curves, legends
    plot_colour.c    colour map, limits of colour scales, colour bars
    plot_field.c     views of the plane, fields on meshes of quadratic elements, scale bars
    plot_interface.c gaps, contact pressure and lamella between cells
    plot_tissue.c    cells of an RVE with their images (plot_tissue.h); plot_cells.c: at several states
    plot_outline.c   edges and closed outlines of such meshes
    plot_curves.c    stress-load curves, and the state at their peak
    plot_strip.c     several states beside each other
    plot_read.c      arrays of a file, checked
    plot_time.c      quantities against time, films (plot_time.h)
    plot_rve.c, plot_fe2.c, plot_database.c, plot_map.c, plot_process.c    one kind of file each (plot_map_read.c: data)
    plot_table.c, plot_slice.c    a database's table: its picture, and the data of a slice through it

  Lengths on the page are points (1/72 inch), y downwards. Text markup: $...$ italic, _{...} subscript, ^{...}
  superscript.
*/
#ifndef LAM_PLOT_H
#define LAM_PLOT_H

#include "mechanical_test.h"
#include <lamella/database.h>
#include <cairo.h>

/* Resolution of PNG files, and of images (fields) inside PDF and SVG files, dots per inch: 400 and 300. Tests that
   draw often use less. */
extern double LamPlotDPI, LamPlotVectorDPI;

typedef struct {
  double x, y, width, height; /* left, top */
} LamRect;

typedef struct {
  double r, g, b;
} LamColour;

/* ---- plot_canvas.c ---- */
typedef struct LamCanvas_s *LamCanvas;

/* PETSC_ERR_USER_INPUT unless `path` ends in .png, .svg or .pdf. */
PetscErrorCode LamCanvasCheckPath(const char path[]);
/* A white page. LamCanvasFinish writes the file, so no file is left after an earlier error. */
PetscErrorCode LamCanvasCreate(const char path[], double width, double height, LamCanvas *canvas);
/* Whether files of this name have several pages (PDF); starts the next page. */
PetscBool LamCanvasHasPages(const char path[]);
void LamCanvasNextPage(LamCanvas canvas);
/* Rejects the picture: LamCanvasFinish then fails with this reason. `reason` is borrowed and must outlive the
   canvas. */
void LamCanvasRefuse(LamCanvas canvas, const char reason[]);
/* Writes the file and frees the canvas. PETSC_ERR_FILE_WRITE; PETSC_ERR_USER_INPUT: the numbers cannot be drawn. */
PetscErrorCode LamCanvasFinish(LamCanvas *canvas);
cairo_t *LamCanvasCairo(LamCanvas canvas);
/* Resolution of images on this page, pixels per point. */
double LamCanvasDots(LamCanvas canvas);
/* Everything drawn between these two calls becomes one image, to keep vector files small. */
PetscErrorCode LamCanvasBeginImage(LamCanvas canvas, LamRect rect);
void LamCanvasEndImage(LamCanvas canvas);

/* Ink of axes and legends, and of titles and outlines. */
static const LamColour LamInk = {0.15, 0.15, 0.15}, LamDarkInk = {0.12, 0.12, 0.16}, LamWhite = {1, 1, 1};
void LamCanvasSetColour(LamCanvas canvas, LamColour colour);
/* Add to the current path. */
void LamCanvasLine(LamCanvas canvas, double x0, double y0, double x1, double y1);
void LamCanvasBox(LamCanvas canvas, LamRect rect);
/* Draw the current path, and set the colour; dash: lengths of dashes and gaps, NULL: a full line. */
void LamCanvasStroke(LamCanvas canvas, LamColour colour, double width, const double dash[2]);
void LamCanvasFill(LamCanvas canvas, LamColour colour);
/* Draws inside the rectangle alone, until cairo_restore. */
void LamCanvasClip(LamCanvas canvas, LamRect rect);
/* Text with its reference point at the fraction `align` (0 left, 0.5 centre, 1 right) of its width and at the middle
   of its capitals; `angle` in radian, counter-clockwise. */
void LamCanvasText(LamCanvas canvas, double x, double y, double align, double angle, double size, const char text[]);
/* The same, smaller where it would be longer than `room`; only where it lies on no earlier text of the page, which it
   returns. */
void LamCanvasTextFit(LamCanvas canvas, double x, double y, double align, double angle, double size, double room,
                      const char text[]);
PetscBool LamCanvasTextFree(LamCanvas canvas, double x, double y, double align, double angle, double size,
                            const char text[]);
/* For tests: called with each text drawn and its box on the page. */
extern void (*LamPlotTextVisit)(const char text[], LamRect box);
double LamCanvasTextWidth(LamCanvas canvas, double size, const char text[]);
/* Smaller where it would leave the page. */
void LamCanvasTitle(LamCanvas canvas, double x, double y, const char title[]);

typedef enum {
  LAM_MARKER_CIRCLE,
  LAM_MARKER_SQUARE,
  LAM_MARKER_TRIANGLE,
  LAM_MARKER_DIAMOND,
  LAM_MARKER_TRIANGLE_DOWN,
  LAM_MARKER_CROSS,
  LAM_MARKER_RING, /* around another marker */
  LAM_MARKER_COUNT
} LamMarker;
/* Drawn in the current colour; hollow markers are filled with white. */
void LamCanvasMarker(LamCanvas canvas, double x, double y, double size, LamMarker marker, PetscBool hollow);

/* Okabe and Ito's colours, which remain distinct with any colour vision; `index` wraps around. */
LamColour LamColourOfLine(PetscInt index);
/* Four digits and a true minus sign, "-0.0125"; `text` has at least 32 bytes. */
void LamFormatNumber(PetscReal value, char text[32]);
/* As LamFormatNumber for a number of order one, such as a component of F: rounding errors around zero become zero. */
void LamFormatRatio(PetscReal value, char text[32]);

/* ---- plot_axes.c ---- */
#define LAM_TEXT_SIZE 7.5  /* labels */
#define LAM_TICK_SIZE 6.75 /* numbers at ticks, legends */
#define LAM_KEY_ROW 10.0   /* between rows of a legend */

/* Round numbers first + i*step, i = 0..count-1; labels show value / 10^exponent with `decimals`, or 10^value if the
   axis is logarithmic. */
typedef struct {
  PetscReal first, step;
  PetscInt count, decimals, exponent;
  PetscBool is_log;
} LamTicks;
/* At most about `wanted` ticks in [low, high], steps of 1, 2 or 5 times a power of ten (integers: at least 1). */
LamTicks LamTicksChoose(PetscReal low, PetscReal high, PetscInt wanted, PetscBool whole);
void LamTicksFormat(const LamTicks *ticks, PetscInt i, char text[32]);
/* Width of the widest tick label. */
double LamTicksWidth(LamCanvas canvas, const LamTicks *ticks);

typedef struct {
  PetscReal low, high;
  const char *label; /* borrowed */
  const char *unit;  /* borrowed; NULL: none */
  PetscBool whole;   /* integers only */
  LamTicks ticks;
  PetscBool is_log; /* values are decadic logarithms; labels show the numbers themselves */
} LamAxis;
typedef struct {
  LamRect frame;
  LamAxis x, y;
} LamAxes;
/* Widens [low, high] by 0.06 of its length at both ends, or to a drawable interval if it is empty. */
void LamAxisPad(LamAxis *axis);
/* Widens the limits of a logarithmic axis to powers of ten. */
void LamAxisPadLog(LamAxis *axis);
/* "label (10^{-3} MPa)" */
void LamAxisLabel(const LamAxis *axis, size_t size, char text[]);
/* Chooses ticks, and the frame inside `outer` that leaves room for tick labels and axis labels. */
void LamAxesLayout(LamCanvas canvas, LamRect outer, LamAxes *axes);
void LamAxesDraw(LamCanvas canvas, const LamAxes *axes);
/* Draws the frame alone: over cells whose colours hide its lines and ticks. */
void LamAxesFrame(LamCanvas canvas, const LamAxes *axes);
double LamAxesX(const LamAxes *axes, PetscReal x);
double LamAxesY(const LamAxes *axes, PetscReal y);
/* Adds a point to the current path; joined: with a line from the last one. */
void LamAxesPath(LamCanvas canvas, const LamAxes *axes, PetscReal x, PetscReal y, PetscBool joined);
/* A vertical line across the frame, with a text beside it where no other one is (NULL: none). */
void LamAxesMark(LamCanvas canvas, const LamAxes *axes, PetscReal x, LamColour colour, PetscBool dashed,
                 const char text[]);
/* Sets empty limits; extends them to a point, if it is finite. */
void LamAxesEmpty(LamAxes *axes);
void LamAxesExtend(LamAxes *axes, PetscReal x, PetscReal y);

typedef struct {
  LamColour colour;
  LamMarker marker;
  PetscBool hollow;
  PetscBool line;
  PetscBool dashed;
} LamStyle;
#define LAM_SERIES_LABEL 64
typedef struct {
  PetscInt n;
  PetscReal *x, *y; /* owned; NaN in y leaves a gap in the line */
  LamStyle style;
  char label[LAM_SERIES_LABEL];
} LamSeries;
PetscErrorCode LamSeriesCreate(PetscInt n, LamSeries *series);
PetscErrorCode LamSeriesDestroy(LamSeries *series);
void LamSeriesExtend(const LamSeries *series, LamAxes *axes);
void LamSeriesDraw(LamCanvas canvas, const LamAxes *axes, const LamSeries *series);
/* The position of the next entry of a legend in rows; left and right end and height of a row, space after an entry. */
typedef struct {
  double left, right, row, space, x, y;
  double size; /* of its text */
} LamPen;
LamPen LamPenStart(LamRect outer, double row, double space);
/* Draws the label of an entry if `draw`; `at`: for its sample, which is `sample` wide, vertically in the middle. */
void LamPenEntry(LamCanvas canvas, LamPen *pen, double sample, const char label[], PetscBool draw, double at[2]);
/* A legend in rows, from the top left corner of `outer`, its text of this size; series without a label are left out.
   Returns its height; draws only if `draw`. */
double LamLegend(LamCanvas canvas, LamRect outer, double size, PetscInt n, const LamSeries series[], PetscBool draw);
/*
  Legend, axes and curves, one above the other, inside `outer`. `axes` holds labels and units; limits are computed from
  the series.
*/
void LamChart(LamCanvas canvas, LamRect outer, LamAxes *axes, PetscInt n, const LamSeries series[]);

/* ---- plot_colour.c ---- */
/* Colour map: perceptually uniform (viridis), `share` in 0..1 (clamped). */
LamColour LamColourMap(PetscReal share);

/* Limits of a colour scale; clipped: values beyond the lower or upper limit exist; is_log: values are decadic
   logarithms of the numbers on the bar. */
typedef struct {
  PetscReal low, high;
  PetscBool clipped[2];
  PetscBool is_log;
} LamColourRange;
/* The middle 98 % of the finite values if the rest are outliers (stress concentrations), else all of them. */
PetscErrorCode LamColourRangeFind(PetscInt n, const PetscReal values[], LamColourRange *range);
PetscReal LamColourShare(const LamColourRange *range, PetscReal value);
/* Width that a colour bar needs to the right of its picture; draws the bar, as high as `frame`. */
double LamColourBarWidth(LamCanvas canvas, const LamColourRange *range);
void LamColourBar(LamCanvas canvas, LamRect frame, const LamColourRange *range, LamColour (*map)(PetscReal share),
                  const char label[], const char unit[]);

/* ---- plot_field.c ---- */
/* World to page: x_page = frame.x + (X - origin[0])*scale, y_page = frame.y + frame.height - (Y - origin[1])*scale. */
typedef struct {
  LamRect frame;
  PetscReal origin[2], scale;
} LamView;
/* Fits the box {xmin, ymin, xmax, ymax} into the frame, centred, with equal scales. */
void LamViewFit(LamRect frame, const PetscReal box[4], LamView *view);
void LamViewPoint(const LamView *view, PetscReal x, PetscReal y, double point[2]);
#define LAM_EMPTY_BOX                                                                                                  \
  {                                                                                                                    \
    PETSC_MAX_REAL, PETSC_MAX_REAL, -PETSC_MAX_REAL, -PETSC_MAX_REAL                                                   \
  }
/* shift: of the points; NULL: none. */
void LamBoxExtend(PetscReal box[4], PetscInt n, const PetscReal points[], const PetscReal shift[2]);
void LamBoxWiden(PetscReal box[4], PetscReal margin);
/* Whether the box, moved by `shift`, is visible in the view. */
PetscBool LamViewShows(const LamView *view, const PetscReal box[4], const PetscReal shift[2]);

/* A translated copy of a mesh, its colours mixed with white by `fade` (0: none). */
typedef struct {
  PetscReal shift[2];
  PetscReal fade;
} LamImage;
static inline int LamElementNodes(const PetscInt nodes[9])
{
  return nodes[6] < 0 ? 6 : 9;
}
typedef struct {
  PetscInt element_count;
  const PetscReal *x; /* [node][2], borrowed */
  /* [element][9]: corners counter-clockwise, mid-edges, centre; of a triangle six, then -1; borrowed */
  const PetscInt *elements;
  const PetscReal *values; /* [node], or [element] if per_element; borrowed */
  PetscBool per_element;
} LamField;
/* Paints the field, interpolated by the elements' quadratic shape functions, inside the clip of the canvas. */
PetscErrorCode LamFieldPaint(LamCanvas canvas, const LamView *view, const LamField *field, const LamColourRange *range,
                             PetscInt image_count, const LamImage images[]);
/* A scale bar of a round length, at most `width` wide, from (x, y) to the right; `unit_length` is the length of one
   `unit` in world coordinates. Returns the width used, including the label. */
#define LAM_SCALE_BAR 52.0 /* points: half of the narrowest panel of a strip */
double LamScaleBar(LamCanvas canvas, const LamView *view, double x, double y, double width, PetscReal unit_length,
                   const char unit[]);

/* ---- plot_interface.c ---- */
/* Samples along the faces of tissue whose cells can part, at one state, as docs/reference/files.md describes them. */
typedef struct {
  PetscInt faces, points;    /* points of each face */
  PetscReal *from, *to;      /* [face][point][2]; owned */
  PetscReal *gap, *pressure; /* [face][point], apothems and MPa; owned */
  PetscBool has_lamella;
  /* with a lamella [face][point][2], the point that `from` is joined to; [face][point], share of its energy that is
     spent; owned */
  PetscReal *across, *broken;
  PetscReal largest_pressure;
  PetscBool is_open;   /* a gap exceeds LAM_VISIBLE_GAP */
  LamColourRange gaps; /* from 0 to the largest gap */
} LamInterface;
/* Reads the state whose fields are in `group` ("/fields/3"). PETSC_ERR_USER_INPUT if the file lacks them. */
PetscErrorCode LamInterfaceRead(const char path[], const char group[], LamInterface *interface);
PetscErrorCode LamInterfaceDestroy(LamInterface *interface);
LamColour LamGapColour(PetscReal share);
/* Of a lamella of whose energy this share is spent. */
LamColour LamLamellaColour(PetscReal broken);
/* Each draws one periodic image, pressure below the lamella, and gaps with its threads on top. width: of the lamella's
   line, points, without its outlines. */
void LamInterfaceDrawPressure(LamCanvas canvas, const LamView *view, const LamInterface *interface,
                              const PetscReal shift[2], double width);
void LamInterfaceDrawLamella(LamCanvas canvas, const LamView *view, const LamInterface *interface,
                             const PetscReal shift[2], double width);
void LamInterfaceDrawGaps(LamCanvas canvas, const LamView *view, const LamInterface *interface,
                          const PetscReal shift[2]);
/* Legend of ribbons and lamella, from (x, y) to `right`; that of the lamella is in a second row where it has no room.
 */
void LamInterfaceDrawKey(LamCanvas canvas, double x, double y, double right, const LamInterface *interface);

/* ---- plot_strip.c ---- */
/* What pictures of several states share: the window, and the colours of a field and of gaps. */
typedef struct {
  PetscReal box[4];
  LamColourRange range, gaps;
  PetscBool is_open;        /* there are gaps */
  const char *label, *unit; /* of the field; borrowed */
} LamFrame;
/* Draws the colour bars at the right of `outer`; *view: of the rest. */
void LamFrameDraw(LamCanvas canvas, LamRect outer, const LamFrame *frame, LamView *view);
#define LAM_STRIP_PANELS 8
/* The first, the last and the peak of n states, and others evenly between; returns their number. */
PetscInt LamStripChoose(PetscInt n, PetscInt peak, PetscInt chosen[LAM_STRIP_PANELS]);
/* `draw` draws panel k, and writes its title; `key` the legend, below the view. */
typedef struct {
  PetscInt count; /* of panels */
  LamFrame frame;
  PetscErrorCode (*draw)(LamCanvas canvas, const LamView *view, void *ctx, PetscInt k, size_t size, char title[]);
  void (*key)(LamCanvas canvas, const LamView *view, void *ctx);
  void *ctx;
} LamStrip;
PetscErrorCode LamStripDraw(const char output[], const LamStrip *strip);

/* ---- plot_outline.c ---- */
typedef struct {
  PetscInt start, middle, end; /* nodes; the element lies to the left */
  PetscInt group;
  PetscBool boundary; /* no second element of the group has this edge */
  PetscInt element;   /* the one to its left */
} LamEdge;
typedef struct {
  PetscInt edge_count;
  LamEdge *edges; /* each edge once, boundary edges first; owned */
  PetscInt loop_count;
  PetscInt *loop_start; /* [loop_count + 1], into loop_edges; owned */
  PetscInt *loop_edges; /* closed loops of boundary edges, in order; owned */
} LamOutline;
/* `groups` [element]: edges between elements of different groups are boundaries of both; NULL: one group. */
PetscErrorCode LamOutlineCreate(PetscInt element_count, const PetscInt elements[], const PetscInt groups[],
                                LamOutline *outline);
PetscErrorCode LamOutlineDestroy(LamOutline *outline);
/* Signed area inside loop `loop` at positions x: negative for holes (lumens). */
PetscReal LamOutlineLoopArea(const LamOutline *outline, PetscInt loop, const PetscReal x[]);
/* Adds one curved edge (joined: continues from the current point), a loop, or the edges between elements to the
   current path; x: positions of the nodes; shift: NULL for none. */
void LamOutlineEdgePath(LamCanvas canvas, const LamView *view, const LamEdge *edge, const PetscReal x[],
                        const PetscReal shift[2], PetscBool joined);
void LamOutlineLoopPath(LamCanvas canvas, const LamView *view, const LamOutline *outline, PetscInt loop,
                        const PetscReal x[], const PetscReal shift[2]);
void LamOutlineInnerPath(LamCanvas canvas, const LamView *view, const LamOutline *outline, const PetscReal x[]);

/* ---- plot_read.c: PETSC_ERR_USER_INPUT if the dataset is missing or has the wrong shape; caller frees ---- */
PetscErrorCode LamPlotHas(const char path[], const char name[], PetscBool *has); /* numbers of this name */
/* Read rows x columns numbers; a text. */
PetscErrorCode LamPlotReadReals(const char path[], const char name[], PetscInt rows, PetscInt columns,
                                PetscReal **values);
PetscErrorCode LamPlotReadInts(const char path[], const char name[], PetscInt rows, PetscInt columns,
                               PetscInt **values);
PetscErrorCode LamPlotReadText(const char path[], const char name[], char **text);
/* The records of a file, and their tissue; borrowed from the database. */
typedef struct {
  PetscInt n;
  const LamResponse *records;
  const PetscInt64 *keys;
  LamMicrostructure micro;
  LamScales scales;
} LamPlotRecords;
PetscErrorCode LamPlotGetRecords(LamDatabase database, LamPlotRecords *records);
/* Reads points of the plane [count][2] from two or three coordinates each; rows: their number, -1: any. */
PetscErrorCode LamPlotReadPoints(const char path[], const char name[], PetscInt rows, PetscInt *count,
                                 PetscReal **points);
/* Reads elements [count][9] with node numbers below node_count; a triangle has six, then -1 (in a file of triangles
   alone the dataset has six columns). */
PetscErrorCode LamPlotReadElements(const char path[], const char name[], PetscInt node_count, PetscInt *count,
                                   PetscInt **elements);

/* ---- plot_curves.c ---- */
/* The load axis of a curve over states: the varying quantity, or the state number. */
typedef struct {
  char label[32];
  const char *unit; /* NULL: none */
  PetscBool whole;
  int component; /* it is this one of F; -1: something else */
} LamLoadAxis;
/* values [n]: the load parameter of each state; keys are the state numbers. */
PetscErrorCode LamLoadAxisChoose(PetscInt n, const LamResponse records[], const PetscInt64 keys[],
                                 const LamScales *scales, LamLoadAxis *axis, PetscReal values[]);
/* The state at which the stress along the way of F has risen most since the first response, (P - P1) : (F - F1) over
   ‖F - F1‖; -1: it does not rise. */
PetscInt LamStressPeak(PetscInt n, const LamResponse records[]);
/* Effective stresses P11, P12, P21, P22 over the states, inside `outer`, with bioyield and peak of the test's curve if
   it is over the same component. */
PetscErrorCode LamStressChart(LamCanvas canvas, LamRect outer, PetscInt n, const LamResponse records[],
                              const PetscInt64 keys[], const LamScales *scales, const LamTest *test);

/* ---- one picture per kind of file ---- */
/* Every picture is as wide as a journal page. */
#define LAM_PLOT_WIDTH 504.0
#define LAM_PLOT_HEIGHT 252.0
enum { LAM_PLOT_PEAK = -1, LAM_PLOT_LAST = -2 };
typedef struct {
  const char *input, *output;
  PetscInt state;    /* a number, or one of LAM_PLOT_PEAK, LAM_PLOT_LAST */
  const char *field; /* NULL: the default for the kind of file */
  PetscBool strip;   /* several states beside each other */
  PetscBool film;  /* for a process: all states whose cells are in the file, each on its own page or in its own file */
  const char *map; /* for a process: the file of a map on which its path is drawn; NULL: none */
  /* of a slice through a table, as given by the user; NULL, 0: chosen */
  const char *angle, *suction, *turgor;
  PetscReal accuracy;
  LamReporter reporter; /* progress of a film, in frames */
} LamPlotRequest;
PetscErrorCode LamPlotRVE(const LamPlotRequest *request);
PetscErrorCode LamPlotFE2(const LamPlotRequest *request);
PetscErrorCode LamPlotProcess(const LamPlotRequest *request);
PetscErrorCode LamPlotDatabase(const LamPlotRequest *request);
PetscErrorCode LamPlotMap(const LamPlotRequest *request);
/* Name i of a field that such a picture may show (that of a process the fields of RVE states), NULL beyond the last. */
const char *LamPlotRVEField(size_t i);
const char *LamPlotFE2Field(size_t i);
const char *LamPlotDatabaseField(size_t i);
const char *LamPlotMapField(size_t i);

#endif
