#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>

#include <Eigen/Cholesky>

#include <cmath>
#include <vector>

using gonio::discrepancy_model;
using gonio::sample_set;
using gonio::valid_cells;

static_assert(gonio::estimator<gonio::reconstruction<gonio::log_relative>>);

namespace {

const valid_cells& discrepancy_cells() {
  static const valid_cells small(gonio::grid({18, 9, 12}));
  return small;
}

const gonio::log_relative_pca& discrepancy_prior() {
  static const auto learned = learn(synthetic_materials(discrepancy_cells(), 8), 10);
  return learned;
}

/// A material of the prior plus a wave that no combination of its components contains.
gonio::brdf_table wavy_material() {
  gonio::brdf_table table = synthetic_materials(discrepancy_cells(), 8).table(3);
  for (Eigen::Index cell = 0; cell < discrepancy_cells().size(); ++cell) {
    const auto angles = discrepancy_cells().angles(cell);
    const double wave = std::exp(0.4 * std::sin(6.0 * std::sqrt(angles.theta_h)) * std::cos(2.0 * angles.theta_d));
    table.set(cell, wave * table.at(cell));
  }
  return table;
}

gonio::reconstruction<gonio::log_relative> keeping_all(const gonio::log_relative_pca& prior,
                                                       const discrepancy_model& model = {},
                                                       gonio::thread_count threads = {}) {
  return gonio::reconstruction{prior, model, threads}.keeping_all();
}

double mapped_error(const gonio::brdf_table& estimate, const gonio::brdf_table& truth) {
  double sum = 0.0;
  for (Eigen::Index cell = 0; cell < discrepancy_cells().size(); ++cell)
    for (Eigen::Index c = 0; c < 3; ++c)
      sum += std::pow(discrepancy_prior().metric().forward(estimate.at(cell)[c], cell) -
                          discrepancy_prior().metric().forward(truth.at(cell)[c], cell),
                      2);
  return std::sqrt(sum / static_cast<double>(3 * discrepancy_cells().size()));
}

}  // namespace

TEST_CASE("the fit is the posterior mean of prior and discrepancy") {
  const sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 25, 2));
  const discrepancy_model model{.variance = 0.05, .error_variance = 0.01, .grazing_variance = 0.0};
  const auto fit = keeping_all(discrepancy_prior(), model).fit(samples);

  // The textbook formula: k(x, X) (k(X, X) + variance of the errors)^-1 y.
  const auto located = gonio::locate_samples(discrepancy_cells(), samples);
  std::vector<gonio::half_difference> centres;
  for (const auto& at : located.locations) centres.push_back(at.angles);
  const double m = 24.0;
  const gonio::discrepancy_functions smooth(centres, 1.0);
  const auto covariance = [&](const gonio::location& a, const gonio::location& b) {
    std::vector<double> x(25), y(25);
    smooth.read(a.angles, x.data());
    smooth.read(b.angles, y.data());
    double sum = gonio::row_at(discrepancy_prior(), a).dot(gonio::row_at(discrepancy_prior(), b)) / m;
    for (Eigen::Index i = 0; i < 25; ++i) sum += model.variance * x[i] * y[i];
    return sum;
  };
  Eigen::MatrixXd among(25, 25);
  Eigen::VectorXd y(25);
  for (Eigen::Index i = 0; i < 25; ++i) {
    const auto& at = located.locations[i];
    y[i] = discrepancy_prior().metric().forward(located.values(i, 1), at) - gonio::offset_at(discrepancy_prior(), at);
    for (Eigen::Index j = 0; j < 25; ++j)
      among(i, j) = covariance(at, located.locations[j]) + (i == j ? model.error_variance : 0);
  }
  const Eigen::VectorXd dual = among.llt().solve(y);
  const gonio::brdf_table table = fit.fit().tabulate(discrepancy_cells());
  for (const Eigen::Index cell : gonio::random_cells(discrepancy_cells(), 40, 9)) {
    const auto at = gonio::locate_cell(discrepancy_cells(), cell);
    double expected = gonio::offset_at(discrepancy_prior(), at);
    for (Eigen::Index i = 0; i < 25; ++i) expected += dual[i] * covariance(at, located.locations[i]);
    CHECK(discrepancy_prior().metric().forward(table.at(cell).y(), at) == doctest::Approx(expected).epsilon(1e-3));
  }
}

TEST_CASE("the mean of the process is the ridge regression of components joined to a discrepancy") {
  sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 25, 2));
  samples[4].weight = 0.25;
  const discrepancy_model model{.variance = 0.05, .error_variance = 0.01, .grazing_variance = 0.0, .noise = 0.03};
  for (const bool apart : {false, true}) {
    CAPTURE(apart);
    if (apart) samples[7].weight = gonio::rgb(1.0, 0.1, 0.5);
    const auto paint = keeping_all(discrepancy_prior(), model).fit(samples);

    gonio::located_samples weighed = gonio::locate_samples(discrepancy_cells(), samples);
    const auto noise = gonio::map_noise(discrepancy_prior(), weighed.locations, model.noise);
    weighed.weights.array().colwise() *= model.error_variance / (model.error_variance + noise.variance.array());
    std::vector<gonio::half_difference> centres;
    for (const gonio::location& at : weighed.locations) centres.push_back(at.angles);
    const gonio::discrepancy_functions smooth(centres, 24 * model.variance);
    const gonio::joined basis{discrepancy_prior(),
                              gonio::discrepancy{discrepancy_cells(), discrepancy_prior().metric(), smooth}};
    const auto ridge = gonio::basis_equations(basis, weighed).solve(gonio::tikhonov(24 * model.error_variance));
    const Eigen::MatrixXd components = ridge.weights.topRows(10);
    CHECK((paint.fit().weights().topRows(10) - components).norm() < 1e-4 * components.norm());
    const auto table = gonio::fitted_brdf(basis, ridge.weights).tabulate(discrepancy_cells());
    CHECK(mapped_error(paint.fit().tabulate(discrepancy_cells()), table) < 1e-5);
    // The reports agree as well.
    for (Eigen::Index c = 0; c < 3; ++c) {
      CHECK(paint.fit().report()->residual[c] == doctest::Approx(ridge.report.residual[c]).epsilon(1e-4));
      CHECK(paint.fit().report()->objective[c] == doctest::Approx(ridge.report.objective[c]).epsilon(1e-4));
      CHECK(paint.fit().report()->kkt_residual[c] < 1e-12);
    }
  }
}

TEST_CASE("the part that components cannot express is learned from many samples") {
  const gonio::brdf_table truth = wavy_material();
  const sample_set samples = gonio::sample_table(truth, gonio::random_cells(discrepancy_cells(), 200, 5));
  const double with = mapped_error(keeping_all(discrepancy_prior()).fit(samples).tabulate(discrepancy_cells()), truth);
  const double without = mapped_error(
      gonio::decomposition{discrepancy_prior(), gonio::tikhonov{24 * 0.007}}.fit(samples).tabulate(discrepancy_cells()),
      truth);
  CAPTURE(with);
  CAPTURE(without);
  CHECK(with < 0.5 * without);
}

TEST_CASE("a discrepancy of almost no variance leaves the components alone") {
  const sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 15, 5));
  const auto with = keeping_all(discrepancy_prior(), {.variance = 1e-12, .grazing_variance = 0.0})
                        .fit(samples)
                        .tabulate(discrepancy_cells());
  const auto without =
      gonio::decomposition{discrepancy_prior(), gonio::tikhonov{24 * 0.007}}.fit(samples).tabulate(discrepancy_cells());
  CHECK(mapped_error(with, without) < 1e-6);
}

TEST_CASE("noise that is stated takes weight from the samples") {
  const sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 15, 5));
  const auto distance = [&](double noise) {
    const auto fit = keeping_all(discrepancy_prior(), {.noise = noise}).fit(samples);
    return fit.fit().weights().topRows(discrepancy_prior().size()).norm();
  };
  CHECK(distance(0.3) < distance(0.1));
  CHECK(distance(0.1) < distance(0.0));
}

TEST_CASE("with more samples than centres, all samples count") {
  const gonio::brdf_table truth = wavy_material();
  const sample_set samples = gonio::sample_table(truth, gonio::random_cells(discrepancy_cells(), 400, 5));
  const auto all = keeping_all(discrepancy_prior()).fit(samples).tabulate(discrepancy_cells());
  const auto fewer = keeping_all(discrepancy_prior(), {.most_centres = 150}).fit(samples);
  CHECK(fewer.fit().functions().second().size() == 150);
  CHECK(mapped_error(fewer.tabulate(discrepancy_cells()), truth) < 1.3 * mapped_error(all, truth));
}

TEST_CASE("the process of the inliers is of some of many samples: its memory does not grow with their square") {
  const auto located = [](Eigen::Index count) {
    const auto cells = gonio::random_cells(discrepancy_cells(), count, 5);
    return gonio::locate_samples(discrepancy_cells(), gonio::sample_table(wavy_material(), cells));
  };
  const auto estimator = keeping_all(discrepancy_prior(), {.most_centres = 40});
  CHECK(estimator.process_of_inliers(located(40)).size() == 40);
  CHECK(estimator.process_of_inliers(located(600)).size() == 500);
}

TEST_CASE("of more samples than are fitted some are chosen at random") {
  const sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 90, 5));
  sample_set some;
  for (const Eigen::Index i : gonio::random_choice(90, 60, 0)) some.push_back(samples[i]);
  const auto of_all = keeping_all(discrepancy_prior(), {.most_centres = 40, .most_samples = 60}).fit(samples);
  const auto of_some = keeping_all(discrepancy_prior(), {.most_centres = 40}).fit(some);
  CHECK((of_all.fit().weights() - of_some.fit().weights()).norm() == 0.0);
}

TEST_CASE("fits around all samples as centres are those of the process") {
  const sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 80, 5));
  const auto exact = keeping_all(discrepancy_prior()).fit(samples).tabulate(discrepancy_cells());
  const auto around = keeping_all(discrepancy_prior(), {.most_centres = 79}).fit(samples);
  CHECK(around.fit().functions().second().size() == 79);
  CHECK(mapped_error(around.tabulate(discrepancy_cells()), exact) < 0.01);
  // The uncertainty comes from the same process.
  const auto at = gonio::locate_cell(discrepancy_cells(), 400);
  CHECK(around.deviation(at) == doctest::Approx(keeping_all(discrepancy_prior()).fit(samples).deviation(at)));
  CHECK_THROWS_WITH_AS(static_cast<void>(around.residuals()), doctest::Contains("at most 79 samples, not 80"),
                       gonio::error);
}

TEST_CASE("the number of threads changes no byte") {
  for (const Eigen::Index count : {60, 150}) {
    auto samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), count, 5));
    samples[3].value *= 30.0;
    const auto by = [&](unsigned threads) {
      const auto table = gonio::reconstruction{discrepancy_prior(), {.most_centres = 100}, gonio::thread_count{threads}}
                             .fit(samples)
                             .tabulate(discrepancy_cells());
      return std::vector<float>(table.values().begin(), table.values().end());
    };
    CHECK(by(1) == by(3));
  }
}

TEST_CASE("each wavelength is fitted as a grey material, without the samples that are rejected") {
  auto samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 30, 5));
  samples[6].value *= 40.0;
  sample_set spectra(gonio::channels({450.0, 550.0, 650.0, 700.0}));
  for (const gonio::sample& each : samples)
    spectra.add(each.directions, std::array{each.value[0], each.value[1], each.value[2], 0.5 * each.value[1]});
  const gonio::reconstruction estimator{discrepancy_prior()};
  const auto paint = estimator.fit(spectra);
  REQUIRE(paint.rejected() == std::vector<Eigen::Index>{6});
  CHECK(paint.kept() == 29);
  for (Eigen::Index band = 0; band < 4; ++band) {
    sample_set grey = spectra.channel(band);
    grey.erase(grey.begin() + 6);
    const auto alone = estimator.keeping_all().fit(grey);
    const auto [wi, wo] = gonio::to_directions({0.2, 0.4, 1.1});
    // A sample that is only probably right has slightly less weight than a certain one.
    CHECK(paint.values(wi, wo)[band] == doctest::Approx(alone(wi, wo)[0]).epsilon(1e-3));
  }
}

TEST_CASE("wrong samples of many count less, and the fit is nearly that without them") {
  auto clean = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 200, 5));
  auto wrong = clean;
  for (Eigen::Index i = 0; i < 200; i += 10) wrong[i].value *= 25.0;
  const gonio::reconstruction estimator{discrepancy_prior()};
  const auto truth = wavy_material();
  const double without = mapped_error(estimator.keeping_all().fit(clean).tabulate(discrepancy_cells()), truth),
               kept = mapped_error(estimator.keeping_all().fit(wrong).tabulate(discrepancy_cells()), truth),
               found = mapped_error(estimator.fit(wrong).tabulate(discrepancy_cells()), truth);
  CAPTURE(without);
  CAPTURE(found);
  CHECK(found < 2.0 * without);
  CHECK(found < 0.3 * kept);
}

TEST_CASE("an impossible model of a discrepancy is refused") {
  const auto refused = [](const discrepancy_model& model, std::initializer_list<std::string> words) {
    const sample_set samples = gonio::sample_table(wavy_material(), gonio::random_cells(discrepancy_cells(), 5, 5));
    scratch::check_refused([&] { return keeping_all(discrepancy_prior(), model).fit(samples); }, words);
  };
  refused({.variance = 0.0}, {"variance of a discrepancy", "positive"});
  refused({.error_variance = 0.0}, {"error variance", "positive"});
  refused({.noise = -0.1}, {"noise", "negative"});
  refused({.most_centres = 0}, {"most_centres", "at least 1"});
}

TEST_CASE("readings through an aperture are told apart from those of single directions") {
  const gonio::valid_cells cells(gonio::grid({40, 9, 12}));
  const auto prior = learn(synthetic_materials(cells, 12), 12);
  const gonio::brdf_table truth = synthetic_materials(cells, 12).table(11);  // a lobe of 5 degrees
  const auto chosen = gonio::random_cells(cells, 120, 5);
  const gonio::aperture cones{0.0, gonio::radians(6.0)};
  const sample_set read = gonio::sample_table(truth, chosen, {.aperture = cones}), told = read,
                   untold = read.through({});
  CHECK(told.have_apertures());
  CHECK(!untold.have_apertures());
  for (const Eigen::Index centres : {1000, 60}) {  // evaluated directly, and from a table
    CAPTURE(centres);
    const gonio::reconstruction estimator{prior, {.most_centres = centres}};
    const auto peak_error = [&](const sample_set& samples) {
      double sum = 0.0;
      const auto paint = estimator.fit(samples);
      for (const double theta_d : {0.2, 0.6, 1.0}) {
        const auto [wi, wo] = gonio::to_directions({0.0, theta_d, 0.5});
        sum += std::abs(std::log(paint(wi, wo)[1] / truth(wi, wo)[1])) / 3.0;
      }
      return sum;
    };
    const double with = peak_error(told), without = peak_error(untold);
    CAPTURE(with);
    CAPTURE(without);
    CHECK(with < 0.5 * without);
  }
  // Messages quote the samples as they were measured.
  const gonio::reconstruction estimator{prior};
  auto wrong = told;
  wrong[7].value *= 30.0;
  const auto paint = estimator.fit(wrong);
  REQUIRE(paint.rejected().size() >= 1);
  CHECK(paint.rejected().front() == 7);
  CHECK((paint.contradicted().front().measured - wrong[7].value).abs().maxCoeff() < 1e-5 * wrong[7].value.maxCoeff());
  std::vector<double> off;
  for (const gonio::sample_residual& each : paint.residuals()) {
    CHECK((each.measured - wrong[each.number].value).abs().maxCoeff() < 1e-5 * each.measured.maxCoeff());
    off.push_back((each.predicted / each.measured).log().abs().maxCoeff());
  }
  CHECK(gonio::median(off) < 0.1);
  // One channel, and wavelengths, each with its own factors.
  sample_set bands(gonio::channels({450.0, 550.0, 650.0, 700.0}));
  for (const gonio::sample& each : told)
    bands.add(each.directions, std::array{each.value[0], each.value[1], each.value[2], 0.5 * each.value[1]}, 1.0,
              cones);
  const auto [wi, wo] = gonio::to_directions({0.0, 0.6, 0.5});
  for (const Eigen::Index centres : {1000, 60}) {
    const gonio::reconstruction any{prior, {.most_centres = centres}};
    const Eigen::ArrayXd spectrum = any.fit(bands).values(wi, wo);
    CHECK(spectrum[1] == doctest::Approx(any.fit(told)(wi, wo)[1]).epsilon(0.1));
    CHECK(spectrum[1] == doctest::Approx(any.fit(bands.channel(1))(wi, wo)[1]).epsilon(0.1));
    CHECK(spectrum[3] == doctest::Approx(0.5 * spectrum[1]).epsilon(0.1));
  }
}
