#include "declared_files.hpp"

#include "tool/files/file_start.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>

#include <algorithm>
#include <system_error>
#include <utility>

namespace cli {

namespace {

namespace fs = std::filesystem;

/// Returns the path with links resolved, whether or not the file exists.
fs::path resolved(const fs::path& path) {
  std::error_code failed;
  const fs::path whole = fs::absolute(gonio::io::follow_links(path), failed);
  const fs::path known = fs::weakly_canonical(whole, failed);
  return failed ? whole.lexically_normal() : known;
}

bool is_same_file(const fs::path& one, const fs::path& other) {
  std::error_code absent;
  return fs::equivalent(one, other, absent) || resolved(one) == resolved(other);
}

/// Ignores case.
bool has_extension(const fs::path& path, const std::vector<std::string>& extensions) {
  return std::ranges::find(extensions, lower_extension(path)) != extensions.end();
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " or ") + word;
  return text;
}

/// Refuses a directory, and a path whose folder does not exist: before hours of work, not after.
void require_place(const std::string& option, const fs::path& path) {
  const fs::path folder = gonio::io::follow_links(path).parent_path();
  std::error_code failed;
  if (fs::is_directory(path, failed)) gonio::refuse({option, " ", path.native(), ": is a directory"});
  if (folder.empty() || fs::is_directory(folder, failed)) return;
  gonio::refuse({option, " ", path.native(), ": cannot be written: there is no folder '", folder.native(), "'"});
}

}  // namespace

void declared_files::add_input(std::string option, paths given) {
  read_.push_back({std::move(option), std::move(given), {}, false});
}

void declared_files::add_input_folder(std::string option, paths given, std::vector<std::string> extensions) {
  read_.push_back({std::move(option), std::move(given), std::move(extensions), true});
}

void declared_files::add_output(std::string option, paths given, std::vector<std::string> extensions) {
  written_.push_back({std::move(option), std::move(given), std::move(extensions), false});
}

void declared_files::add_output_folder(std::string option, paths given, std::vector<std::string> names) {
  written_.push_back({std::move(option), std::move(given), std::move(names), true});
}

void declared_files::require_writable() const {
  const std::vector<output> all = outputs();
  for (std::size_t i = 0; i < all.size(); ++i) {
    require_not_read(all[i]);
    for (std::size_t j = 0; j < i; ++j)
      if (is_same_file(all[i].path, all[j].path))
        gonio::refuse({all[i].option, " ", all[i].path.native(), ": is also written by ", all[j].option});
  }
}

void declared_files::require_writable(const fs::path& derived) const { require_not_read({"output", derived}); }

std::vector<declared_files::output> declared_files::outputs() const {
  std::vector<output> all;
  for (const declaration& each : written_)
    for (const fs::path& path : each.given()) {
      if (path.empty()) continue;
      if (each.is_folder) {
        for (const std::string& name : each.names) all.push_back({each.option, path / name});
        continue;
      }
      if (!each.names.empty() && !has_extension(path, each.names))
        gonio::refuse({each.option, " ", path.native(), ": expected a name that ends in ", listed(each.names)});
      require_place(each.option, path);
      all.push_back({each.option, path});
    }
  return all;
}

void declared_files::require_not_read(const output& written) const {
  for (const declaration& each : read_)
    for (const fs::path& path : each.given()) {
      if (path.empty()) continue;
      const bool is_read = each.is_folder ? has_extension(written.path, each.names) &&
                                                is_same_file(resolved(written.path).parent_path(), path)
                                          : is_same_file(written.path, path);
      if (is_read)
        gonio::refuse({written.option, " ", written.path.native(), ": would overwrite the input ", each.option,
                       ": give another name"});
    }
}

}  // namespace cli
