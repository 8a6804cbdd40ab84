#pragma once
/// A simulated camera that photographs a radiance image: exposure brackets and dark frames.

#include "dark_room.hpp"
#include <gonio/capture/dark_signal.hpp>
#include <gonio/capture/high_dynamic_range.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/table/image.hpp>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>
#include <span>
#include <vector>

namespace lab {

/// The sensor and its defects. By default no light is lost and there is no dark signal.
struct photograph_settings {
  sensor chip = {};             ///< `saturating` is for a radiance of 1 / pi
  double pedestal = 0.0;        ///< counts added after the response
  double dark_current = 0.0;    ///< mean over the pixels, electrons per second
  double dark_spread = 0.3;     ///< relative standard deviation of the current between pixels
  double hot_pixels = 0.0;      ///< fraction of the pixels
  double hot_current = 0.0;     ///< electrons per second of a hot pixel
  double vignetting = 0.0;      ///< fraction of the light that is lost in the image's corners
  double flicker = 0.0;         ///< relative standard deviation of each exposure, common to its pixels
  std::uint64_t chip_seed = 1;  ///< seed of the dark currents and of the positions of hot pixels

  /// A 12-bit camera on a tripod.
  [[nodiscard]] static photograph_settings usual(response_curve curve = response_curve::linear) {
    return {.chip = sensor::usual(curve),
            .pedestal = 64.0,
            .dark_current = 20.0,
            .hot_pixels = 2e-4,
            .hot_current = 5000.0,
            .vignetting = 0.2,
            .flicker = 0.001};
  }
};

/// Returns the radiance that reaches the sensor.
[[nodiscard]] inline gonio::image through_lens(gonio::image radiance, const photograph_settings& settings) {
  const std::size_t rows = radiance.shape(0), columns = radiance.shape(1);
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const double x = (2.0 * static_cast<double>(column) + 1.0) / static_cast<double>(columns) - 1.0;
      const double y = (2.0 * static_cast<double>(row) + 1.0) / static_cast<double>(rows) - 1.0;
      const double kept = 1.0 - settings.vignetting * (x * x + y * y) / 2.0;
      gonio::set_pixel(radiance, row, column, kept * gonio::pixel(radiance, row, column));
    }
  return radiance;
}

namespace detail {

/// Returns a deterministic hash of two numbers, in [0, 1) (S. Vigna's splitmix64).
[[nodiscard]] inline double hashed(std::uint64_t seed, std::uint64_t number) {
  std::uint64_t bits = seed * 0xD1342543DE82EF95u + (number + 1) * 0x9E3779B97F4A7C15u;
  bits = (bits ^ bits >> 30) * 0xBF58476D1CE4E5B9u;
  bits = (bits ^ bits >> 27) * 0x94D049BB133111EBu;
  return static_cast<double>((bits ^ bits >> 31) >> 11) * 0x1p-53;
}

/// Returns the fixed dark current of a pixel: uniform about the mean, with the given standard deviation.
[[nodiscard]] inline double current_of_pixel(const photograph_settings& settings, std::uint64_t pixel) {
  if (hashed(settings.chip_seed, 2 * pixel) < settings.hot_pixels) return settings.hot_current;
  const double off = std::sqrt(12.0) * (hashed(settings.chip_seed, 2 * pixel + 1) - 0.5);
  return settings.dark_current * std::max(1.0 + settings.dark_spread * off, 0.0);
}

/// Returns the sensor's count for an expected number of electrons.
[[nodiscard]] inline std::uint16_t count_of(double electrons, const photograph_settings& settings,
                                            std::mt19937_64& generator) {
  const sensor& chip = settings.chip;
  const bool is_noisy = std::isfinite(chip.full_well);
  double counted = electrons;
  if (is_noisy) {
    // A Poisson distribution is nearly normal from some hundred electrons on.
    constexpr double many = 500.0;
    std::normal_distribution<double> normal;
    if (electrons < many)
      counted = static_cast<double>(std::poisson_distribution<int>(electrons)(generator));
    else
      counted = electrons + std::sqrt(electrons) * normal(generator);
    counted += chip.read_noise * normal(generator);
  }
  const double share = is_noisy ? counted / chip.full_well : counted;
  const double curved = share < 0.0 && chip.curve == response_curve::linear ? share : count_share(chip.curve, share);
  const double exact = settings.pedestal + (chip.largest_count - settings.pedestal) * curved;
  return static_cast<std::uint16_t>(std::lround(std::clamp<double>(exact, 0.0, chip.largest_count)));
}

}  // namespace detail

/// Returns one photograph of the radiance that reaches the sensor. The result does not depend on the number of threads.
[[nodiscard]] inline gonio::stored_codes photograph(const gonio::image& radiance, double seconds,
                                                    const photograph_settings& settings, std::uint64_t seed) {
  const std::size_t rows = radiance.shape(0), columns = radiance.shape(1);
  gonio::stored_codes codes{rows, columns, settings.chip.largest_count, {}};
  codes.values.resize(3 * rows * columns);
  std::seed_seq of_frame{seed};
  std::mt19937_64 frame_generator(of_frame);
  const double flicker = 1.0 + settings.flicker * std::normal_distribution<double>()(frame_generator);
  const double well = std::isfinite(settings.chip.full_well) ? settings.chip.full_well : 1.0;
  const double of_radiance = std::numbers::pi * seconds * flicker / settings.chip.saturating * well;
  gonio::for_each_index(static_cast<Eigen::Index>(rows), 8, [&](Eigen::Index row) {
    std::seed_seq of_row{seed, static_cast<std::uint64_t>(row) + 1};
    std::mt19937_64 generator(of_row);
    for (std::size_t column = 0; column < columns; ++column) {
      const std::size_t pixel = row * columns + column;
      const double dark = detail::current_of_pixel(settings, pixel) * seconds;
      for (std::size_t i = 3 * pixel; i < 3 * pixel + 3; ++i)
        codes.values[i] = detail::count_of(std::max(0.0, of_radiance * radiance.data()[i]) + dark, settings, generator);
    }
  });
  return codes;
}

/// Returns a bracket: a photograph for each exposure time.
[[nodiscard]] inline std::vector<gonio::capture::exposed_frame> photograph_bracket(const gonio::image& radiance,
                                                                                   std::span<const double> times,
                                                                                   const photograph_settings& settings,
                                                                                   std::uint64_t seed) {
  const gonio::image seen = through_lens(radiance, settings);
  std::vector<gonio::capture::exposed_frame> frames;
  for (const double seconds : times)
    frames.push_back({seconds, photograph(seen, seconds, settings, 1000 * seed + frames.size())});
  return frames;
}

/// Returns dark frames: `each` of them for each exposure time.
[[nodiscard]] inline std::vector<gonio::capture::exposed_frame> photograph_dark(std::size_t rows, std::size_t columns,
                                                                                std::span<const double> times, int each,
                                                                                const photograph_settings& settings,
                                                                                std::uint64_t seed) {
  std::vector<double> all;
  for (const double seconds : times) all.insert(all.end(), each, seconds);
  return photograph_bracket(gonio::uniform_image(rows, columns), all, settings, seed + (std::uint64_t{1} << 40));
}

/// Returns the value that `merge_frames` gives for a radiance of 1. In the unit of merged values, 1 is the radiance
/// that gives the middle count in 1 second.
[[nodiscard]] inline double merged_unit(const photograph_settings& settings) {
  double low = 0.0, high = 1.0;
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double middle = 0.5 * (low + high);
    (count_share(settings.chip.curve, middle) < 0.5 ? low : high) = middle;
  }
  return std::numbers::pi / (settings.chip.saturating * high);
}

/// Returns the camera's noise for merging, in counts of a linear camera.
[[nodiscard]] inline gonio::capture::sensor_noise noise_of(const photograph_settings& settings) {
  const double counts = settings.chip.largest_count - settings.pedestal;
  if (!std::isfinite(settings.chip.full_well)) return {.read = 0.0, .shot = 0.0, .relative = settings.flicker};
  return {.read = settings.chip.read_noise * counts / settings.chip.full_well,
          .shot = counts / settings.chip.full_well,
          .relative = settings.flicker};
}

}  // namespace lab
