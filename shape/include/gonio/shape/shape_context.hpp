#pragma once
/// 3D shape context descriptors: what lies where around a point of a surface, as a histogram, and which points of two
/// surfaces look most alike. "Anatomically correct surface recovery" (Nielsen's doctoral thesis, DTU 2016,
/// contribution C.V), section 2, after Frome et al., "Recognizing objects in range data using regional point
/// descriptors" (ECCV 2004, doi:10.1007/978-3-540-24672-5_18).

#include <gonio/core/direction.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <vector>

namespace gonio::shape {

/// The bins of a descriptor and the frame they are counted in. The bins of a coordinate are equally wide. The defaults
/// are the paper's, for millimetres.
struct shape_context_options {
  Eigen::Index radial_bins = 8, polar_bins = 13, azimuthal_bins = 4;
  double radius = 10.0;
  Eigen::Vector3d vertical{0.0, 1.0, 0.0};  ///< of the scanner's platform, in scans and models; of any length
  double least_inclination = radians(10);   ///< of a normal to the vertical axis, below which there is no frame

  [[nodiscard]] Eigen::Index bins() const noexcept { return radial_bins * polar_bins * azimuthal_bins; }
};

/// Descriptors of some vertices of a mesh.
struct shape_descriptors {
  std::vector<Eigen::Index> vertex;  ///< of the mesh, one for each column of `histograms`
  Eigen::MatrixXf histograms;        ///< bins x points, azimuth fastest and radius slowest; each column sums to 1
};

/// A point of one surface and one of another that look alike.
struct shape_match {
  Eigen::Index from = 0, onto = 0;  ///< columns of the descriptors
  double cost = 0.0;                ///< chi-square distance, from 0 (equal) to 1 (nothing in common)
};

namespace detail {

/// Points in a k-d tree, which reads them where they are: they must outlive it. Copies share it.
class point_tree {
 public:
  /// O(n log n).
  explicit point_tree(const point_columns& points);

  /// Square of the distance to the closest point. O(log n). There must be a point.
  [[nodiscard]] double squared_distance(const Eigen::Vector3d& place) const;

  /// The numbers of the points nearer than a radius, always in the same order.
  [[nodiscard]] std::vector<Eigen::Index> within(double radius, const Eigen::Vector3d& place) const;

 private:
  struct built_tree;

  std::shared_ptr<const built_tree> tree_;
};

}  // namespace detail

/// The frame of a point with an outward unit normal, as columns: b1 along the vertical axis as far as that is across
/// the normal, b2 = b3 x b1, and b3 the normal. A place q' has the coordinates F'(q' - q); where the paper prints
/// R (q' - q) it means this. Nothing if the normal is zero or within `least_inclination` of the vertical axis, up or
/// down, where the first direction is uncertain.
[[nodiscard]] std::optional<Eigen::Matrix3d> context_frame(const Eigen::Vector3d& normal,
                                                           const shape_context_options& options);

/// The bin of a place in a frame's coordinates, not zero and within the radius. The azimuth is atan2(y, x), from b1
/// all the way around: the paper prints arctan(y / x), which could not tell opposite places apart.
[[nodiscard]] Eigen::Index context_bin(const Eigen::Vector3d& place, const shape_context_options& options);

/// So many vertices of triangles, spread as evenly as that goes: the one farthest from the centroid of all, then always
/// the one farthest from those chosen. Of equally far ones the lowest number. Fewer if there are no more places.
/// Gonzalez, Theoretical Computer Science 38, 1985 (doi:10.1016/0304-3975(85)90224-5). O(count x vertices). Throws
/// gonio::error if a vertex is not finite, a triangle names a vertex that there is not, or there are no triangles.
[[nodiscard]] std::vector<Eigen::Index> spread_vertices(const triangle_mesh& mesh, Eigen::Index count);

/// Descriptors of chosen vertices, in their order. Left out are those whose normal is too near the vertical axis
/// (`context_frame`), and those with no surface around them.
///
/// The paper counts neighbouring points. Scans are triangulated arbitrarily, so that counts would tell more about the
/// scanner than about the ear: here each neighbouring vertex counts by its share of the surface's area, and the sum of
/// a histogram is 1. Where triangles are of one size, that is the paper's count over the number of neighbours. Frome et
/// al. divide by the density of points for the same reason.
///
/// O(vertices log vertices + points x neighbours). The same bytes for any number of threads. Throws gonio::error for
/// options out of range, and a mesh as `spread_vertices` refuses it or a choice that is no vertex of it.
[[nodiscard]] shape_descriptors describe(const triangle_mesh& mesh, const std::vector<Eigen::Index>& chosen,
                                         const shape_context_options& options = {}, thread_count threads = {});

/// Half the sum of (a - b)^2 / (a + b) over the bins, for each descriptor of the one (rows) and of the other (columns).
/// O(bins x rows x columns). The same bytes for any number of threads. Throws gonio::error if they have different bins.
[[nodiscard]] Eigen::MatrixXd chi_square_costs(const shape_descriptors& from, const shape_descriptors& onto,
                                               thread_count threads = {});

/// The descriptors of the smaller set, each matched to one of the other at the least total cost; the most alike first.
/// O(bins n^2 + n^3). Throws gonio::error as `chi_square_costs` and `optimal_assignment` do.
[[nodiscard]] std::vector<shape_match> match(const shape_descriptors& from, const shape_descriptors& onto,
                                             thread_count threads = {});

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/shape_context.ipp>
#endif
