#pragma once
/// The prior that ships with gonio, and the option for another.

#include "command.hpp"

#include <filesystem>

namespace cli {

/// The prior that ships with the tool: installed beside it, or in the source tree it was built from.
[[nodiscard]] std::filesystem::path shipped_prior();

/// Adds `--prior FILE` with the shipped prior as the default.
void add_prior_option(command& to, std::filesystem::path& prior);

}  // namespace cli
