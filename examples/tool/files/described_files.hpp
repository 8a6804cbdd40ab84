#pragma once
/// The descriptions of `gonio info` for each kind of file that the tool reads or writes.

#include "json.hpp"
#include "measurement_files.hpp"
#include <gonio/basis/pca.hpp>

#include <filesystem>

namespace cli {

/// Returns the key `kind` and other facts; reads samples with the given options. Throws gonio::error for an unknown
/// kind, and if the kind's reader refuses the file.
[[nodiscard]] json describe_file(const std::filesystem::path& path, const measurement_options& reading);

/// Describes a prior that has been read.
[[nodiscard]] json describe(const gonio::log_relative_pca& prior);

}  // namespace cli
