#pragma once
/// A smooth random function for the part of a material that a prior's components cannot express. Such a model
/// discrepancy is a Gaussian process: Kennedy and O'Hagan, "Bayesian calibration of computer models", Journal of the
/// Royal Statistical Society B 63(3), 2001 (doi:10.1111/1467-9868.00294). The basis functions around the measured
/// locations are those of Rasmussen and Williams, "Gaussian Processes for Machine Learning", 2006, section 8.3.1.
/// Results on real materials: docs/results/real-materials.md.

#include <gonio/basis/basis.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/row_source.hpp>
#include <gonio/table/upsample.hpp>

#include <Eigen/Core>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

/// Returns how far Fresnel's reflectance has risen at theta_d, in the logarithm: 0 at normal incidence, .17 at 60
/// degrees, .72 at 80, and 1 at 90. By `fresnel_schlick` with f0 = .04.
[[nodiscard]] double fresnel_rise(double theta_d) noexcept;

/// The correlation lengths of a discrepancy: the standard deviations of its squared-exponential covariance in the
/// coordinates sqrt(theta_h / 90 degrees), theta_d / 90 degrees + `fresnel_weight` fresnel_rise(theta_d) and sin
/// theta_d (cos 2 phi_d, sin 2 phi_d) / 2.
struct correlation_lengths {
  double theta_h = 0.1;
  double theta_d = 0.2;
  double azimuth = 0.4;
  double fresnel_weight = 0.0;
};

namespace detail {

/// The coordinates of angles in units of the correlation lengths: one of theta_h, then three of theta_d and phi_d.
using discrepancy_coordinates = std::array<double, 4>;
[[nodiscard]] discrepancy_coordinates coordinates_of(const half_difference& angles,
                                                     const correlation_lengths& lengths) noexcept;

}  // namespace detail

/// Returns the covariance k of all pairs of angles, for an amplitude of 1: n x n. Throws gonio::error if an angle is
/// not finite, a length is not positive, or the Fresnel weight is negative. O(n^2).
[[nodiscard]] Eigen::MatrixXd discrepancy_covariance(std::span<const half_difference> angles,
                                                     const correlation_lengths& lengths = {});

/// Returns the covariance k of each of `angles` with one other location, for an amplitude of 1.
[[nodiscard]] Eigen::VectorXd discrepancy_covariance(std::span<const half_difference> angles,
                                                     const half_difference& other,
                                                     const correlation_lengths& lengths = {});

/// Returns the covariance k of each of `angles` (a row) with each of `others` (a column), for an amplitude of 1.
[[nodiscard]] Eigen::MatrixXd discrepancy_covariance(std::span<const half_difference> angles,
                                                     std::span<const half_difference> others,
                                                     const correlation_lengths& lengths);

/// The covariance and the functions of a discrepancy, over any cells and for any metric. A value type; copies share
/// their centres.
///
/// With the covariance k(x, y) = exp(-|x - y|^2 / 2) of locations in units of the correlation lengths, the functions
/// are phi(x) = amplitude^(1/2) L^-1 k(centres, x), L L' = k(centres, centres). Weights of unit variance give a
/// function whose variance is `amplitude` at the centres, and smaller far from all centres.
///
/// The covariances k(centres, x) themselves are a second basis with the same span. They are faster to compute, but
/// their weights are correlated.
class discrepancy_functions {
 public:
  /// Makes the functions phi(x) = amplitude^(1/2) L^-1 k(centres, x). Throws gonio::error if there is no centre, an
  /// angle is not finite, or a length or the amplitude is not positive.
  discrepancy_functions(std::span<const half_difference> centres, double amplitude,
                        const correlation_lengths& lengths = {});

  /// Makes the functions k(centres, x) instead of phi. Throws gonio::error if there is no centre, an angle is not
  /// finite, or a length is not positive.
  [[nodiscard]] static discrepancy_functions covariances(std::span<const half_difference> centres,
                                                         const correlation_lengths& lengths = {});

  [[nodiscard]] Eigen::Index size() const noexcept { return std::ssize(shared_->coordinates); }

  /// Writes the values of all functions at one location: size() contiguous numbers. O(size^2) for phi, O(size) for k.
  void read(const half_difference& angles, double* out) const noexcept;

  /// Writes the values of all functions at many locations, into a row of `out` for each. For phi, this is twenty times
  /// as fast as a call for each location.
  void read(std::span<const half_difference> angles, row_block out) const;

  /// Converts weights of phi to weights of k, column by column.
  [[nodiscard]] Eigen::MatrixXd covariance_weights(const Eigen::MatrixXd& weights) const;

  /// Returns the combination of the functions with the weights of three channels (size() x 3), at all cells of a grid.
  /// O(size x (cells + size)): the covariance is a function of theta_h times a function of the other two angles.
  [[nodiscard]] cell_fields<3> combination(const Eigen::MatrixXd& weights, const valid_cells& cells,
                                           thread_count threads = {}) const;

 private:
  struct stored {
    std::vector<detail::discrepancy_coordinates> coordinates;  ///< of the centres
    correlation_lengths lengths;
    double amplitude = 1.0;
    std::optional<cholesky> factors;  ///< L of phi; absent for k
  };

  explicit discrepancy_functions(stored parts) : shared_(std::make_shared<const stored>(std::move(parts))) {}

  std::shared_ptr<const stored> shared_;
};

/// A discrepancy as a computed basis, around centres, over some cells, in the domain of a metric. Combine it with
/// components as `joined{prior, discrepancy{prior.cells(), prior.metric(), functions}}`. estimate/reconstruction.hpp
/// has an estimator with chosen parameters.
template <error_metric Metric>
class discrepancy {
 public:
  /// The sign of a function is arbitrary: see `has_arbitrary_sign`.
  static constexpr bool arbitrary_sign = true;

  discrepancy(valid_cells cells, Metric metric, discrepancy_functions functions)
      : cells_(std::move(cells)), metric_(std::move(metric)), functions_(std::move(functions)) {}

  [[nodiscard]] Eigen::Index size() const noexcept { return functions_.size(); }
  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] const Metric& metric() const noexcept { return metric_; }
  [[nodiscard]] double offset(Eigen::Index /*cell*/) const noexcept { return 0.0; }
  [[nodiscard]] const discrepancy_functions& functions() const noexcept { return functions_; }

  void read_row(const location& at, function_row out) const noexcept { functions_.read(at.angles, out.data()); }

  void read_rows(std::span<const location> at, row_block out) const {
    std::vector<half_difference> angles;
    for (const location& each : at) angles.push_back(each.angles);
    functions_.read(angles, out);
  }

  [[nodiscard]] cell_fields<3> combination(const Eigen::MatrixXd& weights, thread_count threads = {}) const {
    return functions_.combination(weights, cells_, threads);
  }

 private:
  valid_cells cells_;
  Metric metric_;
  discrepancy_functions functions_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/discrepancy.ipp>
#endif
