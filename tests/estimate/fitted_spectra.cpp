#include "../synthetic_materials.hpp"
#include <gonio/basis/measured.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/fitted_spectra.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <doctest/doctest.h>

namespace spectra_test {

const gonio::valid_cells& cells() {
  static const gonio::valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::log_relative_pca& prior() {
  static const auto learned = learn(synthetic_materials(cells(), 8), 10);
  return learned;
}

/// Seven wavelengths: mixtures of the red and the blue of a material, so that no two are alike.
gonio::spectral_samples measured_spectra() {
  const auto colours =
      gonio::sample_table(synthetic_materials(cells(), 9, 11).table(8), gonio::random_cells(cells(), 25, 5));
  gonio::spectral_samples samples{
      {400, 450, 500, 550, 600, 650, 700}, {}, gonio::cell_matrix(std::ssize(colours), 7), {}};
  for (Eigen::Index i = 0; i < std::ssize(colours); ++i) {
    samples.directions.push_back(colours[i].directions);
    samples.weights.push_back(0.5 + 0.1 * static_cast<double>(i % 7));
    for (Eigen::Index band = 0; band < 7; ++band) {
      const double share = static_cast<double>(band) / 6.0;
      samples.values(i, band) = static_cast<float>(share * colours[i].value.x() + (1.0 - share) * colours[i].value.z());
    }
  }
  return samples;
}

/// Each wavelength of a spectral fit is the fit of that wavelength's samples alone.
template <class Estimator>
void check_like_grey(const Estimator& estimator) {
  const auto samples = measured_spectra();
  const auto spectra = gonio::fit_spectra(estimator, samples);
  REQUIRE(spectra.bands() == 7);
  const auto table = spectra.tabulate(cells());
  const auto wi = gonio::spherical_direction(0.3, 0.2), wo = gonio::spherical_direction(0.9, 2.5);
  for (Eigen::Index band = 0; band < 7; ++band) {
    const auto grey = estimator.fit(samples.at_wavelength(band));
    CAPTURE(band);
    CHECK((spectra.weights().col(band) - grey.weights().col(0)).norm() < 1e-6 * (1.0 + grey.weights().col(0).norm()));
    CHECK(spectra.report().residual[band] == doctest::Approx(grey.report()->residual[0]).epsilon(1e-6));
    const auto expected = grey.tabulate(cells());
    for (Eigen::Index cell = 0; cell < cells().size(); ++cell) {
      const double value = expected.at(cell).x();
      CHECK(std::abs(double{table.values()(cell, band)} - value) < 1e-6 * (1.0 + value));
    }
    CHECK(spectra(wi, wo)[band] == doctest::Approx(grey(wi, wo).y()).epsilon(1e-5));
    CHECK(spectra.at_wavelength(band)(wi, wo).z() == doctest::Approx(grey(wi, wo).z()).epsilon(1e-6));
  }
}

gonio::measured<gonio::log> materials() { return {synthetic_materials(cells(), 8), gonio::log{}}; }

TEST_CASE("each wavelength is fitted by components as a grey material") {
  check_like_grey(gonio::decomposition{prior(), gonio::tikhonov{0.1}});
  check_like_grey(gonio::decomposition{prior(), gonio::lasso{1e-3}});
}

TEST_CASE("each wavelength is fitted by measured materials, any channel of which is a grey one") {
  check_like_grey(gonio::decomposition{materials().as_grey(), gonio::nnls{}});
  const auto fewer = materials().without({"material-3"}).as_grey();
  CHECK(fewer.size() == 24);
  const auto spectra = gonio::fit_spectra(gonio::decomposition{fewer, gonio::nnls{}}, measured_spectra());
  for (const Eigen::Index left_out : {3, 11, 19}) CHECK(spectra.weights().row(left_out).isZero(0.0));
  for (Eigen::Index function = 0; function < 24; ++function)
    CHECK(fewer.row(5)[function] == materials().channel(function / 8).row(5)[function % 8]);
}

TEST_CASE("three equal wavelengths are three equal channels") {
  auto samples = measured_spectra();
  samples.wavelengths.resize(3);
  samples.values = samples.values.col(4).replicate(1, 3).eval();
  const gonio::decomposition estimator{prior(), gonio::tikhonov{0.1}};
  const auto table = gonio::fit_spectra(estimator, samples).tabulate(cells());
  const auto grey = estimator.fit(samples.at_wavelength(0)).tabulate(cells());
  for (Eigen::Index cell = 0; cell < cells().size(); ++cell)
    for (Eigen::Index band = 0; band < 3; ++band) CHECK(table.values()(cell, band) == grey.values()[3 * cell + band]);
}

TEST_CASE("one wavelength is fitted as it is") {
  auto samples = measured_spectra();
  samples.wavelengths = {633};
  samples.values = samples.values.col(2).eval();
  const gonio::decomposition estimator{prior(), gonio::tikhonov{0.1}};
  const auto table = gonio::fit_spectra(estimator, samples).tabulate(cells(), gonio::thread_count{2});
  CHECK(
      std::ranges::equal(table.colours().values(), estimator.fit(samples.at_wavelength(0)).tabulate(cells()).values()));
}

TEST_CASE("spectra that cannot be fitted are refused") {
  const gonio::decomposition estimator{prior(), gonio::tikhonov{0.1}};
  auto samples = measured_spectra();
  samples.weights.assign(samples.directions.size(), 0.0);
  CHECK_THROWS_WITH_AS(gonio::fit_spectra(estimator, samples), doctest::Contains("weight zero"), gonio::error);
  samples = measured_spectra();
  samples.wavelengths[3] = 500;
  CHECK_THROWS_WITH_AS(gonio::fit_spectra(estimator, samples), doctest::Contains("wavelength 4"), gonio::error);
  CHECK_THROWS_WITH_AS(
      gonio::fitted_spectra({400.0, 500.0}, prior(), gonio::solution{Eigen::MatrixXd::Zero(10, 3), {}}),
      doctest::Contains("each of 2 wavelengths"), gonio::error);
}

TEST_CASE("a sample of weight zero takes no part in spectra") {
  auto samples = measured_spectra();
  samples.weights[3] = 0.0;
  const gonio::decomposition estimator{prior(), gonio::tikhonov{0.1}};
  const auto without = gonio::fit_spectra(estimator, samples);
  samples.values.row(3).setConstant(1e3f);
  CHECK(gonio::fit_spectra(estimator, samples).weights() == without.weights());
}

}  // namespace spectra_test
