#pragma once
/// What `gonio info` says of each kind of file that the tool reads or writes.

#include "json.hpp"
#include "measurement_files.hpp"
#include <gonio/basis/pca.hpp>

#include <filesystem>

namespace cli {

/// The key `kind`, and what else there is to say; samples are read as the options say. Throws gonio::error for a kind
/// that is not known, and for what a kind's reader refuses.
[[nodiscard]] json describe_file(const std::filesystem::path& path, const measurement_options& reading);

/// The same of a prior that has been read.
[[nodiscard]] json describe(const gonio::log_relative_pca& prior);

}  // namespace cli
