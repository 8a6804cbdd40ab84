#include <gonio/render/half_vector_sampler.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <random>

using gonio::direction;
using gonio::half_vector_sampler;
using gonio::rgb;

namespace {

/// A Lambertian of some reflectance below a lobe about the half vector.
struct shiny {
  double diffuse = 0.2, height = 3.0, exponent = 200.0;

  rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return rgb::Zero();
    const double lobe = height * std::pow((wi + wo).normalized().z(), exponent);
    return rgb(diffuse, 0.5 * diffuse, 0.1) * std::numbers::inv_pi + lobe;
  }
};
static_assert(gonio::brdf<shiny>);

constexpr shiny matt{0.5, 0.0, 1.0}, satin{0.3, 0.5, 20.0}, metal{0.02, 20.0, 1000.0};

const std::array seen_at{0.0, 30.0, 60.0, 80.0, 89.0};

direction viewer(double theta) { return gonio::spherical_direction(gonio::radians(theta), 0.7); }

/// Polar coordinates about the mirror direction of a viewer: t is the square root of the angle from it, as a share, so
/// that a grid of even steps resolves a highlight.
class around_mirror {
 public:
  explicit around_mirror(const direction& wo) : axis_(-wo.x(), -wo.y(), wo.z()) {
    across_ = gonio::detail::cross_product(axis_, std::abs(axis_.z()) < 0.9 ? direction::UnitZ() : direction::UnitX())
                  .normalized();
    up_ = gonio::detail::cross_product(axis_, across_);
  }
  [[nodiscard]] direction at(double t, double turn) const {
    const double angle = std::numbers::pi * t * t, azimuth = 2.0 * std::numbers::pi * turn;
    return std::cos(angle) * axis_ + std::sin(angle) * (std::cos(azimuth) * across_ + std::sin(azimuth) * up_);
  }
  /// The inverse: t and the turn, both from 0 to 1.
  [[nodiscard]] std::pair<double, double> place_of(const direction& w) const {
    const double turn = std::atan2(w.dot(up_), w.dot(across_)) / (2.0 * std::numbers::pi);
    return {std::sqrt(gonio::angle_between(w, axis_) / std::numbers::pi), turn < 0.0 ? turn + 1.0 : turn};
  }
  /// Solid angle for each dt and turn.
  [[nodiscard]] static double measure(double t) {
    return std::sin(std::numbers::pi * t * t) * 2.0 * std::numbers::pi * t * 2.0 * std::numbers::pi;
  }
  template <class F>
  [[nodiscard]] double integral(const F& f, int rows) const {
    double sum = 0.0;
    for (int i = 0; i < rows; ++i)
      for (int j = 0; j < rows; ++j) {
        const double t = (i + 0.5) / rows;
        sum += f(at(t, (j + 0.5) / rows)) * measure(t);
      }
    return sum / (static_cast<double>(rows) * rows);
  }

 private:
  direction axis_, across_, up_;
};

/// Mean and variance of numbers.
struct moments {
  double mean = 0.0, variance = 0.0;
  std::size_t count = 0;

  template <class Draw>
  moments(std::size_t draws, const Draw& draw) : count(draws) {
    double sum = 0.0, squares = 0.0;
    for (std::size_t i = 0; i < draws; ++i) {
      const double value = draw();
      sum += value;
      squares += value * value;
    }
    mean = sum / static_cast<double>(draws);
    variance = std::max(0.0, squares / static_cast<double>(draws) - mean * mean);
  }
  [[nodiscard]] double error() const { return std::sqrt(variance / static_cast<double>(count)); }
};

}  // namespace

TEST_CASE("half-vector sampler: the weight times pdf is f times the cosine") {
  const half_vector_sampler sampler(satin);
  rc::check("of every direction drawn", [&] {
    const auto number = [] { return *rc::gen::inRange(0, 1'000'000) / 1e6; };
    const direction wo = viewer(*rc::gen::inRange(0, 90));
    const auto drawn = sampler.sample(wo, number(), number());
    RC_ASSERT(std::abs(drawn.wi.norm() - 1.0) < 1e-12);
    RC_ASSERT(drawn.pdf > 0.0 || drawn.wi.z() <= 1e-6);
    RC_ASSERT(drawn.pdf == sampler.pdf(drawn.wi, wo));
    const rgb expected = drawn.wi.z() > 0.0 ? rgb(satin(drawn.wi, wo) * drawn.wi.z()) : rgb(rgb::Zero());
    RC_ASSERT(((drawn.weight * drawn.pdf - expected).abs() <= 1e-12 * expected).all());
    RC_ASSERT((drawn.weight <= 10.0001 * std::numbers::pi * satin(drawn.wi, wo)).all());
  });
}

TEST_CASE("half-vector sampler: pdf integrates to 1 over the sphere") {
  for (const shiny& f : {matt, satin, metal}) {
    const half_vector_sampler sampler(f);
    for (const double theta : {0.0, 30.0, 60.0}) {  // farther down the density is infinite in one direction
      const direction wo = viewer(theta);
      CHECK(around_mirror(wo).integral([&](const direction& wi) { return sampler.pdf(wi, wo); }, 1500) ==
            doctest::Approx(1.0).epsilon(0.005));
    }
  }
}

TEST_CASE("half-vector sampler: what is drawn is what pdf says (chi-square)") {
  constexpr int rows = 24, columns = 24, inside = 40;
  constexpr std::size_t draws = 100'000;
  std::mt19937_64 generator(5);
  std::uniform_real_distribution<double> uniform;
  for (const shiny& f : {matt, satin, metal})
    for (const double theta : {0.0, 30.0, 60.0}) {
      const half_vector_sampler sampler(f);
      const direction wo = viewer(theta);
      const around_mirror places(wo);
      std::vector<double> expected(rows * columns), found(rows * columns);
      const double share = 1.0 / (rows * inside * columns * inside);
      for (int i = 0; i < rows * inside; ++i)
        for (int j = 0; j < columns * inside; ++j) {
          const double t = (i + 0.5) / (rows * inside);
          expected[static_cast<std::size_t>(i / inside * columns + j / inside)] +=
              sampler.pdf(places.at(t, (j + 0.5) / (columns * inside)), wo) * places.measure(t) * share *
              static_cast<double>(draws);
        }
      for (std::size_t i = 0; i < draws; ++i) {
        const double u1 = uniform(generator), u2 = uniform(generator);
        const auto [t, turn] = places.place_of(sampler.sample(wo, u1, u2).wi);
        const int row = std::min(static_cast<int>(t * rows), rows - 1);
        const int column = std::min(static_cast<int>(turn * columns), columns - 1);
        ++found[static_cast<std::size_t>(row * columns + column)];
      }
      double statistic = 0.0, pooled_expected = 0.0, pooled_found = 0.0;
      int bins = 0;
      for (std::size_t b = 0; b < expected.size(); ++b) {
        pooled_expected += expected[b];
        pooled_found += found[b];
        if (pooled_expected < 20.0) continue;
        statistic += std::pow(pooled_found - pooled_expected, 2) / pooled_expected;
        ++bins;
        pooled_expected = pooled_found = 0.0;
      }
      // The statistic is nearly normal of mean bins - 1 and variance twice that; nine tests at once, alpha 0.01
      // (Sidak): 3.05 deviations. The grid under `expected` is not exact, hence a little more.
      const double deviations = (statistic - (bins - 1)) / std::sqrt(2.0 * (bins - 1));
      INFO("theta " << theta << ", exponent " << f.exponent << ": " << statistic << " of " << bins << " bins");
      CHECK(deviations < 4.0);
    }
}

TEST_CASE("half-vector sampler: the albedo is that of quadrature, with much less variance where the surface shines") {
  std::mt19937_64 generator(9);
  std::uniform_real_distribution<double> uniform;
  // Compilers differ in the order in which they evaluate arguments.
  const auto with_two_numbers = [&](const auto& draw) {
    const double u1 = uniform(generator), u2 = uniform(generator);
    return draw(u1, u2);
  };
  for (const shiny& f : {matt, satin, metal}) {
    const half_vector_sampler sampler(f);
    double variance = 0.0, variance_of_cosines = 0.0;
    for (const double theta : seen_at) {
      const direction wo = viewer(theta);
      const moments ours(40'000, [&] {
        return with_two_numbers([&](double u1, double u2) { return sampler.sample(wo, u1, u2).weight.mean(); });
      });
      const moments by_cosine(40'000, [&] {
        return with_two_numbers([&](double u1, double u2) {
          return f(gonio::cosine_weighted_direction(u1, u2), wo).mean() * std::numbers::pi;
        });
      });
      const double albedo = around_mirror(wo).integral(
          [&](const direction& wi) { return f(wi, wo).mean() * std::max(wi.z(), 0.0); }, 1000);
      INFO("theta " << theta << ", exponent " << f.exponent << ": " << ours.mean << " +- " << ours.error() << ", is "
                    << albedo << "; variance of cosines " << by_cosine.variance / ours.variance << " times ours");
      CHECK(std::abs(ours.mean - albedo) < 3.5 * ours.error() + 1e-3 * albedo);
      CHECK(ours.variance < 1.3 * by_cosine.variance + 1e-12);
      variance += ours.variance;
      variance_of_cosines += by_cosine.variance;
    }
    INFO("exponent " << f.exponent << ": variance of cosines " << variance_of_cosines / variance << " times ours");
    if (f.exponent == metal.exponent) CHECK(variance < variance_of_cosines / 4.0);
  }
}

TEST_CASE("half-vector sampler: below the horizon nothing is drawn") {
  const half_vector_sampler sampler(satin);
  for (const direction& wo : {direction(0.0, 0.6, -0.8), direction(1.0, 0.0, 0.0), direction(0.0, 0.0, std::nan(""))}) {
    CHECK((sampler.sample(wo, 0.3, 0.3).weight == 0.0).all());
    CHECK(sampler.pdf(direction::UnitZ(), wo) == 0.0);
  }
}
