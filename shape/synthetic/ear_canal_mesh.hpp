#pragma once
/// Triangulates a surface in rings of near-equal triangles: regular for a template, or irregular like a scanner's. The
/// surface is a map from (u, v): v goes around it, u from an open end to a tip.

#include "ear_canals.hpp"
#include <gonio/core/error.hpp>
#include <gonio/shape/triangle_mesh.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <numbers>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace synthetic {

/// (u, v) of a vertex per column.
using parameter_columns = Eigen::Matrix2Xd;

/// A surface as a map from u and an angle v in radians. At u = 1 all v give one point, the tip. d/dv x d/du points
/// outwards.
using parametric_surface = std::function<Eigen::Vector3d(double u, double v)>;

struct parametric_mesh {
  gonio::shape::triangle_mesh mesh;
  parameter_columns parameters;
};

struct irregularity {
  std::uint64_t seed = 0;
  double jitter = 0.16;  ///< largest shift of a vertex, in steps to its neighbours; above 0.2 triangles might fold
  double long_diagonals = 0.2;  ///< probability of choosing the longer diagonal if both are similar
  double skew = 0.02;           ///< variation of u around a ring
};

namespace detail {

/// Makes rings of vertices around a parametric surface, spaced for near-equilateral triangles.
class ring_mesher {
 public:
  ring_mesher(const parametric_surface& surface, double from, std::size_t vertices,
              const std::optional<irregularity>& irregular)
      : surface_(surface), from_(from), irregular_(irregular), numbers_(irregular ? irregular->seed : 0) {
    if (vertices < 50) gonio::refuse("a mesh of rings needs at least 50 vertices, not " + std::to_string(vertices));
    measure();
    choose_counts(vertices);
    if (irregular_) skew_phase_ = numbers_.uniform(0.0, full);
  }

  [[nodiscard]] parametric_mesh mesh() {
    for (std::size_t ring = 0; ring < counts_.size(); ++ring) add_ring(ring);
    parameters_.emplace_back(1.0, 0.0);
    points_.push_back(surface_(1.0, 0.0));
    for (std::size_t ring = 0; ring + 1 < counts_.size(); ++ring) stitch(ring);
    close_tip();
    return {{columns_of<gonio::shape::point_columns>(points_), columns_of<gonio::shape::triangle_columns>(triangles_)},
            columns_of<parameter_columns>(parameters_)};
  }

 private:
  static constexpr double full = 2.0 * std::numbers::pi;
  static constexpr int levels = 200, sectors = 36;

  template <class Columns, class Vector>
  [[nodiscard]] static Columns columns_of(const std::vector<Vector>& vectors) {
    Columns columns(Columns::RowsAtCompileTime, std::ssize(vectors));
    for (std::size_t i = 0; i < vectors.size(); ++i) columns.col(i) = vectors[i];
    return columns;
  }

  /// Measures circumferences, and distances along the surface from the open end, at many levels of u.
  void measure() {
    std::vector<Eigen::Vector3d> before;
    for (int level = 0; level <= levels; ++level) {
      const double u = from_ + (1.0 - from_) * level / levels;
      std::vector<Eigen::Vector3d> ring;
      for (int sector = 0; sector < sectors; ++sector) ring.push_back(surface_(u, full * sector / sectors));
      double round = 0.0, along = 0.0;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        round += (ring[i] - ring[(i + 1) % ring.size()]).norm();
        if (level > 0) along += (ring[i] - before[i]).norm() / sectors;
      }
      circumferences_.push_back(round);
      distances_.push_back(level > 0 ? distances_.back() + along : 0.0);
      before = std::move(ring);
    }
  }

  /// Returns the fractional level at a distance from the open end.
  [[nodiscard]] double level_at(double distance) const {
    const auto above = std::ranges::upper_bound(distances_, distance);
    if (above == distances_.end()) return levels;
    const std::size_t low = (above - distances_.begin()) - 1;
    return static_cast<double>(low) + (distance - distances_[low]) / (distances_[low + 1] - distances_[low]);
  }

  [[nodiscard]] std::vector<Eigen::Index> counts_for(double spacing) const {
    const auto rings =
        static_cast<Eigen::Index>(std::max(3.0, std::round(distances_.back() / (spacing * 0.5 * std::numbers::sqrt3))));
    std::vector<Eigen::Index> counts;
    for (Eigen::Index ring = 0; ring < rings; ++ring) {
      const double level = level_at(distances_.back() * static_cast<double>(ring) / static_cast<double>(rings));
      const auto low = static_cast<Eigen::Index>(std::min(level, levels - 1.0));
      const double share = level - static_cast<double>(low);
      const double round = (1.0 - share) * circumferences_[low] + share * circumferences_[low + 1];
      counts.push_back(static_cast<Eigen::Index>(std::max(5.0, std::round(round / spacing))));
    }
    return counts;
  }

  /// Finds the smallest spacing that needs at most `vertices` vertices, then adds a vertex to some rings to get exactly
  /// `vertices`.
  void choose_counts(std::size_t vertices) {
    const auto total = [](const std::vector<Eigen::Index>& counts) {
      return std::accumulate(counts.begin(), counts.end(), std::size_t{1});
    };
    double low = 1e-3, high = distances_.back();
    for (int halving = 0; halving < 60; ++halving) {
      const double middle = std::sqrt(low * high);
      (total(counts_for(middle)) > vertices ? low : high) = middle;
    }
    counts_ = counts_for(high);
    for (std::size_t missing = vertices - total(counts_), all = missing, i = 0; i < all; ++i)
      ++counts_[i * counts_.size() / all];
  }

  void add_ring(std::size_t ring) {
    const std::size_t count = counts_[ring];
    const double gap = distances_.back() / static_cast<double>(counts_.size());
    const double level = level_at(gap * static_cast<double>(ring)), u = from_ + (1.0 - from_) * level / levels;
    const std::vector<double> lengths = lengths_round(u);
    // The step in u to the next ring, for the jitter.
    const double step = (1.0 - from_) * (level_at(gap * static_cast<double>(ring + 1)) - level) / levels;
    const double start = irregular_ ? numbers_.uniform() : 0.5 * static_cast<double>(ring % 2);
    firsts_.push_back(parameters_.size());
    for (std::size_t i = 0; i < count; ++i) {
      double position = static_cast<double>(i) + start, height = u;
      if (irregular_) {
        position += irregular_->jitter * numbers_.uniform(-1.0, 1.0);
        // The jitter is below one step, so the last ring does not reach the tip.
        height += step * irregular_->jitter * numbers_.uniform(-1.0, 1.0);
      }
      const double v = angle_at(lengths, position / static_cast<double>(count));
      if (irregular_) height += skew_at(u, v);
      parameters_.emplace_back(height, v);
      points_.push_back(surface_(height, v));
    }
  }

  /// Returns the shift in u of a vertex at v. It fades at both ends of the canal.
  [[nodiscard]] double skew_at(double u, double v) const {
    const double along = (u - from_) / (1.0 - from_);
    return irregular_->skew * 4.0 * along * (1.0 - along) * std::sin(v + skew_phase_);
  }

  [[nodiscard]] std::vector<double> lengths_round(double u) const {
    std::vector<double> lengths{0.0};
    Eigen::Vector3d before = surface_(u, 0.0);
    for (int sector = 1; sector <= sectors; ++sector) {
      const Eigen::Vector3d now = surface_(u, full * sector / sectors);
      lengths.push_back(lengths.back() + (now - before).norm());
      before = now;
    }
    return lengths;
  }

  /// Returns the angle at a fraction of the circumference. Fractions below 0 and above 1 continue around.
  [[nodiscard]] static double angle_at(const std::vector<double>& lengths, double share) {
    const double turns = std::floor(share), length = (share - turns) * lengths.back();
    const auto above = std::ranges::upper_bound(lengths, length);
    const auto low = std::min(above - lengths.begin(), std::ssize(lengths) - 1) - 1;
    const double part = (length - lengths[low]) / (lengths[low + 1] - lengths[low]);
    return full * (turns + (static_cast<double>(low) + part) / sectors);
  }

  /// Adds the triangles between a ring and the next.
  void stitch(std::size_t ring) {
    const std::size_t lower = counts_[ring], upper = counts_[ring + 1];
    const auto at_lower = [&](std::size_t i) { return firsts_[ring] + i % lower; };
    // Begin with the upper vertex closest to the first lower one.
    std::size_t begin = 0;
    for (std::size_t j = 1; j < upper; ++j)
      if (distance(firsts_[ring], firsts_[ring + 1] + j) < distance(firsts_[ring], firsts_[ring + 1] + begin))
        begin = j;
    const auto at_upper = [&](std::size_t j) { return firsts_[ring + 1] + (begin + j) % upper; };
    for (std::size_t i = 0, j = 0; i < lower || j < upper;) {
      if (j == upper || (i < lower && prefers_first(distance(at_lower(i + 1), at_upper(j)),
                                                    distance(at_lower(i), at_upper(j + 1))))) {
        add_triangle(at_lower(i), at_lower(i + 1), at_upper(j));
        ++i;
      } else {
        add_triangle(at_lower(i), at_upper(j + 1), at_upper(j));
        ++j;
      }
    }
  }

  [[nodiscard]] bool prefers_first(double first, double second) {
    const bool shorter = first <= second;
    if (!irregular_ || std::max(first, second) > 1.25 * std::min(first, second)) return shorter;
    return (numbers_.uniform() < irregular_->long_diagonals) != shorter;
  }

  void close_tip() {
    const std::size_t tip = points_.size() - 1, count = counts_.back(), first = firsts_.back();
    for (std::size_t i = 0; i < count; ++i) add_triangle(first + i, first + (i + 1) % count, tip);
  }

  [[nodiscard]] double distance(std::size_t first, std::size_t second) const {
    return (points_[first] - points_[second]).norm();
  }

  void add_triangle(std::size_t first, std::size_t second, std::size_t third) {
    triangles_.emplace_back(static_cast<int>(first), static_cast<int>(second), static_cast<int>(third));
  }

  const parametric_surface& surface_;
  double from_;
  std::optional<irregularity> irregular_;
  number_source numbers_;
  double skew_phase_ = 0.0;
  std::vector<double> circumferences_, distances_;  // per level
  std::vector<Eigen::Index> counts_, firsts_;       // per ring
  std::vector<Eigen::Vector2d> parameters_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector3i> triangles_;
};

}  // namespace detail

/// Returns a mesh with exactly `vertices` vertices from u = `from` to the tip, regular or irregular. Throws
/// gonio::error for fewer than 50 vertices. O(vertices).
[[nodiscard]] inline parametric_mesh mesh_of(const parametric_surface& surface, double from, std::size_t vertices,
                                             const std::optional<irregularity>& irregular = std::nullopt) {
  return detail::ring_mesher(surface, from, vertices, irregular).mesh();
}

/// Returns the surface of an ear canal. The canal must outlive it.
[[nodiscard]] inline parametric_surface surface_of(const ear_canal& individual) {
  return [&individual](double u, double v) { return individual.at(u, v); };
}

parametric_surface surface_of(ear_canal&&) = delete;

/// Returns the points of an individual at some parameters: 3 x parameters.
[[nodiscard]] inline gonio::shape::point_columns points_at(const ear_canal& individual,
                                                           const parameter_columns& parameters) {
  gonio::shape::point_columns points(3, parameters.cols());
  for (Eigen::Index i = 0; i < parameters.cols(); ++i)
    points.col(i) = individual.at(parameters(0, i), parameters(1, i));
  return points;
}

/// Near-equilateral triangles on the family's mean. Their vertices give the true correspondences of all individuals.
class ear_canal_template {
 public:
  /// The default is the published number of vertices. Throws gonio::error for fewer than 50.
  explicit ear_canal_template(std::size_t vertices = 3096)
      : on_mean_(
            mesh_of([mean = ear_canal_family::mean()](double u, double v) { return mean.at(u, v); }, 0.0, vertices)) {}

  /// Returns the mesh on the family's mean.
  [[nodiscard]] const gonio::shape::triangle_mesh& mesh() const noexcept { return on_mean_.mesh; }
  [[nodiscard]] const parameter_columns& parameters() const noexcept { return on_mean_.parameters; }

  /// Returns the true positions of the vertices on an individual: 3 x vertices.
  [[nodiscard]] gonio::shape::point_columns corresponded(const ear_canal& individual) const {
    return points_at(individual, on_mean_.parameters);
  }

 private:
  parametric_mesh on_mean_;
};

}  // namespace synthetic
