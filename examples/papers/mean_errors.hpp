#pragma once
/// Errors of reconstructed materials as JSON.

#include "papers/experiments.hpp"
#include "papers/material_result.hpp"
#include "tool/files/json.hpp"

#include <span>

namespace papers {

/// Returns the means of all measures over materials, with the keys of `gonio compare --json`.
[[nodiscard]] json mean_errors(std::span<const material_result> results);

[[nodiscard]] json errors_by_name(std::span<const material_result> results);

}  // namespace papers
