#pragma once
/// Files shipped with gonio: the learned prior, sets of directions, descriptions of apparatus. They are installed
/// beside the tool, are in the source tree that it was built from, or are in the program itself (GONIO_EMBED_DATA).
/// A prior or a set of directions may be named `shipped:PATH`, a path in examples/data.

#include "command.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/design/apparatus.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace cli {

/// Returns the path of a file of examples/data: `shipped:NAME` if it is in the program.
[[nodiscard]] std::filesystem::path shipped_file(const std::string& name);

/// Does the path begin with `shipped:`?
[[nodiscard]] bool is_shipped(const std::filesystem::path& path);

/// Returns the bytes of a file, shipped or not. Throws gonio::error that names it.
[[nodiscard]] std::vector<std::byte> read_input(const std::filesystem::path& path);

/// These functions read like those of the same names in gonio::io, but also accept shipped files.
[[nodiscard]] gonio::log_relative_pca read_prior(const std::filesystem::path& path);
[[nodiscard]] std::vector<gonio::half_difference> read_directions(const std::filesystem::path& path,
                                                                  const gonio::io::sample_reading& reading);
[[nodiscard]] std::vector<gonio::direction_pair> read_direction_pairs(const std::filesystem::path& path,
                                                                      const gonio::io::sample_reading& reading);

/// Adds `--prior FILE` with the shipped prior as the default.
void add_prior_option(command& to, std::filesystem::path& prior);

/// Returns the names for --apparatus.
[[nodiscard]] const std::vector<std::string_view>& shipped_apparatus_names();
[[nodiscard]] gonio::design::apparatus shipped_apparatus(const std::string& name);

}  // namespace cli
