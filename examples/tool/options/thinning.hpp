#pragma once
/// Options that reduce the cells of a grid.

#include "command.hpp"
#include <gonio/table/valid_cells.hpp>

#include <utility>

namespace cli {

/// The cells to keep: every n-th theta_d and every m-th phi_d.
struct thinning {
  std::pair<int, int> steps{1, 1};  ///< n and m

  /// Throws gonio::error unless n and m divide the grid's numbers of cells. Odd steps keep cell centres.
  [[nodiscard]] gonio::valid_cells of(const gonio::valid_cells& cells) const;
};

/// Adds `--thin N M`.
option add_thin_option(command& to, thinning& thin);

}  // namespace cli
