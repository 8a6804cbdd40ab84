#pragma once
/// Radial basis functions, with which Noell, Koehler and Stricker 2014, section 3.1, compare their estimator. 758
/// centres are spread over a radial re-parametrisation of the BRDF's domain, after Zickler et al., "Reflectance
/// sharing", EGSR 2005, and Weistroffer et al., "Efficient basis decomposition for scattered reflectance data", EGSR
/// 2007. The paper states no more. The coordinates (`radial_coordinates`) and the kernel (`linear_kernel`) are our
/// interpretation; other kernels and centres can be passed.

#include <gonio/basis/basis.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// Returns the coordinates of a direction pair for radial basis functions. sqrt(theta_h / 90 degrees) is finer towards
/// the highlight. theta_d / 90 degrees is the radius on a disc with the angle 2 phi_d. The disc closes where phi_d
/// wraps (reciprocity), and its centre is theta_d = 0, where phi_d has no meaning.
[[nodiscard]] inline Eigen::Vector3d radial_coordinates(const half_difference& angles) noexcept {
  constexpr double right_angle = std::numbers::pi / 2.0;
  const double radius = angles.theta_d / right_angle;
  return {std::sqrt(std::max(angles.theta_h, 0.0) / right_angle), radius * std::cos(2.0 * angles.phi_d),
          radius * std::sin(2.0 * angles.phi_d)};
}

/// Squared distances of a location to centres, which a kernel replaces by its values.
using kernel_row = Eigen::Ref<Eigen::Array<double, 1, Eigen::Dynamic>>;

/// A function of the distance to a centre: `apply(row)` replaces a row of squared distances by the kernel's values.
///
/// Requirements that the compiler cannot check: values are finite for distances from 0 to 3; `apply` neither allocates
/// nor throws, and is thread safe.
///
/// With a model of the library:
/// ```cpp
/// #include <gonio/basis/rbf.hpp>
/// #include <gonio/metric/root.hpp>
///
/// #include <cstdio>
///
/// int main() {
///   const gonio::valid_cells cells(gonio::grid({45, 15, 18}));
///   const gonio::rbf functions{cells, gonio::root{}, gonio::farthest_point_centres(cells, 300)};
///   std::printf("%td functions\n", functions.size());
/// }
/// ```
/// With a model of your own, the thin plate's r^2 log r:
/// ```cpp
/// #include <gonio/basis/rbf.hpp>
/// #include <gonio/metric/root.hpp>
///
/// #include <cstdio>
///
/// struct thin_plate_kernel {
///   void apply(gonio::kernel_row squares) const { squares *= 0.5 * squares.max(1e-300).log(); }
/// };
/// static_assert(gonio::radial_kernel<thin_plate_kernel>);
///
/// int main() {
///   const gonio::valid_cells cells(gonio::grid({45, 15, 18}));
///   const gonio::rbf functions{cells, gonio::root{}, gonio::farthest_point_centres(cells, 300), thin_plate_kernel{}};
///   std::printf("%g\n", gonio::row_at(functions, gonio::locate_cell(cells, 0))[0]);
/// }
/// ```
template <class Kernel>
concept radial_kernel = std::copyable<Kernel> && requires(const Kernel& kernel, kernel_row squares) {
  kernel.apply(squares);
};

/// The distance itself: the biharmonic spline of three dimensions, with a kink at each centre.
struct linear_kernel {
  static void apply(kernel_row squares) noexcept { squares = squares.sqrt(); }
};

static_assert(radial_kernel<linear_kernel>);

/// The number of centres of Noell et al. 2014, for each colour channel.
inline constexpr Eigen::Index published_centre_count = 758;

/// Returns the angles of `count` cells: the first is chosen at random; each further cell is the one farthest, in radial
/// coordinates, from the cells already chosen. At most 60,000 cells, chosen at random, are candidates. O(cells +
/// candidates x count). Throws gonio::error if there are fewer different locations.
[[nodiscard]] std::vector<half_difference> farthest_point_centres(const valid_cells& cells,
                                                                  Eigen::Index count = published_centre_count,
                                                                  std::uint64_t seed = 0);

/// Radial basis functions in the domain of a metric: one around each centre, and four that are affine in the radial
/// coordinates. Rows are computed at the exact angles, O(centres), and never stored. A value type; copies share the
/// centres.
///
/// ```cpp
/// const gonio::decomposition rival{gonio::rbf{cells, gonio::log{}}, gonio::tikhonov{1e-6}};  // Noell et al.'s
/// const auto paint = rival.fit(samples);
/// ```
/// The penalty only keeps the system solvable for few samples. It must be tiny, because the Gram matrix has a condition
/// number of almost 1e10. For 100,000 samples, 1e-6 is 1e-11 of the matrix's mean diagonal entry.
template <error_metric Metric, radial_kernel Kernel = linear_kernel>
class rbf {
 public:
  /// The direction of the coordinate axes is arbitrary: see `has_arbitrary_sign`.
  static constexpr bool arbitrary_sign = true;

  /// `cells` are the cells of the metric and of fits. Throws gonio::error if there is no centre, or if a centre is not
  /// finite.
  rbf(valid_cells cells, Metric metric, const std::vector<half_difference>& centres, Kernel kernel = Kernel())
      : cells_(std::move(cells)), metric_(std::move(metric)), kernel_(std::move(kernel)) {
    if (centres.empty()) refuse("radial basis functions need at least one centre");
    coordinate_rows coordinates(3, std::ssize(centres));
    for (Eigen::Index i = 0; i < std::ssize(centres); ++i) {
      const Eigen::Vector3d centre = radial_coordinates(centres[i]);
      if (!centre.allFinite()) refuse({"centre ", i + 1, " of radial basis functions is not finite"});
      coordinates.col(i) = centre.array();
    }
    centres_ = std::make_shared<const coordinate_rows>(std::move(coordinates));
  }

  /// Takes 758 centres, like Noell et al. 2014, that are far from each other. Throws gonio::error if there are fewer
  /// cells.
  explicit rbf(valid_cells cells, Metric metric = Metric(), Kernel kernel = Kernel())
      : rbf(cells, std::move(metric), farthest_point_centres(cells), std::move(kernel)) {}

  /// Returns the number of centres plus four.
  [[nodiscard]] Eigen::Index size() const noexcept { return centres_->cols() + 4; }
  [[nodiscard]] const valid_cells& cells() const noexcept { return cells_; }
  [[nodiscard]] const Metric& metric() const noexcept { return metric_; }
  [[nodiscard]] const Kernel& kernel() const noexcept { return kernel_; }
  [[nodiscard]] double offset(Eigen::Index /*cell*/) const noexcept { return 0.0; }

  /// Writes the kernel of the distance to each centre, then 1, then the three radial coordinates.
  void read_row(const location& at, function_row out) const noexcept {
    const Eigen::Vector3d here = radial_coordinates(at.angles);
    const coordinate_rows& centres = *centres_;
    kernel_row kernels = out.head(centres.cols()).array();
    kernels = (centres.row(0) - here.x()).square() + (centres.row(1) - here.y()).square() +
              (centres.row(2) - here.z()).square();
    kernel_.apply(kernels);
    out.tail<4>() << 1.0, here.transpose();
  }

 private:
  /// Each coordinate of all centres is contiguous.
  using coordinate_rows = Eigen::Array<double, 3, Eigen::Dynamic, Eigen::RowMajor>;

  valid_cells cells_;
  Metric metric_;
  Kernel kernel_;
  std::shared_ptr<const coordinate_rows> centres_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/rbf.ipp>
#endif
