#pragma once
/// 3D shape context descriptors: histograms of the surface around a point, and the matching of similar points on two
/// surfaces. "Anatomically correct surface recovery" (Nielsen's doctoral thesis, DTU 2016, contribution C.V), section
/// 2, after Frome et al., "Recognizing objects in range data using regional point descriptors" (ECCV 2004,
/// doi:10.1007/978-3-540-24672-5_18).

#include <gonio/core/direction.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

namespace gonio::shape {

/// The bins of a descriptor, equally wide in each coordinate, and its frame. Defaults are the paper's, in millimetres.
struct shape_context_options {
  Eigen::Index radial_bins = 8, polar_bins = 13, azimuthal_bins = 4;
  double radius = 10.0;
  Eigen::Vector3d vertical{0.0, 1.0,
                           0.0};  ///< vertical axis of the scanner's platform, in scans and models; of any length
  double least_inclination =
      radians(10);  ///< smallest angle of a normal to the vertical axis; below it there is no frame

  [[nodiscard]] Eigen::Index bins() const noexcept { return radial_bins * polar_bins * azimuthal_bins; }
};

/// Descriptors of some vertices of a mesh.
struct shape_descriptors {
  std::vector<Eigen::Index> vertex;  ///< vertices of the mesh, one for each column of `histograms`
  Eigen::MatrixXf histograms;        ///< bins x points, azimuth fastest and radius slowest; each column sums to 1
};

/// Similar points of two surfaces.
struct shape_match {
  Eigen::Index from = 0, onto = 0;  ///< columns of the descriptors
  double cost = 0.0;                ///< chi-square distance, from 0 (equal) to 1 (nothing in common)
};

namespace detail {

/// A k-d tree of points, which must outlive it. Copies share the tree.
class point_tree {
 public:
  /// O(n log n).
  explicit point_tree(const point_columns& points);

  /// Returns the squared distance to the closest point. O(log n). The tree must have a point.
  [[nodiscard]] double squared_distance(const Eigen::Vector3d& point) const;

  /// Returns the numbers of the points nearer than a radius, always in the same order.
  [[nodiscard]] std::vector<Eigen::Index> within(double radius, const Eigen::Vector3d& centre) const;

 private:
  struct built_tree;

  std::shared_ptr<const built_tree> tree_;
};

}  // namespace detail

/// Returns the frame F of a point q with an outward unit normal, as columns: b1 along the projection of the vertical
/// axis onto the tangent plane, b2 = b3 x b1, and b3 the normal. In it, a point p has the coordinates F' (p - q); the
/// paper prints R (q' - q). Returns nothing if the normal is zero or within `least_inclination` of the vertical axis,
/// up or down, where b1 is uncertain.
[[nodiscard]] std::optional<Eigen::Matrix3d> context_frame(const Eigen::Vector3d& normal,
                                                           const shape_context_options& options);

/// Returns the bin of a point in a frame's coordinates. The point must not be zero, and must be within the radius. The
/// azimuth from b1 is atan2(y, x), over a full turn; the paper prints arctan(y / x), which cannot distinguish opposite
/// points.
[[nodiscard]] Eigen::Index context_bin(const Eigen::Vector3d& point, const shape_context_options& options);

/// Returns `count` evenly spread vertices of triangles: first the one farthest from the centroid of all vertices, then
/// always the one farthest from those chosen before. If several are equally far, takes the lowest number. Returns fewer
/// if there are fewer distinct positions. Gonzalez, Theoretical Computer Science 38, 1985
/// (doi:10.1016/0304-3975(85)90224-5). O(count x vertices). Throws gonio::error if a vertex is not finite, if a
/// triangle names a missing vertex, or if there are no triangles.
[[nodiscard]] std::vector<Eigen::Index> spread_vertices(const triangle_mesh& mesh, Eigen::Index count);

/// Returns descriptors of chosen vertices, in their order. Skips vertices whose normal is too near the vertical axis
/// (`context_frame`), and those with no surface around them.
///
/// The paper counts neighbouring points. Scans are triangulated arbitrarily, so counts would describe the scanner more
/// than the ear. Here each neighbouring vertex counts by its share of the surface area, and a histogram sums to 1. For
/// triangles of equal size this is the paper's count divided by the number of neighbours. Frome et al. divide by the
/// density of points for the same reason.
///
/// O(vertices log vertices + points x neighbours). The bytes do not depend on the number of threads. Throws
/// gonio::error for options out of range, a mesh that `spread_vertices` refuses, and a missing chosen vertex.
[[nodiscard]] shape_descriptors describe(const triangle_mesh& mesh, const std::vector<Eigen::Index>& chosen,
                                         const shape_context_options& options = {}, thread_count threads = {});

/// Returns half the sum of (a - b)^2 / (a + b) over the bins, for each pair of descriptors: `from` in rows, `onto` in
/// columns. O(bins x rows x columns). The bytes do not depend on the number of threads. Throws gonio::error if they
/// have different bins.
[[nodiscard]] Eigen::MatrixXd chi_square_costs(const shape_descriptors& from, const shape_descriptors& onto,
                                               thread_count threads = {});

/// Matches each descriptor of the smaller set to a different one of the other set at the least total cost, and sorts
/// the matches by cost. O(bins n^2 + n^3) for n descriptors of the larger set. Throws gonio::error as
/// `chi_square_costs` and `optimal_assignment` do.
[[nodiscard]] std::vector<shape_match> match(const shape_descriptors& from, const shape_descriptors& onto,
                                             thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/shape_context.ipp>
#endif
