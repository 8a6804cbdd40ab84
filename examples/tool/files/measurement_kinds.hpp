#pragma once
/// The kinds of files that hold samples, and how each is recognised.

#include <gonio/io/measurements/klems_xml.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string_view>

namespace cli {

/// A kind of file of samples other than CSV.
struct measurement_kind {
  std::string_view name;
  /// Recognises a file by its extension in lower case and its first 65,536 bytes.
  bool (*recognises)(std::string_view extension, std::string_view start);
  gonio::sample_set (*read)(const std::filesystem::path& path);
  /// Reads a block of a file with several blocks, each of a side and a band of wavelengths; nullptr for other kinds.
  gonio::sample_set (*read_block)(const std::filesystem::path& path, const gonio::io::window_block& wanted) = nullptr;
};

/// Returns the kind of a file; nullptr if no kind recognises it: samples as CSV, or something else. Throws gonio::error
/// if the file cannot be read.
[[nodiscard]] const measurement_kind* measurement_kind_of(const std::filesystem::path& path);

}  // namespace cli
