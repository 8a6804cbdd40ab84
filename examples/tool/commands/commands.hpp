#pragma once
/// The subcommands of the `gonio` tool. Each file of this folder registers one.

#include "tool/options/command.hpp"
#include "tool/options/team.hpp"

#include <string>
#include <vector>

namespace cli {

void add_expand(command& app);
void add_plan(command& app);
void add_sample(command& app);
void add_near_field(command& app);
void add_sphere(command& app);
/// `words` is the whole command line, which pages for people repeat. `processes` must outlive the program's run.
void add_reconstruct(command& app, const std::vector<std::string>& words);
void add_report(command& app, const std::vector<std::string>& words);
void add_check(command& app, const std::vector<std::string>& words);
void add_fit(command& app, const std::vector<std::string>& words);
void add_design(command& app, const std::vector<std::string>& words, const team& processes);
void add_learn(command& app, const team& processes);
void add_svbrdf(command& app, const team& processes);
void add_texels(command& app);
void add_compare(command& app);
void add_convert(command& app);
void add_render(command& app);
void add_info(command& app);
void add_properties(command& app);
void add_lab(command& app);
void add_shape(command& app);

}  // namespace cli
