#pragma once
/// What several subcommands read and print.

#include <gonio/evaluate/comparison.hpp>
#include <gonio/io/merl_gzip.hpp>
#include <gonio/io/networks.hpp>
#include <gonio/io/prior.hpp>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace cli {

using json = nlohmann::ordered_json;

/// The prior that ships with the tool: installed beside it, or in the source tree it was built from.
[[nodiscard]] std::filesystem::path shipped_prior();

/// Adds `--prior FILE` with the shipped prior as the default.
void add_prior_option(CLI::App& command, std::filesystem::path& prior);

/// Adds `--threads N`.
void add_threads_option(CLI::App& command, gonio::thread_count& threads);

/// Three numbers as an array.
[[nodiscard]] json per_channel(const gonio::rgb& values);

/// The keys that `gonio compare --json` documents.
[[nodiscard]] json to_json(const gonio::comparison& errors);

/// A number in a table for people.
[[nodiscard]] std::string fixed(double value, int digits);

/// The networks whose names are (or are not) in a list. Throws gonio::error if a listed name does not exist.
[[nodiscard]] gonio::named_networks networks_in(const gonio::named_networks& all,
                                                const std::vector<std::string>& names);
[[nodiscard]] gonio::named_networks networks_except(const gonio::named_networks& all,
                                                    const std::vector<std::string>& names);

}  // namespace cli
