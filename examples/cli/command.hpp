#pragma once
/// The subcommands of the `gonio` tool. Each file of this folder holds one and registers it here.

#include <CLI/CLI.hpp>

namespace cli {

void add_learn(CLI::App& app);
void add_expand(CLI::App& app);
void add_design(CLI::App& app);
void add_plan(CLI::App& app);
void add_sample(CLI::App& app);
void add_near_field(CLI::App& app);
void add_reconstruct(CLI::App& app);
void add_fit(CLI::App& app);
void add_compare(CLI::App& app);
void add_render(CLI::App& app);
void add_info(CLI::App& app);
void add_lab(CLI::App& app);
void add_shape(CLI::App& app);
void add_evaluate(CLI::App& app);

}  // namespace cli
