#pragma once
/// Reconstructed BRDFs that are evaluated from their weights on demand. Many materials that share principal components
/// need only a few hundred bytes each. J. B. Nielsen, H. W. Jensen and R. Ramamoorthi, "On Optimal, Minimal BRDF
/// Sampling for Reflectance Acquisition", SIGGRAPH Asia 2015 (doi:10.1145/2816795.2818085), Eq. 1-4 (the log-relative
/// mapping) and 10 (the reconstruction Q c + mu).

#include <gonio/core/assertion.hpp>
#include <gonio/core/brdf.hpp>
#include <gonio/render/grid_coordinates.hpp>
#include <gonio/render/horizon_index.hpp>
#include <gonio/render/lookup_table.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <optional>
#include <string>
#include <vector>

namespace gonio::render {

/// A source of components: a basis of principal components relative to a reference, such as `gonio::log_relative_pca`.
template <class Basis>
concept log_relative_components = requires(const Basis& basis, Eigen::Index cell) {
  { basis.cells().grid() } -> std::convertible_to<grid>;
  { basis.size() } -> std::convertible_to<Eigen::Index>;
  { basis.row(cell)[cell] } -> std::convertible_to<double>;
  { basis.offset(cell) } -> std::convertible_to<double>;
  { basis.metric().reference()[cell] } -> std::convertible_to<double>;
  { basis.metric().epsilon } -> std::convertible_to<double>;
};

/// The data that materials share: principal components Q of log-relative BRDFs, their mean mu and the logarithm of the
/// reference, at the cells of a grid. Any number of threads may read it.
template <stored_number Stored = float>
class shared_components {
 public:
  /// Takes the first `count` components of a basis, or all. Throws gonio::error if it has fewer. O(cells x components).
  template <log_relative_components Basis>
  explicit shared_components(const Basis& basis, std::optional<Eigen::Index> count = {})
      : index_(basis.cells().grid()),
        size_(count ? *count : basis.size()),
        epsilon_(static_cast<float>(basis.metric().epsilon)) {
    if (size_ < 1 || size_ > basis.size())
      refuse("cannot take " + std::to_string(size_) + " of " + std::to_string(basis.size()) + " components");
    read(basis, [&](Eigen::Index cell, Stored* out) {
      for (Eigen::Index k = 0; k < size_; ++k) out[k] = static_cast<Stored>(static_cast<float>(basis.row(cell)[k]));
    });
  }

  /// Takes r functions that are combinations of a basis' k components, as for a spatially varying BRDF map
  /// (`io::svbrdf_header`). `combinations` is k x r: a column of weights for each function. Throws gonio::error unless
  /// there are k rows. O(cells k r).
  template <log_relative_components Basis>
  shared_components(const Basis& basis, const Eigen::Ref<const Eigen::MatrixXf>& combinations)
      : index_(basis.cells().grid()), size_(combinations.cols()), epsilon_(static_cast<float>(basis.metric().epsilon)) {
    if (combinations.rows() != basis.size() || size_ < 1)
      refuse("the combinations have " + std::to_string(combinations.rows()) + " rows, expected one for each of the " +
             std::to_string(basis.size()) + " components");
    read(basis, [&](Eigen::Index cell, Stored* out) {
      for (Eigen::Index r = 0; r < size_; ++r) {
        double sum = 0.0;
        for (Eigen::Index k = 0; k < combinations.rows(); ++k)
          sum += static_cast<double>(combinations(k, r)) * static_cast<double>(basis.row(cell)[k]);
        out[r] = static_cast<Stored>(static_cast<float>(sum));
      }
    });
  }

  /// Returns the number of components.
  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  [[nodiscard]] const gonio::grid& grid() const noexcept { return index_.grid(); }
  [[nodiscard]] const horizon_index& index() const noexcept { return index_; }
  [[nodiscard]] float epsilon() const noexcept { return epsilon_; }

  /// Returns the row of a cell: the logarithm of the reference, mu, and `size()` components.
  [[nodiscard]] const Stored* row(Eigen::Index number) const noexcept { return values_.data() + number * stride(); }

  /// Returns the memory in bytes.
  [[nodiscard]] Eigen::Index memory() const noexcept { return values_.size() * sizeof(Stored) + index_.memory(); }

 private:
  [[nodiscard]] Eigen::Index stride() const noexcept { return size_ + 2; }

  /// Fills all cells. `read_row(cell, out)` writes the `size()` components of a cell.
  template <class Basis, class ReadRow>
  void read(const Basis& basis, const ReadRow& read_row) {
    values_.resize(index_.size() * stride());
    const auto [heights, rows, columns] = grid().extents();
    for (int h = 0; h < heights; ++h)
      for (int d = 0; d < rows; ++d)
        for (int p = 0; p < columns; ++p) {
          const Eigen::Index number = index_(h, d, p);
          const Eigen::Index cell = basis.cells().representative(grid().linear(cell_index{h, d, p}));
          Stored* const row = values_.data() + number * stride();
          // References of zero are far below epsilon and are clamped to a floor, as in `log_relative`.
          const double reference = static_cast<double>(basis.metric().reference()[cell]);
          row[0] = static_cast<Stored>(static_cast<float>(std::log(std::max(reference, 1e-8))));
          row[1] = static_cast<Stored>(static_cast<float>(basis.offset(cell)));
          read_row(cell, row + 2);
        }
  }

  horizon_index index_;
  Eigen::Index size_;
  float epsilon_;
  std::vector<Stored> values_;
};

namespace detail {

/// Returns Q c + mu of the three channels, and the logarithm of the reference. In `weights`, the three weights of a
/// component are adjacent.
template <std::floating_point Real, stored_number Stored>
[[nodiscard]] Eigen::Array<Real, 4, 1> mapped_components(const shared_components<Stored>& components,
                                                         const float* weights, Eigen::Index number) noexcept {
  const Stored* const row = components.row(number);
  const auto mean = static_cast<float>(row[1]);
  std::array<float, 3> sum{mean, mean, mean};
  for (Eigen::Index k = 0; k < components.size(); ++k) {
    const auto value = static_cast<float>(row[2 + k]);
    for (Eigen::Index c = 0; c < 3; ++c) sum[c] += weights[3 * k + c] * value;
  }
  return {sum[0], sum[1], sum[2], static_cast<Real>(static_cast<float>(row[0]))};
}

/// Returns the reflectance for some weights at a pair of unit vectors, at least zero.
template <interpolation Interpolation, stored_number Stored, std::floating_point Real>
[[nodiscard]] Eigen::Array<Real, 3, 1> evaluate_components(const shared_components<Stored>& components,
                                                           const float* weights, const Eigen::Matrix<Real, 3, 1>& wi,
                                                           const Eigen::Matrix<Real, 3, 1>& wo) noexcept {
  const Real ix = wi[0], iy = wi[1], iz = wi[2], ox = wo[0], oy = wo[1], oz = wo[2];
  if (!is_above_horizon(ix, iy, iz, ox, oy, oz)) return Eigen::Array<Real, 3, 1>::Zero();
  const auto coordinates = to_grid_coordinates(ix, iy, iz, ox, oy, oz);
  Eigen::Array<Real, 4, 1> mapped = Eigen::Array<Real, 4, 1>::Zero();
  if constexpr (Interpolation == interpolation::nearest) {
    mapped = mapped_components<Real>(components, weights, components.index().nearest(coordinates));
  } else {
    const trilinear_corners<Real> corners = components.index().around(coordinates);
    for (Eigen::Index k = 0; k < 8; ++k)
      mapped += corners.weight[k] * mapped_components<Real>(components, weights, corners.number[k]);
  }
  // Invert the mapping.
  const auto small = static_cast<Real>(components.epsilon());
  const Real weight = std::max(iz * oz, small);  // Eq. 2
  const Eigen::Array<Real, 4, 1> powers = mapped.exp();
  return ((powers.template head<3>() * (powers[3] * weight + small) - small) / weight).max(Real(0));
}

}  // namespace detail

/// A BRDF with k weights per channel. Evaluation reads one row of k + 2 numbers, or eight for trilinear look-up, and
/// computes three exponentials. It does not allocate, lock or throw. It is a view of the components, which must outlive
/// it.
/// ```cpp
/// const gonio::render::shared_components<Eigen::half> components(prior);
/// const gonio::render::component_brdf paint(components, fit.weights());
/// ```
/// It is black where `lookup_table` is. Both directions must be of unit length, because the mapping depends on their
/// cosines.
template <stored_number Stored = float, interpolation Interpolation = interpolation::trilinear>
class component_brdf {
 public:
  /// `weights` is k x 3, a column for each channel. Throws gonio::error for another size or infinite or NaN weights.
  explicit component_brdf(const shared_components<Stored>& components, const Eigen::Ref<const Eigen::MatrixXd>& weights)
      : components_(&components), weights_(weights.size(), 0.0f) {
    if (weights.rows() != components.size() || weights.cols() != 3 || !weights.allFinite())
      refuse("a BRDF of " + std::to_string(components.size()) +
             " components needs one finite weight per component for each of 3 channels, not " +
             std::to_string(weights.rows()) + " x " + std::to_string(weights.cols()));
    // Store the three weights of a component adjacently.
    for (Eigen::Index k = 0; k < weights.rows(); ++k)
      for (Eigen::Index c = 0; c < 3; ++c) weights_[3 * k + c] = static_cast<float>(weights(k, c));
  }

  /// Returns reflectance in sr^-1 for a pair in `float` or `double`.
  template <std::floating_point Real>
  [[nodiscard]] Eigen::Array<Real, 3, 1> operator()(const Eigen::Matrix<Real, 3, 1>& wi,
                                                    const Eigen::Matrix<Real, 3, 1>& wo) const noexcept {
    return detail::evaluate_components<Interpolation>(*components_, weights_.data(), wi, wo);
  }

  [[nodiscard]] const shared_components<Stored>& components() const noexcept { return *components_; }

  /// Returns the memory in bytes, without the shared components.
  [[nodiscard]] Eigen::Index memory() const noexcept { return sizeof(*this) + weights_.size() * sizeof(float); }

 private:
  const shared_components<Stored>* components_;
  std::vector<float> weights_;
};

static_assert(brdf<component_brdf<>>);

}  // namespace gonio::render
