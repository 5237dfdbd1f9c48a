/*
  The table of keys of scene files.
*/
#include "scene_keys.h"
#include "quantity_text.h"
#include <string.h>

const char *const LamDiscPartNames[] = {LAM_DISC_PARTS(LAM_NAME_ENTRY)};
const char *const LamOutsideNames[] = {LAM_OUTSIDES(LAM_NAME_ENTRY)};
const char *const LamTissueFieldNames[] = {LAM_TISSUE_FIELDS(LAM_NAME_ENTRY)};
const char *const LamBoundaryKindNames[] = {LAM_BOUNDARY_KINDS(LAM_NAME_ENTRY)};
const char *const LamSideNames[] = {LAM_SIDES(LAM_NAME_ENTRY)};
const char *const LamChangingNames[] = {LAM_CHANGING(LAM_NAME_ENTRY)};
const char *const LamMapQuantityNames[] = {LAM_MAP_QUANTITIES(LAM_NAME_ENTRY)};
static const char *const kinetic_law_names[] = {LAM_KINETIC_LAWS(LAM_NAME_ENTRY)};
static const char *const spacing_names[] = {LAM_SPACINGS(LAM_NAME_ENTRY)};
static const char *const turgor_mode_names[] = {LAM_TURGOR_MODES(LAM_NAME_ENTRY)};

#define MAP(key_path) .path = key_path, .type = LAM_KEY_MAP
#define LIST(key_path) .path = key_path, .type = LAM_KEY_LIST
#define LENGTH(key_path, key_unit)                                                                                     \
  .path = key_path, .type = LAM_KEY_QUANTITY, .dimension = LAM_DIMENSION_LENGTH, .unit = key_unit
#define STRESS(key_path) .path = key_path, .type = LAM_KEY_QUANTITY, .dimension = LAM_DIMENSION_STRESS, .unit = "MPa"
#define ANGLE(key_path) .path = key_path, .type = LAM_KEY_QUANTITY, .dimension = LAM_DIMENSION_ANGLE, .unit = "deg"
#define OF_DIMENSION(key_path, key_dimension, key_unit)                                                                \
  .path = key_path, .type = LAM_KEY_QUANTITY, .dimension = LAM_DIMENSION_##key_dimension, .unit = key_unit
#define TIME(key_path) OF_DIMENSION(key_path, TIME, "s")
#define TEMPERATURE(key_path) OF_DIMENSION(key_path, TEMPERATURE, "degC")
#define RATE(key_path) OF_DIMENSION(key_path, RATE, "/s")
#define MOLAR_ENERGY(key_path) OF_DIMENSION(key_path, MOLAR_ENERGY, "kJ/mol")
#define PERMEABILITY(key_path) OF_DIMENSION(key_path, PERMEABILITY, "m/s/MPa")
#define REAL(key_path) .path = key_path, .type = LAM_KEY_REAL
#define INTEGER(key_path) .path = key_path, .type = LAM_KEY_INTEGER
#define BOOL(key_path) .path = key_path, .type = LAM_KEY_BOOL
#define TEXT(key_path) .path = key_path, .type = LAM_KEY_TEXT
#define TENSOR(key_path) .path = key_path, .type = LAM_KEY_TENSOR
#define STRESS_TENSOR(key_path)                                                                                        \
  .path = key_path, .type = LAM_KEY_QUANTITY_TENSOR, .dimension = LAM_DIMENSION_STRESS, .unit = "MPa"
#define NAME(key_path, list)                                                                                           \
  .path = key_path, .type = LAM_KEY_NAME, .names = list, .name_count = PETSC_STATIC_ARRAY_LENGTH(list)
#define NAME_OF(key_path, list, count) .path = key_path, .type = LAM_KEY_NAME, .names = list, .name_count = count
#define REQUIRED .required = PETSC_TRUE
#define FREE .free_word = "free"
#define OPEN .free_word = "x"
#define ABOVE(x) .lower = {LAM_BOUND_EXCLUDED, x}
#define FROM(x) .lower = {LAM_BOUND_INCLUDED, x}
#define TO(x) .upper = {LAM_BOUND_INCLUDED, x}
#define BELOW(x) .upper = {LAM_BOUND_EXCLUDED, x}

#define CHOSEN "chosen for the wanted accuracy"
#define OWN "that of the scene's own cell"
#define AS_RVE "as in `rve`"

/* A field is an expression or a table; `expression` and `table` are texts, read by muParser and as a file. */
#define TISSUE_FIELD(field, sample, expression_sample, unit_sample, words)                                             \
  {MAP("macro.fields." field), .default_words = "does not vary", .example = sample, .help = words},                    \
      {TEXT("macro.fields." field ".expression"), .default_words = "none: a table instead",                            \
       .example = expression_sample, .help = "Its number in the unit, of x and y in mm."},                             \
      {TEXT("macro.fields." field ".table"), .default_words = "none: an expression instead", .example = field ".csv",  \
       .help = "File beside the scene: a line of names, then lines x, y, value with the positions of a grid in mm."},  \
  {                                                                                                                    \
    TEXT("macro.fields." field ".unit"), REQUIRED, .example = unit_sample, .help = "Unit of its numbers."              \
  }

/* The axes of a map are alike. `from` and `to` have the unit of the quantity, so they are read as text. */
#define MAP_AXIS(axis, sample)                                                                                         \
  {MAP("map." axis), REQUIRED, .example = sample, .help = "The axis " axis "."},                                       \
      {NAME("map." axis ".quantity", LamMapQuantityNames), REQUIRED, .example = "turgor",                              \
       .help = "What varies. `shear` (F12) and `load_factor` (0 to 1) say how far the load is followed, the others "   \
               "replace what the scene says."},                                                                        \
      {TEXT("map." axis ".from"), REQUIRED, .example = "0 MPa",                                                        \
       .help = "The first value, with the unit of the quantity; `shear` and `load_factor` are plain numbers."},        \
      {TEXT("map." axis ".to"), REQUIRED, .example = "0.3 MPa", .help = "The last value; larger than `from`."},        \
      {INTEGER("map." axis ".points"),                                                                                 \
       REQUIRED,                                                                                                       \
       FROM(2),                                                                                                        \
       TO(1000),                                                                                                       \
       .example = "13",                                                                                                \
       .help = "Number of values, the ends included."},                                                                \
  {                                                                                                                    \
    NAME("map." axis ".spacing", spacing_names), .default_value = "linear", .example = "log",                          \
                                                 .help = "`linear`: equal differences; `log`: equal ratios."           \
  }

const LamKey LamKeys[] = {
    {MAP(""), .example = "version: 1", .help = "The scene."},
    {INTEGER("version"), REQUIRED, FROM(1), TO(1), .example = "1", .help = "Version of the scene format."},

    {MAP("rve"), REQUIRED, .example = "{cell: {...}, wall: {...}}",
     .help = "The representative volume element: whole hexagonal cells that repeat periodically, or a patch of them."},
    {MAP("rve.cell"), REQUIRED, .example = "{apothem: 75 um, wall_thickness: 11.25 um}", .help = "One cell."},
    {LENGTH("rve.cell.apothem", "um"), REQUIRED, ABOVE(0), .example = "75 um",
     .help = "Distance a from the centre of the hexagon to the middle lamella."},
    {LENGTH("rve.cell.wall_thickness", "um"), REQUIRED, ABOVE(0), .example = "11.25 um",
     .help = "Thickness t of one cell's wall, less than the apothem; two lumens are 2t apart."},
    {ANGLE("rve.cell.orientation"), FROM(-360), TO(360), .default_value = "0 deg", .example = "30 deg",
     .help = "Angle of face normal 0 to the X1 axis; the other normals follow at 60 deg."},
    {INTEGER("rve.cells"), .size = 2, FROM(1), TO(64), .default_value = "[1, 1]", .example = "[2, 2]",
     .help = "Cells in one period along lattice vectors 0 and 1."},
    {MAP("rve.patch"), .example = "{columns: 6, rows: 6, sides: affine}",
     .help =
         "A block of cells between grips instead of `rve.cells`: the outer walls of its bottom and top rows follow F. "
         "It is a body, no material point: solved by `rve` and `map`, without `sample` and `macro`."},
    {INTEGER("rve.patch.columns"), REQUIRED, FROM(1), TO(64), .example = "6", .help = "Cells in a row, along X1."},
    {INTEGER("rve.patch.rows"), REQUIRED, FROM(1), TO(64), .example = "6", .help = "Rows of cells, along X2."},
    {NAME_OF("rve.patch.sides", LamPatchSidesNames, LAM_PATCH_SIDES_COUNT), .default_value = "affine",
     .example = "free",
     .help =
         "Whether the lateral outer walls follow F, too (`affine`), or are left `free`. Free sides need law `bonded` "
         "or a cohesion: nothing else holds the outer cells between the grips."},
    {MAP("rve.wall"), REQUIRED, .example = "{law: mooney_rivlin, C1: 0.1 MPa, C2: 0.01 MPa}",
     .help = "Material of the cell walls. The small-strain shear modulus without fibres is C1 + C2."},
    {NAME_OF("rve.wall.law", LamWallLawNames, LAM_WALL_LAW_COUNT), REQUIRED, .example = "fibre_mooney_rivlin",
     .help = "`fibre_mooney_rivlin`: Mooney-Rivlin with fibres along the wall; `mooney_rivlin`: without fibres."},
    {STRESS("rve.wall.C1"), REQUIRED, ABOVE(0), .example = "0.1 MPa", .help = "First Mooney-Rivlin modulus."},
    {STRESS("rve.wall.C2"), REQUIRED, FROM(0), .example = "0.01 MPa", .help = "Second Mooney-Rivlin modulus."},
    {STRESS("rve.wall.C4"), FROM(0), .default_words = "none: required by law `fibre_mooney_rivlin`", .example = "1 MPa",
     .help = "Fibre modulus; only with law `fibre_mooney_rivlin`."},
    {STRESS("rve.wall.bulk_modulus"), ABOVE(0), .default_words = "1000 (C1 + C2)", .example = "110 MPa",
     .help = "Bulk modulus, larger than C1 + C2: walls are nearly incompressible."},
    {NAME_OF("rve.wall.fibres", LamFibresNames, LAM_FIBRES_COUNT), .default_value = "both", .example = "tension",
     .help = "Whether fibres also resist compression along the wall (`both`) or stretch alone (`tension`)."},
    {MAP("rve.variation"), .default_words = "all cells alike",
     .example = "{kinds: [{turgor: 0.5}], pattern: [[0, 1], [1, 0]]}",
     .help = "Cells that differ: `kinds` with one of `list`, `pattern` and `random`, or a `field`. Cell (i, j) is the "
             "j-th along lattice vector 1, or row of a patch, of the i-th along lattice vector 0, or column."},
    {LIST("rve.variation.kinds"), .example = "[{wall_thickness: 8 um, turgor: 0.5}]",
     .help = "Kinds 1, 2, ... of cells; kind 0 is the scene's own cell."},
    {MAP("rve.variation.kinds[]"), .example = "{wall_thickness: 8 um, turgor: 0.5}",
     .help = "One kind; what it leaves out is that of the scene's own cell."},
    {MAP("rve.variation.kinds[].wall"), .example = "{C1: 0.05 MPa}", .help = "Its wall, as `rve.wall`."},
    {NAME_OF("rve.variation.kinds[].wall.law", LamWallLawNames, LAM_WALL_LAW_COUNT), .default_words = OWN,
     .example = "mooney_rivlin", .help = "Law of its wall."},
    {STRESS("rve.variation.kinds[].wall.C1"), ABOVE(0), .default_words = OWN, .example = "0.05 MPa",
     .help = "First Mooney-Rivlin modulus."},
    {STRESS("rve.variation.kinds[].wall.C2"), FROM(0), .default_words = OWN, .example = "0.005 MPa",
     .help = "Second Mooney-Rivlin modulus."},
    {STRESS("rve.variation.kinds[].wall.C4"), FROM(0), .default_words = OWN, .example = "0.5 MPa",
     .help = "Fibre modulus."},
    {STRESS("rve.variation.kinds[].wall.bulk_modulus"), ABOVE(0), .default_words = OWN ", in proportion to C1 + C2",
     .example = "55 MPa", .help = "Bulk modulus."},
    {NAME_OF("rve.variation.kinds[].wall.fibres", LamFibresNames, LAM_FIBRES_COUNT), .default_words = OWN,
     .example = "tension", .help = "Which fibres resist."},
    {LENGTH("rve.variation.kinds[].wall_thickness", "um"), ABOVE(0), .default_words = OWN, .example = "8 um",
     .help = "Thickness of its wall, less than the apothem."},
    {REAL("rve.variation.kinds[].turgor"), FROM(0), TO(1000), .default_value = "1", .example = "0.5",
     .help = "Its turgor over that of the load."},
    {REAL("rve.variation.kinds[].cohesion"), FROM(0), TO(1000), .default_value = "1", .example = "0.8",
     .help = "Its cohesion over that of the load; between two cells the smaller one holds. Only with law `contact`."},
    {LIST("rve.variation.list"), .example = "[0, 1, 1, 0]",
     .help = "The kind of each cell, in the order (0, 0), (0, 1), ..., (1, 0), ..."},
    {INTEGER("rve.variation.list[]"), FROM(0), .example = "1", .help = "Kind of one cell."},
    {LIST("rve.variation.pattern"), .example = "[[0, 1], [1, 0]]",
     .help = "Kinds that repeat over the block: cell (i, j) has entry j of entry i, counted from 0 and repeated."},
    {LIST("rve.variation.pattern[]"), .example = "[0, 1]", .help = "All of the same length."},
    {INTEGER("rve.variation.pattern[][]"), FROM(0), .example = "1", .help = "Kind of one cell."},
    {MAP("rve.variation.random"), .example = "{shares: [0.2], seed: 7}",
     .help = "Kinds dealt out at random, the same on every machine."},
    {LIST("rve.variation.random.shares"), REQUIRED, .example = "[0.2]",
     .help = "The share of each kind in all cells, rounded to whole cells; the rest are the scene's own."},
    {REAL("rve.variation.random.shares[]"), FROM(0), TO(1), .example = "0.2", .help = "Share of one kind."},
    {INTEGER("rve.variation.random.seed"), FROM(0), TO(999999999), .default_value = "1", .example = "7",
     .help = "Another number deals them out differently."},
    {MAP("rve.variation.field"), .example = "{wall_thickness: 0.1, turgor: 0.3, seed: 7}",
     .help =
         "Every cell differs: independent lognormal factors with mean 1, given by their coefficients of variation."},
    {REAL("rve.variation.field.wall"), FROM(0), TO(1), .default_value = "0", .example = "0.2",
     .help = "Of all moduli of a cell's wall together."},
    {REAL("rve.variation.field.wall_thickness"), FROM(0), TO(1), .default_value = "0", .example = "0.1",
     .help = "Of its thickness."},
    {REAL("rve.variation.field.turgor"), FROM(0), TO(1), .default_value = "0", .example = "0.3",
     .help = "Of its turgor."},
    {REAL("rve.variation.field.cohesion"), FROM(0), TO(1), .default_value = "0", .example = "0.3",
     .help = "Of its cohesion; only with law `contact`."},
    {REAL("rve.variation.field.correlation"), FROM(0), TO(20), .default_value = "0", .example = "2",
     .help = "Correlation length l in distances of neighbours: the logarithms of the factors of two cells r apart have "
             "about the correlation exp(-(r/l)^2). 0: cells independent of each other."},
    {INTEGER("rve.variation.field.seed"), FROM(0), TO(999999999), .default_value = "1", .example = "7",
     .help = "Another number gives other cells."},
    {MAP("rve.interface"), .example = "{law: bonded}", .help = "The middle lamella between the cells."},
    {NAME_OF("rve.interface.law", LamInterfaceLawNames, LAM_INTERFACE_LAW_COUNT), .default_value = "bonded",
     .example = "contact", .help = "`bonded`: cells never part; `contact`: they may part and slide without friction."},
    {STRESS("rve.interface.cohesion"), FROM(0), .default_value = "0 MPa", .example = "0.001 MPa",
     .help = "Normal traction that parts the cells; only with law `contact`."},
    {LENGTH("rve.interface.clearance", "um"), FROM(0), .default_value = "0 um", .example = "0.1 um",
     .help =
         "Distance between facing walls at rest: each cell is smaller than its place by half of it all around; only "
         "with law `contact`."},
    {MAP("rve.turgor"), .example = "{mode: prescribed, pressure: 0.02 MPa}", .help = "Pressure in the lumens."},
    {NAME("rve.turgor.mode", turgor_mode_names), .default_words = "`prescribed` where a pressure is given, else `none`",
     .example = "prescribed",
     .help =
         "`prescribed`: the pressure is given; `sealed`: each cell keeps the water that it has at F = I under that "
         "pressure (in `fe2` with `macro.inflate`: in the inflated body), and its pressure follows. `build` tabulates "
         "prescribed turgor alone."},
    {STRESS("rve.turgor.pressure"), .default_words = "none: required by modes `prescribed` and `sealed`",
     .example = "0.02 MPa", .help = "Turgor of the tissue; negative is suction."},
    {STRESS("rve.turgor.water_bulk_modulus"), ABOVE(0), .default_value = "2200 MPa", .example = "2.2 GPa",
     .help = "How water in sealed cells resists compression; only with mode `sealed`."},
    {MAP("rve.mesh"), .default_words = CHOSEN, .example = "{along: 6, through: 2}",
     .help = "Finite elements of one cell."},
    {INTEGER("rve.mesh.along"), FROM(1), TO(200), .default_words = CHOSEN, .example = "6",
     .help = "Elements along one face."},
    {INTEGER("rve.mesh.through"), FROM(1), TO(50), .default_words = CHOSEN, .example = "2",
     .help = "Elements through one wall."},
    {REAL("rve.mesh.grading"), FROM(0), BELOW(1),
     .default_words = "chosen for the accuracy where `along` is; else 0: elements are alike", .example = "0.6",
     .help = "How much smaller elements at the ends of a face, where stresses are singular, are than in its middle: "
             "about 1 - grading to 1 + grading."},
    {TEXT("rve.mesh.measured"), .default_words = "the program's own figures", .example = "tradeoff/model.json",
     .help =
         "File of errors that `lamella tradeoff` has measured for this tissue: what is left open of the mesh is the "
         "cheapest of those that meets the accuracy."},
    {REAL("rve.tolerance"), ABOVE(0), TO(0.1), .default_words = "rounding", .example = "1e-6",
     .help =
         "Where Newton iterations of the RVE end: residual (forces over (C1 + C2) apothem) and violation of contact. "
         "Not below rounding."},
    {NAME_OF("rve.strategy", LamStrategyNames, LAM_STRATEGY_COUNT), .default_value = "two_step", .example = "two_step",
     .help = "How contact is reached: from the bonded state (`two_step`) or at once (`one_step`). No effect on bonded "
             "tissue."},

    {MAP("strength"), .default_words = "not known: no verdict that needs it",
     .example = "{wall: 0.5 MPa, lamella_normal: 0.02 MPa, lamella_shear: 0.05 MPa}",
     .help = "What the tissue bears, for `lamella rve --failure`."},
    {STRESS("strength.wall"), ABOVE(0), .default_words = "not known", .example = "0.5 MPa",
     .help =
         "Tension of a wall at which it tears: Cauchy stress along it plus the turgor of its cell, averaged over the "
         "wall's thickness and as long a stretch."},
    {STRESS("strength.lamella_normal"), ABOVE(0), .default_words = "not known", .example = "0.02 MPa",
     .help = "Normal traction, averaged over one wall thickness, that parts bonded cells; contact has its cohesion."},
    {STRESS("strength.lamella_shear"), ABOVE(0), .default_words = "not known", .example = "0.05 MPa",
     .help = "Shear traction, likewise, that parts bonded cells."},

    {LIST("load"), .example = "[{F: [[1, 0.1], [0, 1]]}]",
     .help = "States for `lamella rve`, numbered from 1, each starting from the one before."},
    {MAP("load[]"), .example = "{F: [[1, 0.1], [0, 1]]}", .help = "One state (`F`) or several (`ramp`)."},
    {TENSOR("load[].F"), FREE, FROM(-100), TO(100), .example = "[[1, 0.1], [0, 1]]",
     .help = "Deformation gradient, rows first. 2x2: plane strain; 3x3: with F33 > 0, out-of-plane shears 0. Its "
             "determinant is positive. `free` where `P` is given instead; F12 and F21 not both."},
    {STRESS_TENSOR("load[].P"), OPEN, .example = "[[0 MPa, x], [x, 0 MPa]]",
     .help = "Mixed control: the components of the first Piola-Kirchhoff stress that are given, `x` where `F` is. 2x2: "
             "P33 is not."},
    {MAP("load[].ramp"), .example = "{to: [[1, 0.3], [0, 1]], steps: 10}",
     .help = "A straight path from the state before (undeformed at the start), one state per step."},
    {TENSOR("load[].ramp.to"), REQUIRED, FREE, FROM(-100), TO(100), .example = "[[1, 0.3], [0, 1]]",
     .help = "Deformation gradient at the end of the ramp, as `F`."},
    {STRESS_TENSOR("load[].ramp.P"), OPEN, .example = "[[0 MPa, x], [x, 0 MPa]]",
     .help =
         "Stress at the end of the ramp, as `P`; it goes straight from the one prescribed before, from 0 where none "
         "was."},
    {INTEGER("load[].ramp.steps"), REQUIRED, FROM(1), TO(10000), .example = "10", .help = "Equal steps."},
    {STRESS("load[].turgor"), .default_words = "`rve.turgor.pressure`", .example = "0.05 MPa",
     .help = "Turgor of this entry's states."},
    {STRESS("load[].cohesion"), FROM(0), .default_words = "`rve.interface.cohesion`", .example = "0.001 MPa",
     .help = "Cohesion of this entry's states; only with law `contact`."},

    {MAP("sample"), .example = "{stretch: {min: -0.05, max: 0.25}}",
     .help = "States for `lamella build`: a box of deformations and turgor, to be answered by a table."},
    {MAP("sample.stretch"), REQUIRED, .example = "{min: -0.05, max: 0.25}",
     .help = "Principal logarithmic strains in the plane."},
    {REAL("sample.stretch.min"), REQUIRED, FROM(-2), TO(2), .example = "-0.05", .help = "Smallest."},
    {REAL("sample.stretch.max"), REQUIRED, FROM(-2), TO(2), .example = "0.25", .help = "Largest; not below `min`."},
    {MAP("sample.turgor"), .default_words = "the scene's turgor alone", .example = "{min: 0 MPa, max: 0.05 MPa}",
     .help = "Turgor."},
    {STRESS("sample.turgor.min"), REQUIRED, .example = "0 MPa", .help = "Smallest."},
    {STRESS("sample.turgor.max"), REQUIRED, .example = "0.05 MPa", .help = "Largest; not below `min`."},
    {INTEGER("sample.count"), FROM(1), TO(100000000), .default_words = "as many as the accuracy needs",
     .example = "1000", .help = "Number of nodes of the table; those where it is least accurate come first."},
    {REAL("sample.accuracy"), ABOVE(0), TO(0.5), .default_words = "the scene's `accuracy`", .example = "0.01",
     .help = "Add nodes until the estimated error is below this; instead of `count`."},
    {INTEGER("sample.round"), FROM(1), TO(1000000), .default_value = "32", .example = "1000",
     .help = "Nodes that are begun together, at least. More keep more ranks busy, but are chosen from an older table."},

    {MAP("macro"), .example = "{mesh: {...}, boundary: [...]}", .help = "The body for `lamella fe2`, in plane strain."},
    {MAP("macro.mesh"), REQUIRED, .example = "{box: [10 mm, 10 mm], elements: [8, 8]}", .help = "Its mesh."},
    {LENGTH("macro.mesh.box", "mm"), .size = 2, ABOVE(0), .default_words = "none: one of `box`, `disc`, `gmsh`",
     .example = "[10 mm, 10 mm]",
     .help = "Edges of a rectangular block along X1 and X2; its corner is the origin. Its sides are `left`, `right`, "
             "`bottom`, `top`."},
    {LENGTH("macro.mesh.disc", "mm"), ABOVE(0), .default_words = "none: one of `box`, `disc`, `gmsh`",
     .example = "5 mm",
     .help = "Radius of a disc about the origin. Its sides are `rim` and, of a part, `bottom` (X2 = 0) and `left` "
             "(X1 = 0)."},
    {NAME("macro.mesh.part", LamDiscPartNames), .default_value = "whole", .example = "quarter",
     .help = "Of a disc: `whole`, `half` (X2 >= 0) or `quarter` (X1 >= 0, too)."},
    {INTEGER("macro.mesh.elements"), .size = 2, FROM(1), TO(1000),
     .default_words = "none: required with `box` and `disc`", .example = "[8, 8]",
     .help = "Quadratic elements: of a box along X1 and X2; of a disc along an eighth of the rim, and from the rim to "
             "the square in its middle, half as wide."},
    {TEXT("macro.mesh.gmsh"), .default_words = "none: one of `box`, `disc`, `gmsh`", .example = "fruit.msh",
     .help =
         "A Gmsh file, its path relative to the scene's folder: triangles and quadrilaterals in the plane, straight "
         "or quadratic. Physical curves and points are boundaries, physical surfaces are regions, by their names."},
    {LENGTH("macro.mesh.unit", "mm"), ABOVE(0), .default_value = "1 mm", .example = "1 cm",
     .help = "Unit of length of the Gmsh file."},
    {LIST("macro.boundary"), REQUIRED, .example = "[{on: bottom, displacement: [0 mm, 0 mm]}]",
     .help =
         "What acts on the sides; each entry is one of `displacement`, `symmetry`, `traction`, `pressure`, `plate`, "
         "`indenter` and `grip`. A side may have several that do not contradict each other. Displacements, "
         "symmetry and grips together hold the body against rigid motion; obstacles do not count."},
    {MAP("macro.boundary[]"), .example = "{on: bottom, displacement: [0 mm, 0 mm]}", .help = "One condition."},
    {TEXT("macro.boundary[].on"), REQUIRED, .example = "bottom",
     .help = "The name of a side of the box or disc, or of a physical group of the Gmsh file."},
    {TEXT("macro.boundary[].name"), .default_words = "that of the side", .example = "upper plate",
     .help = "The name under which its force is reported."},
    {LENGTH("macro.boundary[].displacement", "mm"), .size = 2, FREE, .example = "[0 mm, free]",
     .help = "At load parameter 1, along X1 and X2; `free` leaves a component. All displacements count from the "
             "inflated state."},
    {BOOL("macro.boundary[].symmetry"), .example = "true",
     .help = "The side, which is straight, does not move along its normal, also while the body inflates."},
    {STRESS("macro.boundary[].traction"), .size = 2, .example = "[0 MPa, 0.01 MPa]",
     .help = "Force per reference area at load parameter 1, along X1 and X2. With `follower`: per present area, along "
             "the present tangent (the outward normal turned by +90 deg) and the present outward normal."},
    {BOOL("macro.boundary[].follower"), .default_value = "false", .example = "true",
     .help = "Whether `traction` turns with the side."},
    {STRESS("macro.boundary[].pressure"), .example = "0.01 MPa",
     .help = "At load parameter 1, against the present outward normal, per present area."},
    {MAP("macro.boundary[].plate"), .example = "{displacement: [0 mm, -1 mm]}",
     .help = "A rigid, flat, frictionless plate that first touches the side and may leave it and come back."},
    {LENGTH("macro.boundary[].plate.displacement", "mm"), .size = 2, REQUIRED, .example = "[0 mm, -1 mm]",
     .help = "Of the plate at load parameter 1; only its part along the normal matters."},
    {REAL("macro.boundary[].plate.normal"), .size = 2, .default_words = "that of the side, where this is straight",
     .example = "[0, -1]", .help = "From the plate into the body."},
    {MAP("macro.boundary[].indenter"), .example = "{radius: 2 mm, at: [5 mm, 10 mm], displacement: [0 mm, -1 mm]}",
     .help = "A rigid, round, frictionless indenter that first touches the side and may leave it and come back."},
    {LENGTH("macro.boundary[].indenter.radius", "mm"), REQUIRED, ABOVE(0), .example = "2 mm", .help = "Its radius."},
    {LENGTH("macro.boundary[].indenter.at", "mm"), .size = 2, REQUIRED, .example = "[5 mm, 10 mm]",
     .help = "A point on the line along which its centre moves, such as the point of the side that it touches first."},
    {LENGTH("macro.boundary[].indenter.displacement", "mm"), .size = 2, REQUIRED, .example = "[0 mm, -1 mm]",
     .help = "At load parameter 1; not zero: it is the direction from which the indenter comes."},
    {LENGTH("macro.boundary[].grip", "mm"), .size = 2, FREE, .example = "[1 mm, free]",
     .help = "A rigid grip: all points of the side move alike. A `free` component bears no total force."},
    {LIST("macro.boundary[].history"), .default_words = "the load parameter itself",
     .example = "[[0, 0], [1, 1], [2, 1]]",
     .help =
         "By which factor the entry's displacement, traction or pressure is multiplied: pairs of load parameter and "
         "factor, straight in between, constant beyond."},
    {REAL("macro.boundary[].history[]"), .size = 2, .example = "[1, 0.5]", .help = "Load parameter and factor."},
    {MAP("macro.control"), .default_words = "tractions follow their histories",
     .example = "{on: top, displacement: [free, -1 mm]}",
     .help = "Prescribes the mean displacement of a side instead of the tractions, whose common factor is found: past "
             "the largest load, too."},
    {TEXT("macro.control.on"), REQUIRED, .example = "top", .help = "The side."},
    {LENGTH("macro.control.displacement", "mm"), .size = 2, REQUIRED, FREE, .example = "[free, -1 mm]",
     .help = "Its mean displacement at load parameter 1: one component, the other one `free`."},
    {BOOL("macro.inflate"), .default_words = "true with turgor, else false", .example = "true",
     .help = "First bring turgor up with only rigid motions held; displacements then count from there. With law "
             "`contact` it needs a cohesion: nothing else holds free tissue together."},
    {INTEGER("macro.steps"), FROM(1), TO(10000), .default_words = "10; with `program`: that of its parts",
     .example = "10", .help = "Equal steps of the load parameter from 0 to 1, after inflation."},
    {LIST("macro.program"), .default_words = "one ramp from 0 to 1",
     .example = "[{to: 1, steps: 10}, {to: 0, steps: 10}]",
     .help = "Ramps of the load parameter, which begins at 0, instead of `steps`."},
    {MAP("macro.program[]"), .example = "{to: 1, steps: 10}", .help = "One ramp."},
    {REAL("macro.program[].to"), REQUIRED, FROM(-1000), TO(1000), .example = "1", .help = "Load parameter at its end."},
    {INTEGER("macro.program[].steps"), REQUIRED, FROM(1), TO(10000), .example = "10", .help = "Its equal steps."},
    {INTEGER("macro.repeat"), FROM(1), TO(1000), .default_value = "1", .example = "3",
     .help = "How often `program` is gone through."},
    {LIST("macro.zoom"), .default_words = "where the tissue is nearest to failure, and the middle",
     .example = "[[5 mm, 5 mm], [9 mm, 9 mm]]",
     .help = "Places, at most three, at whose nearest material points the microstructure is kept for pictures."},
    {LENGTH("macro.zoom[]", "mm"), .size = 2, .example = "[5 mm, 5 mm]", .help = "Position in the undeformed body."},

    {MAP("macro.response"), .default_words = "as below", .example = "{outside: stop, accuracy: 0.003}",
     .help = "How material points are answered."},
    {NAME("macro.response.outside", LamOutsideNames), .default_value = "solve", .example = "stop",
     .help = "What a cache does with a state that no node of its table would answer: `solve` it, and add it to the "
             "database, or `stop` the run where smaller steps do not avoid it."},
    {REAL("macro.response.accuracy"), ABOVE(0), TO(0.5),
     .default_words = "the scene's `accuracy`; a tenth of it where a cache answers for cells in contact with 12 or "
                      "more elements along "
                      "a face",
     .example = "0.001", .help = "Relative error of P that an answer from a database may have by its estimate."},
    {TEXT("macro.response.warm_start_memory"), .default_words = "2 GB", .example = "500 MB",
     .help = "Memory of a rank for the states from which direct solves start; material points that find no room start "
             "from the reference."},
    {LIST("macro.regions"), .default_words = "one tissue",
     .example = "[{name: skin, where: y > 9, cell: {wall_thickness: 20 um}}]",
     .help =
         "Parts of the body whose tissue is another; what an entry leaves out is as in `rve`. Where several cover a "
         "point the last one holds."},
    {MAP("macro.regions[]"), .example = "{name: skin, where: y > 9, cell: {wall_thickness: 20 um}}",
     .help = "One region."},
    {TEXT("macro.regions[].name"), REQUIRED, .example = "skin",
     .help = "Its name, of letters, digits, - and _: also of its database, DB.skin.h5."},
    {TEXT("macro.regions[].where"), .default_words = "the mesh's physical group of this name", .example = "y > 9",
     .help = "Expression of x and y in mm that holds (is not 0) in the region."},
    {MAP("macro.regions[].cell"), .example = "{wall_thickness: 20 um}", .help = "Its cell, as `rve.cell`."},
    {LENGTH("macro.regions[].cell.apothem", "um"), ABOVE(0), .default_words = AS_RVE, .example = "40 um",
     .help = "Apothem."},
    {LENGTH("macro.regions[].cell.wall_thickness", "um"), ABOVE(0), .default_words = AS_RVE, .example = "20 um",
     .help = "Thickness of one cell's wall."},
    {ANGLE("macro.regions[].cell.orientation"), FROM(-360), TO(360), .default_words = AS_RVE, .example = "30 deg",
     .help = "Angle of face normal 0 to the X1 axis."},
    {MAP("macro.regions[].wall"), .example = "{C1: 0.2 MPa}", .help = "Its wall, as `rve.wall`."},
    {NAME_OF("macro.regions[].wall.law", LamWallLawNames, LAM_WALL_LAW_COUNT), .default_words = AS_RVE,
     .example = "mooney_rivlin", .help = "Law of its wall."},
    {STRESS("macro.regions[].wall.C1"), ABOVE(0), .default_words = AS_RVE, .example = "0.2 MPa",
     .help = "First Mooney-Rivlin modulus."},
    {STRESS("macro.regions[].wall.C2"), FROM(0), .default_words = AS_RVE, .example = "0.02 MPa",
     .help = "Second Mooney-Rivlin modulus."},
    {STRESS("macro.regions[].wall.C4"), FROM(0), .default_words = AS_RVE, .example = "2 MPa", .help = "Fibre modulus."},
    {STRESS("macro.regions[].wall.bulk_modulus"), ABOVE(0), .default_words = AS_RVE ", in proportion to C1 + C2",
     .example = "220 MPa", .help = "Bulk modulus."},
    {NAME_OF("macro.regions[].wall.fibres", LamFibresNames, LAM_FIBRES_COUNT), .default_words = AS_RVE,
     .example = "tension", .help = "Whether fibres resist compression."},
    {MAP("macro.regions[].interface"), .example = "{law: bonded}", .help = "Its middle lamella, as `rve.interface`."},
    {NAME_OF("macro.regions[].interface.law", LamInterfaceLawNames, LAM_INTERFACE_LAW_COUNT), .default_words = AS_RVE,
     .example = "bonded", .help = "`bonded` or `contact`."},
    {STRESS("macro.regions[].interface.cohesion"), FROM(0), .default_words = AS_RVE, .example = "0.01 MPa",
     .help = "Cohesion; only with law `contact`."},
    {LENGTH("macro.regions[].interface.clearance", "um"), FROM(0), .default_words = AS_RVE, .example = "0.1 um",
     .help = "Distance between facing walls at rest; only with law `contact`."},
    {MAP("macro.regions[].turgor"), .example = "{pressure: 0.05 MPa}", .help = "Its turgor."},
    {STRESS("macro.regions[].turgor.pressure"), .default_words = AS_RVE, .example = "0.05 MPa", .help = "Pressure."},
    {MAP("macro.regions[].mesh"), .default_words = AS_RVE, .example = "{along: 6, through: 2}",
     .help = "Finite elements of its cell, as `rve.mesh`."},
    {INTEGER("macro.regions[].mesh.along"), FROM(1), TO(200), .default_words = AS_RVE, .example = "6",
     .help = "Elements along one face."},
    {INTEGER("macro.regions[].mesh.through"), FROM(1), TO(50), .default_words = AS_RVE, .example = "2",
     .help = "Elements through one wall."},
    {REAL("macro.regions[].mesh.grading"), FROM(0), BELOW(1), .default_words = AS_RVE, .example = "0.6",
     .help = "How much smaller elements at the ends of a face are."},
    {MAP("macro.fields"), .default_words = "nothing varies", .example = "{orientation: {expression: 3 * x, unit: deg}}",
     .help = "Numbers that vary with the reference position, replacing those of `rve` and `macro.regions`."},
    TISSUE_FIELD("orientation", "{expression: 3 * x, unit: deg}", "3 * x", "deg",
                 "Angle of face normal 0 to the X1 axis."),
    TISSUE_FIELD("turgor", "{table: turgor.csv, unit: MPa}", "0.05 * (1 - y / 10)", "MPa", "Turgor."),
    TISSUE_FIELD("cohesion", "{expression: 0.01 + 0.001 * y, unit: MPa}", "0.01 + 0.001 * y", "MPa",
                 "Cohesion, at least 0, of tissue with law `contact`."),
    TISSUE_FIELD("wall_thickness", "{expression: 11 + 0.2 * y, unit: um}", "11 + 0.2 * y", "um",
                 "Thickness of one cell's wall: a few thicknesses are solved, answers between them blended."),
    {INTEGER("macro.fields.wall_thickness.levels"), FROM(2), TO(8), .default_words = CHOSEN, .example = "5",
     .help = "How many thicknesses of each tissue are solved."},

    {MAP("map"), .example = "{x: {...}, y: {...}}",
     .help = "For `lamella map`: two quantities that vary; at each point the load is followed until the tissue fails."},
    MAP_AXIS("x", "{quantity: turgor, from: 0 MPa, to: 0.3 MPa, points: 13}"),
    MAP_AXIS("y", "{quantity: cohesion, from: 0 MPa, to: 0.05 MPa, points: 11}"),

    {MAP("process"), .example = "{duration: 14 day, kinetics: [...]}",
     .help = "For `lamella process`: tissue that changes in time."},
    {TIME("process.duration"), REQUIRED, ABOVE(0), .example = "14 day", .help = "How long it is followed."},
    {TIME("process.output"), ABOVE(0), .default_words = "a hundredth of the duration", .example = "6 h",
     .help = "Time between the states that are told and written."},
    {REAL("process.tolerance"), FROM(1e-10), TO(0.1), .default_value = "1e-5", .example = "1e-6",
     .help = "Relative error of the integration in a step of time."},
    {BOOL("process.inflate"), .default_words = "true with turgor, else false", .example = "true",
     .help = "First find the tissue free of stress under its turgor; deformation then counts from there. Of a body "
             "`macro.inflate` says it."},
    {REAL("process.opening"), ABOVE(0), BELOW(1), .default_value = "0.01", .example = "0.02",
     .help =
         "What the volume between cells in contact, over that of the tissue, has grown by since the start when they "
         "count as coming apart."},
    {MAP("process.water"), .default_words = "the turgor is prescribed",
     .example = "{permeability: 1e-7 m/s/MPa, osmotic_pressure: 0.8 MPa}",
     .help = "Water passes the membranes of the cells; turgor at the start is that of `rve.turgor`."},
    {PERMEABILITY("process.water.permeability"), REQUIRED, FROM(0), .free_word = "infinite", .example = "1e-7 m/s/MPa",
     .help = "Hydraulic conductivity Lp of a membrane; `infinite`: always in equilibrium."},
    {MOLAR_ENERGY("process.water.activation"), FROM(0), .default_value = "0 kJ/mol", .example = "40 kJ/mol",
     .help = "Activation energy of Lp, which is that of the temperature at the start."},
    {REAL("process.water.reflection"), FROM(0), TO(1), .default_value = "1", .example = "0.9",
     .help = "Reflection coefficient of the membrane for the solutes."},
    {STRESS("process.water.osmotic_pressure"), FROM(0), .default_words = "in equilibrium with turgor and surroundings",
     .example = "0.8 MPa", .help = "Osmotic pressure in the cells at the start."},
    {REAL("process.water.non_osmotic"), FROM(0), BELOW(1), .default_value = "0", .example = "0.1",
     .help = "Share of the lumen at the start that is no solution."},
    {LIST("process.surroundings"), .default_words = "20 degC and pure water",
     .example = "[{time: 0 h, temperature: 20 degC}, {time: 1 h, temperature: 90 degC}]",
     .help =
         "What surrounds the tissue at times: straight in between, constant beyond; a time that is given twice is a "
         "jump."},
    {MAP("process.surroundings[]"), .example = "{time: 0 h, temperature: 20 degC}", .help = "At one time."},
    {TIME("process.surroundings[].time"), REQUIRED, FROM(0), .example = "1 h", .help = "Time, from the start."},
    {TEMPERATURE("process.surroundings[].temperature"), FROM(-270), TO(1000),
     .default_words = "straight between the entries that give it; 20 degC where none does", .example = "90 degC",
     .help = "Temperature of the tissue."},
    {STRESS("process.surroundings[].outside"), FROM(0),
     .default_words = "straight between the entries that give it; 0 MPa where none does", .example = "0.5 MPa",
     .help = "Osmotic pressure outside the cells, such as that of a bath of mannitol."},
    {REAL("process.surroundings[].humidity"), ABOVE(0), TO(1), .default_words = "none: `outside` instead",
     .example = "0.995",
     .help = "Relative humidity of air that the cells are in equilibrium with, instead of `outside`."},
    {STRESS("process.surroundings[].turgor"),
     .default_words = "straight between the entries that give it; that of `rve.turgor` where none does",
     .example = "0.1 MPa", .help = "Turgor, where there is no `water`."},
    {LIST("process.kinetics"), .default_words = "nothing changes",
     .example = "[{of: lamella, law: first_order, rate: 0.1 /day}]", .help = "What changes, each thing once."},
    {MAP("process.kinetics[]"), .example = "{of: lamella, law: first_order, rate: 0.1 /day}",
     .help = "One property, as a factor X(t) of what it is at the start."},
    {NAME("process.kinetics[].of", LamChangingNames), REQUIRED, .example = "lamella",
     .help =
         "`lamella`: cohesion and strengths of the lamella; `walls`: all moduli of the walls; `C1`, `C2`, `C4`: one "
         "of them, besides; `wall_strength`; `solutes` in a cell; `permeability` and `reflection` of its membrane."},
    {NAME("process.kinetics[].law", kinetic_law_names), REQUIRED, .example = "first_order",
     .help = "`first_order`: X' = -k X; `fractional_conversion`: X' = -k (X - plateau), above 1 it stiffens; "
             "`two_fractions`: one decays with k, the other with k2; `autocatalytic`: an enzyme E' = k2 E (1 - E) acts "
             "by X' = -k E (X - plateau); `table`; `constant`."},
    {RATE("process.kinetics[].rate"), FROM(0), .default_words = "none: required by all laws with a rate",
     .example = "0.161 /min", .help = "k at the reference temperature."},
    {RATE("process.kinetics[].second_rate"), FROM(0),
     .default_words = "none: required by `two_fractions` and `autocatalytic`", .example = "0.01 /min",
     .help = "k2 at the reference temperature."},
    {MOLAR_ENERGY("process.kinetics[].activation"), FROM(0), .default_value = "0 kJ/mol", .example = "138 kJ/mol",
     .help = "Activation energy of k (Arrhenius)."},
    {MOLAR_ENERGY("process.kinetics[].second_activation"), FROM(0), .default_words = "that of `activation`",
     .example = "100 kJ/mol", .help = "Activation energy of k2."},
    {TEMPERATURE("process.kinetics[].reference"), FROM(-200), TO(1000), .default_value = "20 degC",
     .example = "100 degC", .help = "The temperature that the rates are given at."},
    {MOLAR_ENERGY("process.kinetics[].deactivation"), ABOVE(0), .default_words = "rates rise with temperature for good",
     .example = "250 kJ/mol", .help = "By it the rates fall again above `half_activity`."},
    {TEMPERATURE("process.kinetics[].half_activity"), FROM(-200), TO(1000),
     .default_words = "none: required with `deactivation`", .example = "35 degC",
     .help = "Temperature at which half of the enzyme has unfolded."},
    {REAL("process.kinetics[].plateau"), FROM(0), .default_words = "none: required by `fractional_conversion`; else 0",
     .example = "0.2", .help = "What X goes to."},
    {REAL("process.kinetics[].share"), ABOVE(0), BELOW(1), .default_words = "none: required by `two_fractions`",
     .example = "0.9", .help = "Share of the fraction that decays with k."},
    {REAL("process.kinetics[].enzyme"), ABOVE(0), TO(1), .default_words = "none: required by `autocatalytic`",
     .example = "0.01", .help = "E at the start, 1 is where it ends."},
    {LIST("process.kinetics[].table"), .default_words = "none: required by `table`",
     .example = "[[0, 1], [7, 0.6], [14, 0.5]]",
     .help = "Pairs of time and X, straight in between; the first is [0, 1]."},
    {REAL("process.kinetics[].table[]"), .size = 2, .example = "[7, 0.6]", .help = "Time and X."},
    {TEXT("process.kinetics[].time_unit"), .default_words = "none: required by `table`", .example = "day",
     .help = "Unit of its times."},
    {LIST("process.program"), .default_words = "free of stress; of a body: load parameter 0",
     .example = "[{for: 10 s, F: [[1, 0.1], [0, 1]]}, {for: 1 h}]",
     .help = "What deformation, stress or load is prescribed, one part after the other; after the last it is held."},
    {MAP("process.program[]"), .example = "{for: 10 s, F: [[1, 0.1], [0, 1]]}",
     .help = "One part: straight from where the tissue is to F and P, or to `load`; without them what is prescribed is "
             "held."},
    {TIME("process.program[].for"), REQUIRED, FROM(0), .example = "10 s", .help = "How long it takes; 0 s: a jump."},
    {TENSOR("process.program[].F"), FREE, .default_words = "held", .example = "[[free, 0.1], [0, free]]",
     .help = "Deformation gradient at its end, from the inflated tissue; `free` where P is given."},
    {STRESS_TENSOR("process.program[].P"), OPEN, .default_words = "F is given in full",
     .example = "[[0 MPa, x], [x, 0 MPa]]",
     .help = "First Piola-Kirchhoff stress at its end, of the reference area before inflation; `x` where F is given."},
    {REAL("process.program[].load"), FROM(-1000), TO(1000), .default_words = "held", .example = "1",
     .help = "Of a body (`macro`): its load parameter at the end, that of `macro.boundary`."},
    {INTEGER("process.repeat"), FROM(1), TO(100000), .default_value = "1", .example = "10",
     .help = "How often `program` is gone through."},
    {REAL("accuracy"), ABOVE(0), TO(0.5), .default_value = "0.01", .example = "0.01",
     .help = "Wanted relative error of the effective stress; what the scene leaves open follows from it."},
};
const PetscInt LamKeyCount = PETSC_STATIC_ARRAY_LENGTH(LamKeys);

const LamKey *LamKeyFind(const char path[])
{
  for (PetscInt i = 0; i < LamKeyCount; i++) {
    if (!strcmp(LamKeys[i].path, path)) return &LamKeys[i];
  }
  return NULL;
}

const char *LamKeyName(const LamKey *key)
{
  const char *dot = strrchr(key->path, '.');

  return dot ? dot + 1 : key->path;
}

PetscBool LamKeyIsChild(const LamKey *key, const LamKey *map)
{
  const size_t length = strlen(map->path);
  const char *rest = key->path + length;

  if (!key->path[0] || strncmp(key->path, map->path, length)) return PETSC_FALSE;
  if (length && *rest++ != '.') return PETSC_FALSE;
  return strpbrk(rest, ".[") ? PETSC_FALSE : PETSC_TRUE;
}

static const char *BoundWords(const LamBound *bound, PetscBool lower)
{
  if (bound->kind == LAM_BOUND_EXCLUDED) return lower ? "larger than" : "less than";
  return lower ? "at least" : "at most";
}

static PetscBool HasOneValue(const LamKey *key)
{
  return key->lower.kind == LAM_BOUND_INCLUDED && key->upper.kind == LAM_BOUND_INCLUDED &&
                 key->lower.value == key->upper.value
             ? PETSC_TRUE
             : PETSC_FALSE;
}

void LamKeyBoundsText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH])
{
  const char *space = key->unit ? " " : "", *unit = key->unit ? key->unit : "";
  char lower[80] = "", upper[80] = "";

  if (HasOneValue(key)) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "exactly %g%s%s", (double)key->lower.value, space, unit);
    return;
  }
  if (key->lower.kind != LAM_BOUND_NONE) {
    snprintf(lower, sizeof(lower), "%s %g%s%s", BoundWords(&key->lower, PETSC_TRUE), (double)key->lower.value, space,
             unit);
  }
  if (key->upper.kind != LAM_BOUND_NONE) {
    snprintf(upper, sizeof(upper), "%s %.9g%s%s", BoundWords(&key->upper, PETSC_FALSE), (double)key->upper.value, space,
             unit);
  }
  snprintf(text, LAM_KEY_TEXT_LENGTH, "%s%s%s", lower, lower[0] && upper[0] ? " and " : "", upper);
}

/* "bonded or contact" */
static void NamesText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH])
{
  size_t used = 0;

  text[0] = '\0';
  for (PetscInt i = 0; i < key->name_count && used < LAM_KEY_TEXT_LENGTH; i++) {
    used += (size_t)snprintf(text + used, LAM_KEY_TEXT_LENGTH - used, "%s%s", i ? " or " : "", key->names[i]);
  }
}

static void SingleText(const LamKey *key, char text[LAM_KEY_TEXT_LENGTH])
{
  static const char *const articles[] = {"a length",      "a stress", "an angle",       "a time",
                                         "a temperature", "a rate",   "a molar energy", "a permeability"};
  const char *what = "a plain number";
  char bounds[LAM_KEY_TEXT_LENGTH], with_unit[80];

  if (key->type == LAM_KEY_NAME) {
    NamesText(key, text);
    return;
  }
  LamKeyBoundsText(key, bounds);
  if (key->unit) {
    snprintf(with_unit, sizeof(with_unit), "%s with its unit", articles[key->dimension]);
    what = with_unit;
  } else if (key->type == LAM_KEY_INTEGER) {
    what = "a whole number";
  } else if (key->type == LAM_KEY_BOOL) {
    what = "true or false";
  } else if (key->type == LAM_KEY_TEXT) {
    what = "a text";
  }
  snprintf(text, LAM_KEY_TEXT_LENGTH, "%s%s%.200s%s%s", what, bounds[0] ? ", " : "", bounds,
           key->free_word ? ", or " : "", key->free_word ? key->free_word : "");
}

void LamKeyExpectation(const LamKey *key, PetscBool single, char text[LAM_KEY_TEXT_LENGTH])
{
  char one[LAM_KEY_TEXT_LENGTH];

  SingleText(key, one);
  if (HasOneValue(key)) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "%s", key->example);
  } else if (key->type == LAM_KEY_MAP) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "keys and values, such as %s", key->example);
  } else if (key->type == LAM_KEY_LIST) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "a list, such as %s", key->example);
  } else if (key->type == LAM_KEY_TENSOR && !single) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "2x2 or 3x3 plain numbers, such as %s", key->example);
  } else if (key->type == LAM_KEY_QUANTITY_TENSOR && !single) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "2x2 or 3x3 values with units, such as %s", key->example);
  } else if (key->size && !single) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "a list of %d, such as %s", (int)key->size, key->example);
  } else if (key->type == LAM_KEY_NAME || key->type == LAM_KEY_BOOL || (key->size && single) ||
             key->type == LAM_KEY_TENSOR || key->type == LAM_KEY_QUANTITY_TENSOR) {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "%s", one);
  } else {
    snprintf(text, LAM_KEY_TEXT_LENGTH, "%.300s, such as %s", one, key->example);
  }
}
