#pragma once
/// A material that a prior was learned from, by its name.

#include <gonio/basis/pca.hpp>

#include <Eigen/Core>

#include <filesystem>
#include <string>

namespace cli {

/// The number of the material of that name. Throws gonio::error, which names the file, if a prior has none.
[[nodiscard]] Eigen::Index material_number(const gonio::log_relative_pca& prior, const std::string& name,
                                           const std::filesystem::path& file);

}  // namespace cli
