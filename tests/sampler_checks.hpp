#pragma once
/// Checks for anything that draws directions: whether `sample` draws what `pdf` says (chi-square over the whole sphere,
/// as in Mitsuba's and pbrt's tests), whether pdf integrates to 1, and albedos by sampling and by quadrature. They
/// return numbers; tests compare them. All bins and integrals are over the half vector h instead of wi, one hemisphere
/// of which is the whole sphere of wi = 2 (wo . h) h - wo: d wi = 4 |wo . h| dh. There a density of reflected half
/// vectors has neither its pole at wi = -wo nor its needle at grazing angles.

#include <gonio/core/brdf.hpp>
#include <gonio/core/sampled_direction.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace sampler_checks {

/// Numbers from 0 up to 1, the same of every compiler and library.
class uniform_numbers {
 public:
  explicit uniform_numbers(std::uint64_t seed) : generator_(seed) {}
  double operator()() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 generator_;
};

/// A rectangle of a chart.
struct box {
  double low_t, high_t, low_turn, high_turn;
};

/// Coordinates from 0 to 1 of wi, given wo: t is the cube root of the half angle, as a share of 90 degrees, so that
/// even steps resolve a highlight; turn is the azimuth of the half vector from that of wo.
class half_vector_chart {
 public:
  explicit half_vector_chart(const gonio::direction& wo) : wo_(wo), azimuth_(std::atan2(wo.y(), wo.x())) {}

  /// t and turn of a direction. Opposite to wo every half vector will do.
  [[nodiscard]] std::pair<double, double> place_of(const gonio::direction& wi) const {
    gonio::direction h = wi + wo_;
    if (h.z() < 0.0) h = -h;
    const double t = std::cbrt(gonio::polar_angle(h) / (std::numbers::pi / 2.0));
    const double turn = (std::atan2(h.y(), h.x()) - azimuth_) / (2.0 * std::numbers::pi);
    return {t, turn - std::floor(turn)};
  }

  /// The integral of g(wi) over the solid angle of a box. It halves parts of the box both ways until that changes them
  /// by less than `tolerance`. Needles, which lie along t, are found up to some 80 times as long as wide.
  template <class G>
  [[nodiscard]] double integral(const G& g, const box& b, double tolerance) const {
    constexpr int along_t = 2, along_turn = 4;
    double sum = 0.0;
    for (int i = 0; i < along_t; ++i)
      for (int j = 0; j < along_turn; ++j) {
        const auto t = [&](int k) { return std::lerp(b.low_t, b.high_t, k / double{along_t}); };
        const auto turn = [&](int k) { return std::lerp(b.low_turn, b.high_turn, k / double{along_turn}); };
        const box part{t(i), t(i + 1), turn(j), turn(j + 1)};
        sum += halved(g, part, by_gauss(g, part), tolerance, 0);
      }
    return sum;
  }

  /// That without halving, by three Gauss-Legendre points each way.
  template <class G>
  [[nodiscard]] double by_gauss(const G& g, const box& b) const {
    constexpr std::array at{0.1127016653792583, 0.5, 0.8872983346207417};
    constexpr std::array weight{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    double sum = 0.0;
    for (std::size_t i = 0; i < at.size(); ++i)
      for (std::size_t j = 0; j < at.size(); ++j)
        sum += weight[i] * weight[j] *
               density(g, std::lerp(b.low_t, b.high_t, at[i]), std::lerp(b.low_turn, b.high_turn, at[j]));
    return sum * (b.high_t - b.low_t) * (b.high_turn - b.low_turn);
  }

 private:
  static constexpr int deepest = 4;

  /// g(wi) times the solid angle of wi for each dt and turn.
  template <class G>
  [[nodiscard]] double density(const G& g, double t, double turn) const {
    const double theta = std::numbers::pi / 2.0 * t * t * t;
    const gonio::direction h = gonio::spherical_direction(theta, azimuth_ + 2.0 * std::numbers::pi * turn);
    const double cosine = wo_.dot(h);
    const double solid_angle = std::sin(theta) * (1.5 * std::numbers::pi * t * t) * (2.0 * std::numbers::pi);
    return g(gonio::direction((2.0 * cosine * h - wo_).normalized())) * 4.0 * std::abs(cosine) * solid_angle;
  }

  template <class G>
  [[nodiscard]] double halved(const G& g, const box& b, double whole, double tolerance, int depth) const {
    const double t = std::midpoint(b.low_t, b.high_t), turn = std::midpoint(b.low_turn, b.high_turn);
    const std::array quarters{box{b.low_t, t, b.low_turn, turn}, box{b.low_t, t, turn, b.high_turn},
                              box{t, b.high_t, b.low_turn, turn}, box{t, b.high_t, turn, b.high_turn}};
    std::array<double, 4> parts{};
    for (std::size_t i = 0; i < parts.size(); ++i) parts[i] = by_gauss(g, quarters[i]);
    const double sum = parts[0] + parts[1] + parts[2] + parts[3];
    if (depth == deepest || !(std::abs(sum - whole) > tolerance)) return sum;
    double better = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i) better += halved(g, quarters[i], parts[i], tolerance, depth + 1);
    return better;
  }

  gonio::direction wo_;
  double azimuth_;
};

/// Bins of the chart: so many of t, and so many of turn.
inline constexpr int rows = 20, columns = 12;

[[nodiscard]] constexpr std::size_t bins() { return rows * columns; }

/// The bin of a direction, or `bins()` for one that is not finite.
[[nodiscard]] inline std::size_t bin_of(const half_vector_chart& chart, const gonio::direction& wi) {
  if (!wi.allFinite()) return bins();
  const auto [t, turn] = chart.place_of(wi);
  const int row = std::min(static_cast<int>(t * rows), rows - 1);
  const int column = std::min(static_cast<int>(turn * columns), columns - 1);
  return row * columns + column;
}

/// The bins in their order.
[[nodiscard]] inline std::vector<box> boxes_of_bins() {
  std::vector<box> boxes;
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      boxes.push_back({i / double{rows}, (i + 1) / double{rows}, j / double{columns}, (j + 1) / double{columns}});
  return boxes;
}

/// The share of draws that pdf promises to each bin.
template <gonio::direction_sampler Sampler>
[[nodiscard]] std::vector<double> shares_of_bins(const Sampler& sampler, const gonio::direction& wo) {
  const half_vector_chart chart(wo);
  std::vector<double> shares;
  for (const box& bin : boxes_of_bins())
    shares.push_back(chart.integral([&](const gonio::direction& wi) { return sampler.pdf(wi, wo); }, bin, 1e-6));
  return shares;
}

/// The integral of pdf over the sphere of directions, which is to be 1.
template <gonio::direction_sampler Sampler>
[[nodiscard]] double integral_of_pdf(const Sampler& sampler, const gonio::direction& wo) {
  const std::vector<double> shares = shares_of_bins(sampler, wo);
  return std::accumulate(shares.begin(), shares.end(), 0.0);
}

/// The regularised incomplete gamma function Q(a, x): its series below a + 1, its continued fraction (by Lentz) above.
/// W. H. Press et al., "Numerical Recipes", 3rd edition 2007, Sec. 6.2.
[[nodiscard]] inline double upper_gamma(double a, double x) {
  if (!(x > 0.0)) return 1.0;
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  constexpr int most_terms = 100'000;
  if (x < a + 1.0) {
    double term = 1.0 / a, sum = term;
    for (int n = 1; n < most_terms && term > 1e-17 * sum; ++n) sum += term *= x / (a + n);
    return std::max(0.0, 1.0 - scale * sum);
  }
  double b = x + 1.0 - a, c = 1e300, d = 1.0 / b, fraction = d;
  for (int n = 1; n < most_terms; ++n) {
    const double numerator = -n * (n - a);
    b += 2.0;
    d = 1.0 / (numerator * d + b);
    c = b + numerator / c;
    fraction *= c * d;
    if (std::abs(c * d - 1.0) < 1e-15) break;
  }
  return scale * fraction;
}

/// How likely counts are at least as far from what is expected as those found, if they are drawn from it. Bins are
/// pooled, those that expect least first, until each expects 20 or more: Pearson's statistic has then the chi-square
/// distribution.
[[nodiscard]] inline double chi_square_p_value(const std::vector<double>& expected, const std::vector<double>& found) {
  std::vector<Eigen::Index> order(expected.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order, {}, [&](std::size_t bin) { return expected[bin]; });
  double statistic = 0.0, pooled_expected = 0.0, pooled_found = 0.0, still_expected = 0.0;
  for (const double count : expected) still_expected += count;
  int pools = 0;
  for (const Eigen::Index bin : order) {
    pooled_expected += expected[bin];
    pooled_found += found[bin];
    still_expected -= expected[bin];
    if (bin != order.back() && (pooled_expected < 20.0 || still_expected < 20.0)) continue;
    statistic += (pooled_found - pooled_expected) * (pooled_found - pooled_expected) / pooled_expected;
    ++pools;
    pooled_expected = pooled_found = 0.0;
  }
  if (pools == 1) return std::abs(statistic) < 1.0 ? 1.0 : 0.0;  // all in one bin
  return std::isfinite(statistic) ? upper_gamma(0.5 * (pools - 1), 0.5 * statistic) : 0.0;
}

/// The p value of draws, given the shares of their bins: what a test with several seeds integrates once.
template <gonio::direction_sampler Sampler>
[[nodiscard]] double chi_square_p_value(const Sampler& sampler, const gonio::direction& wo,
                                        const std::vector<double>& shares, std::size_t draws, std::uint64_t seed) {
  const half_vector_chart chart(wo);
  uniform_numbers number(seed);
  std::vector<double> found(bins() + 1), expected;
  for (const double share : shares) expected.push_back(share * static_cast<double>(draws));
  for (std::size_t i = 0; i < draws; ++i) {
    const double u1 = number();
    const double u2 = number();
    found[bin_of(chart, sampler.sample(wo, u1, u2).wi)] += 1.0;
  }
  if (found.back() > 0.0) return 0.0;
  found.pop_back();
  return chi_square_p_value(expected, found);
}

/// How likely `sample` draws directions as far from `pdf` as these, if the two agree. Compare with `sidak`.
template <gonio::direction_sampler Sampler>
[[nodiscard]] double chi_square_p_value(const Sampler& sampler, const gonio::direction& wo, std::size_t draws,
                                        std::uint64_t seed) {
  return chi_square_p_value(sampler, wo, shares_of_bins(sampler, wo), draws, seed);
}

/// The p value below which one of several tests fails, so that all pass with a chance of 1 - alpha if all is well.
[[nodiscard]] inline double sidak(double alpha, int tests) { return 1.0 - std::pow(1.0 - alpha, 1.0 / tests); }

/// Mean and variance of numbers that were drawn, and how far the mean may be from the true one.
struct moments {
  double mean = 0.0, variance = 0.0, standard_error = 0.0;
};

/// Of draw(u1, u2) for numbers from 0 up to 1.
template <class Draw>
[[nodiscard]] moments moments_of(const Draw& draw, std::size_t draws, std::uint64_t seed) {
  uniform_numbers number(seed);
  double mean = 0.0, squares = 0.0;  // Welford's, which does not cancel
  for (std::size_t i = 0; i < draws; ++i) {
    const double u1 = number();
    const double u2 = number();
    const double value = draw(u1, u2), step = value - mean;
    mean += step / static_cast<double>(i + 1);
    squares += step * (value - mean);
  }
  const double variance = squares / static_cast<double>(draws - 1);
  return {mean, variance, std::sqrt(variance / static_cast<double>(draws))};
}

/// The fraction of light that goes towards wo under a white sky, mean of the channels: the mean weight.
template <gonio::direction_sampler Sampler>
[[nodiscard]] moments albedo_by_sampling(const Sampler& sampler, const gonio::direction& wo, std::size_t draws,
                                         std::uint64_t seed) {
  return moments_of([&](double u1, double u2) { return sampler.sample(wo, u1, u2).weight.mean(); }, draws, seed);
}

/// The same by cosine-weighted directions, with which importance sampling has to compare.
template <gonio::brdf Brdf>
[[nodiscard]] moments albedo_by_cosine(const Brdf& f, const gonio::direction& wo, std::size_t draws,
                                       std::uint64_t seed) {
  return moments_of(
      [&](double u1, double u2) {
        return gonio::rgb(f(gonio::cosine_weighted_direction(u1, u2), wo)).mean() * std::numbers::pi;
      },
      draws, seed);
}

/// The same by integration of f cos(theta_i).
template <gonio::brdf Brdf>
[[nodiscard]] double albedo_by_quadrature(const Brdf& f, const gonio::direction& wo) {
  const auto reflected = [&](const gonio::direction& wi) {
    return wi.z() > 0.0 ? gonio::rgb(f(wi, wo)).mean() * wi.z() : 0.0;
  };
  const half_vector_chart chart(wo);
  double roughly = 0.0, albedo = 0.0;
  for (const box& bin : boxes_of_bins()) roughly += chart.by_gauss(reflected, bin);
  for (const box& bin : boxes_of_bins()) albedo += chart.integral(reflected, bin, 1e-6 * roughly);
  return albedo;
}

}  // namespace sampler_checks
