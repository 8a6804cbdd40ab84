#include <gonio/solve/kkt.hpp>

#include <doctest/doctest.h>

using gonio::kkt_violation;
using gonio::normal_equations;
using gonio::sign_rule;

namespace {

/// Two columns of lengths 1 and 1000. The unconstrained optimum is (2, -0.001).
normal_equations two_columns() {
  return {Eigen::Vector2d(1, 1e6).asDiagonal(), Eigen::MatrixXd(Eigen::Vector2d(2, -1000)), Eigen::VectorXd::Ones(1)};
}

}  // namespace

TEST_CASE("the gradient is measured in units of the columns' lengths and relative to its terms") {
  const auto normal = two_columns();
  CHECK(gonio::stationarity(normal, Eigen::Vector2d(2, -0.001))[0] == 0.0);
  // At zero the scaled gradient is (-2, 1), and its largest term is 2.
  CHECK(gonio::stationarity(normal, Eigen::Vector2d(0, 0))[0] == 1.0);
  // Off by one scaled unit in the second column: terms |m| + |Qx| are at most 4.
  CHECK(gonio::stationarity(normal, Eigen::Vector2d(2, 0))[0] == 0.25);
}

TEST_CASE("KKT conditions of NNLS: the gradient may push against the bound, not away from it") {
  const auto normal = two_columns();
  CHECK(kkt_violation(normal, Eigen::Vector2d(2, 0), 0.0, sign_rule::non_negative)[0] == 0.0);
  CHECK(kkt_violation(normal, Eigen::Vector2d(0, 0), 0.0, sign_rule::non_negative)[0] == 1.0);
  CHECK(std::isinf(kkt_violation(normal, Eigen::Vector2d(2, -0.001), 0.0, sign_rule::non_negative)[0]));
}

TEST_CASE("KKT conditions of the Lasso, with both signs and with one") {
  const auto normal = two_columns();
  // |x|_1 has a penalty of 0.5: x = soft-threshold(2, 0.5) = 1.5, and -(1000 - 0.5) / 1e6.
  CHECK(kkt_violation(normal, Eigen::Vector2d(1.5, -999.5e-6), 0.5, sign_rule::any)[0] < 1e-15);
  CHECK(kkt_violation(normal, Eigen::Vector2d(1.5, 0), 0.5, sign_rule::any)[0] > 0.1);
  CHECK(kkt_violation(normal, Eigen::Vector2d(1.5, 0), 0.5, sign_rule::non_negative)[0] < 1e-15);
  CHECK(kkt_violation(normal, Eigen::Vector2d(0, 0), 1000.0, sign_rule::any)[0] <= 0.0);
}

TEST_CASE("a problem of zeros is solved by zeros") {
  const normal_equations normal(Eigen::MatrixXd::Zero(2, 2), Eigen::MatrixXd::Zero(2, 1));
  CHECK(gonio::stationarity(normal, Eigen::Vector2d(0, 0))[0] == 0.0);
}
