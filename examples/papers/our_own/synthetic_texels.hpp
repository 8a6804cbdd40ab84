#pragma once
/// A flat sample of measured materials that blend smoothly into one another, as registered images.

#include <gonio/core/direction.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/model/adaptive_brdf.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <random>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace papers {

class synthetic_texels {
 public:
  /// `size` x `size` texels. `values` holds for each material a matrix of 3 x directions, sr^-1.
  synthetic_texels(Eigen::Index size, std::vector<Eigen::MatrixXd> values, double noise, std::uint64_t seed)
      : size_(size), values_(std::move(values)), noise_(noise), seed_(seed) {
    std::mt19937_64 generator(seed);
    std::uniform_real_distribution<double> phase(0.0, 2.0 * std::numbers::pi), frequency(-3.0, 3.0);
    for (std::size_t m = 0; m < values_.size(); ++m)
      waves_.push_back({frequency(generator), frequency(generator), phase(generator)});
  }

  /// Returns the share of each material in a texel. The shares sum to 1; one material dominates most texels.
  [[nodiscard]] Eigen::VectorXd shares(Eigen::Index row, Eigen::Index column) const {
    Eigen::VectorXd found(waves_.size());
    for (Eigen::Index m = 0; m < found.size(); ++m) {
      const wave& own = waves_[static_cast<std::size_t>(m)];
      const auto at = [&](Eigen::Index i) { return static_cast<double>(i) / static_cast<double>(size_); };
      const double angle = 2.0 * std::numbers::pi * (own.down * at(row) + own.across * at(column)) + own.phase;
      found[m] = std::exp(4.0 * std::sin(angle));
    }
    return found / found.sum();
  }

  /// Writes the image of one direction pair (.npy), row by row. The noise is relative to the value.
  void write(const std::filesystem::path& path, Eigen::Index direction) const {
    const auto extent = static_cast<std::size_t>(size_);
    const std::string header =
        gonio::io::npy_header("<f4", gonio::io::npy_shape_text(std::vector<std::size_t>{extent, extent, 3}));
    gonio::io::write_atomically(path, [&](gonio::io::file_writer& file) {
      file.write(std::as_bytes(std::span(header)));
      std::mt19937_64 generator(seed_ * 1000 + static_cast<std::uint64_t>(direction));
      std::normal_distribution<float> error;
      std::vector<float> pixels(3 * extent);
      for (Eigen::Index row = 0; row < size_; ++row) {
        for (Eigen::Index column = 0; column < size_; ++column) {
          const Eigen::VectorXd share = shares(row, column);
          Eigen::Vector3d value = Eigen::Vector3d::Zero();
          for (Eigen::Index m = 0; m < share.size(); ++m)
            value += share[m] * values_[static_cast<std::size_t>(m)].col(direction);
          for (Eigen::Index c = 0; c < 3; ++c)
            pixels[static_cast<std::size_t>(3 * column + c)] =
                static_cast<float>(value[c]) * (1.0f + static_cast<float>(noise_) * error(generator));
        }
        file.write(std::as_bytes(std::span(pixels)));
      }
    });
  }

 private:
  struct wave {
    double down, across, phase;
  };

  Eigen::Index size_;
  std::vector<Eigen::MatrixXd> values_;
  double noise_;
  std::uint64_t seed_;
  std::vector<wave> waves_;
};

}  // namespace papers
