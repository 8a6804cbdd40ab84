#include "thinning.hpp"

#include <gonio/core/error.hpp>

#include <string>

namespace cli {

gonio::valid_cells thinning::of(const gonio::valid_cells& cells) const {
  const gonio::grid_extents extents = cells.grid().extents();
  const auto [theta_d, phi_d] = steps;
  if (extents.theta_d % theta_d != 0 || extents.phi_d % phi_d != 0)
    gonio::refuse("--thin " + std::to_string(theta_d) + " " + std::to_string(phi_d) + " must divide the table's " +
                  std::to_string(extents.theta_d) + " and " + std::to_string(extents.phi_d) + " cells");
  const gonio::grid kept({extents.theta_h, extents.theta_d / theta_d, extents.phi_d / phi_d}, cells.grid().anchor());
  return gonio::valid_cells(kept, cells.minimum_cosine());
}

option add_thin_option(command& to, thinning& thin) {
  return to.add_option("--thin", thin.steps, "Keep every n-th theta_d and every m-th phi_d; 1 1 keeps all")
      .check(check::range(1, 90))
      .default_str(std::to_string(thin.steps.first) + ' ' + std::to_string(thin.steps.second));
}

}  // namespace cli
