#pragma once
/// Bodies of core/wavelengths.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/wavelengths.hpp>

#include <Eigen/Core>

#include <cmath>
#include <iterator>
#include <span>

namespace gonio {

GONIO_INLINE void require_wavelengths(std::span<const double> wavelengths) {
  if (wavelengths.empty()) refuse("a spectrum needs at least one wavelength");
  for (Eigen::Index i = 0; i < std::ssize(wavelengths); ++i)
    if (!(wavelengths[i] > (i == 0 ? 0.0 : wavelengths[i - 1]) && std::isfinite(wavelengths[i])))
      refuse({"wavelength ", i + 1, " of a spectrum is not above ", i == 0 ? "0" : "the one before"});
}

}  // namespace gonio
