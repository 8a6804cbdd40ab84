#include "shipped_data.hpp"

#include "built_in_files.hpp"
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/setups/apparatus.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <span>

namespace cli {

namespace {

constexpr std::string_view prefix = "shipped:";

/// Returns the file's path in the installed folder share/gonio or, if it is not there, in the source tree.
std::filesystem::path file_beside_tool(const std::string& name) {
  std::error_code ignored;
  const auto tool = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const auto installed = tool.parent_path().parent_path() / "share/gonio" / name;
  return std::filesystem::exists(installed, ignored) ? installed : std::filesystem::path(GONIO_SOURCE_DATA) / name;
}

/// Throws gonio::error that lists the files in the program if none has this name.
std::span<const std::byte> built_in_bytes(std::string_view name) {
  std::vector<std::string_view> names;
  for (const built_in_file& file : built_in_files()) {
    if (file.name == name) return file.bytes;
    names.push_back(file.name);
  }
  gonio::refuse({prefix, name, ": there is no such file; there are ", gonio::io::listed(names, ", ")});
}

}  // namespace

std::filesystem::path shipped_file(const std::string& name) {
  return built_in_files().empty() ? file_beside_tool(name) : std::filesystem::path(std::string(prefix) + name);
}

bool is_shipped(const std::filesystem::path& path) { return path.string().starts_with(prefix); }

std::vector<std::byte> read_input(const std::filesystem::path& path) {
  if (!is_shipped(path)) return gonio::io::read_bytes(path);
  const std::string name = path.string().substr(prefix.size());
  if (built_in_files().empty()) return gonio::io::read_bytes(file_beside_tool(name));
  const auto bytes = built_in_bytes(name);
  return {bytes.begin(), bytes.end()};
}

gonio::log_relative_pca read_prior(const std::filesystem::path& path) {
  return gonio::io::read_prior(read_input(path), path.string());
}

std::vector<gonio::half_difference> read_directions(const std::filesystem::path& path,
                                                    const gonio::io::sample_reading& reading) {
  const auto bytes = read_input(path);
  return gonio::io::read_directions(gonio::io::as_text(bytes), path.string(), reading);
}

std::vector<gonio::direction_pair> read_direction_pairs(const std::filesystem::path& path,
                                                        const gonio::io::sample_reading& reading) {
  const auto bytes = read_input(path);
  return gonio::io::read_direction_pairs(gonio::io::as_text(bytes), path.string(), reading);
}

void add_prior_option(command& to, std::filesystem::path& prior) {
  prior = shipped_file("materials.prior");
  to.add_input("--prior", prior, "Learned prior (default: the one shipped with gonio)");
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
  const auto file = shipped_file("apparatus/" + name + ".txt");
  const auto bytes = read_input(file);
  return gonio::io::read_apparatus(gonio::io::as_text(bytes), file.string());
}

}  // namespace cli
