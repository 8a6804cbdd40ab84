#pragma once
/// The kinds of files that the tool reads or writes: what each is recognised by, and what can be said of one.

#include "command_line/json.hpp"
#include <gonio/basis/pca.hpp>
#include <gonio/table/brdf_table.hpp>

#include <cstdint>
#include <filesystem>
#include <string>

namespace cli {

/// What a file is recognised by.
struct file_look {
  explicit file_look(const std::filesystem::path& of);

  std::filesystem::path path;
  std::string extension;  ///< with the dot, in lower case
  std::string start;      ///< the first 4096 bytes
  std::uintmax_t size = 0;
};

/// A kind of file.
struct file_kind {
  bool (*recognises)(const file_look& file);
  /// The key `kind`, and what else there is to say.
  json (*describe)(const std::filesystem::path& path);
};

/// Of which kind a file is. Throws gonio::error if none recognises it, or it cannot be read.
[[nodiscard]] const file_kind& file_kind_of(const std::filesystem::path& path);

/// What `gonio info` says of a prior.
[[nodiscard]] json describe(const gonio::log_relative_pca& prior);

}  // namespace cli
