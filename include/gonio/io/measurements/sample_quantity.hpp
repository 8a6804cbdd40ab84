#pragma once
/// The quantity of a file's numbers, and its conversion to a BRDF f in sr^-1. With theta_o the viewer's angle from the
/// normal: brdf is f; brdf-cosine is f cos(theta_o), the cosine-corrected BSDF of scatterometers; reflectance-factor is
/// R = pi f, relative to a perfect white diffuser in the same directions (Nicodemus et al. 1977, Geometrical
/// considerations and nomenclature for reflectance, NBS Monograph 160); percent is 100 R.

#include <gonio/core/direction.hpp>
#include <gonio/io/text/text.hpp>

#include <array>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io {

enum class sample_quantity { brdf, brdf_cosine, reflectance_factor, percent };

/// The quantities' names in options and files.
inline constexpr std::array<std::string_view, 4> sample_quantity_names{"brdf", "brdf-cosine", "reflectance-factor",
                                                                       "percent"};

[[nodiscard]] std::string_view name_of(sample_quantity quantity) noexcept;

/// Returns the quantity of a name, ignoring case, with blanks or underscores for hyphens; nothing for any other text.
[[nodiscard]] std::optional<sample_quantity> quantity_named(std::string_view name);

/// Returns the factor that converts a number to a BRDF, sr^-1; `wo` points to the viewer, above the horizon.
[[nodiscard]] double brdf_factor(sample_quantity quantity, const direction& wo) noexcept;

namespace detail {

/// The stated quantity of a file's numbers and its source. Later statements must agree; reflectance factors with
/// percent signs are percent.
class stated_quantity {
 public:
  /// States a quantity; `by` is its source in messages. Throws gonio::error if another quantity has been stated.
  void state(sample_quantity quantity, const std::string& by, const text_position& position);
  /// States that each number, or the unit of its column, has a percent sign.
  void state_percent_signs(const std::string& by, const text_position& position);
  /// Takes over the statement of another object, as if it were stated here.
  void state(const stated_quantity& other, const text_position& position);

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
