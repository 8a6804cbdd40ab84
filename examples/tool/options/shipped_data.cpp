#include "shipped_data.hpp"

#include <gonio/io/setups/apparatus.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>

namespace cli {

std::filesystem::path shipped_file(const std::filesystem::path& name) {
  std::error_code ignored;
  const auto tool = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const auto installed = tool.parent_path().parent_path() / "share/gonio" / name;
  return std::filesystem::exists(installed, ignored) ? installed : std::filesystem::path(GONIO_SOURCE_DATA) / name;
}

void add_prior_option(command& to, std::filesystem::path& prior) {
  prior = shipped_file("materials.prior");
  to.add_input("--prior", prior, "The learned prior (default: the one shipped with gonio)");
}

const std::vector<std::string_view>& shipped_apparatus_names() {
  static const std::vector<std::string_view> names{"in-plane-arm",  "three-axis-goniometer", "robot",
                                                   "by-hand",       "near-field-tablet",     "multi-angle-3",
                                                   "multi-angle-5", "multi-angle-6"};
  return names;
}

gonio::design::apparatus shipped_apparatus(const std::string& name) {
  const std::vector<std::string_view>& names = shipped_apparatus_names();
  if (std::ranges::find(names, name) == names.end())
    gonio::refuse("--apparatus " + name + ": expected one of " + gonio::io::listed(names, ", "));
  return gonio::io::read_apparatus(shipped_file("apparatus") / (name + ".txt"));
}

}  // namespace cli
