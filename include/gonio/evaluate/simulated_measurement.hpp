#pragma once
/// Simulates measurements from a table, with the defects of real ones. Noell et al. 2014, section 3.1 (data ratio,
/// outlier ratio), and relative noise as in Nielsen et al. 2015 (doi:10.1145/2816795.2818085).

#include <gonio/core/brdf.hpp>
#include <gonio/core/random.hpp>
#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

struct measurement_defects {
  /// Fraction of the samples that are outliers, with the value of a random cell of the table.
  double outlier_ratio = 0.0;
  /// Standard deviation of Gaussian noise relative to the value, independent in each channel.
  double noise = 0.0;
  /// Each value is the mean over the cones of the aperture, computed from `pairs_a_reading` pairs of directions.
  gonio::aperture aperture = {};
  static constexpr int pairs_a_reading = 512;
};

/// Turns a direction by an angle in radians towards a random azimuth. Returns it unchanged if the result would be at or
/// below the horizon.
template <class Generator>
[[nodiscard]] direction misplaced(const direction& w, double angle, Generator& generator) {
  std::uniform_real_distribution<double> any_side(0.0, 2.0 * std::numbers::pi);
  return turned_above_horizon(w, angle, any_side(generator));
}

/// Returns samples whose light and viewer each miss their nominal direction by an angle in radians. The values are
/// interpolated from the table at the actual directions; the samples have the nominal ones.
[[nodiscard]] sample_set sample_table_misplaced(const brdf_table& table, std::span<const direction_pair> pairs,
                                                double angle, std::uint64_t seed = 0);

/// Returns the fraction `share` (0 to 1) of the number `all`, rounded, at least 1.
[[nodiscard]] inline Eigen::Index share_of(Eigen::Index all, double share) noexcept {
  return std::max<Eigen::Index>(std::llround(share * static_cast<double>(all)), 1);
}

/// Returns `count` distinct random cells, ascending. Throws gonio::error unless count is between 1 and the number of
/// cells.
[[nodiscard]] std::vector<Eigen::Index> random_cells(const valid_cells& cells, Eigen::Index count, std::uint64_t seed);

/// Returns the cell nearest to each direction; a cell occurs twice if two directions share it. Throws gonio::error
/// naming the first direction without a valid cell.
[[nodiscard]] std::vector<Eigen::Index> cells_at(const valid_cells& cells, std::span<const half_difference> directions);

/// Adds outliers and noise to samples. The seed determines them. `any_value(generator)` returns the value of an
/// outlier. Throws gonio::error for an outlier ratio outside [0, 1] or negative noise.
template <class AnyValue>
[[nodiscard]] sample_set corrupt(sample_set samples, const measurement_defects& defects, std::uint64_t seed,
                                 AnyValue&& any_value) {
  if (!(defects.outlier_ratio >= 0.0 && defects.outlier_ratio <= 1.0))
    refuse("the outlier ratio must be from 0 to 1, not " + std::to_string(defects.outlier_ratio));
  if (!(defects.noise >= 0.0 && std::isfinite(defects.noise)))
    refuse("the noise must be finite and not negative, not " + std::to_string(defects.noise));

  // Replace exactly the requested fraction, so that 20 samples have the same ratio as a million.
  std::mt19937_64 generator(seed);
  std::vector<Eigen::Index> order(samples.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::shuffle(order, generator);
  const Eigen::Index outliers = std::llround(defects.outlier_ratio * static_cast<double>(samples.size()));
  for (Eigen::Index i = 0; i < outliers; ++i) samples[order[i]].value = any_value(generator);

  if (defects.noise > 0.0) {
    std::normal_distribution<double> normal;
    for (sample& s : samples)
      for (Eigen::Index channel = 0; channel < 3; ++channel)
        s.value[channel] *= 1.0 + defects.noise * normal(generator);
  }
  return samples;
}

/// Returns samples of the table at some cells, with defects; their angles are those of the cells. An outlier has the
/// value of a random cell. Throws as `corrupt` does.
[[nodiscard]] sample_set sample_table(const brdf_table& table, std::span<const Eigen::Index> cells,
                                      const measurement_defects& defects = {}, std::uint64_t seed = 0);

/// Returns `count` random pairs of directions for a material of any symmetry: those of distinct random cells, each
/// turned about the normal to a random azimuth. Throws like `random_cells`.
[[nodiscard]] std::vector<direction_pair> random_pairs(const valid_cells& cells, Eigen::Index count,
                                                       std::uint64_t seed);

/// Returns the values of a BRDF in pairs of directions, with defects. An outlier has the value of another pair. Throws
/// as `corrupt` does.
template <brdf Brdf>
[[nodiscard]] sample_set sample_brdf(const Brdf& f, std::span<const direction_pair> pairs,
                                     const measurement_defects& defects = {}, std::uint64_t seed = 0) {
  sample_set samples;
  samples.reserve(pairs.size());
  for (const direction_pair& pair : pairs) {
    const rgb value = defects.aperture.is_point()
                          ? rgb(f(pair.wi, pair.wo))
                          : mean_within(pair, defects.aperture, measurement_defects::pairs_a_reading, f);
    samples.push_back({pair, value, 1.0, defects.aperture});
  }
  std::uniform_int_distribution<std::size_t> any_pair(0, std::max<std::size_t>(pairs.size(), 1) - 1);
  return corrupt(std::move(samples), defects, seed, [&](std::mt19937_64& generator) {
    const auto& [wi, wo] = pairs[any_pair(generator)];
    return rgb(f(wi, wo));
  });
}

struct sample_split {
  sample_set some, others;
};

/// Splits off `count` random samples; both parts keep their order. Throws gonio::error if there are fewer than `count`
/// samples.
[[nodiscard]] sample_split split_samples(const sample_set& samples, Eigen::Index count, std::uint64_t seed);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/evaluate/impl/simulated_measurement.ipp>
#endif
