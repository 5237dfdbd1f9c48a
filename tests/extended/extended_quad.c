#include <quadmath.h>
#define EXTENDED_REAL __float128
#define EXTENDED_EPSILON FLT128_EPSILON
#define EXTENDED_PI M_PIq
#define EXTENDED_SOLVE ExtendedQuad
#define EXTENDED(name) Quad##name
#define EXTENDED_FUNCTION(name) name##q
#include "extended_source.h"
