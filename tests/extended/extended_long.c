#include <float.h>
#include <math.h>
#define EXTENDED_REAL long double
#define EXTENDED_EPSILON LDBL_EPSILON
#define EXTENDED_PI 3.14159265358979323846264338327950288L
#define EXTENDED_SOLVE ExtendedLong
#define EXTENDED(name) Long##name
#define EXTENDED_FUNCTION(name) name##l
#include "extended_source.h"
