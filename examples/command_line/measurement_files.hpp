#pragma once
/// Files whose format is told from their name or their beginning.

#include <gonio/table/brdf_table.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <vector>

namespace cli {

/// Measurements: samples as CSV, or in a format of the field that is recognised (measurement_kinds.hpp).
[[nodiscard]] gonio::sample_set read_measurements(const std::filesystem::path& path);

/// Which samples of a file count, by their positions.
[[nodiscard]] std::vector<Eigen::Index> counting_samples(const gonio::sample_set& samples);

/// Writes a table in the format that the name asks for: an array if it ends in .npy, otherwise MERL's.
void write_table(const std::filesystem::path& path, const gonio::brdf_table& table);

}  // namespace cli
