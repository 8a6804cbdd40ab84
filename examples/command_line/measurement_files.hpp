#pragma once
/// Files whose format is told from their name.

#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <vector>

namespace cli {

/// Measurements: samples as CSV, or if the name ends in .brdf, Cornell's text format.
[[nodiscard]] gonio::sample_set read_measurements(const std::filesystem::path& path);

/// Which samples of a file count, by their positions.
[[nodiscard]] std::vector<Eigen::Index> counting_samples(const gonio::sample_set& samples);

/// Writes a table in the format that the name asks for: see `written_kind`.
void write_table(const std::filesystem::path& path, const gonio::brdf_table& table);

}  // namespace cli
