#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/estimate/robust_decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <doctest/doctest.h>

#include <vector>

using gonio::valid_cells;

namespace {

const valid_cells& robust_cells() {
  static const valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::discrepancy_decomposition<gonio::log_relative>& plain_estimator() {
  static const gonio::discrepancy_decomposition all{learn(synthetic_materials(robust_cells(), 60), 80)};
  return all;
}

/// A material that the prior has not seen.
gonio::brdf_table unseen_material() { return synthetic_materials(robust_cells(), 3, 100).table(1); }

gonio::sample_set robust_samples(Eigen::Index count, double outlier_ratio) {
  return gonio::sample_table(unseen_material(), gonio::random_cells(robust_cells(), count, 4),
                             {.outlier_ratio = outlier_ratio}, 5);
}

std::vector<float> numbers_of(const gonio::brdf_table& table) { return {table.values().begin(), table.values().end()}; }

/// Root mean square of the logarithm of an estimate over the truth.
double robust_log_error(const gonio::brdf_table& estimate) {
  const gonio::brdf_table truth = unseen_material();
  double sum = 0.0;
  for (Eigen::Index cell = 0; cell < truth.cells().size(); ++cell)
    sum += ((estimate.at(cell) + 0.01).log() - (truth.at(cell) + 0.01).log()).square().mean();
  return std::sqrt(sum / static_cast<double>(truth.cells().size()));
}

}  // namespace

TEST_CASE("few samples support no large share of outliers") {
  CHECK(gonio::largest_outlier_share(1) == 0.0);
  CHECK(gonio::largest_outlier_share(12) == 0.0);
  CHECK(gonio::largest_outlier_share(20) == doctest::Approx(0.24));
  CHECK(gonio::largest_outlier_share(100) == doctest::Approx(0.528));
  for (Eigen::Index n = 1; n < 1000; ++n) CHECK(gonio::largest_outlier_share(n) <= gonio::largest_outlier_share(n + 1));

  // Twelve samples count in full, whatever they were thought to count; of 20 at most four do not.
  CHECK(gonio::limit_outliers(Eigen::VectorXd::LinSpaced(12, 0.1, 0.9)) == Eigen::VectorXd::Ones(12));
  const Eigen::VectorXd of_twenty = gonio::limit_outliers(Eigen::VectorXd::LinSpaced(20, 0.05, 1.0));
  CHECK((of_twenty.array() < 1.0).count() == 4);
  CHECK(of_twenty[0] == doctest::Approx(0.05 / 0.25));
  CHECK(gonio::limit_outliers(Eigen::VectorXd::Zero(30)) == Eigen::VectorXd::Ones(30));
  CHECK(gonio::limit_outliers(Eigen::VectorXd()).size() == 0);
}

TEST_CASE("outliers are found, and the fit is nearly the one without them") {
  const gonio::robust_decomposition robust{plain_estimator()};
  for (const double ratio : {0.2, 0.4}) {
    CAPTURE(ratio);
    const gonio::sample_set clean = robust_samples(300, 0.0), wrong = robust_samples(300, ratio);
    const auto located = gonio::locate_samples(robust_cells(), wrong);
    const Eigen::VectorXd weights = robust.inlier_weights(located);
    CHECK(weights.minCoeff() >= 0.0);
    CHECK(weights.maxCoeff() <= 1.0);
    // What is off by more than a factor of three counts less than half, what is right more.
    Eigen::Index missed = 0, refused = 0;
    for (Eigen::Index i = 0; i < std::ssize(clean); ++i) {
      const double off = (wrong[i].value.max(0.0) + 0.01).log().mean() - (clean[i].value.max(0.0) + 0.01).log().mean();
      if (std::abs(off) > std::log(3.0)) missed += weights[i] > 0.5 ? 1 : 0;
      if (off == 0.0) refused += weights[i] < 0.5 ? 1 : 0;
    }
    CHECK(missed <= 6);
    CHECK(refused <= 15);
    const double error = robust_log_error(robust.fit(wrong).tabulate(robust_cells()));
    CHECK(error < 2.0 * robust_log_error(plain_estimator().fit(clean).tabulate(robust_cells())));
    CHECK(error < 0.5 * robust_log_error(plain_estimator().fit(wrong).tabulate(robust_cells())));
  }
}

TEST_CASE("clean samples cost little, and few are fitted as they are") {
  const gonio::robust_decomposition robust{plain_estimator()};
  const gonio::sample_set many = robust_samples(300, 0.0), few = robust_samples(12, 0.4);
  // Measured: 1.41. Some good samples where the prior knows little look like outliers.
  CHECK(robust_log_error(robust.fit(many).tabulate(robust_cells())) <
        1.5 * robust_log_error(plain_estimator().fit(many).tabulate(robust_cells())));
  CHECK(numbers_of(robust.fit(few).tabulate(robust_cells())) ==
        numbers_of(plain_estimator().fit(few).tabulate(robust_cells())));
}

TEST_CASE("the number of threads does not change a robust fit, and bad samples are refused") {
  const gonio::sample_set samples = robust_samples(100, 0.2);
  const auto by_threads = [&](unsigned threads) {
    const gonio::thread_count count{threads};
    return numbers_of(gonio::robust_decomposition{plain_estimator(), {}, count}.fit(samples).tabulate(robust_cells()));
  };
  CHECK(by_threads(1) == by_threads(3));
  scratch::check_refused([] { return gonio::robust_decomposition{plain_estimator()}.fit(gonio::sample_set{}); },
                         {"sample"});
}
