#pragma once
/// Bodies of estimate/mirror_envelope.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/estimate/mirror_envelope.hpp>

#include <cmath>
#include <cstddef>

namespace gonio {

GONIO_INLINE double brightness(const channels& kinds, const Eigen::ArrayXd& values) {
  if (!kinds.have_colour()) return values.mean();
  return luminance(kinds.colour({values.data(), static_cast<std::size_t>(values.size())}));
}

namespace detail {

/// Fills the dips of a table. In `values`, the channels of a cell are adjacent.
GONIO_INLINE void fill_mirror_dips(const valid_cells& cells, float* values, const channels& kinds,
                                   thread_count threads) {
  const grid& all = cells.grid();
  const Eigen::Index size = kinds.size();
  const auto rows = static_cast<int>(std::ceil(all.theta_h_coordinate(mirror_envelope<Eigen::ArrayXd>::theta_h)));
  const auto fill = [&](int theta_d, int phi_d) {
    mirror_envelope<Eigen::ArrayXd> envelope(all.theta_d(theta_d));
    for (int theta_h = std::min(rows, all.extents().theta_h) - 1; theta_h >= 0; --theta_h) {
      const Eigen::Index cell = all.linear({theta_h, theta_d, phi_d});
      if (!cells.contains(cell)) continue;
      Eigen::Map<Eigen::ArrayXf> here(values + size * cells.representative(cell), size);
      const Eigen::ArrayXd value = here.cast<double>();
      here = envelope.next(value, brightness(kinds, value)).cast<float>();
    }
  };
  for_each_index(
      all.extents().theta_d, 1,
      [&](Eigen::Index theta_d) {
        if (mirror_envelope<Eigen::ArrayXd>::share_at(all.theta_d(static_cast<int>(theta_d))) == 0.0) return;
        for (int phi_d = 0; phi_d < all.extents().phi_d; ++phi_d) fill(static_cast<int>(theta_d), phi_d);
      },
      threads);
}

}  // namespace detail

GONIO_INLINE void fill_mirror_dips(brdf_table& table, thread_count threads) {
  detail::fill_mirror_dips(table.cells(), table.values().data(), {}, threads);
}

GONIO_INLINE void fill_mirror_dips(spectral_table& table, const channels& kinds, thread_count threads) {
  detail::fill_mirror_dips(table.cells(), table.values().data(), kinds, threads);
}

}  // namespace gonio
