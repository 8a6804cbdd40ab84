#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/estimate/discrepancy_decomposition.hpp>
#include <gonio/estimate/estimator.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Cholesky>

#include <cmath>
#include <vector>

using gonio::discrepancy_decomposition;
using gonio::discrepancy_model;
using gonio::sample_set;
using gonio::valid_cells;

static_assert(gonio::estimator<discrepancy_decomposition<gonio::log_relative>>);

namespace {

const valid_cells& discrepancy_cells() {
  static const valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::log_relative_pca& discrepancy_prior() {
  static const auto learned = learn(synthetic_materials(discrepancy_cells(), 8), 10);
  return learned;
}

/// A material of the prior with a wave that no combination of its components has.
gonio::brdf_table wavy_material() {
  gonio::brdf_table table = synthetic_materials(discrepancy_cells(), 8).table(3);
  for (Eigen::Index cell = 0; cell < discrepancy_cells().size(); ++cell) {
    const auto angles = discrepancy_cells().angles(cell);
    const double wave = std::exp(0.4 * std::sin(6.0 * std::sqrt(angles.theta_h)) * std::cos(2.0 * angles.theta_d));
    table.set(cell, wave * table.at(cell));
  }
  return table;
}

double mapped_error(const gonio::brdf_table& estimate, const gonio::brdf_table& truth) {
  double sum = 0.0;
  for (Eigen::Index cell = 0; cell < discrepancy_cells().size(); ++cell)
    for (Eigen::Index c = 0; c < 3; ++c)
      sum += std::pow(discrepancy_prior().metric().forward(estimate.at(cell)[c], cell) -
                          discrepancy_prior().metric().forward(truth.at(cell)[c], cell),
                      2);
  return std::sqrt(sum / static_cast<double>(3 * discrepancy_cells().size()));
}

}  // namespace

TEST_CASE("the fit is the posterior mean of prior and discrepancy") {
  const sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 25, 2));
  const discrepancy_model model{.variance = 0.05, .error_variance = 0.01};
  const auto fit = discrepancy_decomposition{discrepancy_prior(), model}.fit(samples);

  // The textbook's: k(x, X) (k(X, X) + variance of the errors)^-1 y.
  const auto located = gonio::locate_samples(discrepancy_cells(), samples);
  std::vector<gonio::half_difference> places;
  for (const auto& at : located.locations) places.push_back(at.angles);
  const double m = 24.0;
  const gonio::discrepancy_functions smooth(places, 1.0);
  const auto covariance = [&](const gonio::location& a, const gonio::location& b) {
    std::vector<double> x(25), y(25);
    smooth.read(a.angles, x.data());
    smooth.read(b.angles, y.data());
    double sum = gonio::row_at(discrepancy_prior(), a).dot(gonio::row_at(discrepancy_prior(), b)) / m;
    for (Eigen::Index i = 0; i < 25; ++i) sum += model.variance * x[i] * y[i];
    return sum;
  };
  Eigen::MatrixXd among(25, 25);
  Eigen::VectorXd y(25);
  for (Eigen::Index i = 0; i < 25; ++i) {
    const auto& at = located.locations[i];
    y[i] = discrepancy_prior().metric().forward(located.values(i, 1), at) - gonio::offset_at(discrepancy_prior(), at);
    for (Eigen::Index j = 0; j < 25; ++j)
      among(i, j) = covariance(at, located.locations[j]) + (i == j ? model.error_variance : 0);
  }
  const Eigen::VectorXd dual = among.llt().solve(y);
  const gonio::brdf_table table = fit.tabulate(discrepancy_cells());
  for (const Eigen::Index cell : gonio::random_cells(discrepancy_cells(), 40, 9)) {
    const auto at = gonio::locate_cell(discrepancy_cells(), cell);
    double expected = gonio::offset_at(discrepancy_prior(), at);
    for (Eigen::Index i = 0; i < 25; ++i) expected += dual[i] * covariance(at, located.locations[i]);
    CHECK(discrepancy_prior().metric().forward(table.at(cell).y(), at) == doctest::Approx(expected).epsilon(1e-3));
  }
}

TEST_CASE("what the components cannot say is learned from many samples") {
  const gonio::brdf_table truth = wavy_material();
  const sample_set samples = gonio::sample_table(truth, gonio::random_cells(discrepancy_cells(), 200, 5));
  const double with =
      mapped_error(discrepancy_decomposition{discrepancy_prior()}.fit(samples).tabulate(discrepancy_cells()), truth);
  const double without = mapped_error(
      gonio::decomposition{discrepancy_prior(), gonio::tikhonov{24 * 0.007}}.fit(samples).tabulate(discrepancy_cells()),
      truth);
  CAPTURE(with);
  CAPTURE(without);
  CHECK(with < 0.5 * without);
}

TEST_CASE("a discrepancy of almost no variance leaves the components alone") {
  const sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 15, 5));
  const auto with =
      discrepancy_decomposition{discrepancy_prior(), {.variance = 1e-12}}.fit(samples).tabulate(discrepancy_cells());
  const auto without =
      gonio::decomposition{discrepancy_prior(), gonio::tikhonov{24 * 0.007}}.fit(samples).tabulate(discrepancy_cells());
  CHECK(mapped_error(with, without) < 1e-6);
}

TEST_CASE("noise that is stated takes weight from the samples") {
  const sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 15, 5));
  const auto distance = [&](double noise) {
    const auto fit = discrepancy_decomposition{discrepancy_prior(), {.noise = noise}}.fit(samples);
    return fit.weights().norm();
  };
  CHECK(distance(0.3) < distance(0.1));
  CHECK(distance(0.1) < distance(0.0));
}

TEST_CASE("beyond the most centres, samples are still all heard") {
  const gonio::brdf_table truth = wavy_material();
  const sample_set samples = gonio::sample_table(truth, gonio::random_cells(discrepancy_cells(), 400, 5));
  const auto all = discrepancy_decomposition{discrepancy_prior()}.fit(samples).tabulate(discrepancy_cells());
  const auto fewer = discrepancy_decomposition{discrepancy_prior(), {.most_centres = 150}}.fit(samples);
  CHECK(fewer.functions().second().size() == 150);
  CHECK(mapped_error(fewer.tabulate(discrepancy_cells()), truth) < 1.3 * mapped_error(all, truth));
}

TEST_CASE("of more samples than are fitted some are chosen at random") {
  const sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 90, 5));
  sample_set some;
  for (const Eigen::Index i : gonio::random_choice(90, 60, 0)) some.push_back(samples[i]);
  const auto of_all = discrepancy_decomposition{discrepancy_prior(), {.most_samples = 60}}.fit(samples);
  const auto of_some = discrepancy_decomposition{discrepancy_prior()}.fit(some);
  CHECK((of_all.weights() - of_some.weights()).norm() == 0.0);
}

TEST_CASE("an impossible model of a discrepancy is refused") {
  const auto refused = [](const discrepancy_model& model, std::initializer_list<std::string> words) {
    const sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 5, 5));
    scratch::check_refused([&] { return discrepancy_decomposition{discrepancy_prior(), model}.fit(samples); }, words);
  };
  refused({.variance = 0.0}, {"amplitude", "positive"});
  refused({.error_variance = 0.0}, {"error variance", "positive"});
  refused({.noise = -0.1}, {"noise", "negative"});
  refused({.most_centres = 0}, {"at least one centre"});
}
