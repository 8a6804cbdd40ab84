#pragma once
/// Ears from which a model is learned, and other ears with holes to recover: the study of "Anatomically correct surface
/// recovery" (Nielsen, doctoral thesis, DTU 2016, contribution C.V, section 4), with synthetic ears.

#include "ear_canal_scans.hpp"
#include <gonio/core/parallel.hpp>
#include <gonio/shape/shape_model.hpp>

#include <Eigen/Core>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace synthetic {

/// The ears of a study. All random numbers derive from the seed.
class ear_study {
 public:
  explicit ear_study(std::uint64_t seed) : seed_(seed) {}

  [[nodiscard]] const ear_canal_template& common() const noexcept { return common_; }

  /// Learns a model from `shapes` ears.
  [[nodiscard]] gonio::shape::shape_model learn(Eigen::Index shapes, gonio::thread_count threads) const {
    std::vector<gonio::shape::point_columns> all;
    std::vector<std::string> names;
    number_source seeds(seed_);
    for (Eigen::Index i = 0; i < shapes; ++i) {
      all.push_back(common_.corresponded(family_.draw(seeds.seed())));
      names.push_back("ear-" + std::to_string(i + 1));
    }
    return gonio::shape::learn_shape_model(all, std::move(names), common_.mesh().triangles, threads);
  }

  /// Returns a scan of an ear that is in no model. Each has its own random source, so the held-out ears do not depend
  /// on the number of learned ears.
  [[nodiscard]] ear_scan held_out(Eigen::Index number, const scan_options& how) const {
    number_source seeds(seed_ + 1'000'003 * (number + 1));
    const std::uint64_t individual = seeds.seed(), scanner = seeds.seed();
    return scan_of(family_.draw(individual), common_, scanner, how);
  }

  /// Returns the template's vertices in the hole of a scan.
  [[nodiscard]] std::vector<Eigen::Index> hole_of(const ear_scan& scan) const {
    std::vector<Eigen::Index> hole;
    for (std::size_t v = 0; v < scan.covered.size(); ++v)
      if (!scan.covered[v] && common_.parameters()(0, v) > 0.1) hole.push_back(v);
    return hole;
  }

 private:
  std::uint64_t seed_;
  ear_canal_family family_;
  ear_canal_template common_;
};

}  // namespace synthetic
