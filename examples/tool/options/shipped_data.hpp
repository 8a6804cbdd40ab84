#pragma once
/// Files shipped with gonio: the prior, descriptions of apparatus.

#include "command.hpp"
#include <gonio/design/apparatus.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace cli {

/// Returns a file of examples/data: installed beside the tool, or in the source tree of the build.
[[nodiscard]] std::filesystem::path shipped_file(const std::filesystem::path& name);

/// Adds `--prior FILE` with the shipped prior as the default.
void add_prior_option(command& to, std::filesystem::path& prior);

/// Returns the names for --apparatus.
[[nodiscard]] const std::vector<std::string_view>& shipped_apparatus_names();
[[nodiscard]] gonio::design::apparatus shipped_apparatus(const std::string& name);

}  // namespace cli
