#include "../synthetic_materials.hpp"
#include <gonio/evaluate/perceived_norm.hpp>

#include <doctest/doctest.h>

#include <random>

namespace {

const gonio::log_relative_pca& few_materials() {
  static const gonio::log_relative_pca prior = learn(synthetic_materials(small_cells(), 4), 6);
  return prior;
}

gonio::render::sphere_operator lit_sphere(int size) { return {small_cells(), gonio::render::two_lights(), size}; }

/// Returns the lightness of a sphere's points for a grey material with these weights.
Eigen::ArrayXd lightness(const gonio::render::sphere_operator& sphere, const Eigen::VectorXf& weights) {
  const gonio::log_relative_pca& prior = few_materials();
  gonio::brdf_table table(small_cells());
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell) {
    const double mapped = prior.offset(cell) + double{prior.components().row(cell).dot(weights)};
    const auto rho = static_cast<float>(prior.metric().inverse(mapped, cell));
    for (std::size_t channel = 0; channel < 3; ++channel) table.values()[3 * cell + channel] = rho;
  }
  const gonio::render::sphere_colours colours = sphere.apply(table);
  Eigen::ArrayXd lightness(colours.rows());
  for (Eigen::Index point = 0; point < colours.rows(); ++point)
    lightness[point] = gonio::to_lab(colours.row(point).transpose())[0];
  return lightness;
}

}  // namespace

TEST_CASE("the norm is the mean square change of lightness over points and materials") {
  const gonio::render::sphere_operator sphere = lit_sphere(9);
  const gonio::log_relative_pca& prior = few_materials();
  const Eigen::MatrixXd norm = gonio::perceived_norm(prior, sphere);
  std::mt19937 generator(3);
  std::normal_distribution<float> normal;
  for (int trial = 0; trial < 5; ++trial) {
    Eigen::VectorXf change(prior.size());
    for (float& value : change) value = 1e-3f * normal(generator);
    double expected = 0.0;
    for (Eigen::Index i = 0; i < prior.coefficients().rows(); ++i) {
      const Eigen::VectorXf weights = prior.coefficients().row(i).transpose();
      expected += (lightness(sphere, weights + change) - lightness(sphere, weights - change)).square().mean() / 4.0;
    }
    expected /= static_cast<double>(prior.coefficients().rows());
    const Eigen::VectorXd x = change.cast<double>();
    CHECK(x.dot(norm * x) == doctest::Approx(expected).epsilon(0.02));
  }
}

TEST_CASE("what is beyond white does not count; else the slope is that of CIELAB's lightness") {
  using gonio::detail::lightness_slope;
  CHECK(lightness_slope(1.5) == 0.0);
  for (const double luminance : {0.001, 0.008, 0.05, 0.4, 0.99}) {
    const double step = 1e-4 * luminance;
    const auto grey = [](double value) { return gonio::to_lab(gonio::rgb::Constant(value))[0]; };
    CHECK(lightness_slope(luminance) ==
          doctest::Approx((grey(luminance + step) - grey(luminance - step)) / (2.0 * step)).epsilon(1e-4));
  }
}

TEST_CASE("the same bytes for any number of threads, and only over the same cells") {
  const gonio::render::sphere_operator sphere = lit_sphere(12);
  const Eigen::MatrixXd norm = gonio::perceived_norm(few_materials(), sphere, {1});
  CHECK(norm == gonio::perceived_norm(few_materials(), sphere, {3}));
  CHECK(norm == norm.transpose());
  const gonio::render::sphere_operator other(gonio::valid_cells(gonio::grid({8, 7, 9})), gonio::render::two_lights(),
                                             4);
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::perceived_norm(few_materials(), other)),
                       doctest::Contains("over the same cells"), gonio::error);
}
