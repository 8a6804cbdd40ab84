#pragma once
/// gonio-papers figures: the figures of Nielsen et al. 2015 and Xu et al. 2016 as tables, one function each.

#include "papers/experiments.hpp"
#include "papers/networks_option.hpp"
#include "papers/xu2016/mapped_errors.hpp"
#include "tool/files/json.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/design/exhaustive_search.hpp>
#include <gonio/design/expected_error.hpp>
#include <gonio/design/sphere_geometry.hpp>
#include <gonio/io/materials/networks.hpp>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace papers::figures {

struct options {
  studied_networks networks;
  std::filesystem::path measured_tables, spheres;       ///< spheres: an image to write
  std::vector<std::filesystem::path> measured_samples;  ///< measured samples
  Eigen::Index most = 0;                                ///< number of measurements; 0: as in the figure
  Eigen::Index repetitions = 5, random_sets = 20;
  double eta = 40.0, step = 10.0;
  std::vector<double> fields_of_view{15.0, 25.0, 35.0, 45.0};
  std::vector<Eigen::Index> components;  ///< numbers of components in a sweep; empty: as in the figure
  gonio::cosine_weighting weighting = gonio::cosine_weighting::product;
  std::uint64_t seed = 0;
  gonio::thread_count threads;

  /// Returns the numbers of components to sweep that are below `all`.
  [[nodiscard]] std::vector<Eigen::Index> swept_components(std::vector<Eigen::Index> of_figure,
                                                           Eigen::Index all) const {
    std::vector<Eigen::Index> swept = components.empty() ? std::move(of_figure) : components;
    std::erase_if(swept, [&](Eigen::Index k) { return k >= all; });
    return swept;
  }

  [[nodiscard]] std::size_t up_to(std::size_t most_of_figure) const noexcept {
    return most > 0 ? most : most_of_figure;
  }
};

/// A printed table. Cells are words or numbers; null is an empty cell.
struct table {
  struct column {
    std::string title;
    int digits = 3;
  };
  std::string title;
  std::vector<column> columns;
  std::vector<std::vector<json>> rows = {};
};
using tables = std::vector<table>;

/// The learned prior with all components, and the errors on the tested materials.
struct laboratory {
  mapped_errors tested;

  [[nodiscard]] const gonio::log_relative_pca& prior() const noexcept { return tested.prior(); }

  /// Returns the error of reconstructions from measurements in these directions: the mean over the tested materials and
  /// channels.
  [[nodiscard]] double error(std::span<const gonio::half_difference> directions) const {
    return tested.from(directions).mean();
  }

  /// Converts E of Xu et al. 2016, Eq. 15, to a root mean square over the cells.
  [[nodiscard]] double expected(double value) const {
    return value / std::sqrt(static_cast<double>(prior().cells().size()));
  }
};

/// Learns the 90 materials of Nielsen et al. 2015, or the given ones, and tests the ten other materials.
[[nodiscard]] laboratory open_laboratory(const options& given, const gonio::progress& listener);
[[nodiscard]] laboratory open_laboratory(const options& given, const gonio::model::named_networks& learned,
                                         const gonio::progress& listener);

/// Returns E of Xu et al. 2016, with the full prior and the given penalty.
[[nodiscard]] gonio::design::expected_error criterion_of(const laboratory& lab, const options& given);

/// Returns E of a set of points as a root mean square over the cells.
[[nodiscard]] double expected_of(const laboratory& lab, const options& given,
                                 const std::vector<gonio::half_difference>& directions);

/// The field of view of most near-field figures, in degrees.
inline constexpr double figures_field_of_view = 25.0;

/// Returns light and camera of the images in a named set that ships with the tool.
[[nodiscard]] std::vector<gonio::direction_pair> shipped_poses(const std::string& name);

/// Returns all samples of images with a 25 degree field of view. `poses` are light and camera seen from each image's
/// centre.
[[nodiscard]] std::vector<gonio::half_difference> samples_of_images(const std::vector<gonio::direction_pair>& poses);

/// The two images with a fixed camera (Fig. 14 a) and with a fixed light (Fig. 14 b), as Xu et al. 2016 print them.
[[nodiscard]] std::vector<gonio::direction_pair> printed_fixed_camera();
[[nodiscard]] std::vector<gonio::direction_pair> printed_fixed_light();

/// Returns the slices of a set of spheres: `published` in Nielsen et al. 2015, Table 2, or a set that ships with the
/// tool. Returns none if there is no set of that size.
[[nodiscard]] std::vector<Eigen::Index> sphere_slices(const gonio::design::sphere_geometry& spheres,
                                                      const std::string& set, Eigen::Index n);

template <gonio::design::capture_geometry Geometry>
[[nodiscard]] std::vector<gonio::half_difference> samples_of(const Geometry& geometry,
                                                             const std::vector<Eigen::Index>& candidates) {
  std::vector<gonio::half_difference> samples;
  for (const Eigen::Index candidate : candidates) {
    const auto more = geometry.directions(candidate);
    samples.insert(samples.end(), more.begin(), more.end());
  }
  return samples;
}

/// Returns the best plans of 1 to `most` measurements. Each adds the best candidate to the previous plan, exchanges its
/// candidates if they are at most `exchanged`, and moves them along the grid.
template <gonio::design::sweeping_objective Objective>
[[nodiscard]] std::vector<gonio::design::capture_plan> best_plans(const Objective& objective, std::size_t most,
                                                                  std::size_t exchanged, std::uint64_t seed,
                                                                  const gonio::progress& listener) {
  std::vector<gonio::design::capture_plan> plans;
  gonio::design::capture_plan grown;
  for (std::size_t n = 1; n <= most; ++n) {
    grown = gonio::design::grow_greedily(objective, n, std::move(grown), listener);
    const gonio::design::capture_plan start =
        n <= exchanged ? gonio::design::exchange(objective, grown, listener) : grown;
    plans.push_back(gonio::design::descend(objective.geometry(), objective, start, seed));
  }
  return plans;
}

/// Tabulates paints reconstructed from simulated images of a sphere, with errors on the measurements that were not
/// used.
[[nodiscard]] table paints_from_spheres(const options& given, const gonio::log_relative_pca& prior);

[[nodiscard]] tables nielsen_2(const options& given, const gonio::progress& listener);
[[nodiscard]] tables nielsen_5(const options& given, const gonio::progress& listener);
[[nodiscard]] tables nielsen_6(const options& given, const gonio::progress& listener);
[[nodiscard]] tables nielsen_7(const options& given, const gonio::progress& listener);
[[nodiscard]] tables nielsen_10(const options& given, const gonio::progress& listener);
[[nodiscard]] tables nielsen_11(const options& given, const gonio::progress& listener);
[[nodiscard]] tables nielsen_12(const options& given, const gonio::progress& listener);
[[nodiscard]] tables nielsen_penalties(const options& given, const gonio::progress& listener);
[[nodiscard]] tables nielsen_table_1(const options& given, const gonio::progress& listener);
[[nodiscard]] tables nielsen_table_2(const options& given, const gonio::progress& listener);
[[nodiscard]] tables nielsen_8(const options& given, const gonio::progress& listener);
[[nodiscard]] tables nielsen_9(const options& given, const gonio::progress& listener);
[[nodiscard]] tables xu_2(const options& given, const gonio::progress& listener);
[[nodiscard]] tables xu_3(const options& given, const gonio::progress& listener);
[[nodiscard]] tables xu_5(const options& given, const gonio::progress& listener);
[[nodiscard]] tables xu_6(const options& given, const gonio::progress& listener);
[[nodiscard]] tables xu_7(const options& given, const gonio::progress& listener);
[[nodiscard]] tables xu_8(const options& given, const gonio::progress& listener);
[[nodiscard]] tables xu_13(const options& given, const gonio::progress& listener);
[[nodiscard]] tables xu_15(const options& given, const gonio::progress& listener);
[[nodiscard]] tables xu_17(const options& given, const gonio::progress& listener);
[[nodiscard]] tables xu_19(const options& given, const gonio::progress& listener);

}  // namespace papers::figures
