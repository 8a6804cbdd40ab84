#pragma once
/// Materials as networks (Sztrajman et al. 2021, doi:10.1111/cgf.14335, see model/network_brdf.hpp): an .npy array of
/// 675 columns with a row for each material, and a text file with one name per line.

#include <gonio/io/bytes/file.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/model/network_brdf.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

/// Reads one name per line, without surrounding blanks. Throws gonio::error naming an empty or repeated line.
[[nodiscard]] std::vector<std::string> read_names(const std::filesystem::path& path);

/// Reads networks and their names.
[[nodiscard]] model::named_networks read_networks(const std::filesystem::path& path,
                                                  const std::filesystem::path& names_path);

/// Reads networks with the names in `merl_names.txt` beside them.
[[nodiscard]] inline model::named_networks read_networks(const std::filesystem::path& path) {
  return read_networks(path, path.parent_path() / "merl_names.txt");
}

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/networks.ipp>
#endif
