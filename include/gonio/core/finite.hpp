#pragma once
/// Tests whether every number of an array is finite.

#include <span>

namespace gonio {

[[nodiscard]] bool all_finite(std::span<const double> values) noexcept;
[[nodiscard]] bool all_finite(std::span<const float> values) noexcept;

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/finite.ipp>
#endif
