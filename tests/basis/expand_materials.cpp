#include "../synthetic_materials.hpp"
#include <gonio/basis/expand_materials.hpp>
#include <gonio/basis/learn_streamed_pca.hpp>
#include <gonio/core/spectrum.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <span>
#include <vector>

namespace {

/// Returns a material's spectrum at a cell as the prior stores it.
std::vector<double> spectrum_of(const gonio::log_relative_pca& prior, Eigen::Index material, Eigen::Index cell) {
  const Eigen::MatrixXd weights = prior.weights_of(material);
  std::vector<double> values;
  for (Eigen::Index band = 0; band < weights.cols(); ++band) {
    double mapped = prior.offset(cell);
    for (Eigen::Index k = 0; k < prior.size(); ++k) mapped += double{prior.row(cell)[k]} * weights(k, band);
    values.push_back(std::max(prior.metric().inverse(mapped, gonio::locate_cell(prior.cells(), cell)), 0.0));
  }
  return values;
}

}  // namespace

TEST_CASE("all components give the materials that they were learned from") {
  const auto set = synthetic_materials(small_cells(), 6);
  const auto again = gonio::expand(learn(set, 17));
  CHECK(again.names == set.names);
  CHECK((again.values.array() / set.values.array() - 1.0f).abs().maxCoeff() < 1e-3f);
}

TEST_CASE("spectra expand to their colours under D65, and one wavelength to grey") {
  const auto set = synthetic_materials(small_cells(), 12);
  const std::vector<double> wavelengths{420.0, 500.0, 580.0, 660.0};
  const auto prior = gonio::learn_streamed_pca(at_wavelengths(set, wavelengths), {.components = 20}).prior;
  const auto colours = gonio::expand(prior);
  CHECK(colours.names == prior.names());
  REQUIRE(colours.values.cols() == 27);
  const gonio::spectral_colour colour(wavelengths);
  for (Eigen::Index cell = 0; cell < colours.cells.size(); cell += 50)
    for (Eigen::Index m = 0; m < 9; ++m) {
      const gonio::rgb expected = colour(spectrum_of(prior, m, cell)).max(0.0);
      for (Eigen::Index c = 0; c < 3; ++c)
        CHECK(double{colours.values(cell, 3 * m + c)} == doctest::Approx(expected[c]).epsilon(1e-5));
    }

  const auto laser = gonio::learn_streamed_pca(at_wavelengths(set, {633.0}), {.components = 20}).prior;
  const auto greys = gonio::expand(laser);
  REQUIRE(greys.values.cols() == 108);
  for (Eigen::Index m = 0; m < 36; ++m) {
    CHECK(greys.values(7, 3 * m) == greys.values(7, 3 * m + 2));
    CHECK(double{greys.values(7, 3 * m)} == doctest::Approx(spectrum_of(laser, m, 7)[0]));
  }
}
