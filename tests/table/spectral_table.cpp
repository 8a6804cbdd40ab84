#include <gonio/core/error.hpp>
#include <gonio/table/spectral_table.hpp>

#include <doctest/doctest.h>

#include <utility>

using gonio::spectral_table;

namespace {

const gonio::valid_cells& cells() {
  static const gonio::valid_cells small(gonio::grid({6, 5, 4}));
  return small;
}

/// Reflectances that increase along the cells and decrease along the wavelengths.
spectral_table table() {
  spectral_table made(cells(), {400.0, 500.0, 600.0, 700.0});
  for (Eigen::Index cell = 0; cell < cells().size(); ++cell)
    for (Eigen::Index band = 0; band < 4; ++band)
      made.values()(cell, band) = 0.01f * static_cast<float>(cell) + 0.1f * static_cast<float>(4 - band);
  return made;
}

}  // namespace

TEST_CASE("a spectral table reads like a table of each wavelength") {
  const spectral_table spectra = table();
  CHECK(spectra.bands() == 4);
  const auto wi = gonio::spherical_direction(0.3, 0.2), wo = gonio::spherical_direction(0.9, 2.5);
  const Eigen::ArrayXf found = spectra(wi, wo);
  for (Eigen::Index band = 0; band < 4; ++band) {
    const gonio::rgb expected = spectra.at_wavelength(band)(wi, wo);
    CHECK(double{found[band]} == doctest::Approx(expected.x()).epsilon(1e-6));
    CHECK(expected.x() == expected.z());
    CHECK(spectra.at(7)[static_cast<std::size_t>(band)] == spectra.values()(7, band));
  }
  CHECK((spectra(wi, gonio::spherical_direction(2.0, 0.0)) == 0.0f).all());
}

TEST_CASE("colours of a spectral table are those of its spectra, for any number of threads") {
  const spectral_table spectra = table();
  const auto colours = spectra.colours(gonio::illuminant::a);
  const gonio::spectral_colour colour(spectra.wavelengths(), gonio::illuminant::a);
  for (Eigen::Index cell = 0; cell < cells().size(); ++cell)
    CHECK(((colours.at(cell) - colour(spectra.at(cell))).abs() < 1e-6).all());
  CHECK(std::ranges::equal(colours.values(), spectra.colours(gonio::illuminant::a, gonio::thread_count{3}).values()));
  const spectral_table laser(cells(), {633.0}, gonio::cell_matrix::Constant(cells().size(), 1, 0.5f));
  CHECK((laser.colours().at(0) == 0.5).all());
}

TEST_CASE("invalid spectral tables are refused") {
  CHECK_THROWS_WITH_AS(spectral_table(cells(), {500.0, 500.0}), doctest::Contains("wavelength 2"), gonio::error);
  CHECK_THROWS_WITH_AS(spectral_table(cells(), {}), doctest::Contains("at least one"), gonio::error);
  CHECK_THROWS_WITH_AS(spectral_table(cells(), {400.0, 500.0}, gonio::cell_matrix::Zero(cells().size(), 3)),
                       doctest::Contains("needs 2 values a cell"), gonio::error);
  CHECK_THROWS_WITH_AS((void)spectral_table(cells(), {2000.0, 3000.0}).colours(), doctest::Contains("visible"),
                       gonio::error);
}
