#include <gonio/solve/growing_cholesky.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <random>
#include <vector>

TEST_CASE("columns come and go, and the factor solves for those present") {
  CHECK(rc::check([] {
    std::mt19937 engine(*rc::gen::arbitrary<unsigned>());
    std::normal_distribution<double> normal;
    constexpr Eigen::Index k = 12;
    Eigen::MatrixXd a(30, k);
    for (double& value : a.reshaped()) value = normal(engine);
    const Eigen::MatrixXd gram = a.transpose() * a;

    gonio::growing_cholesky factor(k);
    std::vector<Eigen::Index> present;
    for (int change = 0; change < 60; ++change) {
      const Eigen::Index column = engine() % k;
      const auto found = std::ranges::find(present, column);
      if (found != present.end()) {
        factor.remove(found - present.begin());
        present.erase(found);
      } else {
        Eigen::VectorXd cross = gram(present, column);
        RC_ASSERT(factor.append(cross, gram(column, column)));
        present.push_back(column);
      }
      RC_ASSERT(factor.size() == std::ssize(present));
      const Eigen::MatrixXd part = gram(present, present);
      const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(factor.size(), 1.0, 2.0);
      Eigen::VectorXd z = part * x;
      factor.solve(z);
      if (factor.size() > 0) RC_ASSERT((z - x).cwiseAbs().maxCoeff() < 1e-9);
    }
  }));
}

TEST_CASE("a column that depends on those present is refused and changes nothing") {
  gonio::growing_cholesky factor(3);
  Eigen::VectorXd none(0), one = Eigen::VectorXd::Constant(1, 6.0);
  REQUIRE(factor.append(none, 4.0));
  CHECK_FALSE(factor.append(one, 9.0));  // (3, 0), parallel to (2, 0)
  CHECK(factor.size() == 1);
  one[0] = 6.0;
  CHECK(factor.append(one, 9.0 + 1e-10));
  factor.clear();
  CHECK(factor.size() == 0);
  CHECK_FALSE(factor.append(none, 0.0));
}
