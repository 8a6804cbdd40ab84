#pragma once
/// Selection of networks from a file.

#include <gonio/io/materials/networks.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace cli {

/// Return the networks of a file whose names are (or are not) in a list. Throw gonio::error, which names the file, if a
/// listed name does not exist.
[[nodiscard]] gonio::model::named_networks networks_in(const gonio::model::named_networks& all,
                                                       const std::vector<std::string>& names,
                                                       const std::filesystem::path& file);
[[nodiscard]] gonio::model::named_networks networks_except(const gonio::model::named_networks& all,
                                                           const std::vector<std::string>& names,
                                                           const std::filesystem::path& file);

}  // namespace cli
