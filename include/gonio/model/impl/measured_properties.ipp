#pragma once
/// Bodies of model/measured_properties.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/core/turned_pair.hpp>
#include <gonio/model/measured_properties.hpp>
#include <gonio/model/physical_properties.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace gonio::model::detail {

[[nodiscard]] GONIO_INLINE bool same_directions(const direction_pair& a, const direction_pair& b, double tolerance) {
  return angle_between(a.wi, b.wi) <= tolerance && angle_between(a.wo, b.wo) <= tolerance;
}

/// Returns the rotation about the normal between two pairs in radians, measured at the light or the viewer, whichever
/// is farther from the normal.
[[nodiscard]] GONIO_INLINE double turn_between(const direction_pair& a, const direction_pair& b) {
  const bool by_light = a.wi.z() < a.wo.z();
  return std::abs(
      std::remainder(azimuth(by_light ? a.wi : a.wo) - azimuth(by_light ? b.wi : b.wo), 2.0 * std::numbers::pi));
}

/// Returns true if all half vectors have azimuth 0, as in files that have only half and difference angles.
[[nodiscard]] GONIO_INLINE bool lacks_azimuths(const sample_set& samples) {
  constexpr double rounding = 1e-9;
  return std::ranges::all_of(samples, [](const sample& s) {
    const direction_pair& pair = s.directions.pair();
    return std::abs(pair.wi.y() + pair.wo.y()) <= rounding && pair.wi.x() + pair.wo.x() >= -rounding;
  });
}

/// Samples sorted into boxes of polar angles as wide as the tolerance. Samples that agree are in neighbouring boxes.
class boxed_samples {
 public:
  boxed_samples(const sample_set& samples, double tolerance) : tolerance_(tolerance) {
    for (const sample& s : samples) {
      pairs_.emplace_back(s.directions.pair());
      boxes_.emplace_back(box_of(pairs_.back(), 0, 0), std::ssize(boxes_));
    }
    std::ranges::sort(boxes_);
  }

  [[nodiscard]] const turned_pair& operator[](Eigen::Index i) const { return pairs_[i]; }

  /// Calls `visit(j)` for the samples j > i in the boxes around a pair, until it returns false.
  template <class Visit>
  void around(const turned_pair& pair, Eigen::Index i, Visit&& visit) const {
    for (const int further_i : {-1, 0, 1})
      for (const int further_o : {-1, 0, 1}) {
        const std::uint64_t box = box_of(pair, further_i, further_o);
        for (auto at = std::ranges::lower_bound(boxes_, std::pair{box, i + 1}); at != boxes_.end() && at->first == box;
             ++at)
          if (!visit(at->second)) return;
      }
  }

 private:
  /// Returns the key of a box, given by its offset from the box of a pair. Polar angles are below pi/2; boxes count
  /// from 1.
  [[nodiscard]] std::uint64_t box_of(const turned_pair& pair, int further_i, int further_o) const {
    const auto along = [&](double theta, int further) {
      return static_cast<std::uint64_t>(static_cast<std::int64_t>(theta / tolerance_) + 1 + further);
    };
    return (along(pair.theta_i, further_i) << 32U) | along(pair.theta_o, further_o);
  }

  double tolerance_;
  std::vector<turned_pair> pairs_;
  std::vector<std::pair<std::uint64_t, Eigen::Index>> boxes_;
};

/// Collects the differences between pairs of samples.
class pair_differences {
 public:
  void add(const sample_set& samples, Eigen::Index first, Eigen::Index second) {
    const double difference = relative_difference(samples[first].value, samples[second].value);
    if (all_.empty() || difference > found_.worst) {
      found_.worst = difference;
      found_.first = first;
      found_.second = second;
    }
    all_.push_back(difference);
  }

  [[nodiscard]] equal_samples result() const {
    equal_samples all = found_;
    all.pairs = std::ssize(all_);
    if (!all_.empty()) all.median = median(std::vector(all_));
    return all;
  }

 private:
  equal_samples found_;
  std::vector<double> all_;
};

/// Returns the mean of a row of cells over phi_d.
[[nodiscard]] GONIO_INLINE rgb mean_over_phi_d(const brdf_table& table, Eigen::Index row) {
  rgb sum = rgb::Zero();
  const Eigen::Index begin = table.cells().row_begin(row), end = table.cells().row_begin(row + 1);
  for (Eigen::Index cell = begin; cell < end; ++cell) sum += table.at(cell);
  return sum / static_cast<double>(end - begin);
}

}  // namespace gonio::model::detail

namespace gonio::model {

GONIO_INLINE table_values summarise(const brdf_table& table) {
  table_values found{table.at(0), rgb::Zero(), table.at(0)};
  double lowest = found.minimum.minCoeff();
  for (Eigen::Index cell = 0; cell < table.cells().size(); ++cell) {
    const rgb value = table.at(cell);
    found.minimum = found.minimum.min(value);
    found.maximum = found.maximum.max(value);
    found.mean += value;
    if ((value < 0.0).any()) ++found.negative_cells;
    if (value.minCoeff() < lowest) {
      lowest = value.minCoeff();
      found.lowest_cell = cell;
    }
  }
  found.mean /= static_cast<double>(table.cells().size());
  return found;
}

GONIO_INLINE tail_rise largest_tail_rise(const brdf_table& table) {
  constexpr double dark = 0.001, widest = radians(70.0);
  const grid& over = table.cells().grid();
  const auto [heights, rows, columns] = over.extents();
  tail_rise found;
  for (int d = 0; d < rows; ++d) {
    std::vector<rgb> curve;
    for (int h = 0; h < heights && over.theta_h(h) + over.theta_d(d) <= widest; ++h)
      curve.push_back(detail::mean_over_phi_d(table, Eigen::Index{h} * rows + d));
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto channel = [c](const rgb& value) { return value[c]; };
      const auto peak = std::ranges::max_element(curve, {}, channel);
      double least = peak == curve.end() ? 0.0 : channel(*peak);
      for (auto at = peak; at != curve.end(); ++at) {
        least = std::min(least, channel(*at));
        const double rise = (channel(*at) - least) / (std::max(least, 0.0) + dark);
        if (rise > found.amount)
          found = {rise, over.theta_h(static_cast<double>(at - curve.begin())), over.theta_d(d), c};
      }
    }
  }
  return found;
}

GONIO_INLINE sample_symmetries compare_equal_samples(const sample_set& samples, double tolerance) {
  require_usable(samples);
  if (!(tolerance > 0.0 && tolerance <= 0.1))
    refuse({"the tolerance of equal directions must be above 0 and at most 0.1 radians, not ", tolerance});
  constexpr int most_partners = 100;
  constexpr double least_turn = 10.0;
  const bool has_azimuths = !detail::lacks_azimuths(samples);
  const detail::boxed_samples boxed(samples, tolerance);
  detail::pair_differences repeated, turned, reciprocal;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    const turned_pair &here = boxed[i], swapped = here.swapped();
    int partners = 0;
    boxed.around(here, i, [&](Eigen::Index j) {
      if (!boxed[j].agrees(here, tolerance)) return true;
      const direction_pair &one = samples[i].directions.pair(), &other = samples[j].directions.pair();
      if (detail::same_directions(one, other, tolerance))
        repeated.add(samples, i, j);
      else if (has_azimuths && detail::turn_between(one, other) > least_turn * tolerance)
        turned.add(samples, i, j);
      else
        return true;
      return ++partners < most_partners;
    });
    partners = 0;
    boxed.around(swapped, i, [&](Eigen::Index j) {
      if (!boxed[j].agrees(swapped, tolerance) || boxed[j].agrees(here, tolerance)) return true;
      reciprocal.add(samples, i, j);
      return ++partners < most_partners;
    });
  }
  return {repeated.result(), turned.result(), reciprocal.result()};
}

}  // namespace gonio::model
