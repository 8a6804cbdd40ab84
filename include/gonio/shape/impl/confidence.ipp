#pragma once
/// Bodies of shape/confidence.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/shape/confidence.hpp>

#include <Eigen/Core>
#include <unsupported/Eigen/SpecialFunctions>

#include <string>

namespace gonio {

GONIO_INLINE double f_quantile(double share, double numerator_degrees, double denominator_degrees) {
  return detail::quantile(share, [=](double x) {
    const double part = numerator_degrees * x;
    return Eigen::numext::betainc(0.5 * numerator_degrees, 0.5 * denominator_degrees,
                                  part / (part + denominator_degrees));
  });
}

}  // namespace gonio
