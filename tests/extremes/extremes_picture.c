/* The pairs of a map as a table of all quantities by all: below the diagonal bonded tissue, above it contact. In each
   square the four corners of two quantities, the low end left and above, coloured by the verdict. */
#include "extremes_picture.h"
#include <stdio.h>

#define CORNER 18 /* points */
#define SQUARE (2 * CORNER + 4)
#define LEFT 84 /* of the table */
#define TOP 84

static const char *Colour(int verdict)
{
  static const char *const colours[EXTREMES_VERDICT_COUNT] = {
      [EXTREMES_CONFIRMED] = "#2a7f4f",  [EXTREMES_BRANCH] = "#8fc79a",    [EXTREMES_UNCONFIRMED] = "#d5e8c9",
      [EXTREMES_REASON] = "#3f6fb5",     [EXTREMES_NUMERICAL] = "#e08214", [EXTREMES_WRONG] = "#b2182b",
      [EXTREMES_NOT_FINITE] = "#67001f", [EXTREMES_SLOW] = "#f2d24b",      [EXTREMES_CRASH] = "#000000"};

  return verdict < 0 ? "#e6e6e6" : colours[verdict];
}

static void Corner(PetscInt id, int verdict)
{
  ExtremesCase c;
  PetscInt column, row, low_column, low_row;

  ExtremesCaseMake(id, &c);
  column = c.pair[c.contact ? 1 : 0];
  row = c.pair[c.contact ? 0 : 1];
  low_column = id / (c.contact ? 4 : 2) % 2;
  low_row = id / (c.contact ? 2 : 4) % 2;
  printf("<rect x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" fill=\"%s\"/>\n",
         (int)(LEFT + SQUARE * column + CORNER * low_column), (int)(TOP + SQUARE * row + CORNER * low_row), CORNER - 1,
         CORNER - 1, Colour(verdict));
}

static void Legend(int verdict, int place, const int verdicts[])
{
  const int y = TOP + SQUARE * EXTREMES_AXIS_COUNT + 14 + 18 * (place / 3), x = LEFT + 200 * (place % 3);
  int count = 0;

  for (PetscInt id = 0; id < ExtremesPairCount(); id++) count += verdicts[id] == verdict;
  printf("<rect x=\"%d\" y=\"%d\" width=\"12\" height=\"12\" fill=\"%s\"/><text x=\"%d\" y=\"%d\">%s: %d</text>\n", x,
         y, Colour(verdict), x + 18, y + 10, verdict < 0 ? "not solved" : ExtremesVerdictNames[verdict], count);
}

void ExtremesPicture(const int verdicts[])
{
  const int width = LEFT + SQUARE * EXTREMES_AXIS_COUNT + 40, height = TOP + SQUARE * EXTREMES_AXIS_COUNT + 80;

  printf("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" font-family=\"sans-serif\" "
         "font-size=\"12\">\n<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
         width, height);
  for (int axis = 0; axis < EXTREMES_AXIS_COUNT; axis++) {
    const int middle = SQUARE * axis + CORNER;

    printf("<text x=\"%d\" y=\"%d\" text-anchor=\"end\">%s</text>\n", LEFT - 6, TOP + middle + 4,
           ExtremesAxisNames[axis]);
    printf("<text transform=\"translate(%d,%d) rotate(-60)\">%s</text>\n", LEFT + middle + 4, TOP - 6,
           ExtremesAxisNames[axis]);
  }
  for (PetscInt id = 0; id < ExtremesPairCount(); id++) Corner(id, verdicts[id]);
  for (int verdict = -1, place = 0; verdict < EXTREMES_VERDICT_COUNT; verdict++) Legend(verdict, place++, verdicts);
  puts("</svg>");
}
