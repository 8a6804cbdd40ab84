#include "../dense_reference.hpp"
#include "made_up_candidates.hpp"
#include <gonio/design/design_criterion.hpp>
#include <gonio/design/expected_error.hpp>

#include <doctest/doctest.h>

using gonio::expected_error;
static_assert(gonio::design_criterion<expected_error>);

namespace {

Eigen::MatrixXd components_at(const std::vector<std::size_t>& cells) {
  Eigen::MatrixXd rows(std::ssize(cells), static_cast<Eigen::Index>(candidate_basis().size()));
  for (std::size_t i = 0; i < cells.size(); ++i)
    rows.row(static_cast<Eigen::Index>(i)) =
        candidate_basis().components().row(static_cast<Eigen::Index>(cells[i])).cast<double>();
  return rows;
}

/// Eq. 15 as printed, with p-dimensional norms in which each cell counts as much as `weights` says.
double as_printed(const Eigen::MatrixXd& measured, double eta, double beta, const Eigen::VectorXd& weights) {
  const Eigen::MatrixXd q = candidate_basis().components().cast<double>();
  const Eigen::MatrixXd c = candidate_basis().coefficients().cast<double>();
  const Eigen::Index k = q.cols();
  const Eigen::MatrixXd inverse =
      dense_reference::inverse(measured.transpose() * measured + eta * Eigen::MatrixXd::Identity(k, k)) *
      measured.transpose();
  const auto norm = [&](const Eigen::VectorXd& x) { return x.cwiseProduct(weights.cwiseSqrt()).norm(); };
  double sum = 0.0;
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    const Eigen::VectorXd y = c.row(i).transpose();
    sum += norm(q * (y - inverse * (measured * y)));
  }
  return sum / static_cast<double>(c.rows()) + beta * norm(q * (inverse * Eigen::VectorXd::Ones(measured.rows())));
}

}  // namespace

TEST_CASE("it is Eq. 15 as printed") {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(small_cells().size()));
  for (const double eta : {0.01, 1.0, 40.0})
    for (const double beta : {0.0, 0.3}) {
      const expected_error criterion(candidate_basis(), {.eta = eta, .noise = beta});
      for (const std::vector<std::size_t>& cells :
           {std::vector<std::size_t>{5}, {0, 100}, {3, 60, 200, 222, 310}, {7, 7, 8}}) {
        const Eigen::MatrixXd measured = components_at(cells);
        // Components are stored as float: Q'Q is Sigma^2 to its precision.
        CHECK(criterion(criterion.prepare(measured)) ==
              doctest::Approx(as_printed(measured, eta, beta, ones)).epsilon(1e-5));
      }
    }
}

TEST_CASE("cells count as much as the norm says") {
  const Eigen::Index p = static_cast<Eigen::Index>(small_cells().size());
  const Eigen::VectorXd weights = Eigen::VectorXd::LinSpaced(p, 0.0, 2.0);
  const Eigen::MatrixXd q = candidate_basis().components().cast<double>();
  const expected_error criterion(candidate_basis(), {.eta = 0.7, .noise = 0.2},
                                 q.transpose() * weights.asDiagonal() * q);
  const Eigen::MatrixXd measured = components_at({3, 60, 200, 222, 310});
  CHECK(criterion(criterion.prepare(measured)) ==
        doctest::Approx(as_printed(measured, 0.7, 0.2, weights)).epsilon(1e-6));
}

TEST_CASE("errors of their own: the reconstruction expects them, and they add their mean square") {
  const Eigen::MatrixXd measured = components_at({3, 60, 200, 222, 310}),
                        q = candidate_basis().components().cast<double>(),
                        c = candidate_basis().coefficients().cast<double>();
  const double eta = 0.7, m = static_cast<double>(c.rows());
  const expected_error criterion(candidate_basis(), {.eta = eta});
  auto rows = criterion.prepare(measured);
  rows.own_eta << 0.0, 0.3, 5.0, 1e-3, 40.0;

  Eigen::MatrixXd k = measured * measured.transpose();
  k.diagonal() += (eta + rows.own_eta.array()).matrix();
  const Eigen::MatrixXd inverse = measured.transpose() * dense_reference::inverse(k), spread = q * inverse;
  const double own = (spread.colwise().squaredNorm() * rows.own_eta / m).value();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    const Eigen::VectorXd y = c.row(i).transpose();
    sum += std::sqrt((q * (y - inverse * (measured * y))).squaredNorm() + own);
  }
  CHECK(own > 0.0);
  CHECK(criterion(rows) == doctest::Approx(sum / m).epsilon(1e-6));
  CHECK(criterion(rows) > criterion(measured));
}

TEST_CASE("nothing measured: the mean distance of the materials from their mean; more measurements leave less") {
  const expected_error criterion(candidate_basis(), {.eta = 1e-3});
  const auto error = [&](const std::vector<std::size_t>& cells) {
    return criterion(criterion.prepare(components_at(cells)));
  };
  CHECK(error({}) == doctest::Approx(criterion.energies().cwiseSqrt().mean()));
  std::vector<std::size_t> every(small_cells().size());
  std::iota(every.begin(), every.end(), std::size_t{0});
  CHECK(error(every) < 1e-3 * error({}));
  CHECK(error({5}) < error({}));
}

TEST_CASE("what cannot be is refused") {
  CHECK_THROWS_WITH_AS(expected_error(candidate_basis(), {.eta = 0.0}), doctest::Contains("eta must be positive"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(expected_error(candidate_basis(), {.noise = -1.0}), doctest::Contains("not negative"),
                       gonio::error);
  CHECK_THROWS_AS(expected_error(candidate_basis(), {.eta = std::nan("")}), gonio::error);
  CHECK_THROWS_WITH_AS(expected_error(candidate_basis(), {}, Eigen::MatrixXd::Identity(2, 2)),
                       doctest::Contains("square matrix"), gonio::error);
}
