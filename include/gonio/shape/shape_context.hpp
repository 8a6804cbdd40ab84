#pragma once
/// 3D shape context descriptors: what lies where around a point of a surface, as a histogram, and which points of two
/// surfaces look most alike. "Anatomically correct surface recovery" (Nielsen's doctoral thesis, DTU 2016,
/// contribution C.V), section 2, after Frome et al., "Recognizing objects in range data using regional point
/// descriptors" (ECCV 2004).

#include <gonio/core/direction.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/shape/assignment.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Geometry>
#include <nanoflann.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace gonio {

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

inline void require_context(const shape_context_options& options) {
  if (options.radial_bins < 1 || options.polar_bins < 1 || options.azimuthal_bins < 1)
    throw error("a shape context needs at least one bin for each of its three coordinates");
  if (!(options.radius > 0.0 && std::isfinite(options.radius)))
    throw error("the radius of a shape context must be positive and finite, not " + std::to_string(options.radius));
  if (!options.vertical.allFinite() || !(options.vertical.stableNorm() > 0.0))
    throw error("the vertical axis of a shape context must be finite and not zero");
  if (!(options.least_inclination > 0.0 && options.least_inclination < std::numbers::pi / 2.0))
    throw error("the least inclination of a shape context's normals must be between 0 and pi/2, not " +
                std::to_string(options.least_inclination));
}

/// What sampling and describing need of a mesh, which may be less than a surface.
inline void require_finite_mesh(const triangle_mesh& mesh) {
  if (!mesh.vertices.allFinite()) throw error("the vertices of a mesh to describe must be finite");
  if (mesh.triangles.cols() == 0) throw error("a mesh to describe has no triangles");
  if (mesh.triangles.minCoeff() < 0 || mesh.triangles.maxCoeff() >= mesh.vertices.cols())
    throw error("a triangle of a mesh to describe names a vertex that is not among its " +
                std::to_string(mesh.vertices.cols()));
}

/// A third of the area of the triangles around each vertex.
[[nodiscard]] inline Eigen::VectorXd vertex_areas(const triangle_mesh& mesh) {
  const Eigen::RowVectorXd doubled = area_normals(mesh).colwise().norm();
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.vertices.cols());
  for (Eigen::Index t = 0; t < doubled.size(); ++t)
    for (Eigen::Index corner = 0; corner < 3; ++corner) areas[mesh.triangles(corner, t)] += doubled[t] / 6.0;
  return areas;
}

/// Points in a k-d tree, which reads them where they are: they must outlive it.
class point_tree {
 public:
  /// O(n log n).
  explicit point_tree(const point_columns& points) : points_{points}, tree_(3, points_, {leaf_size}) {}

  /// Square of the distance to the closest point. O(log n). There must be a point.
  [[nodiscard]] double squared_distance(const Eigen::Vector3d& place) const {
    std::uint32_t index = 0;
    double squared = 0.0;
    tree_.knnSearch(place.data(), 1, &index, &squared);
    return squared;
  }

  /// Calls `use(index)` for each point nearer than a radius, always in the same order.
  template <class Use>
  void for_each_within(double radius, const Eigen::Vector3d& place, const Use& use) const {
    std::vector<std::pair<std::uint32_t, double>> found;
    tree_.radiusSearch(place.data(), radius * radius, found, nanoflann::SearchParams(0, 0.0F, false));
    for (const auto& [index, squared] : found) use(static_cast<Eigen::Index>(index));
  }

 private:
  /// What nanoflann asks for.
  struct adaptor {
    const point_columns& points;

    [[nodiscard]] std::size_t kdtree_get_point_count() const { return static_cast<std::size_t>(points.cols()); }
    [[nodiscard]] double kdtree_get_pt(std::size_t index, std::size_t axis) const {
      return points(static_cast<Eigen::Index>(axis), static_cast<Eigen::Index>(index));
    }
    template <class Box>
    [[nodiscard]] bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };
  using metric = nanoflann::L2_Simple_Adaptor<double, adaptor>;

  static constexpr std::size_t leaf_size = 16;

  adaptor points_;
  nanoflann::KDTreeSingleIndexAdaptor<metric, adaptor, 3> tree_;
};

}  // namespace detail

/// The frame of a point with an outward unit normal, as columns: b1 along the vertical axis as far as that is across
/// the normal, b2 = b3 x b1, and b3 the normal. A place q' has the coordinates F'(q' - q); where the paper prints
/// R (q' - q) it means this. Nothing if the normal is zero or within `least_inclination` of the vertical axis, up or
/// down, where the first direction is uncertain.
[[nodiscard]] inline std::optional<Eigen::Matrix3d> context_frame(const Eigen::Vector3d& normal,
                                                                  const shape_context_options& options) {
  const Eigen::Vector3d vertical = options.vertical.stableNormalized();
  const Eigen::Vector3d across = vertical - vertical.dot(normal) * normal;
  if (!(normal.squaredNorm() > 0.0 && across.norm() >= std::sin(options.least_inclination))) return {};
  Eigen::Matrix3d frame;
  frame << across.normalized(), normal.cross(across).normalized(), normal;
  return frame;
}

/// The bin of a place in a frame's coordinates, not zero and within the radius. The azimuth is atan2(y, x), from b1
/// all the way around: the paper prints arctan(y / x), which could not tell opposite places apart.
[[nodiscard]] inline Eigen::Index context_bin(const Eigen::Vector3d& place, const shape_context_options& options) {
  const auto bin = [](double share, Eigen::Index bins) {
    return std::clamp(static_cast<Eigen::Index>(share * static_cast<double>(bins)), Eigen::Index{0}, bins - 1);
  };
  const double r = place.norm(), theta = std::acos(std::clamp(place.z() / r, -1.0, 1.0)),
               phi = std::atan2(place.y(), place.x());
  const Eigen::Index radial = bin(r / options.radius, options.radial_bins),
                     polar = bin(theta / std::numbers::pi, options.polar_bins),
                     azimuthal = bin(0.5 + phi / (2.0 * std::numbers::pi), options.azimuthal_bins);
  return (radial * options.polar_bins + polar) * options.azimuthal_bins + azimuthal;
}

/// So many vertices of triangles, spread as evenly as that goes: the one farthest from the centroid of all, then always
/// the one farthest from those chosen. Of equally far ones the lowest number. Fewer if there are no more places.
/// Gonzalez, Theoretical Computer Science 38, 1985. O(count x vertices). Throws gonio::error if a vertex is not finite,
/// a triangle names a vertex that there is not, or there are no triangles.
[[nodiscard]] inline std::vector<Eigen::Index> spread_vertices(const triangle_mesh& mesh, Eigen::Index count) {
  detail::require_finite_mesh(mesh);
  if (count < 0) throw error("the number of vertices to choose must not be negative");
  // Of squared distances from what was chosen; vertices of no triangle are as near as those chosen.
  Eigen::RowVectorXd nearest = Eigen::RowVectorXd::Zero(mesh.vertices.cols());
  for (const int vertex : mesh.triangles.reshaped()) nearest[vertex] = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d centroid = mesh.vertices.rowwise().mean();
  Eigen::RowVectorXd key = nearest.cwiseMin((mesh.vertices.colwise() - centroid).colwise().squaredNorm());
  std::vector<Eigen::Index> chosen;
  while (static_cast<Eigen::Index>(chosen.size()) < count) {
    Eigen::Index farthest = 0;
    if (!(key.maxCoeff(&farthest) > 0.0)) break;
    chosen.push_back(farthest);
    const Eigen::Vector3d place = mesh.vertices.col(farthest);
    nearest = nearest.cwiseMin((mesh.vertices.colwise() - place).colwise().squaredNorm());
    key = nearest;
  }
  return chosen;
}

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
[[nodiscard]] inline shape_descriptors describe(const triangle_mesh& mesh, const std::vector<Eigen::Index>& chosen,
                                                const shape_context_options& options = {}, thread_count threads = {}) {
  detail::require_context(options);
  detail::require_finite_mesh(mesh);
  for (const Eigen::Index vertex : chosen)
    if (vertex < 0 || vertex >= mesh.vertices.cols())
      throw error("vertex " + std::to_string(vertex) + " of a mesh of " + std::to_string(mesh.vertices.cols()) +
                  " cannot be described");
  const point_columns normals = vertex_normals(mesh);
  const Eigen::VectorXd areas = detail::vertex_areas(mesh);
  const detail::point_tree tree(mesh.vertices);
  Eigen::MatrixXd histograms = Eigen::MatrixXd::Zero(options.bins(), static_cast<Eigen::Index>(chosen.size()));
  const auto fill = [&](Eigen::Index point) {
    const Eigen::Index vertex = chosen[static_cast<std::size_t>(point)];
    const Eigen::Vector3d origin = mesh.vertices.col(vertex);
    const std::optional<Eigen::Matrix3d> frame = context_frame(normals.col(vertex), options);
    if (!frame) return;
    tree.for_each_within(options.radius, origin, [&](Eigen::Index neighbour) {
      const Eigen::Vector3d place = frame->transpose() * (mesh.vertices.col(neighbour) - origin);
      if (place.squaredNorm() > 0.0) histograms(context_bin(place, options), point) += areas[neighbour];
    });
  };
  for_each_block(
      chosen.size(), 8,
      [&](block points) {
        for (std::size_t i = points.begin; i < points.end; ++i) fill(static_cast<Eigen::Index>(i));
      },
      threads);

  shape_descriptors found;
  std::vector<Eigen::Index> filled;
  for (Eigen::Index point = 0; point < histograms.cols(); ++point) {
    const double sum = histograms.col(point).sum();
    if (!(sum > 0.0)) continue;
    histograms.col(point) /= sum;
    filled.push_back(point);
    found.vertex.push_back(chosen[static_cast<std::size_t>(point)]);
  }
  found.histograms = histograms(Eigen::all, filled).cast<float>();
  return found;
}

/// Half the sum of (a - b)^2 / (a + b) over the bins, for each descriptor of the one (rows) and of the other (columns).
/// O(bins x rows x columns). The same bytes for any number of threads. Throws gonio::error if they have different bins.
[[nodiscard]] inline Eigen::MatrixXd chi_square_costs(const shape_descriptors& from, const shape_descriptors& onto,
                                                      thread_count threads = {}) {
  if (from.histograms.rows() != onto.histograms.rows())
    throw error("descriptors of " + std::to_string(from.histograms.rows()) + " and " +
                std::to_string(onto.histograms.rows()) + " bins cannot be compared");
  Eigen::MatrixXd costs(from.histograms.cols(), onto.histograms.cols());
  // Empty in both: 0 / least, which is 0.
  constexpr float least = std::numeric_limits<float>::min();
  for_each_block(
      static_cast<std::size_t>(costs.cols()), 8,
      [&](block columns) {
        for (auto j = static_cast<Eigen::Index>(columns.begin); j < static_cast<Eigen::Index>(columns.end); ++j)
          for (Eigen::Index i = 0; i < costs.rows(); ++i) {
            const auto a = from.histograms.col(i).array(), b = onto.histograms.col(j).array();
            costs(i, j) = 0.5 * ((a - b).square() / (a + b).max(least)).cast<double>().sum();
          }
      },
      threads);
  return costs;
}

/// The descriptors of the smaller set, each matched to one of the other at the least total cost; the most alike first.
/// O(bins n^2 + n^3). Throws gonio::error as `chi_square_costs` and `optimal_assignment` do.
[[nodiscard]] inline std::vector<shape_match> match(const shape_descriptors& from, const shape_descriptors& onto,
                                                    thread_count threads = {}) {
  const Eigen::MatrixXd costs = chi_square_costs(from, onto, threads);
  const std::vector<Eigen::Index> columns = optimal_assignment(costs);
  std::vector<shape_match> matches;
  for (Eigen::Index row = 0; row < costs.rows(); ++row) {
    const Eigen::Index column = columns[static_cast<std::size_t>(row)];
    if (column >= 0) matches.push_back({row, column, costs(row, column)});
  }
  std::ranges::sort(matches, {}, [](const shape_match& one) { return std::tuple(one.cost, one.from); });
  return matches;
}

}  // namespace gonio
