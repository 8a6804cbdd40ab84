#pragma once
/// What the numbers of a file of measurements are, and how they become a BRDF f in sr^-1. With theta_o the viewer's
/// angle from the normal: brdf is f; brdf-cosine is f cos(theta_o), the cosine-corrected BSDF of scatterometers;
/// reflectance-factor is R = pi f, relative to a perfect white diffuser under the same directions (Nicodemus et al.
/// 1977, Geometrical considerations and nomenclature for reflectance, NBS Monograph 160); percent is 100 R.

#include <gonio/core/direction.hpp>
#include <gonio/io/text/text.hpp>

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io {

enum class sample_quantity { brdf, brdf_cosine, reflectance_factor, percent };

/// How options and files call them.
inline constexpr std::array<std::string_view, 4> sample_quantity_names{"brdf", "brdf-cosine", "reflectance-factor",
                                                                       "percent"};

[[nodiscard]] std::string_view name_of(sample_quantity quantity) noexcept;

/// The quantity of a name, in letters of either case, with blanks or underscores for hyphens; none of any other text.
[[nodiscard]] std::optional<sample_quantity> quantity_named(std::string_view name);

/// What a number is multiplied by to be a BRDF, sr^-1; `wo` points to the viewer, above the horizon.
[[nodiscard]] double brdf_factor(sample_quantity quantity, const direction& wo) noexcept;

namespace detail {

/// What has been said of a file's numbers, and by whom. Who speaks second must agree; reflectance factors with percent
/// signs are percent.
class stated_quantity {
 public:
  /// Throws gonio::error if another quantity has been stated; `by` is what the sentence calls who says so.
  void state(sample_quantity quantity, const std::string& by, const text_place& place);
  /// The numbers have percent signs, each or in the unit of their column.
  void state_percent_signs(const std::string& by, const text_place& place);
  /// All that another has stated.
  void state(const stated_quantity& other, const text_place& place);

  [[nodiscard]] const std::optional<sample_quantity>& quantity() const noexcept { return quantity_; }

 private:
  std::optional<sample_quantity> quantity_;
  std::string by_;
  bool has_percent_signs_ = false;
};

}  // namespace detail

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/sample_quantity.ipp>
#endif
