#include "../synthetic_materials.hpp"
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/robust/nearest_material.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::nearest_material;

static_assert(gonio::estimator<nearest_material<gonio::log>>);

namespace {

const gonio::material_set& nine_materials() {
  static const auto set = synthetic_materials(small_cells(), 9);
  return set;
}

const gonio::measured<gonio::log>& nine_in_log() {
  static const gonio::measured basis{nine_materials(), gonio::log{}};
  return basis;
}

gonio::brdf_table scaled_table(std::size_t material, const gonio::rgb& factors) {
  auto table = nine_materials().table(material);
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell) table.set(cell, factors * table.at(cell));
  return table;
}

gonio::sample_set samples_of(const gonio::brdf_table& table, std::size_t count, double outliers, std::uint64_t seed) {
  return gonio::sample_table(table, gonio::random_cells(small_cells(), count, seed), {.outlier_ratio = outliers}, seed);
}

auto choice_for(const nearest_material<gonio::log>& nearest, const gonio::sample_set& samples) {
  return nearest.choose(gonio::locate_samples(small_cells(), samples));
}

}  // namespace

TEST_CASE("which material it is, and how bright, is found among 60 % outliers") {
  const nearest_material nearest{nine_in_log()};
  for (const std::size_t material : {0u, 3u, 4u, 8u}) {
    CAPTURE(material);
    const gonio::rgb factors(0.5, 1.0, 2.0);
    const auto chosen = choice_for(nearest, samples_of(scaled_table(material, factors), 300, 0.6, material));
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(chosen[c].material == material);
      // Without noise an inlier is exact, except for the offset, a hundredth of the median. The logarithm includes the
      // offset, which the factor does not multiply.
      CHECK(chosen[c].factor == doctest::Approx(factors[c]).epsilon(0.02));
    }
  }
}

TEST_CASE("materials that are left out are never chosen") {
  for (const std::size_t material : {0u, 4u, 8u}) {
    const auto samples = samples_of(nine_materials().table(material), 100, 0.0, 1);
    const nearest_material all{nine_in_log()}, fewer{nine_in_log().without({nine_materials().names[material]})};
    for (std::size_t c = 0; c < 3; ++c) {
      CHECK(choice_for(all, samples)[c].material == material);
      CHECK(choice_for(fewer, samples)[c].material != material);
    }
  }
}

TEST_CASE("the fit is the chosen material times the factor of each channel") {
  const gonio::rgb factors(0.25, 1.0, 3.0);
  const nearest_material nearest{nine_in_log()};
  const auto samples = samples_of(scaled_table(2, factors), 200, 0.2, 4);
  const auto chosen = choice_for(nearest, samples);
  const auto table = nearest.fit(samples).tabulate(small_cells());
  const auto whole = [](Eigen::Index material) { return gonio::scaled_material{material, 1.0}; };
  for (Eigen::Index cell = 0; cell < small_cells().size(); ++cell) {
    const std::vector<gonio::location> here{gonio::locate_cell(small_cells(), cell)};
    const auto found =
        nearest.values({whole(chosen[0].material), whole(chosen[1].material), whole(chosen[2].material)}, here);
    const auto second = nearest.values({whole(2), whole(2), whole(2)}, here);
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Index row = c;
      REQUIRE(table.values()[3 * cell + c] == doctest::Approx(chosen[c].factor * double{found(row, 0)}).epsilon(1e-6));
      REQUIRE(second(row, 0) ==  // logarithm and exponential in float
              doctest::Approx(double{nine_materials().values(cell, 6 + row)}).epsilon(2e-6));
    }
  }
}

TEST_CASE("the metric of the basis does not matter at cells") {
  const nearest_material by_log{nine_in_log()};
  const nearest_material by_lin{gonio::measured{nine_materials(), gonio::lin{}}};
  const auto located = gonio::locate_samples(small_cells(), samples_of(nine_materials().table(6), 150, 0.4, 2));
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(by_log.choose(located)[c].material == 6);
    CHECK(by_lin.choose(located)[c].material == 6);
    CHECK(by_log.choose(located)[c].factor == doctest::Approx(by_lin.choose(located)[c].factor).epsilon(1e-5));
  }
}

TEST_CASE("the same seed chooses the same from many samples, for any number of threads") {
  std::vector<Eigen::Index> every(small_cells().size());
  std::iota(every.begin(), every.end(), std::size_t{0});
  auto samples = gonio::sample_table(nine_materials().table(1), every, {.outlier_ratio = 0.5}, 1);
  const auto more = gonio::sample_table(nine_materials().table(1), every, {.outlier_ratio = 0.5}, 2);
  while (samples.size() <= 20'000) samples.insert(samples.end(), more.begin(), more.end());
  REQUIRE(samples.size() > 20'000);  // otherwise all are used, for any seed
  const auto one = choice_for(nearest_material{nine_in_log(), 5, {1}}, samples);
  const auto three = choice_for(nearest_material{nine_in_log(), 5, {3}}, samples);
  const auto other_seed = choice_for(nearest_material{nine_in_log(), 6}, samples);
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(one[c].material == 1);
    CHECK(one[c].material == three[c].material);
    CHECK(one[c].factor == three[c].factor);
    CHECK(other_seed[c].material == 1);
    CHECK(other_seed[c].factor != one[c].factor);  // another choice of samples
  }
}

TEST_CASE("the factor of a mixture is found from the differences alone") {
  CHECK(rc::check([] {
    const double logarithm = 0.1 * *rc::gen::inRange(-30, 31);
    const auto seed = static_cast<std::uint64_t>(*rc::gen::inRange(0, 1000));
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> normal(logarithm, 0.1);
    std::uniform_real_distribution<double> uniform(-8.0, 8.0);
    std::vector<double> differences(400);
    for (Eigen::Index i = 0; i < 400; ++i) differences[i] = i % 2 == 0 ? normal(generator) : uniform(generator);
    const auto found = gonio::detail::best_factor(differences, std::vector<double>(400, 1.0 / 16.0));
    // The standard error of the mean of 200 is 0.007; the limit is six times that.
    RC_ASSERT(std::abs(found.logarithm_of_factor - logarithm) < 0.045);
    RC_ASSERT(std::isfinite(found.log_likelihood));
  }));
}

TEST_CASE("one sample, none but zeros, negative ones, equal ones: a finite material") {
  const nearest_material nearest{nine_in_log()};
  auto samples = samples_of(nine_materials().table(3), 30, 0.0, 1);
  const auto check = [&](const gonio::sample_set& some) {
    for (const auto& chosen : choice_for(nearest, some)) {
      CHECK(chosen.material < 9);
      CHECK(std::isfinite(chosen.factor));
      CHECK(chosen.factor > 0.0);
    }
    const auto fit = nearest.fit(some);
    for (const float value : fit.table().values()) REQUIRE((std::isfinite(value) && value >= 0.0f));
  };
  check({samples.begin(), samples.begin() + 1});
  check({samples.begin(), samples.begin() + 2});
  for (auto& s : samples) s.value.setZero();
  check(samples);
  // For black samples the result must be dark.
  CHECK(std::ranges::max(nearest.fit(samples).table().values()) < 1.0f);
  for (auto& s : samples) s.value.setConstant(-2.0);
  check(samples);
  for (auto& s : samples) s.value.setConstant(0.3);
  check(samples);
  for (auto& s : samples) s.value.setConstant(1e30);
  check(samples);
}

TEST_CASE("a material that is black at the samples may be near") {
  auto set = synthetic_materials(small_cells(), 3);
  set.values.middleCols(3, 3).setZero();
  const nearest_material nearest{gonio::measured{set, gonio::log{}}};
  auto samples = gonio::sample_table(set.table(1), gonio::random_cells(small_cells(), 50, 1));
  CHECK(choice_for(nearest, samples)[0].material == 1);
}

TEST_CASE("samples of weight zero change nothing, and unusable ones are refused") {
  const nearest_material nearest{nine_in_log()};
  const auto samples = samples_of(nine_materials().table(7), 40, 0.5, 3);
  auto more = samples;
  more.insert(more.begin() + 10, 30, {samples[0].angles(), gonio::rgb(90, 80, 70), 0.0});
  const auto one = nearest.fit(samples), other = nearest.fit(more);
  CHECK(std::ranges::equal(one.table().values(), other.table().values()));
  CHECK_THROWS_WITH_AS(nearest.fit(gonio::sample_set{}), doctest::Contains("no samples"), gonio::error);
  more[3].value.x() = std::nan("");
  CHECK_THROWS_WITH_AS(nearest.fit(more), doctest::Contains("sample 4"), gonio::error);
}
