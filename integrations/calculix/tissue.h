/*
  Tissue as a material of a host program: a file by the material's name, responses, and states of material points.

  Stresses are in the host's unit, whose value in Pa is the material's first constant. A mistake of the input ends the
  program with a message, as hosts do. Functions may be called from several threads.
*/
#ifndef TISSUE_H
#define TISSUE_H

typedef struct Tissue_s *Tissue;

/* State variables of a material point: the number of its state, which is 0 for undeformed tissue, and its turgor. */
enum { TISSUE_STATE, TISSUE_TURGOR, TISSUE_VARIABLES };

/* The length of a name of Fortran, which is padded with blanks. */
static inline int TissueTrim(const char name[], int length)
{
  while (length > 0 && name[length - 1] == ' ') --length;
  return length;
}

/*
  The tissue of a material, opened when it is first asked for. name: of `length` characters; behind its last @, if there
  is one, it is that of a file in the folder that the variable LAMELLA_FOLDER names, otherwise in the working directory:
  a database, *.h5, or else a scene. Capitals do not matter, and an underscore may stand for a point. constants: the
  host's unit of stress in Pa, and, for a database alone, the largest estimated error at which it answers.
*/
Tissue TissueFind(const char name[], int length, int n, const double constants[]);

/* A material point in an increment. */
typedef struct {
  int element, point;
  const double *F0, *F; /* at its start and its end; row-major */
  double turgor;        /* at its end */
} TissueLoad;

typedef struct {
  double P[9], tangent[81]; /* row-major; tangent: dP/dF */
  char reason[256];         /* why there is none */
} TissueResponse;

/*
  Returns whether there is a response. begin and end: state variables at the start and the end of the increment; end may
  be NULL: then the state reached is not kept. A scene is solved from the state of `begin`, which must be that of the
  last call or of the increment that it belongs to, and of F0; any other, as after a restart from a file, ends the
  program.
*/
int TissueRespond(Tissue tissue, const TissueLoad *load, const double begin[TISSUE_VARIABLES],
                  double end[TISSUE_VARIABLES], TissueResponse *response);

/* Row-major F of a host's, by columns. */
void TissueGradient(const double columns[9], double F[9]);
/* Takes off what is rounding of the components that plane strain has not: before a load has F, and S is made of it. */
void TissueRound(double F[9]);
/* Tells once for each attempt at an increment, which ends at `time`, why it is cut back. */
void TissueReport(const TissueLoad *load, double time, const char reason[]);
/* Ends the program. */
_Noreturn void TissueFail(const char format[], ...) __attribute__((format(printf, 1, 2)));

#endif
