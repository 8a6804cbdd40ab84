#include "prior_option.hpp"

namespace cli {

std::filesystem::path shipped_prior() {
  std::error_code ignored;
  const auto tool = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const auto installed = tool.parent_path().parent_path() / "share/gonio/materials.prior";
  return std::filesystem::exists(installed, ignored) ? installed : std::filesystem::path(GONIO_SOURCE_PRIOR);
}

void add_prior_option(command& to, std::filesystem::path& prior) {
  prior = shipped_prior();
  to.add_input("--prior", prior, "The learned prior (default: the one shipped with gonio)");
}

}  // namespace cli
