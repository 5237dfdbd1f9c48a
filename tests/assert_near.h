/* Comparison of reals in double precision; cmocka's assert_float_equal rounds to single. Include after cmocka.h. */
#ifndef LAM_ASSERT_NEAR_H
#define LAM_ASSERT_NEAR_H

#include <math.h>

#define assert_near(value, expected, tolerance)                                                                        \
  do {                                                                                                                 \
    const double near_value_ = (value), near_expected_ = (expected), near_tolerance_ = (tolerance);                    \
                                                                                                                       \
    if (!(fabs(near_value_ - near_expected_) <= near_tolerance_))                                                      \
      fail_msg("%s is %.17g, expected %.17g: off by %.3g, more than %.3g", #value, near_value_, near_expected_,        \
               fabs(near_value_ - near_expected_), near_tolerance_);                                                   \
  } while (0)

#endif
