#include "../io/scratch.hpp"
#include <gonio/core/interpolated_colour.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/model/smooth_spectra.hpp>

#include <doctest/doctest.h>

#include <random>
#include <vector>

using gonio::rgb;
using gonio::model::smooth_spectra;

TEST_CASE("a smooth spectrum has the colour that it is for, and is not negative") {
  const smooth_spectra spectra;
  CHECK(spectra.wavelengths().size() == 20);
  const Eigen::MatrixXd weights = gonio::interpolated_colour(spectra.wavelengths());
  // To the seven digits of the matrices in core/rgb.hpp.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 2.0);
  for (int i = 0; i < 200; ++i) {
    rgb colour(uniform(random), uniform(random), uniform(random));
    if (i % 5 == 0) colour[i % 3] = 0.0;
    const Eigen::ArrayXd spectrum = spectra(colour);
    CHECK((weights * spectrum.matrix() - colour.matrix()).cwiseAbs().maxCoeff() < 1e-6);
    CHECK(spectrum.minCoeff() > -1e-9);
  }
  // Colours outside the gamut have spectra as well. Grey is the same at all wavelengths.
  const rgb negative(-0.1, 0.2, 0.3);
  CHECK((weights * spectra(negative).matrix() - negative.matrix()).cwiseAbs().maxCoeff() < 1e-6);
  CHECK((spectra(rgb::Constant(0.3)) == 0.3).all());
  CHECK((spectra(rgb(0.4, 0.4, 0.2)) - spectra(rgb(0.4, 0.4, 0.2) * 2.0) / 2.0).abs().maxCoeff() < 1e-12);
}

TEST_CASE("a smooth spectrum steps by little from one wavelength to the next") {
  const smooth_spectra spectra;
  const Eigen::ArrayXd red = spectra(rgb(0.5, 0.1, 0.1));
  CHECK((red.tail(19) - red.head(19)).abs().maxCoeff() < 0.25);
  CHECK(red[14] > 3.0 * red[5]);
}

TEST_CASE("wavelengths that cannot make colours are refused") {
  const auto refused = [](std::vector<double> wavelengths, const char* word) {
    scratch::check_refused([&] { return smooth_spectra(std::move(wavelengths)); }, {word});
  };
  refused({500.0}, "at least two wavelengths");
  refused({500.0, 450.0, 600.0}, "wavelength 2");
  refused({2000.0, 3000.0, 4000.0}, "is visible: they have no colour");
}

TEST_CASE("wavelengths weighed as they are interpolated add up to white, and agree with dense ones") {
  const std::vector<double> few{400.0, 480.0, 550.0, 640.0};
  const Eigen::MatrixXd weights = gonio::interpolated_colour(few);
  CHECK((weights.rowwise().sum().array() - 1.0).abs().maxCoeff() < 1e-6);
  std::vector<double> dense, values;
  for (int nanometres = 360; nanometres <= 830; ++nanometres) {
    dense.push_back(nanometres);
    values.push_back(nanometres <= 480 ? 0.0 : nanometres <= 550 ? (nanometres - 480) / 70.0 : 1.0);
  }
  const rgb expected = gonio::spectral_colour(dense)(values);
  CHECK(((weights * Eigen::Vector4d(0.0, 0.0, 1.0, 1.0)).array() - expected).abs().maxCoeff() < 1e-9);
}
