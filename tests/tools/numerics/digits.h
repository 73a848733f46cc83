// What the numerics table compares with: 50 decimal digits.
#ifndef EYEBOX_TESTS_TOOLS_NUMERICS_DIGITS_H_
#define EYEBOX_TESTS_TOOLS_NUMERICS_DIGITS_H_

#include <boost/multiprecision/mpfr.hpp>

namespace eyebox::numerics {

using Digits50 = boost::multiprecision::number<boost::multiprecision::mpfr_float_backend<50>,
                                               boost::multiprecision::et_off>;

}  // namespace eyebox::numerics

#endif  // EYEBOX_TESTS_TOOLS_NUMERICS_DIGITS_H_
