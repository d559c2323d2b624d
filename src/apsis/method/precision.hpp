#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>

namespace apsis {

/// Real number of 60 significant decimal digits: certificates guarantee residuals below 1e-38 with
/// digits to spare.
using mp_real =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>, boost::multiprecision::et_off>;

}  // namespace apsis
