#pragma once
/// E(S) of Xu et al. 2016 (doi:10.1145/2980179.2982396) for candidates that are images with many samples each (section
/// 5.2).

#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/design/capture_geometry.hpp>
#include <gonio/design/compressed_rows.hpp>
#include <gonio/design/expected_error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace gonio::design {

namespace detail {

/// Returns all rows of Y and W of the parts, one part after the other, for m observations.
[[nodiscard]] expected_error::rows joined(std::span<const expected_error::rows* const> parts, Eigen::Index m);

}  // namespace detail

/// Computes E of images. Computes the rows of their samples at each call, for searches that evaluate few of many
/// candidates. Ignores eigenvalues below eta / 1000 (`compressed`), which changes E by less than a thousandth.
template <error_metric Metric, capture_geometry Geometry>
class image_objective {
 public:
  /// `basis` must be the basis from which `criterion` was made.
  image_objective(pca<Metric> basis, expected_error criterion, Geometry geometry)
      : basis_(std::move(basis)), criterion_(std::move(criterion)), geometry_(std::move(geometry)) {}

  [[nodiscard]] const Geometry& geometry() const noexcept { return geometry_; }
  [[nodiscard]] const expected_error& criterion() const noexcept { return criterion_; }

  /// Returns Y and W of one image, compressed. O(s k min(s, k)) for s samples and k components.
  [[nodiscard]] expected_error::rows rows_of(Eigen::Index candidate) const {
    const std::vector<half_difference> directions = geometry_.directions(candidate);
    const component_rows few = compressed(rows_at(basis_, directions), 1e-3 * criterion_.options().eta);
    return criterion_.prepare(few.components, few.noise);
  }

  /// Returns the expected error E after measuring some images.
  [[nodiscard]] double operator()(std::span<const Eigen::Index> candidates) const {
    return criterion_(rows_of_all(candidates));
  }

  /// Returns a function of one more image, which returns E of some images and this one.
  [[nodiscard]] auto beside(std::span<const Eigen::Index> candidates) const {
    return [this, others = rows_of_all(candidates)](Eigen::Index candidate) {
      const expected_error::rows one = rows_of(candidate);
      const std::array<const expected_error::rows*, 2> both{&others, &one};
      return criterion_(detail::joined(both, others.both.cols()));
    };
  }

 private:
  [[nodiscard]] expected_error::rows rows_of_all(std::span<const Eigen::Index> candidates) const {
    std::vector<expected_error::rows> each;
    for (const Eigen::Index candidate : candidates) each.push_back(rows_of(candidate));
    std::vector<const expected_error::rows*> parts;
    for (const auto& rows : each) parts.push_back(&rows);
    return detail::joined(parts, criterion_.coefficients().rows());
  }

  pca<Metric> basis_;
  expected_error criterion_;
  Geometry geometry_;
};

/// Computes E of images. Computes the rows of all candidates beforehand, so that a search can try each image next. Each
/// image is compressed to 5 to 40 rows, as in `image_objective`. A row needs 16 m bytes for m observations.
template <error_metric Metric, capture_geometry Geometry>
class image_candidates {
 public:
  /// O(s k min(s, k)) for each candidate of s samples and k components.
  explicit image_candidates(image_objective<Metric, Geometry> objective, thread_count threads = {},
                            const progress& listener = {})
      : objective_(std::move(objective)), rows_(objective_.geometry().size()), threads_(threads) {
    constexpr Eigen::Index batch = 64;
    for (Eigen::Index begin = 0; begin < std::ssize(rows_); begin += batch) {
      const Eigen::Index count = std::min(batch, std::ssize(rows_) - begin);
      for_each_block(
          count, 1,
          [&](block range) {
            const Eigen::Index candidate = begin + range.begin;
            if (objective_.geometry().allows(candidate)) rows_[candidate] = objective_.rows_of(candidate);
          },
          threads_);
      report(listener, "images", static_cast<double>(begin + count) / static_cast<double>(rows_.size()));
    }
  }

  [[nodiscard]] const Geometry& geometry() const noexcept { return objective_.geometry(); }

  /// Returns the expected error E after measuring some images.
  [[nodiscard]] double operator()(std::span<const Eigen::Index> candidates) const {
    return objective_.criterion()(rows_of_all(candidates));
  }

  /// Returns a function of one more image, which returns E of some images and this one.
  [[nodiscard]] auto beside(std::span<const Eigen::Index> candidates) const {
    return [this, others = rows_of_all(candidates)](Eigen::Index candidate) {
      const std::array<const expected_error::rows*, 2> both{&others, &rows_[candidate]};
      return objective_.criterion()(detail::joined(both, others.both.cols()));
    };
  }

  /// Returns one value for each candidate: E of some images and this one, or infinity if this one is not allowed.
  [[nodiscard]] std::vector<float> errors_with_each(std::span<const Eigen::Index> candidates) const {
    return errors_with_each(candidates, {0, std::ssize(rows_)});
  }

  /// Returns the values of `errors_with_each(candidates)` for a range of the candidates.
  [[nodiscard]] std::vector<float> errors_with_each(std::span<const Eigen::Index> candidates, block range) const {
    std::vector<float> errors(static_cast<std::size_t>(range.size()), std::numeric_limits<float>::infinity());
    const auto with = beside(candidates);
    for_each_index(
        range.size(), sweep_block,
        [&](Eigen::Index i) {
          const Eigen::Index candidate = range.begin + i;
          if (geometry().allows(candidate)) errors[i] = static_cast<float>(with(candidate));
        },
        threads_);
    return errors;
  }

  static constexpr Eigen::Index sweep_block = 16;

 private:
  [[nodiscard]] expected_error::rows rows_of_all(std::span<const Eigen::Index> candidates) const {
    std::vector<const expected_error::rows*> parts;
    for (const Eigen::Index candidate : candidates) parts.push_back(&rows_[candidate]);
    return detail::joined(parts, objective_.criterion().coefficients().rows());
  }

  image_objective<Metric, Geometry> objective_;
  std::vector<expected_error::rows> rows_;
  thread_count threads_;
};

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/image_candidates.ipp>
#endif
