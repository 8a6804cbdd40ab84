#include "../synthetic_materials.hpp"
#include <gonio/interpolate/scattered_brdf.hpp>
#include <gonio/metric/log_relative.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <ranges>

using gonio::direction;
using gonio::half_difference;
using gonio::interpolation_domain;
using gonio::rgb;
using gonio::sample_set;
using gonio::scattered_interpolation;
using gonio::scattered_options;

static_assert(gonio::estimator<scattered_interpolation> && gonio::tabulated_brdf<gonio::scattered_brdf>);

namespace {

direction any_direction(std::mt19937_64& generator) {
  std::uniform_real_distribution<double> uniform;
  const double z = 0.05 + 0.95 * uniform(generator), phi = 2.0 * std::numbers::pi * uniform(generator);
  return {std::sqrt(1.0 - z * z) * std::cos(phi), std::sqrt(1.0 - z * z) * std::sin(phi), z};
}

gonio::direction_pair any_pair(std::mt19937_64& generator) {
  const direction wi = any_direction(generator);
  return {wi, any_direction(generator)};
}

sample_set scattered_samples(int count, std::mt19937_64& generator) {
  std::uniform_real_distribution<double> uniform;
  sample_set samples;
  for (int i = 0; i < count; ++i)
    samples.push_back({any_pair(generator), rgb(uniform(generator), 3.0 * uniform(generator), 0.01), 1.0});
  return samples;
}

/// Computes the value by its definition: distances to all samples, sorted.
rgb by_definition(const sample_set& samples, const gonio::direction_pair& pair, const scattered_options& options) {
  const auto distance = [&](const gonio::sample& s) {
    const auto a = options.embedding(s.angles()), b = options.embedding(gonio::to_half_difference(pair.wi, pair.wo));
    return std::hypot(std::hypot(a[0] - b[0], a[1] - b[1]), std::hypot(a[2] - b[2], a[3] - b[3]));
  };
  std::vector<std::pair<double, rgb>> near;
  for (const gonio::sample& s : samples) near.emplace_back(distance(s), s.value);
  std::ranges::sort(near, {}, [](const auto& one) { return one.first; });
  const Eigen::Index count = std::min(options.neighbours, std::ssize(near));
  const bool all = count == std::ssize(near);
  const bool logarithm = options.domain == interpolation_domain::logarithm;
  rgb sum = rgb::Zero();
  double weights = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) {
    const double d = near[i].first, r = all ? 0.0 : near[count].first;
    const double weight = std::pow(all ? 1.0 / d : (r - d) / (r * d), options.exponent);
    sum += weight * (logarithm ? rgb((near[i].second + 1e-3).log()) : near[i].second);
    weights += weight;
  }
  return logarithm ? rgb((sum / weights).exp() - 1e-3) : rgb(sum / weights);
}

}  // namespace

TEST_CASE("a search through all samples finds the same") {
  for (const Eigen::Index neighbours : {1, 2, 8, 40})
    for (const auto domain : {interpolation_domain::reflectance, interpolation_domain::logarithm})
      for (const double exponent : {1.0, 2.0, 3.5}) {
        std::mt19937_64 generator(11);
        const sample_set samples = scattered_samples(30, generator);
        const scattered_options options{.neighbours = neighbours, .exponent = exponent, .domain = domain};
        const auto f = scattered_interpolation{options}.fit(samples);
        for (int i = 0; i < 50; ++i) {
          const auto pair = any_pair(generator);
          // By the definition, weights end a millionth further out.
          REQUIRE((f(pair.wi, pair.wo) - by_definition(samples, pair, options)).abs().maxCoeff() < 1e-4);
        }
      }
}

TEST_CASE("anything usable: samples come back, values lie between them, a constant stays one") {
  CHECK(rc::check([] {
    std::mt19937_64 generator(*rc::gen::arbitrary<std::uint64_t>());
    const int count = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(1, 60));
    const scattered_options options{
        .neighbours = *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(1, 65)),
        .exponent = 0.1 * *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(15, 50)),
        .domain = *rc::gen::element(interpolation_domain::reflectance, interpolation_domain::logarithm)};
    sample_set samples = scattered_samples(count, generator);
    const auto f = scattered_interpolation{options}.fit(samples);
    rgb least = samples[0].value, most = least;
    for (const gonio::sample& s : samples) {
      least = least.min(s.value);
      most = most.max(s.value);
      const auto [wi, wo] = s.directions.pair();
      RC_ASSERT((f(wi, wo) - s.value).abs().maxCoeff() < 1e-9);
    }
    for (int i = 0; i < 20; ++i) {
      const auto [wi, wo] = any_pair(generator);
      const rgb value = f(wi, wo);
      RC_ASSERT((value >= least - 1e-12).all());
      RC_ASSERT((value <= most + 1e-12).all());
    }
    for (gonio::sample& s : samples) s.value = rgb(1, 2, 3);
    const auto constant = scattered_interpolation{options}.fit(samples);
    for (int i = 0; i < 20; ++i) {
      const auto [wi, wo] = any_pair(generator);
      RC_ASSERT((constant(wi, wo) - rgb(1, 2, 3)).abs().maxCoeff() < 1e-12);
    }
  }));
}

TEST_CASE("reciprocal bit by bit, isotropic up to rounding") {
  std::mt19937_64 generator(5);
  const auto f = scattered_interpolation{}.fit(scattered_samples(400, generator));
  for (int i = 0; i < 500; ++i) {
    const auto [wi, wo] = any_pair(generator);
    REQUIRE((f(wi, wo) == f(wo, wi)).all());
    for (const double angle : {0.5, 2.0, 4.0})
      REQUIRE((f(wi, wo) - f(gonio::turned_about_normal(wi, angle), gonio::turned_about_normal(wo, angle)))
                  .abs()
                  .maxCoeff() < 1e-9);
  }
}

TEST_CASE("the value changes without steps, also where one neighbour replaces another") {
  std::mt19937_64 generator(6);
  const auto f = scattered_interpolation{}.fit(scattered_samples(100, generator));
  const auto at = [&](double x) {
    return f(gonio::spherical_direction(0.2 + x, 0.0), gonio::spherical_direction(0.9, 2.0));
  };
  constexpr int steps = 100'000;
  double largest = 0.0;
  for (int i = 0; i < steps; ++i)
    largest = std::max(largest, (at((i + 1.0) / steps) - at(static_cast<double>(i) / steps)).abs().maxCoeff());
  CHECK(largest < 1e-3);
  CHECK((at(0.0) - at(1.0)).abs().maxCoeff() > 10.0 * largest);
}

TEST_CASE("samples count by their weights, and by those of each channel") {
  const half_difference here{0.2, 0.3, 0.4};
  const scattered_options plain{.domain = interpolation_domain::reflectance};
  const auto value = [&](const sample_set& samples) {
    const auto [wi, wo] = to_directions(here);
    return scattered_interpolation{plain}.fit(samples)(wi, wo);
  };
  CHECK((value({{here, rgb(1, 2, 4), 0.5}, {here, rgb(5, 6, 0), 1.5}}) - rgb(4, 5, 1)).abs().maxCoeff() < 1e-12);
  CHECK((value({{here, rgb(1, 2, 4), 0.0}, {here, rgb(5, 6, 0), 1.5}}) - rgb(5, 6, 0)).abs().maxCoeff() < 1e-12);
  // More repeats than neighbours: none is left out, and samples elsewhere keep their weights.
  sample_set many(100, {here, rgb(2, 2, 2), 1.0});
  many.push_back({here, rgb(103, 2, -99), 1.0});
  CHECK((value(many) - rgb(3, 2, 1)).abs().maxCoeff() < 1e-12);
  // A channel overexposed here is taken from elsewhere.
  const half_difference elsewhere{0.2, 0.35, 0.4};
  const rgb known = value({{here, rgb(1, 2, 4), rgb(0, 1, 1)}, {elsewhere, rgb(5, 6, 7), 1.0}});
  CHECK(known.x() == doctest::Approx(5.0));
  CHECK(known.y() == doctest::Approx(2.0));
}

TEST_CASE("negative results become zero; the value below the horizon is zero") {
  const half_difference here{0.2, 0.3, 0.4};
  const auto [wi, wo] = to_directions(here);
  for (const auto domain : {interpolation_domain::reflectance, interpolation_domain::logarithm}) {
    const auto f = scattered_interpolation{{.domain = domain}}.fit(sample_set{{here, rgb(-1, 0, 2), 1.0}});
    CHECK((f(wi, wo) - rgb(0, 0, 2)).abs().maxCoeff() < 1e-12);
    CHECK((f({0, 0, 1}, {1, 0, 0}) == 0.0).all());
    CHECK((f({0, 0, -1}, {0, 0, 1}) == 0.0).all());
  }
}

TEST_CASE("tables have the same bytes for any number of threads, and approach a densely sampled BRDF") {
  const auto truth = synthetic_materials(small_cells(), 3).table(1);
  sample_set samples;
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell)
    samples.push_back({small_cells().angles(cell), truth.at(cell), 1.0});
  const auto f = scattered_interpolation{}.fit(samples);
  const auto table = f.tabulate(small_cells(), {1});
  CHECK(std::ranges::equal(table.values(), f.tabulate(small_cells(), {3}).values()));
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell)
    REQUIRE((table.at(cell) - truth.at(cell)).abs().maxCoeff() < 1e-5 * (1.0 + truth.at(cell).maxCoeff()));
  // Accepts any range of samples.
  const auto read = samples | std::views::transform([](const gonio::sample& s) { return s; });
  CHECK(std::ranges::equal(scattered_interpolation{}.fit(read).tabulate(small_cells()).values(), table.values()));
}

TEST_CASE("unusable samples and options are refused") {
  const scattered_interpolation estimator;
  CHECK_THROWS_WITH_AS(estimator.fit(sample_set{}), doctest::Contains("no samples"), gonio::error);
  sample_set samples{{{0.1, 0.2, 0.3}, rgb(1, 1, 1), 0.0}, {{0.3, 0.2, 0.3}, rgb(1, 1, 1), 0.0}};
  CHECK_THROWS_WITH_AS(estimator.fit(samples), doctest::Contains("weight zero"), gonio::error);
  samples[0].weight = rgb(1, 1, 0);
  CHECK_THROWS_WITH_AS(estimator.fit(samples), doctest::Contains("one of the channels"), gonio::error);
  samples[1].value.y() = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH_AS(estimator.fit(samples), doctest::Contains("sample 2"), gonio::error);
  CHECK_THROWS_WITH_AS(scattered_interpolation{{.neighbours = 0}}, doctest::Contains("neighbours"), gonio::error);
}
