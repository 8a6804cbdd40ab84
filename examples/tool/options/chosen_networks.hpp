#pragma once
/// Selection of networks from a file.

#include <gonio/io/materials/networks.hpp>

#include <string>
#include <vector>

namespace cli {

/// Return the networks whose names are (or are not) in a list. Throw gonio::error if a listed name does not exist.
[[nodiscard]] gonio::model::named_networks networks_in(const gonio::model::named_networks& all,
                                                       const std::vector<std::string>& names);
[[nodiscard]] gonio::model::named_networks networks_except(const gonio::model::named_networks& all,
                                                           const std::vector<std::string>& names);

}  // namespace cli
