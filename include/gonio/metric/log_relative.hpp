#pragma once
/// The log-relative metric: the logarithm of a cosine-weighted reflectance relative to a reference's. Nielsen, Jensen
/// and Ramamoorthi, "On Optimal, Minimal BRDF Sampling for Reflectance Acquisition", SIGGRAPH Asia 2015
/// (doi:10.1145/2816795.2818085), Eq. 1-4. Weighting by the larger cosine: Xu et al. 2016
/// (doi:10.1145/2980179.2982396), section 3.

#include <gonio/core/vector_kernels.hpp>
#include <gonio/metric/error_metric.hpp>
#include <gonio/table/cell_matrix.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <vector>

namespace gonio {

/// The cosines that weight a reflectance in `log_relative`. Two papers differ: docs/reference/estimators.md.
enum class cosine_weighting {
  product,  ///< cos theta_i cos theta_o: Nielsen et al. 2015, Eq. 2
  larger,   ///< the larger of the two cosines: Xu, Nielsen, Yu, Jensen and Ramamoorthi 2016, section 3
};

/// forward(rho) = ln((rho c + epsilon) / (rho_ref c + epsilon)) with the cosine weight
/// c = max(cos theta_i cos theta_o, epsilon) of the location (Eq. 1-2), or max(cos theta_i, cos theta_o, epsilon).
///
/// Negative reflectance counts as zero in `forward`, whose smallest value is ln(epsilon / (rho_ref c + epsilon)).
/// `inverse` of a smaller value is negative, down to -epsilon / c: clamp it at zero for a BRDF. Between cells the
/// logarithm of the reference is interpolated, and c is exact.
class log_relative {
 public:
  /// Avoids division by zero and bounds the influence of camera noise. The value is that of Nielsen et al. 2015.
  static constexpr double epsilon = 0.001;

  /// `reference` has one value in sr^-1 for each cell. Throws gonio::error if there are more or fewer values than
  /// cells, or if a value is negative or not finite.
  log_relative(valid_cells cells, std::vector<float> reference, cosine_weighting weighting = cosine_weighting::product);

  /// Returns the metric relative to the median of all columns at each cell (Eq. 3). Takes a material_set or any other
  /// set of observations with `cells` and `values`. O(cells x columns).
  template <class Materials>
  [[nodiscard]] static log_relative to_median_of(const Materials& materials, thread_count threads = {}) {
    return to_median_of(materials.cells, materials.values, threads);
  }

  /// Returns the metric relative to the median of each row of a matrix, which has a row for each cell.
  [[nodiscard]] static log_relative to_median_of(const valid_cells& cells, const cell_matrix& values,
                                                 thread_count threads = {});

  /// Returns the metric with another cosine weight. The reference stays, because it does not depend on the weight.
  [[nodiscard]] log_relative weighted_by(cosine_weighting weighting) const {
    log_relative other = *this;
    other.weighting_ = weighting;
    return other;
  }
  [[nodiscard]] cosine_weighting weighting() const noexcept { return weighting_; }

  /// Returns the cosine weight c.
  [[nodiscard]] double cosine_weight(const cosine_pair& cosine) const noexcept {
    return std::max(weighting_ == cosine_weighting::product ? product_of(cosine) : larger_of(cosine), epsilon);
  }

  [[nodiscard]] static double forward(double rho, double reference, double cosine_weight) noexcept {
    return std::log((std::max(rho, 0.0) * cosine_weight + epsilon) / (reference * cosine_weight + epsilon));
  }
  [[nodiscard]] static double inverse(double y, double reference, double cosine_weight) noexcept {
    return (std::exp(y) * (reference * cosine_weight + epsilon) - epsilon) / cosine_weight;
  }

  [[nodiscard]] double forward(double rho, Eigen::Index cell) const noexcept {
    return forward(rho, (*reference_)[cell], cosine_weight(cosines(cells_.angles(cell))));
  }
  [[nodiscard]] double inverse(double y, Eigen::Index cell) const noexcept {
    return inverse(y, (*reference_)[cell], cosine_weight(cosines(cells_.angles(cell))));
  }
  [[nodiscard]] double forward(double rho, const location& at) const noexcept {
    return forward(rho, reference(at), cosine_weight(at.cosine));
  }
  [[nodiscard]] double inverse(double y, const location& at) const noexcept {
    return inverse(y, reference(at), cosine_weight(at.cosine));
  }

  /// Returns the same metric over other cells. Interpolates its reference.
  [[nodiscard]] log_relative on(const valid_cells& cells) const;

  /// The logarithm of the reference is interpolated with the channels. See `row_metric`.
  static constexpr int companions = 1;
  static constexpr weighted_mean mean = weighted_mean::geometric;
  [[nodiscard]] std::array<float, 1> companion(Eigen::Index cell) const noexcept { return {(*log_reference_)[cell]}; }
  template <class Values>
  void inverse_row(const cell_row& row, const Values& exponentials, std::span<float> out) const {
    constexpr Eigen::Index at_once = shifts_at_once;
    for (Eigen::Index begin = 0; begin < row.count; begin += at_once) {
      const Eigen::Index count = std::min(at_once, row.count - begin);
      std::array<float, at_once> shift;
      compute_shifts(row, begin, {shift.data(), static_cast<std::size_t>(count)});
      const float* relative = exponentials.data() + 4 * begin;
      float* cell = out.data() + 3 * begin;
      const auto value_at = [&](Eigen::Index i) -> Eigen::Array4f {
        const Eigen::Array4f these = Eigen::Map<const Eigen::Array4f>(relative + 4 * i);
        return (these * (these[3] + shift[i]) - shift[i]).max(0.0f);
      };
      // Write vectors of four, whose last number the next cell overwrites.
      for (Eigen::Index i = 0; i + 1 < count; ++i) Eigen::Map<Eigen::Array4f>{cell + 3 * i} = value_at(i);
      const Eigen::Array4f last = value_at(count - 1);
      std::copy_n(last.data(), 3, cell + 3 * (count - 1));
    }
  }

  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] std::span<const float> reference() const noexcept { return *reference_; }

  /// Returns the reference BRDF at a location, in sr^-1.
  [[nodiscard]] double reference(const location& at) const noexcept {
    if (at.count == 1) return (*reference_)[at.cell[0]];
    const auto value = [&](Eigen::Index cell) { return log_reference((*reference_)[cell]); };
    return std::exp(interpolate(at, value, 0.0));
  }

  /// Returns the logarithm in which the reference is interpolated. Zeros are replaced by a value far below epsilon.
  [[nodiscard]] static double log_reference(double reference) noexcept { return std::log(std::max(reference, 1e-8)); }

 private:
  static constexpr Eigen::Index shifts_at_once = 64;
  /// Computes epsilon / c, with the cosine weight c, for at most `shifts_at_once` cells of a row from `begin` on.
  void compute_shifts(const cell_row& row, Eigen::Index begin, std::span<float> shift) const;

  [[nodiscard]] static double product_of(const cosine_pair& cosine) noexcept { return cosine.i * cosine.o; }
  [[nodiscard]] static double larger_of(const cosine_pair& cosine) noexcept { return std::max(cosine.i, cosine.o); }

  valid_cells cells_;
  std::shared_ptr<const std::vector<float>> reference_, log_reference_;
  cosine_weighting weighting_;
};

static_assert(row_metric<log_relative>);

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/metric/impl/log_relative.ipp>
#endif
