#include <gonio/solve/levenberg_marquardt.hpp>
#include <gonio/solve/nnls.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>

namespace {

constexpr double unbounded = std::numeric_limits<double>::infinity();

/// Residuals 10 (y - x^2) and 1 - x.
gonio::local_parabola rosenbrock(const Eigen::VectorXd& at) {
  const double x = at[0], y = at[1];
  const Eigen::Vector2d residual(10.0 * (y - x * x), 1.0 - x);
  Eigen::Matrix2d jacobian;
  jacobian << -20.0 * x, 10.0, -1.0, 0.0;
  return {0.5 * residual.squaredNorm(), jacobian.transpose() * residual, jacobian.transpose() * jacobian};
}

gonio::unknown_bounds box(Eigen::Index n, double lowest, double highest) {
  return {Eigen::VectorXd::Constant(n, lowest), Eigen::VectorXd::Constant(n, highest)};
}

}  // namespace

TEST_CASE("Levenberg and Marquardt find the bottom of Rosenbrock's valley") {
  const auto found = gonio::levenberg_marquardt(rosenbrock, Eigen::Vector2d(-1.2, 1.0), box(2, -unbounded, unbounded));
  CHECK(found.converged);
  CHECK((found.unknowns - Eigen::Vector2d(1.0, 1.0)).norm() < 1e-10);
  CHECK(found.evaluations < 50);
  CHECK(found.promised_gain < 1e-12);
}

TEST_CASE("bounds hold, also at the start, and equal ones fix an unknown") {
  // Below x = 0.5 the bottom of the valley is y = x^2, so the minimum is at the corner (0.5, 0.25).
  gonio::unknown_bounds bounds = box(2, -2.0, 0.5);
  const auto watched = [&](const Eigen::VectorXd& x) {
    CHECK((x.array() >= bounds.lowest.array()).all());
    CHECK((x.array() <= bounds.highest.array()).all());
    return rosenbrock(x);
  };
  const auto bounded = gonio::levenberg_marquardt(watched, Eigen::Vector2d(5.0, -7.0), bounds);
  CHECK((bounded.unknowns - Eigen::Vector2d(0.5, 0.25)).norm() < 1e-9);
  CHECK(bounded.promised_gain < 1e-12);

  bounds.lowest[0] = bounds.highest[0] = -1.0;
  bounds.highest[1] = 9.0;
  const auto fixed = gonio::levenberg_marquardt(watched, Eigen::Vector2d(0.0, 0.0), bounds);
  CHECK(fixed.unknowns[0] == -1.0);
  CHECK(fixed.unknowns[1] == doctest::Approx(1.0));
}

TEST_CASE("a linear problem with bounds at zero has the solution of NNLS") {
  CHECK(rc::check([] {
    const int n = *rc::gen::inRange(1, 7);
    const auto seed = *rc::gen::arbitrary<unsigned>();
    std::srand(seed);
    const Eigen::MatrixXd a = Eigen::MatrixXd::Random(12, n);
    const Eigen::VectorXd b = Eigen::VectorXd::Random(12);
    const Eigen::MatrixXd gram = a.transpose() * a, rhs = a.transpose() * b;
    const auto squares = [&](const Eigen::VectorXd& x) -> gonio::local_parabola {
      return {0.5 * (a * x - b).squaredNorm(), gram * x - rhs, gram};
    };
    const auto found = gonio::levenberg_marquardt(squares, Eigen::VectorXd::Ones(n), box(n, 0.0, unbounded));
    const Eigen::VectorXd expected = gonio::nnls().solve(gonio::normal_equations(gram, rhs)).weights;
    RC_ASSERT(found.converged);
    RC_ASSERT((found.unknowns - expected).norm() <= 1e-6 * (1.0 + expected.norm()));
  }));
}

TEST_CASE("steps to where the function is no number are taken back") {
  const auto root = [](const Eigen::VectorXd& x) -> gonio::local_parabola {
    const double residual = std::sqrt(x[0]) - 0.01, slope = 0.5 / std::sqrt(x[0]);
    return {0.5 * residual * residual, Eigen::VectorXd::Constant(1, slope * residual),
            Eigen::MatrixXd::Constant(1, 1, slope * slope)};
  };
  const auto found = gonio::levenberg_marquardt(root, Eigen::VectorXd::Constant(1, 4.0), box(1, -unbounded, unbounded));
  CHECK(found.unknowns[0] == doctest::Approx(1e-4));
}

TEST_CASE("no unknowns: one evaluation; and an iteration limit that comes first is reported") {
  const auto constant = [](const Eigen::VectorXd&) -> gonio::local_parabola { return {3.0, {}, {}}; };
  const auto nothing = gonio::levenberg_marquardt(constant, Eigen::VectorXd(), {});
  CHECK(nothing.value == 3.0);
  CHECK(nothing.converged);
  const auto early = gonio::levenberg_marquardt(rosenbrock, Eigen::Vector2d(-1.2, 1.0), box(2, -unbounded, unbounded),
                                                {.iteration_limit = 2});
  CHECK(!early.converged);
  CHECK(early.value < rosenbrock(Eigen::Vector2d(-1.2, 1.0)).value);
  CHECK(early.promised_gain > 1e-6);
}
