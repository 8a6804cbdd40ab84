#pragma once
/// Is every number of an array finite?

#include <span>

namespace gonio {

[[nodiscard]] bool all_finite(std::span<const double> values) noexcept;
[[nodiscard]] bool all_finite(std::span<const float> values) noexcept;

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/core/impl/finite.ipp>
#endif
