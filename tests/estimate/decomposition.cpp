#include "../archetypes.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>

using gonio::decomposition;
using gonio::rgb;
using gonio::sample_set;
using gonio::tikhonov;
using gonio::valid_cells;

static_assert(gonio::estimator<decomposition<gonio::log_relative_pca, tikhonov>>);

namespace {

const valid_cells& cells() {
  static const valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::log_relative_pca& prior() {
  static const auto learned = learn(synthetic_materials(cells(), 8), 10);
  return learned;
}

/// Counts copies of its functions.
class counted_prior {
 public:
  static inline int copies = 0;

  counted_prior() = default;
  counted_prior(const counted_prior&) { ++copies; }
  counted_prior(counted_prior&&) = default;
  counted_prior& operator=(const counted_prior&) = delete;
  counted_prior& operator=(counted_prior&&) = default;

  [[nodiscard]] Eigen::Index size() const noexcept { return prior().size(); }
  [[nodiscard]] const valid_cells& cells() const noexcept { return prior().cells(); }
  [[nodiscard]] auto row(Eigen::Index cell) const noexcept { return prior().row(cell); }
  [[nodiscard]] double offset(Eigen::Index cell) const noexcept { return prior().offset(cell); }
  [[nodiscard]] const auto& metric() const noexcept { return prior().metric(); }
};
static_assert(gonio::basis<counted_prior>);

}  // namespace

TEST_CASE("a basis is not copied for each sample") {
  const auto truth = synthetic_materials(cells(), 8).table(3);
  const auto samples = gonio::sample_table(truth, gonio::random_cells(cells(), 300, 5));
  const decomposition estimator{counted_prior{}, tikhonov{1.0}};
  counted_prior::copies = 0;
  CHECK(estimator.fit(samples).weights().rows() == prior().size());
  CHECK(counted_prior::copies < 10);
}

TEST_CASE("a material of the prior comes back from a few samples") {
  const auto truth = synthetic_materials(cells(), 8).table(3);
  const auto samples = gonio::sample_table(truth, gonio::random_cells(cells(), 60, 5));
  const auto fit = decomposition{prior(), tikhonov{1e-6}}.fit(samples);
  const auto table = fit.tabulate(cells());
  double error = 0;
  for (Eigen::Index cell = 0; cell < cells().size(); ++cell) {
    const auto at = gonio::locate_cell(cells(), cell);
    for (Eigen::Index c = 0; c < 3; ++c)
      error = std::max(error, std::abs(prior().metric().forward(table.at(cell)[c], at) -
                                       prior().metric().forward(truth.at(cell)[c], at)));
  }
  CHECK(error < 0.1);
  CHECK(fit.report()->kkt_residual.maxCoeff() < 1e-9);
}

TEST_CASE("the system has the rows, weights and right-hand sides of the equations") {
  const auto truth = synthetic_materials(cells(), 8).table(1);
  const auto chosen = gonio::random_cells(cells(), 7, 1);
  auto samples = gonio::sample_table(truth, chosen);
  samples[2].weight = 0.25;
  const auto problem = gonio::basis_equations(prior(), gonio::locate_samples(prior().cells(), samples)).problem();
  REQUIRE(problem.equations() == 7);
  REQUIRE(problem.unknowns() == 10);
  CHECK(problem.weights()[2] == 0.25);
  for (std::size_t i = 0; i < 7; ++i) {
    const Eigen::Index row = i;
    for (std::size_t k = 0; k < 10; ++k) CHECK(problem.rows()(row, k) == doctest::Approx(prior().row(chosen[i])[k]));
    CHECK(problem.right_hand_side()(row, 1) ==
          doctest::Approx(prior().metric().forward(truth.at(chosen[i]).y(), chosen[i]) - prior().offset(chosen[i])));
  }
}

TEST_CASE("channels that count apart are fitted each with its own weights") {
  auto samples = gonio::sample_table(synthetic_materials(cells(), 8).table(2), gonio::random_cells(cells(), 20, 3));
  const auto weight = [](std::size_t i, Eigen::Index c) { return 0.1 + static_cast<double>((3 * i + 7 * c) % 5); };
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i].weight = rgb(weight(i, 0), weight(i, 1), weight(i, 2));
  CHECK(gonio::basis_equations(prior(), gonio::locate_samples(prior().cells(), samples)).systems() == 3);
  const auto apart = decomposition{prior(), tikhonov{0.3}}.fit(samples);
  for (Eigen::Index c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i].weight = weight(i, c);
    CHECK(gonio::basis_equations(prior(), gonio::locate_samples(prior().cells(), samples)).systems() == 1);
    const auto alike = decomposition{prior(), tikhonov{0.3}}.fit(samples);
    CHECK((apart.weights().col(c) - alike.weights().col(c)).norm() < 1e-12 * alike.weights().norm());
    CHECK(apart.report()->residual[c] == doctest::Approx(alike.report()->residual[c]).epsilon(1e-12));
    CHECK((apart.weights().col((c + 1) % 3) - alike.weights().col((c + 1) % 3)).norm() > 1e-3 * alike.weights().norm());
  }
}

TEST_CASE("noise in a channel of low weight does less harm, and none to the other channels") {
  const auto truth = synthetic_materials(cells(), 8).table(5);
  double heeded = 0.0, ignored = 0.0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    auto samples = gonio::sample_table(truth, gonio::random_cells(cells(), 30, seed));
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal;
    for (std::size_t i = 0; i < samples.size(); i += 2) samples[i].value.z() *= std::exp(0.7 * normal(generator));
    const auto error = [&](const gonio::sample_set& measured, Eigen::Index channel) {
      const auto fit = decomposition{prior(), tikhonov{0.1}}.fit(measured);
      double sum = 0.0;
      for (Eigen::Index cell = 0; cell < cells().size(); ++cell) {
        const auto at = gonio::locate_cell(cells(), cell);
        const double expected = prior().metric().forward(truth.at(cell)[channel], at);
        sum += std::pow(fit.mapped(cell)[channel] - expected, 2);
      }
      return sum;
    };
    auto weighted = samples;
    for (std::size_t i = 0; i < samples.size(); i += 2) weighted[i].weight = rgb(1.0, 1.0, 0.01);
    heeded += error(weighted, 2);
    ignored += error(samples, 2);
    CHECK(error(weighted, 0) == doctest::Approx(error(samples, 0)).epsilon(1e-9));
  }
  CAPTURE(heeded / ignored);
  CHECK(heeded < 0.5 * ignored);
}

TEST_CASE("an infinite penalty gives the mean material, whatever was measured") {
  const auto samples =
      gonio::sample_table(synthetic_materials(cells(), 8).table(2), gonio::random_cells(cells(), 20, 3));
  const auto table = decomposition{prior(), tikhonov{1e18}}.fit(samples).tabulate(cells());
  for (Eigen::Index cell = 0; cell < cells().size(); cell += 11)
    CHECK(table.at(cell).x() ==
          doctest::Approx(std::max(0.0, prior().metric().inverse(prior().offset(cell), cell))).epsilon(1e-4));
}

TEST_CASE("tabulating agrees with evaluating, on the basis' cells and on others, and with any number of threads") {
  const auto samples =
      gonio::sample_table(synthetic_materials(cells(), 8).table(4), gonio::random_cells(cells(), 30, 2));
  const auto fit = decomposition{prior(), tikhonov{0.1}}.fit(samples);
  for (const auto& over : {cells(), valid_cells(gonio::grid({20, 14, 10})), valid_cells(gonio::grid({18, 27, 36})),
                           valid_cells(gonio::grid({9, 9, 9}, gonio::cell_anchor::lower_corner))}) {
    const auto table = fit.tabulate(over, {1}), threaded = fit.tabulate(over, {3});
    CHECK(std::ranges::equal(table.values(), threaded.values()));
    const auto simple = fit.tabulate_cells(over);
    for (Eigen::Index cell = 0; cell < over.size(); ++cell) {
      if (over.angles(cell).theta_d == 0.0) continue;  // directions do not determine phi_d
      const auto [wi, wo] = to_directions(over.angles(cell));
      const rgb direct = fit(wi, wo);
      const double tolerance = 2e-6 * (1.0 + direct.maxCoeff());
      REQUIRE((table.at(cell) - direct).abs().maxCoeff() <= tolerance);
      REQUIRE((simple.at(cell) - direct).abs().maxCoeff() <= tolerance);
      REQUIRE((direct >= 0.0).all());
    }
  }
}

TEST_CASE("values that are too large for a progression are as large as they are, and infinite beyond floats") {
  // `upsample` gives infinity if the mapped value exceeds 88. Reflectance is then at least this, at zero reference.
  const double representable = gonio::log_relative::epsilon * std::exp(88.0);
  const valid_cells fine(gonio::grid({18, 27, 36}));
  double largest = 0.0;
  for (const double weight : {1.0, -1.0, 100.0, -100.0, 1e30, -1e30}) {
    const gonio::fitted_brdf fit(prior(), Eigen::MatrixXd(Eigen::MatrixXd::Constant(prior().size(), 3, weight)));
    const auto table = fit.tabulate(fine), simple = fit.tabulate_cells(fine);
    for (Eigen::Index i = 0; i < std::ssize(table.values()); ++i) {
      const double found = table.values()[i], expected = simple.values()[i];
      if (std::isinf(expected)) {
        REQUIRE(std::isinf(found));
      } else if (std::isinf(found)) {
        REQUIRE(expected >= representable);
      } else {
        REQUIRE(std::abs(found - expected) <= 1e-4 * (1.0 + expected));
        largest = std::max(largest, found);
      }
    }
  }
  CHECK(largest > 1e30);
}

TEST_CASE("archetypes: the least-squares fit of a constant is the weighted mean") {
  const archetype::constant_basis functions{cells(), 0.5};
  sample_set samples{{{0.1, 0.2, 0.3}, rgb(1, 2, 3), 1.0}, {{0.4, 0.5, 0.6}, rgb(5, 6, 3), 3.0}};
  const decomposition estimator{functions, archetype::ordinary_least_squares{}};
  static_assert(gonio::estimator<decltype(estimator)>);
  const auto fit = estimator.fit(samples);
  CHECK((fit({0, 0, 1}, {0, 0, 1}) - rgb(4, 5, 3)).abs().maxCoeff() < 1e-6);
  CHECK((fit.tabulate(valid_cells(gonio::grid({4, 3, 5}))).at(7) - rgb(4, 5, 3)).abs().maxCoeff() < 1e-6);
  CHECK(fit.report()->residual[0] == doctest::Approx(std::sqrt(9.0 + 3.0)));
  CHECK(fit.functions().mean == 0.5);
}

TEST_CASE("archetypes: a basis that computes its rows is fitted and evaluated at the exact locations") {
  const archetype::theta_d_polynomial functions{cells(), 0.5};
  const sample_set samples{{{0.1, 0.2, 0.3}, rgb(1, 2, 3)}, {{0.4, 0.6, 0.5}, rgb(5, 6, 3)}};
  const decomposition estimator{functions, archetype::ordinary_least_squares{}};
  static_assert(gonio::estimator<decltype(estimator)>);
  const auto fit = estimator.fit(samples);
  const auto [wi, wo] = gonio::to_directions({0.2, 0.01, 0.7});  // below the first node of theta_d
  CHECK((fit(wi, wo) - rgb(0, 0.1, 3)).abs().maxCoeff() < 1e-9);
  const auto table = fit.tabulate(valid_cells(gonio::grid({4, 30, 5})));
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell)
    REQUIRE(table.at(cell).y() == doctest::Approx(10.0 * table.cells().angles(cell).theta_d).epsilon(1e-6));
}

namespace {

/// A computed basis for each channel. The three differ in their offsets.
struct three_polynomials {
  archetype::theta_d_polynomial first;
  std::size_t size() const { return 2; }
  const valid_cells& cells() const { return first.over; }
  archetype::theta_d_polynomial channel(std::size_t index) const { return {first.over, static_cast<double>(index)}; }
  archetype::identity_metric metric() const { return {}; }
};
static_assert(gonio::channelwise_basis<three_polynomials>);

}  // namespace

TEST_CASE("computed bases that differ from channel to channel") {
  const sample_set samples{{{0.1, 0.2, 0.3}, rgb(1, 2, 3)}, {{0.4, 0.6, 0.5}, rgb(5, 6, 3)}};
  const auto fit = decomposition{three_polynomials{{cells()}}, archetype::ordinary_least_squares{}}.fit(samples);
  const auto [wi, wo] = gonio::to_directions({0.2, 0.4, 0.7});
  CHECK((fit(wi, wo) - rgb(3, 4, 3)).abs().maxCoeff() < 1e-9);
  CHECK(fit.weights()(0, 2) == doctest::Approx(1.0));  // 3 minus the offset of 2
  CHECK(fit.mapped(0).z() == doctest::Approx(3.0));
}

TEST_CASE("a fit is zero below the horizon") {
  const auto samples =
      gonio::sample_table(synthetic_materials(cells(), 8).table(4), gonio::random_cells(cells(), 30, 2));
  const auto fit = decomposition{prior(), tikhonov{0.1}}.fit(samples);
  CHECK((fit({0, 0, 1}, {1, 0, 0}) == 0.0).all());
  CHECK((fit({0, 0, -1}, {0, 0, 1}) == 0.0).all());
}

TEST_CASE("negative and zero measurements are taken, unusable ones refused") {
  auto samples = gonio::sample_table(synthetic_materials(cells(), 8).table(4), gonio::random_cells(cells(), 3, 2));
  samples[0].value = rgb(-0.1, 0.0, 0.2);
  const decomposition estimator{prior(), tikhonov{1.0}};
  CHECK(estimator.fit(samples).weights().allFinite());
  CHECK_THROWS_AS(static_cast<void>(estimator.fit(sample_set{})), gonio::error);
  samples[1].value.x() = std::nan("");
  CHECK_THROWS_WITH_AS(static_cast<void>(estimator.fit(samples)), doctest::Contains("sample 2"), gonio::error);
}

TEST_CASE("weights of the wrong size are refused") {
  gonio::solution wrong;
  wrong.weights = Eigen::MatrixXd::Zero(4, 3);
  CHECK_THROWS_AS(gonio::fitted_brdf(prior(), wrong), gonio::error);
}
