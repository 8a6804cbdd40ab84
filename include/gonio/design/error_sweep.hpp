#pragma once
/// The inner loop of a search that tries every cell as one more measurement. Computes the expected error (Xu et al.
/// 2016, doi:10.1145/2980179.2982396, Eq. 15) for eight candidates at a time.

#include <gonio/design/expected_error.hpp>

#include <Eigen/Core>

#include <span>
#include <vector>

namespace gonio::design {

/// Computes `extended_error` for many candidates in single precision. 10 n m operations for each candidate, with n
/// measurements and m observations. Only the candidate's own rows of Y and W are read from memory.
class error_sweep {
 public:
  static constexpr Eigen::Index width = 8;
  /// One number for each of eight candidates.
  using lanes = Eigen::Array<float, width, 1>;
  /// Tiles of eight candidates, side by side. A tile has a column for each observation, with eight numbers of Y above
  /// eight numbers of W, and then columns of zeros up to `columns(m)`.
  using tiles = Eigen::Array<float, 2 * width, Eigen::Dynamic>;

  /// The number of columns of a tile, given the number of observations.
  [[nodiscard]] static constexpr Eigen::Index columns(Eigen::Index observations) noexcept {
    return (observations + observations_together - 1) / observations_together * observations_together;
  }

  error_sweep(const expected_error& criterion, const expected_error::rows& measured);

  /// Writes, for each candidate of `errors.size()` tiles, E of the measurements and this candidate.
  /// `sample_noise_penalties` has the candidates' own penalties. The first tile begins at column `first` of
  /// `candidates`.
  void operator()(const tiles& candidates, Eigen::Index first, std::span<const lanes> sample_noise_penalties,
                  std::span<lanes> errors) const;

 private:
  static constexpr Eigen::Index measurements_together = 4, observations_together = 4;

  /// Intermediate values for the candidates of a tile.
  struct found {
    std::vector<lanes> on_y, on_w;   ///< Y y and Y (w - W'a), one element per measurement
    std::vector<lanes> once, twice;  ///< a = K^-1 Y y and b = K^-1 Y (w - W'a)
    tiles left;                      ///< t = y - Y'a above u = w - W'a - Y'b
    lanes d, r;                      ///< d = eta + the candidate's own penalty + y . t and r = y . u
  };

  void project(const float* tile, found& of) const;
  void take_away(const float* tile, found& of) const;
  [[nodiscard]] lanes own_growth(const found& of, const lanes& sample_noise_penalty) const;
  [[nodiscard]] lanes mean(const found& of, const lanes& grown) const;
  template <class Channels>
  [[nodiscard]] lanes mean_of_excluded(Channels channels, const found& of, const lanes& own) const;
  [[nodiscard]] lanes shift(const float* tile, const found& of) const;

  Eigen::Index measurements_, observations_;
  float eta_, common_shift_;
  /// Y in groups of four measurements, side by side. In each group an observation is a column.
  Eigen::Array<float, measurements_together, Eigen::Dynamic> by_measurement_;
  /// Y above W in groups of four observations, side by side. In each group a measurement is a column.
  Eigen::Array<float, 2 * observations_together, Eigen::Dynamic> by_observation_;
  Eigen::MatrixXf inverse_, cross_;  ///< K^-1 and W Y'
  Eigen::ArrayXf squared_errors_;
  Eigen::Index channels_;
  Eigen::MatrixXf inverse_unknown_, missed_;  ///< from `remainder`; empty unless materials are left out
  Eigen::ArrayXf own_variances_;
  Eigen::ArrayXf noise_response_, weighted_response_;  ///< the second is W times the first
  float noise_energy_, own_energy_;
};

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/error_sweep.ipp>
#endif
