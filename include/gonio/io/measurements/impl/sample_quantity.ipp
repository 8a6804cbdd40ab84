#pragma once
/// Bodies of io/measurements/sample_quantity.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/io/measurements/sample_quantity.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE std::string_view name_of(sample_quantity quantity) noexcept {
  return sample_quantity_names[static_cast<std::size_t>(quantity)];
}

[[gnu::cold]] GONIO_INLINE std::optional<sample_quantity> quantity_named(std::string_view name) {
  std::string word = lower_case(trimmed(name));
  for (char& c : word)
    if (c == ' ' || c == '_') c = '-';
  for (std::size_t i = 0; i < sample_quantity_names.size(); ++i)
    if (sample_quantity_names[i] == word) return static_cast<sample_quantity>(i);
  return {};
}

GONIO_INLINE double brdf_factor(sample_quantity quantity, const direction& wo) noexcept {
  switch (quantity) {
    case sample_quantity::brdf:
      return 1.0;
    case sample_quantity::brdf_cosine:
      return 1.0 / wo.z();
    case sample_quantity::reflectance_factor:
      return std::numbers::inv_pi;
    case sample_quantity::percent:
      return 0.01 * std::numbers::inv_pi;
  }
  return 1.0;
}

}  // namespace gonio::io

namespace gonio::io::detail {

[[gnu::cold]] GONIO_INLINE void stated_quantity::state(sample_quantity quantity, const std::string& by,
                                                       const text_position& position) {
  if (has_percent_signs_ && quantity == sample_quantity::reflectance_factor) return;
  if (quantity_ && *quantity_ != quantity)
    position.refuse({"the values are ", name_of(*quantity_), " according to ", by_, ", but ", name_of(quantity),
                     " according to ", by, ", expected one quantity"});
  if (!quantity_) by_ = by;
  quantity_ = quantity;
}

[[gnu::cold]] GONIO_INLINE void stated_quantity::state_percent_signs(const std::string& by,
                                                                     const text_position& position) {
  if (quantity_ == sample_quantity::reflectance_factor) quantity_ = sample_quantity::percent;
  state(sample_quantity::percent, by, position);
  has_percent_signs_ = true;
}

[[gnu::cold]] GONIO_INLINE void stated_quantity::state(const stated_quantity& other, const text_position& position) {
  if (!other.quantity_) return;
  if (other.has_percent_signs_)
    state_percent_signs(other.by_, position);
  else
    state(*other.quantity_, other.by_, position);
}

}  // namespace gonio::io::detail
