#pragma once
/// A material from which a prior was learned, by name.

#include <gonio/basis/pca.hpp>

#include <Eigen/Core>

#include <filesystem>
#include <string>

namespace cli {

/// Returns the material's position in the prior. Throws gonio::error naming the file if there is no such material.
[[nodiscard]] Eigen::Index material_number(const gonio::log_relative_pca& prior, const std::string& name,
                                           const std::filesystem::path& file);

}  // namespace cli
