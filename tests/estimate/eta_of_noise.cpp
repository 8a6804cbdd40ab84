#include "../synthetic_materials.hpp"
#include <gonio/basis/project.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/eta_of_noise.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <numeric>

namespace {

/// Returns the squared distance between weights and a table, over all cells, for each channel.
Eigen::Array3d squared_distance(const gonio::log_relative_pca& prior, const Eigen::MatrixXd& weights,
                                const gonio::brdf_table& table) {
  Eigen::Array3d squares = Eigen::Array3d::Zero();
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell) {
    const Eigen::RowVectorXd row = gonio::row_at(prior, gonio::locate_cell(table.cells(), cell));
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double truth = prior.metric().forward(table.at(cell)[c], cell);
      squares[c] += std::pow(prior.offset(cell) + row.dot(weights.col(c)) - truth, 2);
    }
  }
  return squares;
}

gonio::sample_set measured_at(const gonio::brdf_table& table, std::span<const Eigen::Index> cells) {
  gonio::sample_set samples = gonio::sample_table(table, cells);
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].weight = 0.5 + static_cast<double>(i % 3);
  return samples;
}

/// The definition: learns again without each material, and reconstructs it.
double by_learning_again(const gonio::material_set& materials, std::span<const Eigen::Index> cells, double eta) {
  const auto metric = gonio::log_relative::to_median_of(materials);
  double sum = 0.0;
  for (std::size_t material = 0; material < materials.names.size(); ++material) {
    std::vector<Eigen::Index> others(materials.names.size());
    std::iota(others.begin(), others.end(), std::size_t{0});
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(material));
    const auto prior = gonio::learn_pca(materials.subset(others), metric, 1000);
    const auto table = materials.table(material);
    const auto fit = gonio::decomposition{prior, gonio::tikhonov{eta}}.fit(measured_at(table, cells));
    sum += squared_distance(prior, fit.weights(), table).sqrt().sum();
  }
  return sum / static_cast<double>(3 * materials.names.size());
}

gonio::leave_one_material_out_error error_of(const gonio::log_relative_pca& prior, std::span<const Eigen::Index> cells,
                                             double noise) {
  const auto samples = measured_at(gonio::brdf_table(prior.cells()), cells);
  const auto located = gonio::locate_samples(prior.cells(), samples);
  return {prior, located.locations, located.weights, noise};
}

double at_one_eta(const gonio::leave_one_material_out_error& error, double eta) {
  return error(Eigen::VectorXd::Constant(1, eta))[0];
}

const gonio::log_relative_pca& twelve_materials() {
  static const auto prior = learn(synthetic_materials(small_cells(), 12), 1000);
  return prior;
}

}  // namespace

TEST_CASE("the error of leaving a material out depends on eta by its ratio to the weights") {
  const auto& prior = twelve_materials();
  const auto cells = gonio::random_cells(small_cells(), 30, 3);
  const auto located = gonio::locate_samples(prior.cells(), measured_at(gonio::brdf_table(prior.cells()), cells));
  const auto error = [&](double factor) {
    const Eigen::VectorXd weights = factor * located.weights;
    const gonio::leave_one_material_out_error scaled(prior, located.locations, weights, 0.1);
    return at_one_eta(scaled, 0.5 * factor);
  };
  for (const double factor : {1e-8, 1e8}) CHECK(error(factor) == doctest::Approx(error(1.0)).epsilon(1e-6));
}

TEST_CASE("leaving a material out is learning again without it") {
  const auto materials = synthetic_materials(small_cells(), 6);
  const auto prior = learn(materials, 1000);
  for (const std::size_t count : {1u, 4u, 60u}) {  // fewer and more locations than components
    const auto cells = gonio::random_cells(small_cells(), count, count);
    const auto error = error_of(prior, cells, 0.0);
    for (const double eta : {0.01, 1.0, 30.0}) {
      CAPTURE(count);
      CAPTURE(eta);
      CHECK(at_one_eta(error, eta) == doctest::Approx(by_learning_again(materials, cells, eta)).epsilon(2e-3));
    }
  }
}

TEST_CASE("noise adds the variance of the reconstruction, and shifts the measured values") {
  const auto& prior = twelve_materials();
  const auto cells = gonio::random_cells(small_cells(), 5, 1);
  const auto samples = measured_at(gonio::brdf_table(prior.cells()), cells);
  const auto located = gonio::locate_samples(prior.cells(), samples);
  const auto noise = gonio::map_noise(prior, located.locations, 0.1);
  for (Eigen::Index i = 0; i < 5; ++i) {
    // Far above epsilon the map is a logarithm: E ln(1 + b z) = -b^2 / 2 and the variance is b^2, up to O(b^4).
    CHECK(noise.shift[i] == doctest::Approx(-0.005).epsilon(0.1));
    CHECK(noise.variance[i] == doctest::Approx(0.01).epsilon(0.1));
  }

  // A penalty this large gives the mean material. The error is then that of the mean for any noise.
  const double without = at_one_eta(error_of(prior, cells, 0.0), 1e12);
  CHECK(at_one_eta(error_of(prior, cells, 0.3), 1e12) == doctest::Approx(without).epsilon(1e-6));

  // With large noise and a small penalty, nearly all of the error is noise. Its squared norm is the sum over the
  // locations of the response to unit noise times the variance.
  const double eta = 1e-4;
  Eigen::MatrixXd rows(5, prior.size());
  for (Eigen::Index i = 0; i < 5; ++i) rows.row(i) = gonio::row_at(prior, located.locations[i]);
  const auto spread = gonio::map_noise(prior, located.locations, 0.3);
  double squares = 0.0;
  for (Eigen::Index i = 0; i < 5; ++i) {
    const Eigen::MatrixXd one = Eigen::VectorXd::Unit(5, i) * std::sqrt(spread.variance[i]);
    const auto response = gonio::tikhonov(eta).solve(gonio::least_squares_problem{rows, one, located.weights}).weights;
    squares += (prior.singular_values().asDiagonal() * response).squaredNorm();
  }
  const double quiet = at_one_eta(error_of(prior, cells, 0.0), eta),
               loud = at_one_eta(error_of(prior, cells, 0.3), eta);
  REQUIRE(std::sqrt(squares) > 10.0 * quiet);
  CHECK(loud == doctest::Approx(std::sqrt(squares)).epsilon(0.1));
}

TEST_CASE("the order of the locations does not matter, and weights have the units of eta") {
  CHECK(rc::check([] {
    const auto& prior = twelve_materials();
    const auto count = *rc::gen::inRange<std::size_t>(1, 60);
    auto cells = gonio::random_cells(small_cells(), count, *rc::gen::arbitrary<std::uint64_t>());
    const double noise = *rc::gen::inRange(0, 50) * 0.01, eta = std::pow(10.0, *rc::gen::inRange(-10, 30) * 0.1);
    auto located = gonio::locate_samples(prior.cells(), gonio::sample_table(gonio::brdf_table(prior.cells()), cells));
    const double error = at_one_eta({prior, located.locations, located.weights, noise}, eta);
    const Eigen::VectorXd tenfold = 10.0 * located.weights;
    RC_ASSERT(std::abs(at_one_eta({prior, located.locations, tenfold, noise}, 10.0 * eta) - error) < 1e-6 * error);
    std::ranges::reverse(located.locations);
    RC_ASSERT(std::abs(at_one_eta({prior, located.locations, located.weights, noise}, eta) - error) < 1e-6 * error);
  }));
}

TEST_CASE("the chosen eta is the best of a dense scan, and grows with the noise") {
  const auto& prior = twelve_materials();
  for (const std::size_t count : {5u, 40u}) {
    const auto cells = gonio::random_cells(small_cells(), count, 3);
    const auto samples = measured_at(gonio::brdf_table(prior.cells()), cells);
    double smaller = 0.0;
    for (const double noise : {0.0, 0.1, 0.3, 1.0}) {
      const double eta = gonio::eta_of_noise(prior, samples, noise);
      const auto error = error_of(prior, cells, noise);
      const Eigen::VectorXd scan = gonio::geometric_sequence(1e-7 * error.largest(), 1e2 * error.largest(), 501);
      CHECK(at_one_eta(error, eta) <= 1.001 * error(scan).minCoeff());
      CHECK(eta >= smaller);
      smaller = eta;
    }
    CHECK(smaller > 10.0 * gonio::eta_of_noise(prior, samples, 0.0));
    const auto range = gonio::plausible_etas(prior, samples);
    CHECK(range.lowest == gonio::eta_of_noise(prior, samples, 0.0));
    CHECK(range.highest == gonio::eta_of_noise(prior, samples, 0.3));
  }
}

TEST_CASE("without a stated noise, cross-validation chooses eta among the plausible ones") {
  const auto& prior = twelve_materials();
  const auto materials = synthetic_materials(small_cells(), 3, 99);
  for (const std::size_t count : {1u, 4u, 30u}) {
    const auto cells = gonio::random_cells(small_cells(), count, 8);
    const auto samples = gonio::sample_table(materials.table(1), cells, {.noise = 0.1}, 2);
    const auto range = gonio::plausible_etas(prior, samples);
    const double eta = gonio::eta_of_unknown_noise(prior, samples);
    CHECK(eta >= range.lowest);
    CHECK(eta <= range.highest);
    if (count == 1) {
      CHECK(eta == range.highest);
      continue;
    }
    const auto problem = gonio::basis_equations(prior, gonio::locate_samples(prior.cells(), samples)).problem();
    const auto criterion = gonio::eta_criterion::generalised_cross_validation;
    const Eigen::VectorXd scan = gonio::geometric_sequence(range.lowest, range.highest, 301);
    CHECK(gonio::cross_validate(problem, criterion, Eigen::VectorXd::Constant(1, eta))[0] <=
          1.001 * gonio::cross_validate(problem, criterion, scan).minCoeff());
  }
}

TEST_CASE("components that are left out are noise of the measurements") {
  const auto& prior = twelve_materials();
  const auto cells = gonio::random_cells(small_cells(), 20, 5);
  const auto samples = measured_at(gonio::brdf_table(prior.cells()), cells);
  const auto few = prior.truncated(4);
  REQUIRE(few.explained_variance() < 0.999);
  gonio::pca_parts<gonio::log_relative> parts{few.cells(),      few.metric(), few.names(),        few.singular_values(),
                                              few.components(), few.mean(),   few.coefficients(), 1.0};
  CHECK(gonio::eta_of_noise(few, samples, 0.0) > gonio::eta_of_noise(gonio::log_relative_pca(parts), samples, 0.0));
}

TEST_CASE("an eta is not chosen from nothing") {
  const auto& prior = twelve_materials();
  const auto samples = gonio::sample_table(gonio::brdf_table(prior.cells()), gonio::random_cells(small_cells(), 2, 1));
  CHECK_THROWS_WITH_AS(gonio::eta_of_noise(prior, samples, -0.1),
                       "the noise must be finite and not negative, not -0.100000", gonio::error);
  CHECK_THROWS_AS(gonio::eta_of_noise(prior, samples, std::nan("")), gonio::error);
  CHECK_THROWS_AS(gonio::eta_of_noise(prior, gonio::sample_set{}, 0.1), gonio::error);
  const auto located = gonio::locate_samples(prior.cells(), samples);
  CHECK_THROWS_AS(gonio::leave_one_material_out_error(prior, located.locations, Eigen::VectorXd::Ones(3), 0.1),
                  gonio::error);
  const auto single = learn(synthetic_materials(small_cells(), 1), 2);
  CHECK_THROWS_AS(gonio::eta_of_noise(single, samples, 0.1), gonio::error);
}
