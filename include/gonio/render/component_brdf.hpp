#pragma once
/// Reconstructed BRDFs that are evaluated from their weights when they are asked: many materials that share their
/// principal components need a few hundred bytes each. J. B. Nielsen, H. W. Jensen and R. Ramamoorthi, "On Optimal,
/// Minimal BRDF Sampling for Reflectance Acquisition", SIGGRAPH Asia 2015 (doi:10.1145/2816795.2818085), Eq. 1-4 (the
/// log-relative mapping) and 10 (the reconstruction Q c + mu).

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

/// What components can be taken from: a basis of principal components relative to a reference, as
/// `gonio::log_relative_pca` is one.
template <class Basis>
concept log_relative_components = requires(const Basis& basis, Eigen::Index cell) {
  { basis.cells().grid() } -> std::convertible_to<grid>;
  { basis.size() } -> std::convertible_to<Eigen::Index>;
  { basis.row(cell)[cell] } -> std::convertible_to<double>;
  { basis.offset(cell) } -> std::convertible_to<double>;
  { basis.metric().reference()[cell] } -> std::convertible_to<double>;
  { basis.metric().epsilon } -> std::convertible_to<double>;
};

/// Principal components Q of log-relative BRDFs, their mean mu and the logarithm of the reference, at the cells of a
/// grid: what materials share. Read by any number of threads.
template <stored_number Stored = float>
class shared_components {
 public:
  /// The first `count` components of a basis, or all. Throws gonio::error if it has fewer. O(cells x components).
  template <log_relative_components Basis>
  explicit shared_components(const Basis& basis, std::optional<Eigen::Index> count = {})
      : index_(basis.cells().grid()),
        size_(count ? *count : basis.size()),
        epsilon_(static_cast<float>(basis.metric().epsilon)) {
    if (size_ < 1 || size_ > basis.size())
      refuse("cannot take " + std::to_string(size_) + " of " + std::to_string(basis.size()) + " components");
    values_.resize(index_.size() * stride());
    const auto [heights, rows, columns] = grid().extents();
    for (int h = 0; h < heights; ++h)
      for (int d = 0; d < rows; ++d)
        for (int p = 0; p < columns; ++p) {
          const Eigen::Index number = index_(h, d, p);
          const Eigen::Index cell = basis.cells().representative(grid().linear(cell_index{h, d, p}));
          Stored* const row = values_.data() + number * stride();
          // Zeros are far below epsilon and are floored, as in `log_relative`.
          const double reference = static_cast<double>(basis.metric().reference()[cell]);
          row[0] = static_cast<Stored>(static_cast<float>(std::log(std::max(reference, 1e-8))));
          row[1] = static_cast<Stored>(static_cast<float>(basis.offset(cell)));
          for (Eigen::Index k = 0; k < size_; ++k)
            row[2 + k] = static_cast<Stored>(static_cast<float>(basis.row(cell)[k]));
        }
  }

  /// The number of components.
  [[nodiscard]] Eigen::Index size() const noexcept { return size_; }
  [[nodiscard]] const gonio::grid& grid() const noexcept { return index_.grid(); }
  [[nodiscard]] const horizon_index& index() const noexcept { return index_; }
  [[nodiscard]] float epsilon() const noexcept { return epsilon_; }

  /// Of a cell: the logarithm of the reference, mu, and `size()` components.
  [[nodiscard]] const Stored* row(Eigen::Index number) const noexcept { return values_.data() + number * stride(); }

  /// In bytes.
  [[nodiscard]] Eigen::Index memory() const noexcept { return values_.size() * sizeof(Stored) + index_.memory(); }

 private:
  [[nodiscard]] Eigen::Index stride() const noexcept { return size_ + 2; }

  horizon_index index_;
  Eigen::Index size_;
  float epsilon_;
  std::vector<Stored> values_;
};

/// A BRDF of k weights for each channel. Evaluation costs a row of k + 2 numbers, or eight for trilinear look-up, and
/// three exponentials; it does not allocate, lock or throw. A view of the components, which must outlive it.
/// ```cpp
/// const gonio::render::shared_components<Eigen::half> components(prior);
/// const gonio::render::component_brdf paint(components, fit.weights());
/// ```
/// Black where `lookup_table` is. Both directions must be of unit length, because the mapping depends on their cosines.
template <stored_number Stored = float, interpolation Interpolation = interpolation::trilinear>
class component_brdf {
 public:
  /// `weights` is k x 3, a column for each channel. Throws gonio::error if it is not or one is not finite.
  explicit component_brdf(const shared_components<Stored>& components, const Eigen::Ref<const Eigen::MatrixXd>& weights)
      : components_(&components), weights_(weights.size(), 0.0f) {
    if (weights.rows() != components.size() || weights.cols() != 3 || !weights.allFinite())
      refuse("a BRDF of " + std::to_string(components.size()) +
             " components needs as many finite weights for each of " + "3 channels, not " +
             std::to_string(weights.rows()) + " x " + std::to_string(weights.cols()));
    // The three weights of a component beside each other.
    for (Eigen::Index k = 0; k < weights.rows(); ++k)
      for (Eigen::Index c = 0; c < 3; ++c) weights_[3 * k + c] = static_cast<float>(weights(k, c));
  }

  /// Reflectance in sr^-1 of a pair, `float` or `double`.
  template <std::floating_point Real>
  [[nodiscard]] Eigen::Array<Real, 3, 1> operator()(const Eigen::Matrix<Real, 3, 1>& wi,
                                                    const Eigen::Matrix<Real, 3, 1>& wo) const noexcept {
    const Real ix = wi[0], iy = wi[1], iz = wi[2], ox = wo[0], oy = wo[1], oz = wo[2];
    if (!is_above_horizon(ix, iy, iz, ox, oy, oz)) return Eigen::Array<Real, 3, 1>::Zero();
    const auto place = to_grid_coordinates(ix, iy, iz, ox, oy, oz);
    const Real weight = std::max(iz * oz, static_cast<Real>(components_->epsilon()));  // Eq. 2
    if constexpr (Interpolation == interpolation::nearest) {
      return reflectance(mapped<Real>(components_->index().nearest(place)), weight);
    } else {
      const trilinear_corners<Real> corners = components_->index().around(place);
      Eigen::Array<Real, 4, 1> sum = Eigen::Array<Real, 4, 1>::Zero();
      for (Eigen::Index k = 0; k < 8; ++k) sum += corners.weight[k] * mapped<Real>(corners.number[k]);
      return reflectance(sum, weight);
    }
  }

  [[nodiscard]] const shared_components<Stored>& components() const noexcept { return *components_; }

  /// In bytes, without the components that are shared.
  [[nodiscard]] Eigen::Index memory() const noexcept { return sizeof(*this) + weights_.size() * sizeof(float); }

 private:
  /// Q c + mu of the three channels, and the logarithm of the reference.
  template <std::floating_point Real>
  [[nodiscard]] Eigen::Array<Real, 4, 1> mapped(Eigen::Index number) const noexcept {
    const Stored* const row = components_->row(number);
    const auto mean = static_cast<float>(row[1]);
    std::array<float, 3> sum{mean, mean, mean};
    for (Eigen::Index k = 0; k < components_->size(); ++k) {
      const auto value = static_cast<float>(row[2 + k]);
      for (Eigen::Index c = 0; c < 3; ++c) sum[c] += weights_[3 * k + c] * value;
    }
    return {sum[0], sum[1], sum[2], static_cast<Real>(static_cast<float>(row[0]))};
  }

  /// The inverse of the mapping, at least zero.
  template <std::floating_point Real>
  [[nodiscard]] Eigen::Array<Real, 3, 1> reflectance(const Eigen::Array<Real, 4, 1>& mapped,
                                                     Real weight) const noexcept {
    const auto small = static_cast<Real>(components_->epsilon());
    const Eigen::Array<Real, 4, 1> powers = mapped.exp();
    return ((powers.template head<3>() * (powers[3] * weight + small) - small) / weight).max(Real(0));
  }

  const shared_components<Stored>* components_;
  std::vector<float> weights_;
};

static_assert(brdf<component_brdf<>>);

}  // namespace gonio::render
