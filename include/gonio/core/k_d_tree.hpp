#pragma once
/// Finds the points nearest to a location, by a k-d tree. Needs nanoflann, which the targets gonio::scattered and
/// gonio::shape link. Only function bodies include this header, so that users do not parse nanoflann.

#include <Eigen/Core>
#include <nanoflann.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace gonio {

/// Points in a k-d tree. Reads the points in place: they must outlive the tree. The tree cannot be moved.
template <int Dimension>
class k_d_tree {
 public:
  using points = Eigen::Matrix<double, Dimension, Eigen::Dynamic>;

  /// Builds the tree in O(n log n).
  explicit k_d_tree(const points& of) : points_{of}, tree_(Dimension, points_, {leaf_size}) {}

  k_d_tree(const k_d_tree&) = delete;
  k_d_tree& operator=(const k_d_tree&) = delete;

  /// Writes the indices of the `count` points nearest to `query`, or of all if there are fewer, and their squared
  /// distances, the nearest first. Returns the number of points written. O(count log n); does not allocate.
  Eigen::Index nearest(const double* query, Eigen::Index count, std::uint32_t* numbers, double* squared) const {
    return static_cast<Eigen::Index>(tree_.knnSearch(query, static_cast<std::size_t>(count), numbers, squared));
  }

  /// Returns the indices of the points within a radius of `query`, always in the same order.
  [[nodiscard]] std::vector<Eigen::Index> within(double radius, const double* query) const {
    std::vector<std::pair<std::uint32_t, double>> found;
    tree_.radiusSearch(query, radius * radius, found, nanoflann::SearchParams(0, 0.0F, false));
    std::vector<Eigen::Index> numbers;
    numbers.reserve(found.size());
    for (const auto& [number, square] : found) numbers.push_back(number);
    return numbers;
  }

 private:
  /// The interface that nanoflann needs.
  struct adaptor {
    const points& of;

    [[nodiscard]] Eigen::Index kdtree_get_point_count() const { return of.cols(); }
    [[nodiscard]] double kdtree_get_pt(Eigen::Index index, Eigen::Index axis) const { return of(axis, index); }
    template <class Box>
    [[nodiscard]] bool kdtree_get_bbox(Box&) const {
      return false;
    }
  };

  static constexpr Eigen::Index leaf_size = 16;

  adaptor points_;
  nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, adaptor>, adaptor, Dimension> tree_;
};

}  // namespace gonio
