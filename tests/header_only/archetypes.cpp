// Every template of the heart with the smallest models of its concepts, and the functions beside them: what compiles
// and links against the headers alone must against gonio::compiled, and give the same.

#include "../archetypes.hpp"

#include <gonio/estimate/decomposition.hpp>
#include <gonio/solve/choose_eta.hpp>
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/least_squares.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/quadratic_program.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <doctest/doctest.h>

namespace {

const gonio::valid_cells& cells() {
  static const gonio::valid_cells small(gonio::grid({10, 8, 12}));
  return small;
}

gonio::sample_set grey_samples(double value) {
  gonio::sample_set samples;
  for (int i = 1; i < 9; ++i)
    samples.push_back({{gonio::radians(5.0 * i), gonio::radians(4.0 * i), 1.0}, gonio::rgb::Constant(value), 1.0});
  return samples;
}

static_assert(gonio::tabulated_brdf<gonio::fitted_brdf<archetype::constant_basis>>);
static_assert(gonio::tabulated_brdf<gonio::fitted_brdf<archetype::theta_d_polynomial>>);

/// The constant function fits constant samples by any solver.
template <class Solver>
void check_constant(const Solver& solver) {
  const auto fit = gonio::decomposition{archetype::constant_basis{cells()}, solver}.fit(grey_samples(0.25));
  CHECK(fit.weights()(0, 0) == doctest::Approx(0.25).epsilon(1e-6));
  CHECK(fit.report()->kkt_residual.maxCoeff() <= 1e-9);
  const gonio::brdf_table table = fit.tabulate(cells());
  CHECK(table.at(0).x() == doctest::Approx(0.25).epsilon(1e-6));
  CHECK(fit({0, 0, 1}, {0.6, 0, 0.8}).y() == doctest::Approx(0.25).epsilon(1e-6));
}

}  // namespace

TEST_CASE("a constant by every solver") {
  check_constant(archetype::ordinary_least_squares{});
  check_constant(gonio::tikhonov{1e-9});
  check_constant(gonio::least_squares{});
  check_constant(gonio::truncated_svd{});
  check_constant(gonio::nnls{});
  check_constant(gonio::quadratic_program{});
  check_constant(gonio::lasso{1e-9});
  check_constant(gonio::automatic_tikhonov{});
}

TEST_CASE("a computed basis") {
  gonio::sample_set samples;
  for (int i = 1; i < 9; ++i) {
    const gonio::half_difference angles{0.1, gonio::radians(8.0 * i), 1.0};
    samples.push_back({angles, gonio::rgb::Constant(1.0 + angles.theta_d), 1.0});
  }
  const auto fit = gonio::decomposition{archetype::theta_d_polynomial{cells()}, gonio::least_squares{}}.fit(samples);
  CHECK(fit.weights()(0, 2) == doctest::Approx(1.0).epsilon(1e-9));
  CHECK(fit.weights()(1, 2) == doctest::Approx(1.0).epsilon(1e-9));
}

TEST_CASE("a table is fitted cell by cell, and bad samples are refused") {
  const gonio::decomposition estimator{archetype::constant_basis{cells()}, gonio::tikhonov{1e-9}};
  const auto table = estimator.fit(grey_samples(0.5)).tabulate(cells());
  CHECK(estimator.fit(table).weights()(0, 1) == doctest::Approx(0.5).epsilon(1e-6));
  CHECK_THROWS_WITH_AS(estimator.fit(gonio::sample_set{}), "there are no samples: at least one is needed",
                       gonio::error);
}
