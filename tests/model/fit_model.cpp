#include "../archetypes.hpp"
#include "physical.hpp"
#include <gonio/metric/log.hpp>
#include <gonio/metric/root.hpp>
#include <gonio/model/fit_model.hpp>
#include <gonio/model/physical_properties.hpp>
#include <gonio/model/sum_of_lobes.hpp>
#include <gonio/model/ward.hpp>

#include <random>
#include <set>

namespace {

using gonio::rgb;
using gonio::model::analytic_brdf;
using gonio::model::lobe_kind;

/// Directions above the horizon, denser near the highlight.
std::vector<gonio::direction_pair> scattered_pairs(std::size_t count, unsigned seed = 1) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform;
  std::vector<gonio::direction_pair> pairs;
  while (pairs.size() < count) {
    const double s = uniform(random);
    const auto pair = gonio::to_directions({pi / 2 * s * s, pi / 2 * uniform(random), pi * uniform(random)});
    if (pair.wi.z() > 0.02 && pair.wo.z() > 0.02) pairs.push_back(pair);
  }
  return pairs;
}

std::vector<gonio::model::fit_observation> observed(const gonio::model::analytic_brdf& f,
                                                    const std::vector<gonio::direction_pair>& pairs) {
  std::vector<gonio::model::fit_observation> all;
  for (const auto& [wi, wo] : pairs) all.push_back({gonio::model::lobe_geometry(wi, wo), f(wi, wo), 1.0});
  return all;
}

/// Returns a lobe of a kind, with parameters that a few hundred measurements can determine.
gonio::model::analytic_lobe any_lobe(const lobe_kind& kind, std::mt19937_64& random) {
  const auto between = [&](double low, double high) { return std::uniform_real_distribution(low, high)(random); };
  lobe_kind::values values{};
  for (std::size_t i = 0; i < kind.parameters().size(); ++i) {
    const auto& about = kind.parameters()[i];
    double low = about.lowest, high = about.highest;
    if (about.name == "shininess" || about.name == "exponent") low = 1.0, high = 500.0;
    if (about.unit == "slope") low = 0.04, high = 0.8;
    if (about.name == "refractive_index") low = 1.1, high = 2.5;
    if (about.name == "tilt") low = gonio::radians(30.0), high = gonio::radians(60.0);
    values[i] = about.logarithmic ? std::exp(between(std::log(low), std::log(high))) : between(low, high);
  }
  return {kind, {between(0.05, 1.0), between(0.05, 1.0), between(0.05, 1.0)}, values};
}

/// Returns the largest relative error of colours and parameters.
double error_of(const gonio::model::analytic_lobe& found, const gonio::model::analytic_lobe& truth) {
  double worst = ((found.colour() - truth.colour()).abs() / truth.colour()).maxCoeff();
  for (std::size_t i = 0; i < truth.kind().parameters().size(); ++i)
    worst = std::max(worst, std::abs(found.parameters()[i] - truth.parameters()[i]) / std::abs(truth.parameters()[i]));
  return worst;
}

}  // namespace

TEST_CASE("a fit to what a model made finds its parameters without an initial guess: every kind, beside Lambert") {
  const auto pairs = scattered_pairs(600);
  const lobe_kind& lambert = lobe_kind::of<gonio::model::lambert_shape>();
  std::mt19937_64 random(3);
  for (const lobe_kind* kind : gonio::model::lobe_kinds()) {
    if (*kind == lambert) continue;
    CAPTURE(kind->name());
    for (int draw = 0; draw < 20; ++draw) {
      CAPTURE(draw);
      const gonio::model::analytic_lobe diffuse = any_lobe(lambert, random), lobe = any_lobe(*kind, random);
      const auto fit =
          gonio::model::fit_model({&lambert, kind}, observed(gonio::model::analytic_brdf({diffuse, lobe}), pairs));
      CHECK(fit.converged);
      CHECK(error_of(fit.model.lobes()[0], diffuse) < 1e-6);
      CHECK(error_of(fit.model.lobes()[1], lobe) < 1e-6);
    }
  }
}

TEST_CASE("also by L1 and Huber's norm, in other metrics, weighted by the cosine") {
  const auto pairs = scattered_pairs(600);
  const lobe_kind &lambert = lobe_kind::of<gonio::model::lambert_shape>(),
                  &ward = lobe_kind::of<gonio::model::ward_shape>();
  const gonio::model::analytic_lobe diffuse(lambert, {0.1, 0.3, 0.5}, {}), lobe(ward, {0.4, 0.2, 0.1}, {0.2});
  const auto samples = observed(gonio::model::analytic_brdf({diffuse, lobe}), pairs);
  const auto check = [&](const auto& metric, const gonio::model::model_fit_options& options, double tolerance) {
    CAPTURE(static_cast<int>(options.norm));
    const auto fit = gonio::model::fit_model({&lambert, &ward}, samples, metric, options);
    CHECK(fit.converged);
    CHECK(error_of(fit.model.lobes()[0], diffuse) < tolerance);
    CHECK(error_of(fit.model.lobes()[1], lobe) < tolerance);
  };
  for (const bool cosine_weighted : {false, true})
    for (const auto norm : {gonio::model::fit_norm::l2, gonio::model::fit_norm::l1, gonio::model::fit_norm::huber}) {
      const gonio::model::model_fit_options options{.norm = norm, .cosine_weighted = cosine_weighted};
      check(gonio::lin(), options, 1e-6);
      check(gonio::log(), options, 1e-6);
      check(gonio::root(3.0), options, 1e-6);
    }
}

TEST_CASE("the last stage as printed: the diffuse colour stays what the first one found, which costs") {
  const auto pairs = scattered_pairs(600);
  const lobe_kind &lambert = lobe_kind::of<gonio::model::lambert_shape>(),
                  &ward = lobe_kind::of<gonio::model::ward_shape>();
  const auto samples = observed(analytic_brdf({{lambert, {0.1, 0.3, 0.5}, {}}, {ward, {0.4, 0.2, 0.1}, {0.2}}}), pairs);
  for (const auto norm : {gonio::model::fit_norm::l1, gonio::model::fit_norm::l2}) {
    const auto fit = [&](bool diffuse_stays) {
      return gonio::model::fit_model({&lambert, &ward}, samples, gonio::lin(),
                                     {.norm = norm, .diffuse_stays = diffuse_stays});
    };
    const auto all = fit(false), printed = fit(true);
    CHECK(printed.converged);
    CHECK(printed.loss >= all.loss);
    CHECK(error_of(all.model.lobes()[0], {lambert, {0.1, 0.3, 0.5}, {}}) < 1e-6);
    CHECK(error_of(printed.model.lobes()[0], {lambert, {0.1, 0.3, 0.5}, {}}) > 1e-3);
  }
}

TEST_CASE("a fit reflects no more than falls in, by any norm and metric, and is no other where that holds anyway") {
  const auto pairs = scattered_pairs(400);
  const lobe_kind &lambert = lobe_kind::of<gonio::model::lambert_shape>(),
                  &ggx = lobe_kind::of<gonio::model::ggx_shape>();
  // At grazing angles it reflects twice the incident light.
  const analytic_brdf impossible({{lambert, {0.3, 0.2, 0.1}, {}}, {ggx, {4.0, 2.0, 1.0}, {0.1, 0.1}}}),
      possible({{lambert, {0.3, 0.2, 0.1}, {}}, {ggx, {0.5, 0.5, 0.25}, {0.1, 0.1}}});
  REQUIRE(gonio::model::find_largest_albedo(impossible).value > 1.5);
  const auto check = [&](const auto& metric, gonio::model::model_fit_options options) {
    const auto fit_of = [&](const analytic_brdf& truth, double largest) {
      options.largest_albedo = largest;
      return gonio::model::fit_model({&lambert, &ggx}, observed(truth, pairs), metric, options);
    };
    const auto bounded = fit_of(impossible, 1.0);
    const double found = gonio::model::find_largest_albedo(bounded.model).value;
    CHECK(found < 1.0005);
    CHECK(found > 0.99);
    // Much closer than the same lobes scaled down together.
    const double darker = 1.0 / gonio::model::find_largest_albedo(impossible).value;
    std::vector<gonio::model::analytic_lobe> scaled;
    for (const auto& lobe : impossible.lobes())
      scaled.emplace_back(lobe.kind(), darker * lobe.colour(), lobe.parameters());
    const auto observations = observed(impossible, pairs);
    const gonio::model::detail::model_loss loss({&lambert, &ggx}, observations,
                                                gonio::model::detail::chosen_metric(metric), options);
    Eigen::VectorXd x(loss.unknowns());
    x.head(2) = loss.coded(std::vector{scaled[0].parameters(), scaled[1].parameters()});
    for (Eigen::Index c = 0; c < 3; ++c)
      for (Eigen::Index l = 0; l < 2; ++l) x[2 + 2 * c + l] = scaled[l].colour()[c];
    CHECK(bounded.loss < 0.7 * loss.joint(x).value);
    CHECK(fit_of(possible, 1.0).loss == fit_of(possible, std::numeric_limits<double>::infinity()).loss);
  };
  check(gonio::lin(), {});
  check(gonio::log(), {.norm = gonio::model::fit_norm::huber, .cosine_weighted = true});
  check(gonio::log(), {.norm = gonio::model::fit_norm::l1});
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::model::fit_model({&lambert}, observed(possible, pairs), gonio::lin(),
                                                                 {.largest_albedo = 0.0})),
                       doctest::Contains("must be positive, not 0"), gonio::error);
}

TEST_CASE("variable projection and the joint descent end in the same minimum of noisy data") {
  const auto pairs = scattered_pairs(400);
  const lobe_kind &lambert = lobe_kind::of<gonio::model::lambert_shape>(),
                  &ggx = lobe_kind::of<gonio::model::ggx_shape>();
  auto samples = observed(
      gonio::model::analytic_brdf({{lambert, {0.1, 0.3, 0.5}, {}}, {ggx, {0.4, 0.2, 0.1}, {0.2, 0.3}}}), pairs);
  std::mt19937_64 random(5);
  std::normal_distribution<double> noise(0.0, 0.05);
  for (auto& seen : samples) seen.value *= 1.0 + noise(random);
  const auto projected = gonio::model::fit_model({&lambert, &ggx}, samples);
  // The linear metric under another name, so that the fit does not know that the colours separate.
  const auto joint = gonio::model::fit_model({&lambert, &ggx}, samples, archetype::smooth_identity_metric());
  CHECK(projected.loss > 1e-6);
  CHECK(projected.loss == doctest::Approx(joint.loss).epsilon(1e-9));
  CHECK(error_of(projected.model.lobes()[1], joint.model.lobes()[1]) < 1e-4);
  CHECK(projected.promised_gain < 1e-9);
}

TEST_CASE("L1 follows the many where squares follow the few") {
  const auto pairs = scattered_pairs(500);
  const lobe_kind& lambert = lobe_kind::of<gonio::model::lambert_shape>();
  auto samples = observed(gonio::model::analytic_brdf({{lambert, rgb::Constant(0.5), {}}}), pairs);
  for (std::size_t i = 0; i < samples.size(); i += 10) samples[i].value *= 100.0;
  const auto albedo = [&](gonio::model::fit_norm norm) {
    return gonio::model::fit_model({&lambert}, samples, gonio::lin(), {.norm = norm}).model.lobes()[0].colour()[1];
  };
  CHECK(albedo(gonio::model::fit_norm::l1) == doctest::Approx(0.5).epsilon(1e-3));
  CHECK(albedo(gonio::model::fit_norm::huber) == doctest::Approx(0.5).epsilon(0.05));
  CHECK(albedo(gonio::model::fit_norm::l2) > 3.0);
}

TEST_CASE("robust norms have a scale also where most measurements are black") {
  const lobe_kind& lambert = lobe_kind::of<gonio::model::lambert_shape>();
  auto samples = observed(gonio::model::analytic_brdf({{lambert, rgb::Constant(0.5), {}}}), scattered_pairs(800));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (i % 10 > 3) samples[i].weight = 0.0, samples[i].value.setZero();
    if (i % 40 == 0) samples[i].value *= 3.0;
  }
  const auto albedo = [&](gonio::model::fit_norm norm) {
    return gonio::model::fit_model({&lambert}, samples, gonio::lin(), {.norm = norm}).model.lobes()[0].colour()[1];
  };
  CHECK(albedo(gonio::model::fit_norm::l2) == doctest::Approx(0.5625).epsilon(0.01));  // one in 16 is tripled
  CHECK(albedo(gonio::model::fit_norm::huber) == doctest::Approx(0.51).epsilon(0.01));
  CHECK(albedo(gonio::model::fit_norm::l1) == doctest::Approx(0.5).epsilon(1e-3));
}

TEST_CASE("the same bytes for any number of threads, and weights count") {
  const auto pairs = scattered_pairs(2000);
  const lobe_kind &lambert = lobe_kind::of<gonio::model::lambert_shape>(),
                  &phong = lobe_kind::of<gonio::model::phong_shape>();
  auto samples =
      observed(gonio::model::analytic_brdf({{lambert, {0.1, 0.3, 0.5}, {}}, {phong, {0.4, 0.2, 0.1}, {30.0}}}), pairs);
  for (std::size_t i = 0; i < samples.size(); i += 2) {
    samples[i].value *= 3.0;
    samples[i].weight = 0.0;
  }
  const auto with = [&](unsigned threads) {
    return gonio::model::fit_model({&lambert, &phong}, samples, gonio::log(), {.threads = {threads}});
  };
  const auto one = with(1), three = with(3);
  CHECK(one.loss == three.loss);
  CHECK(one.model.lobes()[1].parameters() == three.model.lobes()[1].parameters());
  CHECK(one.model.lobes()[1].parameters()[0] == doctest::Approx(30.0).epsilon(1e-6));
}

TEST_CASE("a channel of weight zero does not matter, the others of the same measurement do") {
  const lobe_kind &lambert = lobe_kind::of<gonio::model::lambert_shape>(),
                  &phong = lobe_kind::of<gonio::model::phong_shape>();
  const auto exact =
      observed(gonio::model::analytic_brdf({{lambert, {0.1, 0.3, 0.5}, {}}, {phong, {0.4, 0.2, 0.1}, {30.0}}}),
               scattered_pairs(600));
  auto samples = exact;
  for (std::size_t i = 0; i < samples.size(); i += 2) {
    samples[i].value[2] *= 5.0;
    samples[i].weight = rgb(1.0, 2.0, 0.0);
  }
  const auto check = [&](const auto& metric, gonio::model::fit_norm norm) {
    const auto fit = gonio::model::fit_model({&lambert, &phong}, samples, metric, {.norm = norm});
    CHECK((fit.model.lobes()[0].colour() - rgb(0.1, 0.3, 0.5)).abs().maxCoeff() < 1e-3);
    CHECK((fit.model.lobes()[1].colour() - rgb(0.4, 0.2, 0.1)).abs().maxCoeff() < 1e-3);
    CHECK(fit.model.lobes()[1].parameters()[0] == doctest::Approx(30.0).epsilon(1e-3));
    CHECK(fit.loss < 1e-3);
  };
  check(gonio::lin(), gonio::model::fit_norm::l2);
  check(gonio::log(), gonio::model::fit_norm::l1);
}

TEST_CASE("a table is fitted as its cells are") {
  const gonio::valid_cells cells(gonio::grid({18, 12, 18}));
  const gonio::model::ward paint(rgb(0.1, 0.2, 0.3), {.roughness = 0.3});
  const auto table = gonio::tabulate(paint, cells);
  const auto fit =
      gonio::model::fit_model({&lobe_kind::of<gonio::model::ward_shape>()}, gonio::model::fit_observations(table));
  const auto ward = fit.model.lobes()[0].as<gonio::model::ward_shape>();
  CHECK(ward.shape().roughness == doctest::Approx(0.3).epsilon(1e-6));  // the table stores floats
  CHECK(((ward.colour() - paint.colour()).abs() < 1e-6).all());
}

TEST_CASE("cells may count by the pairs of directions in them, or by these times the cosines") {
  for (const auto anchor : {gonio::cell_anchor::centre, gonio::cell_anchor::lower_corner}) {
    const gonio::valid_cells cells(gonio::grid({60, 60, 90}, anchor));
    double pairs = 0.0, reflected = 0.0;
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
      const auto at = gonio::cosines(cells.angles(cell));
      const double own =
          gonio::model::detail::solid_angle_of_pairs(cells.grid(), cells.grid().cell(cells.linear(cell)));
      pairs += own;
      reflected += own * at.i * at.o;
    }
    // Half vectors at all azimuths, and phi_d over 360 degrees: two hemispheres of directions, weighted by cosines.
    const double all = 2.0 * std::numbers::pi * 2.0;
    CHECK(all * pairs == doctest::Approx(std::pow(2.0 * std::numbers::pi, 2)).epsilon(0.03));
    CHECK(all * reflected == doctest::Approx(std::pow(std::numbers::pi, 2)).epsilon(0.01));
  }
  const auto table = gonio::tabulate(gonio::model::ward(rgb(0.1, 0.2, 0.3), {.roughness = 0.3}), gonio::valid_cells());
  const auto share_near_highlight = [&](gonio::model::cell_weighting weighting) {
    const auto all = gonio::model::fit_observations(table, {}, weighting);
    double near = 0.0, sum = 0.0;
    for (Eigen::Index cell = 0; cell < std::ssize(all); ++cell) {
      sum += all[cell].weight.mean();
      if (table.cells().angles(cell).theta_h < gonio::radians(22.5)) near += all[cell].weight.mean();
    }
    CHECK(sum == doctest::Approx(static_cast<double>(all.size())).epsilon(1e-9));
    return near / sum;
  };
  CHECK(share_near_highlight(gonio::model::cell_weighting::equal) == doctest::Approx(0.63).epsilon(0.01));
  CHECK(share_near_highlight(gonio::model::cell_weighting::solid_angle) == doctest::Approx(0.146).epsilon(0.01));
  CHECK(share_near_highlight(gonio::model::cell_weighting::cosine) == doctest::Approx(0.271).epsilon(0.01));
}

TEST_CASE("weights decide what a model that does not describe a table follows") {
  const gonio::valid_cells cells(gonio::grid({45, 30, 36}));
  const gonio::model::sum_of_lobes truth{gonio::model::ward(rgb::Constant(0.2), {.roughness = 0.1}),
                                         gonio::model::ward(rgb::Constant(0.2), {.roughness = 0.7})};
  const auto table = gonio::tabulate(truth, cells);
  const auto fit_by = [&](gonio::model::cell_weighting weighting) {
    return gonio::model::fit_model({&lobe_kind::of<gonio::model::ward_shape>()},
                                   gonio::model::fit_observations(table, {}, weighting), gonio::log(),
                                   {.norm = gonio::model::fit_norm::l1});
  };
  const auto loss_of = [&](const gonio::model::model_fit& fit, gonio::model::cell_weighting weighting) {
    double sum = 0.0, weights = 0.0;
    const auto all = gonio::model::fit_observations(table, {}, weighting);
    for (Eigen::Index cell = 0; cell < std::ssize(all); ++cell) {
      const auto [wi, wo] = gonio::to_directions(cells.angles(cell));
      sum += all[cell].weight[0] * std::abs(std::log1p(all[cell].value[0]) - std::log1p(fit.model(wi, wo)[0]));
      weights += all[cell].weight[0];
    }
    return sum / weights;
  };
  const auto equal = fit_by(gonio::model::cell_weighting::equal), cosine = fit_by(gonio::model::cell_weighting::cosine);
  CHECK(loss_of(cosine, gonio::model::cell_weighting::cosine) <
        0.99 * loss_of(equal, gonio::model::cell_weighting::cosine));
  CHECK(loss_of(equal, gonio::model::cell_weighting::equal) <
        0.99 * loss_of(cosine, gonio::model::cell_weighting::equal));
  CHECK(cosine.loss == doctest::Approx(loss_of(cosine, gonio::model::cell_weighting::cosine)).epsilon(0.01));
}

TEST_CASE("random starts never end worse than the consecutive scheme alone") {
  const auto pairs = scattered_pairs(300);
  const lobe_kind& ggx = lobe_kind::of<gonio::model::ggx_shape>();
  const auto samples = observed(
      gonio::model::analytic_brdf({{ggx, rgb::Constant(0.3), {0.05, 0.1}}, {ggx, rgb::Constant(0.2), {0.5, 0.5}}}),
      pairs);
  const lobe_kind& ward = lobe_kind::of<gonio::model::ward_shape>();
  const auto alone = gonio::model::fit_model({&ward, &ward}, samples, gonio::log());
  const auto many = gonio::model::fit_model({&ward, &ward}, samples, gonio::log(), {.random_starts = 5, .seed = 4});
  CHECK(many.loss <= alone.loss);
  CHECK(many.evaluations > alone.evaluations);
}

TEST_CASE("random starts are those of their seed") {
  const lobe_kind &ward = lobe_kind::of<gonio::model::ward_shape>(), &ggx = lobe_kind::of<gonio::model::ggx_shape>();
  const auto samples =
      observed(gonio::model::analytic_brdf({{ggx, rgb::Constant(0.3), {0.2, 0.1}}}), scattered_pairs(200));
  const auto evaluations = [&](std::uint64_t seed) {
    return gonio::model::fit_model({&ward}, samples, gonio::log(), {.random_starts = 8, .seed = seed}).evaluations;
  };
  CHECK(evaluations(1) == evaluations(1));
  CHECK(std::set{evaluations(1), evaluations(2), evaluations(3), evaluations(4)}.size() > 1);
}

TEST_CASE("what cannot be fitted is refused") {
  const lobe_kind &lambert = lobe_kind::of<gonio::model::lambert_shape>(),
                  &ggx = lobe_kind::of<gonio::model::ggx_shape>();
  auto few = observed(gonio::model::analytic_brdf({{lambert, rgb::Ones(), {}}}), scattered_pairs(2));
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::model::fit_model({&lambert, &ggx}, few)),
                       "2 samples of three channels are too few for 8 parameters", gonio::error);
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::model::fit_model({}, few)), doctest::Contains("at least one lobe"),
                       gonio::error);
  for (auto& seen : few) seen.value.setZero();
  CHECK_THROWS_WITH_AS(static_cast<void>(gonio::model::fit_model({&lambert}, few)),
                       doctest::Contains("all measurements are"), gonio::error);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS(
      static_cast<void>(gonio::model::fit_observations(gonio::sample_set{{{0.1, 0.2, 0.3}, {0.1, nan, 0.1}, 1.0}})),
      doctest::Contains("sample 1: a reflectance is not finite"), gonio::error);
}
