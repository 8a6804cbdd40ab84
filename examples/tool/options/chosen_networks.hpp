#pragma once
/// Some networks of a file.

#include <gonio/io/materials/networks.hpp>

#include <string>
#include <vector>

namespace cli {

/// The networks whose names are (or are not) in a list. Throws gonio::error if a listed name does not exist.
[[nodiscard]] gonio::model::named_networks networks_in(const gonio::model::named_networks& all,
                                                       const std::vector<std::string>& names);
[[nodiscard]] gonio::model::named_networks networks_except(const gonio::model::named_networks& all,
                                                           const std::vector<std::string>& names);

}  // namespace cli
