/// Every sensible combination of basis, metric and solver: fitted, certified, tabulated, evaluated.

#include "../solve/oracles/nnls_block_pivoting.hpp"
#include "../solve/oracles/nnls_coordinate_descent.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/basis/measured.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/metric/root.hpp>
#include <gonio/solve/any_solver.hpp>
#include <gonio/solve/choose_eta.hpp>
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/least_squares.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/quadratic_program.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <doctest/doctest.h>

#include <tuple>

namespace {

constexpr std::size_t truth_index = 2;

const gonio::material_set& materials() {
  static const auto synthetic = synthetic_materials(small_cells(), 6);
  return synthetic;
}

const gonio::sample_set& samples() {
  static const auto measured =
      gonio::sample_table(materials().table(truth_index), gonio::random_cells(small_cells(), 80, 5));
  return measured;
}

/// Solvers whose weights may have any sign.
auto free_solvers() {
  return std::tuple{gonio::tikhonov{1e-6},
                    gonio::automatic_tikhonov{gonio::eta_criterion::generalised_cross_validation},
                    gonio::automatic_tikhonov{gonio::eta_criterion::leave_one_out},
                    gonio::least_squares{},
                    gonio::truncated_svd{0.9999999},
                    gonio::lasso{1e-7}};
}

/// Solvers whose weights are at least zero.
auto non_negative_solvers() {
  return std::tuple{gonio::nnls{}, gonio::nnls_block_pivoting{}, gonio::nnls_coordinate_descent{},
                    gonio::quadratic_program{}, gonio::non_negative_lasso{1e-7}};
}

/// The material belongs to the basis: the fit explains its measurements and predicts the rest of it.
template <class Basis>
void check_fit(const gonio::fitted_brdf<Basis>& fit) {
  REQUIRE(fit.report());
  CHECK(fit.report()->kkt_residual.maxCoeff() <= 1e-9);
  CHECK(fit.weights().allFinite());
  CHECK(fit.weights().rows() == std::ssize(fit.functions()));
  CHECK(fit.weights().cols() == 3);
  CHECK(fit.report()->residual.size() == 3);
  CHECK(fit.report()->objective.size() == 3);

  const auto table = fit.tabulate(small_cells()), simple = fit.tabulate_cells(small_cells());
  const auto truth = materials().table(truth_index);
  double error = 0.0;
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell) {
    error = std::max(error, ((table.at(cell) - truth.at(cell)) / (truth.at(cell) + 0.1)).abs().maxCoeff());
    REQUIRE((table.at(cell) - simple.at(cell)).abs().maxCoeff() <= 1e-5 * (1.0 + truth.at(cell).maxCoeff()));
    REQUIRE((table.at(cell) >= 0.0).all());
  }
  CHECK(error < 0.05);
  CHECK((fit({0, 0, 1}, {0.6, 0, 0.8}) >= 0.0).all());
}

template <class Basis, class Solver>
void check_triple(const Basis& basis, const Solver& solver) {
  const gonio::decomposition estimator{basis, solver};
  static_assert(gonio::estimator<decltype(estimator)>);
  const auto fit = estimator.fit(samples());
  if (gonio::solves_non_negative<Solver>) CHECK(fit.weights().minCoeff() >= 0.0);
  check_fit(fit);
}

template <class Basis, class Solvers>
void check_solvers(const Basis& basis, const Solvers& solvers) {
  std::apply([&](const auto&... solver) { (check_triple(basis, solver), ...); }, solvers);
}

template <class Metric>
void check_metric(const Metric& metric) {
  const gonio::measured tables{materials(), metric};
  check_solvers(tables, free_solvers());
  check_solvers(tables, non_negative_solvers());
  check_solvers(gonio::learn_pca(materials(), metric, 17), free_solvers());
}

template <class Basis, class Solver>
concept decomposes = requires(Basis basis, Solver solver) {
  gonio::decomposition<Basis, Solver>(basis, solver);
};

}  // namespace

TEST_CASE("linear reflectance with every basis and solver") { check_metric(gonio::lin{}); }
TEST_CASE("its root") { check_metric(gonio::root{}); }
TEST_CASE("its logarithm") { check_metric(gonio::log{}); }
TEST_CASE("its logarithm relative to the median") { check_metric(gonio::log_relative::to_median_of(materials())); }

TEST_CASE("a solver chosen at run time") {
  check_triple(gonio::measured{materials(), gonio::log{}}, gonio::any_solver(gonio::nnls{}));
}

TEST_CASE("non-negative weights of principal components are no estimator") {
  using components = gonio::pca<gonio::log>;
  using tables = gonio::measured<gonio::log>;
  static_assert(decomposes<components, gonio::tikhonov> && decomposes<components, gonio::lasso>);
  static_assert(decomposes<components, gonio::quadratic_program<gonio::linear_constraints>>);
  static_assert(decomposes<tables, gonio::nnls> && decomposes<tables, gonio::tikhonov>);
  static_assert(!decomposes<components, gonio::nnls> && !decomposes<components, gonio::quadratic_program<>>);
  static_assert(!decomposes<components, gonio::nnls_block_pivoting> &&
                !decomposes<components, gonio::non_negative_lasso>);
}
