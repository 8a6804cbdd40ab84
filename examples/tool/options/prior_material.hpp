#pragma once
/// A material from which a prior was learned, by name.

#include <gonio/basis/pca.hpp>

#include <Eigen/Core>

#include <filesystem>
#include <string>

namespace cli {

/// Returns the number of the material of that name. Throws gonio::error naming the file if there is none.
[[nodiscard]] Eigen::Index material_number(const gonio::log_relative_pca& prior, const std::string& name,
                                           const std::filesystem::path& file);

}  // namespace cli
