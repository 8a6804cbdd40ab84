#include "../synthetic_materials.hpp"
#include <gonio/basis/measured.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace spectra_test {

using gonio::rgb;

const gonio::valid_cells& cells() {
  static const gonio::valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::log_relative_pca& prior() {
  static const auto learned = learn(synthetic_materials(cells(), 8), 10);
  return learned;
}

/// Seven wavelengths: different mixtures of the red and the blue of a material.
gonio::sample_set measured_spectra(std::vector<double> wavelengths = {400, 450, 500, 550, 600, 650, 700},
                                   Eigen::Index weightless = -1, const rgb& weightless_value = rgb::Zero()) {
  const auto colours =
      gonio::sample_table(synthetic_materials(cells(), 9, 11).table(8), gonio::random_cells(cells(), 25, 5));
  gonio::sample_set samples{gonio::channels(std::move(wavelengths))};
  for (Eigen::Index i = 0; i < std::ssize(colours); ++i) {
    const Eigen::ArrayXd share = Eigen::ArrayXd::LinSpaced(7, 0.0, 1.0).head(samples.channels().size());
    const double weight = i == weightless ? 0.0 : 0.5 + 0.1 * static_cast<double>(i % 7);
    const rgb value = i == weightless ? weightless_value : colours[i].value;
    samples.add(colours[i].directions, Eigen::ArrayXd(share * value.x() + (1.0 - share) * value.z()), weight);
  }
  return samples;
}

/// Checks that each wavelength of a spectral fit equals the fit to that wavelength's samples alone.
template <class Estimator>
void check_like_grey(const Estimator& estimator) {
  const auto samples = measured_spectra();
  const auto spectra = estimator.fit(samples);
  REQUIRE(spectra.channels().size() == 7);
  const auto table = spectra.tabulate_spectra(cells());
  const auto wi = gonio::spherical_direction(0.3, 0.2), wo = gonio::spherical_direction(0.9, 2.5);
  for (Eigen::Index band = 0; band < 7; ++band) {
    const auto grey = estimator.fit(samples.channel(band));
    CAPTURE(band);
    CHECK((spectra.weights().col(band) - grey.weights().col(0)).norm() < 1e-6 * (1.0 + grey.weights().col(0).norm()));
    CHECK(spectra.report()->residual[band] == doctest::Approx(grey.report()->residual[0]).epsilon(1e-6));
    const auto expected = grey.tabulate(cells());
    for (Eigen::Index cell = 0; cell < cells().size(); ++cell) {
      const double value = expected.at(cell).x();
      CHECK(std::abs(double{table.values()(cell, band)} - value) < 1e-6 * (1.0 + value));
    }
    CHECK(spectra.values(wi, wo)[band] == doctest::Approx(grey(wi, wo).y()).epsilon(1e-5));
  }
  // Converted to a colour, it is the colour of its spectrum.
  const Eigen::ArrayXd spectrum = spectra.values(wi, wo);
  const rgb seen = samples.channels().colour(std::span(spectrum.data(), 7));
  CHECK(((spectra(wi, wo) - seen).abs() < 1e-6).all());
  CHECK(((spectra.tabulate(cells())(wi, wo) - table.colours()(wi, wo)).abs() == 0.0).all());
}

gonio::measured<gonio::log> materials() { return {synthetic_materials(cells(), 8), gonio::log{}}; }

TEST_CASE("the gradient says how values change with the weights, of colours and of wavelengths") {
  const auto fit = gonio::decomposition{prior(), gonio::tikhonov{0.1}}.fit(measured_spectra());
  const auto wi = gonio::spherical_direction(0.4, 0.2), wo = gonio::spherical_direction(0.9, 2.5);
  const Eigen::MatrixXd gradient = fit.gradient(wi, wo);
  REQUIRE(gradient.rows() == fit.weights().rows());
  REQUIRE(gradient.cols() == 7);
  constexpr double step = 1e-5;
  for (const Eigen::Index k : {0, 3, 9})
    for (const Eigen::Index band : {0, 6}) {
      CAPTURE(k);
      CAPTURE(band);
      Eigen::MatrixXd more = fit.weights(), less = fit.weights();
      more(k, band) += step;
      less(k, band) -= step;
      const auto value = [&](const Eigen::MatrixXd& weights) -> Eigen::ArrayXd {
        return gonio::fitted_brdf(prior(), weights, {}, fit.channels()).values(wi, wo);
      };
      const Eigen::ArrayXd slope = (value(more) - value(less)) / (2.0 * step);
      CHECK(gradient(k, band) == doctest::Approx(slope[band]).epsilon(1e-5));
      CHECK(slope[3] == 0.0);  // a channel's value depends on its own weights alone
    }
  CHECK(fit.gradient(wi, {0.0, 0.6, -0.8}).isZero(0.0));
  // A value that is clamped at zero stays there.
  const gonio::fitted_brdf black(prior(), 1e3 * fit.weights(), {}, fit.channels());
  const Eigen::ArrayXd dark = black.values(wi, wo);
  REQUIRE((dark == 0.0).any());
  for (Eigen::Index band = 0; band < 7; ++band)
    CHECK(black.gradient(wi, wo).col(band).isZero(0.0) == (dark[band] == 0.0));
}

TEST_CASE("each wavelength is fitted by components as a grey material") {
  check_like_grey(gonio::decomposition{prior(), gonio::tikhonov{0.1}});
  check_like_grey(gonio::decomposition{prior(), gonio::lasso{1e-3}});
}

TEST_CASE("each wavelength is fitted by measured materials, any channel of which is a grey one") {
  check_like_grey(gonio::decomposition{materials().as_grey(), gonio::nnls{}});
  const auto fewer = materials().without({"material-3"}).as_grey();
  CHECK(fewer.size() == 24);
  const auto spectra = gonio::decomposition{fewer, gonio::nnls{}}.fit(measured_spectra());
  for (const Eigen::Index left_out : {3, 11, 19}) CHECK(spectra.weights().row(left_out).isZero(0.0));
  for (Eigen::Index function = 0; function < 24; ++function)
    CHECK(fewer.row(5)[function] == materials().channel(function / 8).row(5)[function % 8]);
}

TEST_CASE("three equal wavelengths are three equal channels") {
  const auto one = measured_spectra().channel(4);
  gonio::sample_set samples{gonio::channels({450, 550, 650})};
  for (Eigen::Index i = 0; i < std::ssize(one); ++i)
    samples.add(one.directions(i), std::vector(3, one.values(i)[0]), one.weight(i));
  const gonio::decomposition estimator{prior(), gonio::tikhonov{0.1}};
  const auto table = estimator.fit(samples).tabulate_spectra(cells());
  const auto grey = estimator.fit(one).tabulate(cells());
  for (Eigen::Index cell = 0; cell < cells().size(); ++cell)
    for (Eigen::Index band = 0; band < 3; ++band) CHECK(table.values()(cell, band) == grey.values()[3 * cell + band]);
}

TEST_CASE("one wavelength is fitted as it is, once") {
  const auto laser = measured_spectra().channel(2);
  const gonio::decomposition estimator{prior(), gonio::tikhonov{0.1}};
  const auto fit = estimator.fit(laser);
  CHECK(fit.weights().cols() == 1);
  const auto table = fit.tabulate_spectra(cells(), gonio::thread_count{2});
  CHECK(std::ranges::equal(table.colours().values(), fit.tabulate(cells()).values()));
  // Agrees with three equal colour channels.
  gonio::sample_set colours;
  for (const gonio::sample& each : laser) colours.push_back(each);
  CHECK(std::ranges::equal(estimator.fit(colours).tabulate(cells()).values(), fit.tabulate(cells()).values()));
}

TEST_CASE("one value is fitted by materials whose channels differ as a grey, and wavelengths are refused") {
  const gonio::decomposition estimator{materials(), gonio::nnls{}};
  const auto one = measured_spectra().channel(2);
  gonio::sample_set colours;
  for (const gonio::sample& each : one) colours.push_back(each);
  CHECK(estimator.fit(one).weights() == estimator.fit(colours).weights());
  CHECK_THROWS_WITH_AS(estimator.fit(measured_spectra()), doctest::Contains("7 wavelengths have no colours"),
                       gonio::error);
}

TEST_CASE("spectra that cannot be fitted are refused") {
  const gonio::decomposition estimator{prior(), gonio::tikhonov{0.1}};
  gonio::sample_set samples(gonio::channels({400, 500}));
  samples.add({0.1, 0.2, 0.3}, std::array{1.0, 1.0}, 0.0);
  CHECK_THROWS_WITH_AS(estimator.fit(samples), doctest::Contains("weight zero"), gonio::error);
  const auto wrong = [](Eigen::Index columns, gonio::channels kinds) {
    return gonio::fitted_brdf(prior(), Eigen::MatrixXd::Zero(10, columns), {}, std::move(kinds));
  };
  CHECK_THROWS_WITH_AS(wrong(3, gonio::channels({400.0, 500.0})), doctest::Contains("each of 2 channels"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(wrong(2, {}), doctest::Contains("each of 3 channels"), gonio::error);
}

TEST_CASE("a sample of weight zero takes no part in spectra") {
  const gonio::decomposition estimator{prior(), gonio::tikhonov{0.1}};
  const std::vector<double> wavelengths{400, 500, 600, 700};
  CHECK(estimator.fit(measured_spectra(wavelengths, 3)).weights() ==
        estimator.fit(measured_spectra(wavelengths, 3, rgb(1e3, 1e3, 1e3))).weights());
}

}  // namespace spectra_test
