#include <gonio/core/error.hpp>
#include <gonio/core/wavelengths.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <vector>

TEST_CASE("wavelengths are positive, finite and ascending") {
  gonio::require_wavelengths(std::vector<double>{633.0});
  gonio::require_wavelengths(std::vector<double>{400.0, 400.5, 1064.0});
  const auto refuses = [](const std::vector<double>& wavelengths, const char* what) {
    CHECK_THROWS_WITH_AS(gonio::require_wavelengths(wavelengths), doctest::Contains(what), gonio::error);
  };
  refuses({}, "at least one wavelength");
  refuses({0.0}, "wavelength 1 of a spectrum is not above 0");
  refuses({500.0, 500.0}, "wavelength 2 of a spectrum is not above the one before");
  refuses({500.0, std::nan("")}, "wavelength 2");
  refuses({500.0, std::numeric_limits<double>::infinity()}, "wavelength 2");
}
