#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/estimate/sample_process.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Cholesky>
#include <doctest/doctest.h>

#include <cmath>
#include <vector>

namespace {

/// Components alone, or with a discrepancy, at n locations over the hemisphere.
gonio::sample_process some_process(Eigen::Index n, double variance, const Eigen::MatrixXd& weights,
                                   double error_variance = 0.1) {
  gonio::located_rows at{Eigen::MatrixXd::Random(n, 12), {}};
  for (Eigen::Index i = 0; i < n; ++i)
    at.angles.push_back({0.1 + 0.05 * static_cast<double>(i), 0.9 - 0.03 * static_cast<double>(i), 0.4});
  const gonio::located_samples mapped{std::vector<gonio::location>(n), Eigen::MatrixXd::Random(n, 3), weights};
  return {{6.0, {.variance = variance, .error_variance = error_variance}},
          at,
          mapped,
          Eigen::VectorXd::Constant(n, error_variance)};
}

}  // namespace

TEST_CASE("the covariance is that of components, discrepancy and errors") {
  Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(5, 1);
  weights(2, 0) = 0.5;
  const gonio::sample_process process = some_process(5, 0.3, weights);
  for (Eigen::Index i = 0; i < 5; ++i)
    for (Eigen::Index j = 0; j < 5; ++j) {
      const double near = gonio::discrepancy_covariance(process.at().angles, process.at().angles[j])[i];
      const double error = i == j ? 0.1 / weights(i, 0) : 0.0;
      CHECK(process.covariance()(i, j) ==
            doctest::Approx(process.at().rows.row(i).dot(process.at().rows.row(j)) / 6.0 + 0.3 * near + error));
    }
  CHECK((process.covariance() * process.inverse() - Eigen::MatrixXd::Identity(5, 5)).norm() < 1e-10);
}

TEST_CASE("each sample is predicted as a fit without it does") {
  const gonio::sample_process process = some_process(8, 0.2, Eigen::MatrixXd::Ones(8, 1));
  const Eigen::MatrixXd &covariance = process.covariance(), &values = process.values();
  const gonio::sample_predictions all = process.predicted_without();
  for (Eigen::Index i = 0; i < 8; ++i) {
    std::vector<Eigen::Index> others;
    for (Eigen::Index j = 0; j < 8; ++j)
      if (j != i) others.push_back(j);
    const Eigen::MatrixXd among = covariance(others, others);
    const Eigen::VectorXd with = covariance(others, i);
    const Eigen::LLT<Eigen::MatrixXd> factors(among);
    const Eigen::RowVectorXd mean = with.transpose() * factors.solve(Eigen::MatrixXd(values(others, Eigen::all)));
    CHECK((all.mean.row(i) - mean).norm() < 1e-9);
    CHECK(all.deviation[i] == doctest::Approx(std::sqrt(covariance(i, i) - with.dot(factors.solve(with)))));
    // A single sample, by the other method.
    const gonio::sample_predictions one = process.predicted_without(std::vector<Eigen::Index>{i});
    CHECK((one.mean.row(0) - mean).norm() < 1e-9);
    CHECK(one.deviation[0] == doctest::Approx(all.deviation[i]));
    CHECK((one.mapped.row(0) - values.row(i)).norm() == 0.0);
  }
  const Eigen::VectorXd disagreement = all.disagreement();
  CHECK(disagreement[3] ==
        doctest::Approx((values.row(3) - all.mean.row(3)).squaredNorm() / std::pow(all.deviation[3], 2) / 3.0));
}

TEST_CASE("a subset is the process of these samples, with errors by their inlier weights") {
  Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(9, 3);
  weights(4, 1) = 0.2;
  const gonio::sample_process whole = some_process(9, 0.2, weights);
  const std::vector<Eigen::Index> positions{1, 4, 7, 8};
  Eigen::VectorXd inlier_weights = Eigen::VectorXd::Ones(9);
  inlier_weights[7] = 0.25;
  const gonio::sample_process some = whole.subset(positions, inlier_weights);

  Eigen::MatrixXd of_some = weights(positions, Eigen::all);
  of_some.row(2) *= 0.25;
  gonio::located_rows at{whole.at().rows(positions, Eigen::all), {}};
  for (const Eigen::Index i : positions) at.angles.push_back(whole.at().angles[i]);
  const gonio::sample_process again(whole.expected(), at,
                                    {std::vector<gonio::location>(4), whole.values()(positions, Eigen::all), of_some},
                                    Eigen::VectorXd::Constant(4, 0.1));
  CHECK((some.covariance() - again.covariance()).norm() < 1e-12);
  CHECK((some.fit().weights - again.fit().weights).norm() < 1e-9);
  CHECK(some.scale() == doctest::Approx(again.scale()));
}

TEST_CASE("other values of the same samples share their covariance") {
  const gonio::sample_process process = some_process(6, 0.2, Eigen::MatrixXd::Ones(6, 1));
  const gonio::sample_process other = process.with_values(Eigen::MatrixXd::Random(6, 40));
  CHECK(&process.covariance() == &other.covariance());
  CHECK(other.channels() == 40);
  CHECK(other.fit().weights.cols() == 40);
  scratch::check_refused([&] { return process.with_values(Eigen::MatrixXd(5, 3)); }, {"6 samples", "not 5"});
}

TEST_CASE("other locations are predicted as the textbook does") {
  const gonio::sample_process process = some_process(7, 0.2, Eigen::MatrixXd::Ones(7, 1));
  gonio::located_rows others{Eigen::MatrixXd::Random(3, 12), {}};
  for (const double theta_h : {0.05, 0.3, 1.2}) others.angles.push_back({theta_h, 0.6, 0.2});
  const Eigen::MatrixXd before = process.expected().among(others);
  const auto [mean, covariance] = process.predict(others, before);
  const Eigen::MatrixXd with = process.expected().between(others, process.at());
  const Eigen::LLT<Eigen::MatrixXd> factors(process.covariance());
  CHECK((mean - with * factors.solve(process.values())).norm() < 1e-9);
  CHECK((covariance - (before - with * factors.solve(with.transpose()))).norm() < 1e-9);
  const Eigen::VectorXd deviations = process.deviations(others);
  for (Eigen::Index i = 0; i < 3; ++i)
    CHECK(deviations[i] ==
          doctest::Approx(
              std::sqrt(covariance(i, i) + gonio::error_variance_at(process.expected().model, others.angles[i]))));
}

TEST_CASE("familiarity shares the samples among components, discrepancy and errors") {
  const gonio::sample_process process = some_process(10, 0.2, Eigen::MatrixXd::Ones(10, 1));
  const gonio::familiarity known = process.familiarity();
  const Eigen::MatrixXd dual = Eigen::LLT<Eigen::MatrixXd>(process.covariance()).solve(process.values());
  const double all = (process.values().array() * dual.array()).sum();
  const Eigen::MatrixXd smooth = gonio::discrepancy_covariance(process.at().angles);
  CHECK(known.scale == doctest::Approx(all / 30.0));
  CHECK(known.components == doctest::Approx((process.at().rows.transpose() * dual).squaredNorm() / 6.0 / all));
  CHECK(known.discrepancy == doctest::Approx(0.2 * (smooth * dual).cwiseProduct(dual).sum() / all));
  CHECK(known.components + known.discrepancy + known.errors == doctest::Approx(1.0));
}

TEST_CASE("samples whose covariance cannot be are refused") {
  const gonio::sample_process process = some_process(6, 0.2, Eigen::MatrixXd::Ones(6, 1), -5.0);
  scratch::check_refused([&] { return process.scale(); }, {"not positive definite"});
  scratch::check_refused([&] { return process.inverse(); }, {"not positive definite"});
}

TEST_CASE("an error is larger where light or viewer graze") {
  const gonio::discrepancy_model model{.error_variance = 0.01, .grazing_variance = 0.2};
  CHECK(gonio::error_variance_at(model, {0.0, 0.0, 0.0}) == doctest::Approx(0.01));
  // 2.5 degrees above the horizon.
  CHECK(gonio::error_variance_at(model, {0.0, gonio::radians(87.5), 0.3}) ==
        doctest::Approx(0.01 + 0.2 / std::exp(1.0)));
}

TEST_CASE("crowds at one theta_d count as the effective number, samples of all theta_d count in full") {
  const gonio::discrepancy_model model{.effective_samples = 100.0};
  // A crowd of 400 samples within a degree at 60 degrees, and 600 samples of all theta_d.
  const auto theta_d = [](Eigen::Index i) {
    return i < 400 ? 60.0 + static_cast<double>(i) / 400.0 : 90.0 * static_cast<double>(i - 400) / 600.0;
  };
  std::vector<gonio::location> locations(1000);
  for (std::size_t i = 0; i < locations.size(); ++i) locations[i].angles = {0.1, gonio::radians(theta_d(i)), 1.0};
  const Eigen::VectorXd variances = gonio::crowding_variances(model, locations);
  for (Eigen::Index i = 0; i < variances.size(); ++i) {
    const double one = gonio::error_variance_at(model, locations[i].angles);
    CAPTURE(i);
    if (i < 400)  // 400, and 20 of the others; twice 1000 / 30 are usual
      CHECK(variances[i] / one == doctest::Approx((420.0 - 66.7) / 100.0 - 1.0).epsilon(0.01));
    else if (std::abs(theta_d(i) - 60.0) > 3.0)
      CHECK(variances[i] == 0.0);
  }
}

TEST_CASE("doubts add to the process, and errors that neighbours share do not average out") {
  const gonio::sample_process process = some_process(7, 0.2, Eigen::MatrixXd::Ones(7, 1)),
                              doubting = process.with_doubts();
  const auto& at = process.at().angles;
  const gonio::discrepancy_model& model = process.expected().model;
  const auto factor = [&](const gonio::half_difference& angles) {
    return 1.0 + model.doubt.fresnel_weight * gonio::fresnel_rise(angles.theta_d);
  };
  Eigen::MatrixXd doubts = gonio::discrepancy_covariance(at, model.doubt.lengths);
  for (Eigen::Index i = 0; i < doubts.rows(); ++i)
    for (Eigen::Index j = 0; j < doubts.cols(); ++j)
      doubts(i, j) *= model.doubt.variance * std::sqrt(factor(at[i]) * factor(at[j]));
  for (Eigen::Index i = 0; i < doubts.rows(); ++i) doubts(i, i) += model.error_variance * (factor(at[i]) - 1.0);
  const Eigen::MatrixXd expected = process.covariance() + doubts +
                                   model.doubt.shared_error_variance * gonio::discrepancy_covariance(at, model.lengths);
  CHECK((doubting.covariance() - expected).norm() < 1e-12 * expected.norm());
  CHECK((doubting.values() - process.values()).norm() == 0.0);
  CHECK_FALSE(process.expected().doubts);
  // The textbook formula for the deviation.
  const gonio::half_difference here{0.4, 0.3, 1.0};
  const Eigen::RowVectorXd row = Eigen::RowVectorXd::LinSpaced(process.at().rows.cols(), -1.0, 1.0);
  const Eigen::MatrixXd with = doubting.expected().between(process.at(), {row, {here}});
  const double before = row.squaredNorm() / process.expected().observations + model.variance +
                        model.doubt.variance * factor(here) + gonio::error_variance_at(model, here) +
                        model.error_variance * (factor(here) - 1.0);
  const double variance = before - (with.transpose() * expected.llt().solve(with))(0, 0);
  const gonio::located_rows other{row, {here}};
  CHECK(doubting.deviations(other)[0] == doctest::Approx(std::sqrt(variance)));
  CHECK(doubting.deviations_before(other)[0] == doctest::Approx(std::sqrt(before)));
  CHECK(doubting.deviations(other)[0] > process.deviations(other)[0]);
}
