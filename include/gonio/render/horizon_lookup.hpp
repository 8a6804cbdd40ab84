#pragma once
/// Look-up in a table for images. Between cells, interpolates f times the cosines of light and viewer instead of f, and
/// divides by the interpolated cosines.
///
/// A cell just above the horizon hardly determines f: in Eq. 1 of Nielsen, Jensen and Ramamoorthi 2015
/// (doi:10.1145/2816795.2818085), an error of epsilon becomes epsilon / (cos theta_i cos theta_o) in f, and an estimate
/// may be ten times too bright. Interpolating f carries this error one cell inwards, where it is visible as a dotted
/// line along the terminator. With cosine weights such a cell counts by the light it reflects.

#include <gonio/core/brdf.hpp>
#include <gonio/table/brdf_table.hpp>

#include <Eigen/Core>

#include <algorithm>

namespace gonio::render {

/// A BRDF in sr^-1; zero below the horizon. It is a view; the table must outlive it.
class horizon_lookup {
 public:
  explicit horizon_lookup(const brdf_table& table) noexcept : table_(&table) {}

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return {0.0, 0.0, 0.0};
    location at = locate(table_->cells(), to_half_difference(wi, wo));
    double sum = 0.0;
    for (Eigen::Index corner = 0; corner < at.count; ++corner) {
      const cosine_pair cosine = cosines(table_->cells().angles(at.cell[corner]));
      at.weight[corner] *= std::max(cosine.i * cosine.o, smallest_weight);
      sum += at.weight[corner];
    }
    return table_->at(at) / sum;
  }

 private:
  /// The smallest weight, for cells on the horizon itself.
  static constexpr double smallest_weight = 1e-9;

  const brdf_table* table_;
};

static_assert(brdf<horizon_lookup>);

}  // namespace gonio::render
