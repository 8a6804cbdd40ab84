#include "prior_material.hpp"

#include <algorithm>

namespace cli {

Eigen::Index material_number(const gonio::log_relative_pca& prior, const std::string& name,
                             const std::filesystem::path& file) {
  const auto found = std::ranges::find(prior.names(), name);
  if (found == prior.names().end()) gonio::refuse(file.string() + ": there is no material named '" + name + "'");
  return found - prior.names().begin();
}

}  // namespace cli
