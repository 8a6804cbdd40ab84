#include "../dense_reference.hpp"
#include "synthetic_candidates.hpp"
#include <gonio/design/design_criterion.hpp>
#include <gonio/design/expected_error.hpp>
#include <gonio/estimate/leave_one_material_out_error.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

using gonio::design::expected_error;
static_assert(gonio::design::design_criterion<expected_error>);

namespace {

Eigen::MatrixXd components_at(const std::vector<Eigen::Index>& cells) {
  Eigen::MatrixXd rows(std::ssize(cells), std::ssize(candidate_basis()));
  for (Eigen::Index i = 0; i < std::ssize(cells); ++i)
    rows.row(i) = candidate_basis().components().row(cells[i]).cast<double>();
  return rows;
}

/// Eq. 15 as printed, with p-dimensional norms in which cells are weighted by `weights`.
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
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(std::ssize(small_cells()));
  for (const double eta : {0.01, 1.0, 40.0})
    for (const double beta : {0.0, 0.3}) {
      const expected_error criterion(candidate_basis(), {.eta = eta, .common_shift = beta});
      for (const std::vector<Eigen::Index>& cells :
           {std::vector<Eigen::Index>{5}, {0, 100}, {3, 60, 200, 222, 310}, {7, 7, 8}}) {
        const Eigen::MatrixXd measured = components_at(cells);
        // Components are stored as float, so Q'Q equals Sigma^2 to float precision.
        CHECK(criterion(criterion.prepare(measured)) ==
              doctest::Approx(as_printed(measured, eta, beta, ones)).epsilon(1e-5));
      }
    }
}

TEST_CASE("cells count as much as the norm says") {
  const Eigen::Index p = std::ssize(small_cells());
  const Eigen::VectorXd weights = Eigen::VectorXd::LinSpaced(p, 0.0, 2.0);
  const Eigen::MatrixXd q = candidate_basis().components().cast<double>();
  const expected_error criterion(candidate_basis(), {.eta = 0.7, .common_shift = 0.2},
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
  rows.sample_noise_penalty << 0.0, 0.3, 5.0, 1e-3, 40.0;

  Eigen::MatrixXd k = measured * measured.transpose();
  k.diagonal() += (eta + rows.sample_noise_penalty.array()).matrix();
  const Eigen::MatrixXd inverse = measured.transpose() * dense_reference::inverse(k), spread = q * inverse;
  const double own = (spread.colwise().squaredNorm() * rows.sample_noise_penalty / m).value();
  double sum = 0.0;
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    const Eigen::VectorXd y = c.row(i).transpose();
    sum += std::sqrt((q * (y - inverse * (measured * y))).squaredNorm() + own);
  }
  CHECK(own > 0.0);
  CHECK(criterion(rows) == doctest::Approx(sum / m).epsilon(1e-6));
  CHECK(criterion(rows) > criterion(measured));
}

TEST_CASE("noise is independent in each measurement: what many draws of it add, to a reconstruction that expects it") {
  const std::vector<Eigen::Index> cells{3, 60, 200, 222, 310};
  const Eigen::MatrixXd measured = components_at(cells), q = candidate_basis().components().cast<double>(),
                        c = candidate_basis().coefficients().cast<double>();
  const double eta = 0.7, noise = 0.2, m = static_cast<double>(c.rows());
  const Eigen::MatrixXd inverse =
      measured.transpose() *
      dense_reference::inverse(measured * measured.transpose() +
                               (eta + m * noise * noise) * Eigen::MatrixXd::Identity(measured.rows(), measured.rows()));
  const Eigen::MatrixXd to_cells = q * inverse;
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal(0.0, noise);
  double sum = 0.0;
  for (Eigen::Index i = 0; i < c.rows(); ++i) {
    const Eigen::VectorXd y = c.row(i).transpose(), missed = q * (y - inverse * (measured * y));
    double squares = 0.0;
    constexpr int draws = 4000;
    for (int draw = 0; draw < draws; ++draw) {
      const Eigen::VectorXd wrong = Eigen::VectorXd::NullaryExpr(measured.rows(), [&] { return normal(generator); });
      squares += (missed - to_cells * wrong).squaredNorm() / draws;
    }
    sum += std::sqrt(squares);
  }
  const expected_error criterion(candidate_basis(), {.eta = eta, .noise = noise});
  CHECK(criterion(measured) == doctest::Approx(sum / m).epsilon(5e-3));
  // A shift common to all samples gives another error.
  const expected_error shared(candidate_basis(), {.eta = eta, .common_shift = noise});
  CHECK(std::abs(shared(measured) - criterion(measured)) > 0.02 * criterion(measured));
}

namespace {

/// The textbook error of each material's reconstruction with a prior from the other materials: mean and covariance of
/// their weights, Bayes' rule, and the norm over all cells.
double each_left_out(const gonio::log_relative_pca& basis, const Eigen::MatrixXd& measured, double eta, double noise) {
  const Eigen::MatrixXd q = basis.components().cast<double>(), c = basis.coefficients().cast<double>();
  const Eigen::Index m = c.rows(), k = c.cols(), n = measured.rows(), channels = basis.channels();
  const Eigen::MatrixXd of_all =
      q * measured.transpose() *
      dense_reference::inverse(measured * measured.transpose() +
                               (eta + static_cast<double>(m) * noise * noise) * Eigen::MatrixXd::Identity(n, n));
  const double own = of_all.squaredNorm() * noise * noise;
  double sum = 0.0;
  for (Eigen::Index first = 0; first < m; first += channels) {
    Eigen::MatrixXd others(m - channels, k);
    others << c.topRows(first), c.bottomRows(m - channels - first);
    const Eigen::RowVectorXd mean = others.colwise().mean();
    const Eigen::MatrixXd apart = others.rowwise() - mean, covariance = apart.transpose() * apart;
    const Eigen::MatrixXd gain =
        covariance * measured.transpose() *
        dense_reference::inverse(measured * covariance * measured.transpose() +
                                 (eta + static_cast<double>(m) * noise * noise) * Eigen::MatrixXd::Identity(n, n));
    for (Eigen::Index row = first; row < first + channels; ++row) {
      const Eigen::VectorXd t = (c.row(row) - mean).transpose();
      sum += std::sqrt((q * (t - gain * (measured * t))).squaredNorm() + own);
    }
  }
  return sum / static_cast<double>(m);
}

}  // namespace

TEST_CASE("out of sample it is the error of each material with the prior of the others") {
  for (const gonio::log_relative_pca& basis : {candidate_basis(), spectral_candidate_basis()})
    for (const double eta : {0.02, 1.0, 40.0})
      for (const double noise : {0.0, 0.3}) {
        const expected_error criterion(basis, {.eta = eta, .noise = noise, .leave_out = true}),
            in_sample(basis, {.eta = eta, .noise = noise});
        for (const std::vector<Eigen::Index>& cells :
             {std::vector<Eigen::Index>{5}, {0, 100}, {3, 60, 200, 222, 310}, {7, 7, 8}}) {
          CAPTURE(eta);
          const Eigen::MatrixXd measured = components_at(cells);
          CHECK(criterion(measured) == doctest::Approx(each_left_out(basis, measured, eta, noise)).epsilon(1e-5));
          CHECK(criterion(measured) > in_sample(measured));
        }
        CHECK(criterion(expected_error::rows(0, criterion.coefficients().rows())) ==
              doctest::Approx(each_left_out(basis, Eigen::MatrixXd(0, basis.components().cols()), eta, 0.0))
                  .epsilon(1e-5));
      }
}

TEST_CASE("a material that is left out is left out with all of its wavelengths") {
  // The same columns, grouped into fewer materials. In sample, nothing changes. Out of sample, leaving out more columns
  // at once increases the error.
  const Eigen::MatrixXd measured = components_at({3, 60, 200, 222, 310});
  const auto error = [&](const gonio::log_relative_pca& basis, bool leave_out) {
    return expected_error(basis, {.eta = 1.0, .leave_out = leave_out})(measured);
  };
  const auto grouped = [](Eigen::Index by) {
    const std::vector<double> all{400.0, 450.0, 500.0, 550.0, 600.0, 650.0, 700.0, 750.0, 800.0};
    return gonio::learn_streamed_pca(
               at_wavelengths(synthetic_materials(small_cells(), 12), {all.begin(), all.begin() + by}),
               {.components = 100})
        .prior;
  };
  const auto colours =
      gonio::learn_streamed_pca(gonio::rows_of(synthetic_materials(small_cells(), 12)), {.components = 100}).prior;
  CHECK(error(grouped(9), false) == error(grouped(1), false));
  CHECK(error(grouped(3), true) == error(colours, true));
  CHECK(error(grouped(1), true) < error(grouped(3), true));
}

TEST_CASE("materials with more channels that are all the same have the same errors and designs") {
  const auto grey = [](Eigen::Index channels) {
    const auto set = synthetic_materials(small_cells(), 12);
    gonio::material_rows rows = gonio::rows_of(set);
    rows.wavelengths.resize(static_cast<std::size_t>(channels));
    std::iota(rows.wavelengths.begin(), rows.wavelengths.end(), 500.0);
    rows.read = [set, channels](gonio::block range, gonio::cell_rows out) {
      for (Eigen::Index i = 0; i < range.size(); ++i)
        for (Eigen::Index j = 0; j < out.cols(); ++j) out(i, j) = set.values(range.begin + i, 3 * (j / channels) + 1);
    };
    return gonio::learn_streamed_pca(std::move(rows), {.components = 11}).prior;
  };
  // With c equal channels the variance is c times as large, and eta is scaled by c.
  const auto candidates = [](const gonio::log_relative_pca& basis) {
    const double eta = 0.2 * static_cast<double>(basis.channels());
    return gonio::design::cell_candidates(basis, expected_error(basis, {.eta = eta, .leave_out = true}));
  };
  const gonio::design::cell_candidates three = candidates(grey(3)), one = candidates(grey(1)),
                                       seven = candidates(grey(7));
  std::vector<Eigen::Index> chosen;
  for (int number = 0; number < 4; ++number) {
    CAPTURE(number);
    const auto errors = three.errors_with_each(chosen);
    for (const auto* other : {&one, &seven}) {
      CHECK((*other)(chosen) == doctest::Approx(three(chosen)).epsilon(1e-4));
      const auto others = other->errors_with_each(chosen);
      for (Eigen::Index cell = 0; cell < std::ssize(errors); ++cell)
        REQUIRE(others[cell] == doctest::Approx(errors[cell]).epsilon(1e-3));
    }
    chosen.push_back(std::ranges::min_element(errors) - errors.begin());
  }
}

TEST_CASE("out of sample it is what eta is chosen by") {
  const std::vector<Eigen::Index> cells{3, 60, 200, 222, 310};
  std::vector<gonio::location> locations;
  for (const Eigen::Index cell : cells) locations.push_back(gonio::locate_cell(small_cells(), cell));
  for (const gonio::log_relative_pca& basis : {candidate_basis(), spectral_candidate_basis()}) {
    const gonio::leave_one_material_out_error chosen_by(basis, locations, Eigen::VectorXd::Ones(5), 0.0);
    for (const double eta : {0.1, 3.0}) {
      const expected_error criterion(basis, {.eta = eta, .leave_out = true});
      CHECK(criterion(components_at(cells)) ==
            doctest::Approx(chosen_by(Eigen::VectorXd::Constant(1, eta))[0]).epsilon(1e-4));
    }
  }
}

TEST_CASE("nothing measured: the mean distance of the materials from their mean; more measurements leave less") {
  const expected_error criterion(candidate_basis(), {.eta = 1e-3});
  const auto error = [&](const std::vector<Eigen::Index>& cells) {
    return criterion(criterion.prepare(components_at(cells)));
  };
  CHECK(error({}) == doctest::Approx(criterion.energies().cwiseSqrt().mean()));
  std::vector<Eigen::Index> every(small_cells().size());
  std::iota(every.begin(), every.end(), Eigen::Index{0});
  CHECK(error(every) < 1e-3 * error({}));
  CHECK(error({5}) < error({}));
}

TEST_CASE("what cannot be is refused") {
  CHECK_THROWS_WITH_AS(expected_error(candidate_basis(), {.eta = 0.0}), doctest::Contains("eta must be positive"),
                       gonio::error);
  CHECK_THROWS_WITH_AS(expected_error(candidate_basis(), {.noise = -1.0}),
                       doctest::Contains("the noise must be finite and not negative"), gonio::error);
  CHECK_THROWS_WITH_AS(expected_error(candidate_basis(), {.common_shift = -1.0}),
                       doctest::Contains("the common shift must be finite and not negative"), gonio::error);
  const auto one = learn(synthetic_materials(small_cells(), 1), 3);
  CHECK_THROWS_WITH_AS(expected_error(one, {.leave_out = true}),
                       doctest::Contains("leaving out a material needs at least two"), gonio::error);
  CHECK_THROWS_AS(expected_error(candidate_basis(), {.eta = std::nan("")}), gonio::error);
  CHECK_THROWS_WITH_AS(expected_error(candidate_basis(), {}, Eigen::MatrixXd::Identity(2, 2)),
                       doctest::Contains("must be a matrix with"), gonio::error);
}
