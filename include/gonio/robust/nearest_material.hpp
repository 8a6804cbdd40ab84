#pragma once
/// Finds the measured material nearest to measurements, even if most of them are outliers: a robust start for other
/// estimators. Outliers distort a linear combination of materials, but a single material times a factor cannot follow
/// them.

#include <gonio/basis/measured.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/outlier_mixture.hpp>
#include <gonio/estimate/scaled_likelihood.hpp>
#include <gonio/interpolate/completed_table.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <utility>
#include <vector>

namespace gonio {

struct scaled_material {
  Eigen::Index material = 0;
  double factor = 1.0;
};

/// For each colour channel, finds the material and its factor under which the measurements are most likely a mixture of
/// inliers and outliers (estimate/outlier_mixture.hpp). The search has two stages: 1,500 random samples select twenty
/// materials, and 20,000 samples select one of the twenty. A few samples exclude most materials, but distinguishing
/// similar materials takes thousands if four of five samples are outliers. O(materials + n) for n samples.
template <error_metric Metric>
class nearest_material {
 public:
  explicit nearest_material(measured<Metric> materials, std::uint64_t seed = 0, thread_count threads = {})
      : materials_(std::move(materials)), seed_(seed), threads_(threads) {}

  /// Returns the nearest material of each channel, given samples in three channels.
  [[nodiscard]] std::array<scaled_material, 3> choose(const located_samples& samples) const {
    const located_samples few = samples.subset(random_choice(samples.size(), 1'500, seed_));
    const located_samples many = samples.subset(random_choice(samples.size(), 20'000, seed_));
    std::array<scaled_material, 3> chosen;
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double* values = &samples.values(0, c);
      const double offset = logarithm_offset({values, values + samples.size()});
      chosen[c] = choose(evidence(few, c, offset), evidence(many, c, offset), c);
    }
    return chosen;
  }

  /// Returns a table of the chosen materials, one for each channel, times their factors. Throws gonio::error for
  /// unusable samples.
  template <class Samples>
  [[nodiscard]] completed_table fit(const Samples& samples) const {
    const auto chosen = choose(in_colours(locate_samples(materials_.cells(), samples, threads_)));
    const valid_cells& cells = materials_.cells();
    std::vector<location> locations(cells.size());
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell) locations[cell] = locate_cell(cells, cell);
    const channel_values found = values(chosen, locations);
    return completed_table(brdf_table(cells, std::vector<float>(found.data(), found.data() + found.size())));
  }

  /// Returns the reflectance of the chosen materials at n locations on their cells, 3 x n.
  [[nodiscard]] channel_values values(const std::array<scaled_material, 3>& chosen,
                                      const std::vector<location>& locations) const {
    // A factor from a few bright samples may exceed the range of float.
    constexpr double largest = std::numeric_limits<float>::max();
    channel_values found(3, std::ssize(locations));
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto functions = materials_.channel(c);
      for (Eigen::Index i = 0; i < std::ssize(locations); ++i)
        found(c, i) = static_cast<float>(
            std::min(chosen[c].factor * reflectance(functions, chosen[c].material, locations[i]), largest));
    }
    return found;
  }

 private:
  /// Returns the reflectance of a material at a location, at least zero.
  [[nodiscard]] double reflectance(const material_channel<Metric>& functions, Eigen::Index material,
                                   const location& at) const {
    const double mapped = interpolate(
        at, [&](Eigen::Index cell) { return double{functions.row(cell)[material]}; }, 0.0);
    return reflectance_of(materials_.metric(), mapped, at);
  }

  /// The logarithms of one channel's samples, and the density of outliers at each.
  struct evidence {
    evidence(const located_samples& samples, Eigen::Index channel, double offset_of_logarithm)
        : locations(&samples.locations), offset(offset_of_logarithm) {
      for (Eigen::Index i = 0; i < samples.size(); ++i)
        logarithms.push_back(std::max(samples.values(i, channel), 0.0) + offset);
      take_logarithms(logarithms.data(), samples.size());
      const outlier_density density(logarithms);
      for (const double value : logarithms) outliers.push_back(density(value));
    }

    const std::vector<location>* locations;  // the three channels have the same locations
    double offset;
    std::vector<double> logarithms, outliers;
  };

  struct candidate {
    Eigen::Index material = 0;
    detail::scaled_likelihood found;
  };

  /// Returns the logarithms of measurements minus those of a material.
  [[nodiscard]] std::vector<double> differences(const evidence& seen, const material_channel<Metric>& functions,
                                                Eigen::Index material) const {
    std::vector<double> values(seen.logarithms);
    for (Eigen::Index i = 0; i < std::ssize(*seen.locations); ++i)
      values[i] -= std::log(reflectance(functions, material, (*seen.locations)[i]) + seen.offset);
    return values;
  }

  [[nodiscard]] scaled_material choose(const evidence& few, const evidence& many, Eigen::Index channel) const {
    const auto functions = materials_.channel(channel);
    std::vector<candidate> candidates;
    for (const Eigen::Index column : columns_of(materials_)) candidates.push_back({column, {}});
    const auto for_each_candidate = [&](const auto& body) {
      for_each_block(
          candidates.size(), 1, [&](block one) { body(candidates[one.begin]); }, threads_);
    };
    for_each_candidate([&](candidate& each) {
      each.found = detail::best_factor(differences(few, functions, each.material), few.outliers);
    });
    constexpr Eigen::Index shortlist = 20;
    const auto likelihood = [](const candidate& each) { return each.found.log_likelihood; };
    std::ranges::sort(candidates, std::greater{}, likelihood);
    candidates.resize(std::min(std::ssize(candidates), shortlist));
    for_each_candidate([&](candidate& each) {
      each.found = detail::locate_mixture(differences(many, functions, each.material), many.outliers,
                                          each.found.logarithm_of_factor);
    });
    const candidate best = *std::ranges::max_element(candidates, {}, likelihood);
    return {best.material, std::exp(best.found.logarithm_of_factor)};
  }

  measured<Metric> materials_;
  std::uint64_t seed_;
  thread_count threads_;
};

}  // namespace gonio
