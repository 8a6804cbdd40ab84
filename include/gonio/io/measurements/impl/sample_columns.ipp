#pragma once
/// Bodies of io/measurements/sample_columns.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/measurements/sample_columns.hpp>
#include <gonio/io/measurements/sample_quantity.hpp>
#include <gonio/io/text/csv_dialect.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

namespace gonio::io::detail {

inline constexpr sample_quantity named_factor = sample_quantity::reflectance_factor;

/// Names in lower-case letters and digits only.
inline constexpr std::array known_names{
    known_name{"thetah", 0}, known_name{"thetad", 1}, known_name{"phid", 2},
    // the light's polar angle
    known_name{"thetai", 3}, known_name{"thetain", 3}, known_name{"aoi", 3}, known_name{"angleofincidence", 3},
    known_name{"incidenceangle", 3}, known_name{"incidentangle", 3}, known_name{"incidence", 3}, known_name{"sza", 3},
    known_name{"solarzenith", 3}, known_name{"solarzenithangle", 3}, known_name{"einfallswinkel", 3},
    known_name{"beleuchtungswinkel", 3}, known_name{"lichteinfallswinkel", 3}, known_name{"angleincidence", 3},
    known_name{"angledincidence", 3}, known_name{"angledeclairage", 3}, known_name{"angleeclairage", 3},
    // the light's azimuth
    known_name{"phii", 4}, known_name{"phiin", 4}, known_name{"saa", 4}, known_name{"solarazimuth", 4},
    known_name{"solarazimuthangle", 4}, known_name{"einfallsazimut", 4}, known_name{"azimutincidence", 4},
    known_name{"azimutdincidence", 4},
    // the viewer's polar angle
    known_name{"thetao", 5}, known_name{"thetaout", 5}, known_name{"thetar", 5}, known_name{"thetas", 5},
    known_name{"aor", 5}, known_name{"angleofreflection", 5}, known_name{"viewangle", 5}, known_name{"viewingangle", 5},
    known_name{"observationangle", 5}, known_name{"detectorangle", 5}, known_name{"receiverangle", 5},
    known_name{"vza", 5}, known_name{"viewzenith", 5}, known_name{"viewzenithangle", 5},
    known_name{"viewingzenithangle", 5}, known_name{"beobachtungswinkel", 5}, known_name{"ausfallswinkel", 5},
    known_name{"reflexionswinkel", 5}, known_name{"detektorwinkel", 5}, known_name{"angleobservation", 5},
    known_name{"angledobservation", 5}, known_name{"anglereflexion", 5}, known_name{"angledereflexion", 5},
    known_name{"anglededetection", 5}, known_name{"angledetection", 5},
    // the viewer's azimuth
    known_name{"phio", 6}, known_name{"phiout", 6}, known_name{"phir", 6}, known_name{"phis", 6}, known_name{"vaa", 6},
    known_name{"viewazimuth", 6}, known_name{"viewazimuthangle", 6}, known_name{"beobachtungsazimut", 6},
    known_name{"azimutobservation", 6}, known_name{"azimutdobservation", 6},
    // the viewer's azimuth relative to the light's
    known_name{"phi", 6, {}, true}, known_name{"dphi", 6, {}, true}, known_name{"deltaphi", 6, {}, true},
    known_name{"phirel", 6, {}, true}, known_name{"raa", 6, {}, true}, known_name{"relativeazimuth", 6, {}, true},
    known_name{"relativeazimuthangle", 6, {}, true}, known_name{"relativazimut", 6, {}, true},
    known_name{"azimutrelatif", 6, {}, true}, known_name{"wix", 7}, known_name{"wiy", 8}, known_name{"wiz", 9},
    known_name{"wox", 10}, known_name{"woy", 11}, known_name{"woz", 12}, known_name{"r", 13}, known_name{"red", 13},
    known_name{"g", 14}, known_name{"green", 14}, known_name{"b", 15}, known_name{"blue", 15}, known_name{"weight", 16},
    known_name{"weightr", 17}, known_name{"weightg", 18}, known_name{"weightb", 19},
    // the one value
    known_name{"value", 20}, known_name{"reflectance", 20}, known_name{"reflektanz", 20},
    known_name{"brdf", 20, sample_quantity::brdf}, known_name{"bsdf", 20, sample_quantity::brdf},
    known_name{"brdfcosine", 20, sample_quantity::brdf_cosine}, known_name{"brdfcos", 20, sample_quantity::brdf_cosine},
    known_name{"ccbrdf", 20, sample_quantity::brdf_cosine}, known_name{"ccbsdf", 20, sample_quantity::brdf_cosine},
    known_name{"reflectancefactor", 20, named_factor}, known_name{"radiancefactor", 20, named_factor},
    known_name{"luminancefactor", 20, named_factor}, known_name{"brf", 20, named_factor},
    known_name{"reflexionsfaktor", 20, named_factor}, known_name{"reflektanzfaktor", 20, named_factor},
    known_name{"leuchtdichtefaktor", 20, named_factor}, known_name{"strahldichtefaktor", 20, named_factor},
    known_name{"facteurdeluminance", 20, named_factor}, known_name{"facteurluminance", 20, named_factor},
    known_name{"facteurdereflectance", 20, named_factor}, known_name{"facteurdeluminanceenergetique", 20, named_factor},
    known_name{"percent", 20, sample_quantity::percent}, known_name{"prozent", 20, sample_quantity::percent},
    known_name{"wavelength", 21}, known_name{"lambda", 21}, known_name{"wellenlange", 21},
    known_name{"wellenlaenge", 21}, known_name{"longueurdonde", 21}, known_name{"sourcehalfangle", 22},
    known_name{"receiverhalfangle", 23}, known_name{"quantity", quantity_column},
    // CIE tristimulus values
    known_name{"x", 25}, known_name{"y", 26}, known_name{"z", 27}, known_name{"ciex", 25}, known_name{"ciey", 26},
    known_name{"ciez", 27}};

struct letter {
  std::string_view written, plain;
};

/// Greek letters and subscripts, UTF-8.
inline constexpr std::array greek_letters{
    letter{"\xCE\xB8", "theta"},  letter{"\xCF\x91", "theta"}, letter{"\xCE\x98", "theta"},
    letter{"\xCF\x86", "phi"},    letter{"\xCF\x95", "phi"},   letter{"\xCE\xA6", "phi"},
    letter{"\xCE\xBB", "lambda"}, letter{"\xCE\x94", "delta"}, letter{"\xE2\x88\x86", "delta"},
    letter{"\xCE\xB4", "delta"},  letter{"\xE1\xB5\xA2", "i"}, letter{"\xE1\xB5\xA3", "r"},
    letter{"\xE2\x82\x92", "o"},  letter{"\xE2\x82\x9B", "s"}};

/// Unaccented letters for Latin-1 from 0xC0 on; blank for other characters.
inline constexpr std::string_view latin_letters = "aaaaaa ceeeeiiii nooooo  uuuu   aaaaaa ceeeeiiii nooooo  uuuu  y";
static_assert(latin_letters.size() == 64);

/// Returns the number of bytes of the first letter in UTF-8; 1 for ASCII and Latin-1.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::size_t letter_size(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  const auto goes_on = [&](std::size_t i) { return (byte(i) & 0xC0) == 0x80; };
  if (byte(0) < 0xC0 || !goes_on(1)) return 1;
  return byte(0) >= 0xE0 && goes_on(2) ? 3 : 2;
}

/// Returns the name with only a to z and 0 to 9: "theta_i" is thetai, "Longueur d'onde" longueurdonde.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::string plain_letters(std::string_view name) {
  std::string plain;
  for (std::size_t size = 1; !name.empty(); name.remove_prefix(size)) {
    const unsigned char c = static_cast<unsigned char>(name.front());
    size = letter_size(name);
    const std::string_view whole = name.substr(0, size);
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9')) plain += name.front();
    if (c < 0xC0) continue;
    const auto* const greek = std::ranges::find(greek_letters, whole, &letter::written);
    if (greek != greek_letters.end()) plain += greek->plain;
    if (size > 1 && c != 0xC3) continue;
    const char latin = latin_letters[static_cast<unsigned char>(whole.back()) & 0x3F];
    if (latin != ' ') plain += latin;
  }
  return plain;
}

[[gnu::cold]] GONIO_INLINE const known_name* find_known(std::string_view name) {
  const std::string letters = plain_letters(name);
  for (const known_name& each : known_names)
    if (each.letters == letters) return &each;
  return nullptr;
}

[[gnu::cold]] GONIO_INLINE column_unit unit_named(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, column_unit>, 19> known{
      {{"", column_unit::none},
       {"-", column_unit::none},
       {"deg", column_unit::degrees},
       {"degree", column_unit::degrees},
       {"degrees", column_unit::degrees},
       {"\xC2\xB0", column_unit::degrees},  // degree sign in UTF-8
       {"\xB0", column_unit::degrees},      // degree sign in Latin-1
       {"grad", column_unit::degrees},      // German; gradians are written gon
       {"rad", column_unit::radians},
       {"radian", column_unit::radians},
       {"radians", column_unit::radians},
       {"nm", column_unit::nanometres},
       {"%", column_unit::percent},
       {"percent", column_unit::percent},
       {"1/sr", column_unit::per_steradian},
       {"/sr", column_unit::per_steradian},
       {"sr^-1", column_unit::per_steradian},
       {"sr-1", column_unit::per_steradian},
       {"sr\xE2\x81\xBB\xC2\xB9", column_unit::per_steradian}}};  // superscripts
  for (const auto& [each, unit] : known)
    if (each == name) return unit;
  return column_unit::unknown;
}

[[gnu::cold]] GONIO_INLINE bool fits(column_unit unit, std::size_t column) {
  if (unit == column_unit::none) return true;
  if (is_angle(column)) return unit == column_unit::degrees || unit == column_unit::radians;
  if (colour_group.has(column) || grey_group.has(column) || tristimulus_group.has(column))
    return unit == column_unit::percent || unit == column_unit::per_steradian;
  return column == wavelength_column && unit == column_unit::nanometres;
}

[[gnu::cold]] GONIO_INLINE written_column written(std::string_view field) {
  std::string text;
  for (std::size_t i = 0; i < field.size(); ++i) {
    text += field[i];
    if (field.substr(i).starts_with("\"\"")) ++i;  // a doubled quote stands for one
  }
  std::string_view name = text;
  std::string unit;
  if (name.ends_with(']') || name.ends_with(')')) {
    const std::size_t open = name.find_last_of(name.back() == ']' ? '[' : '(');
    if (open != std::string_view::npos) {
      unit = lower_case(trimmed(name.substr(open + 1, name.size() - open - 2)));
      name = name.substr(0, open);
    }
  } else if (const std::size_t word = name.find_last_of("_ /"); word != std::string_view::npos) {
    std::string last = lower_case(name.substr(word + 1));
    const bool is_unit = !last.empty() && last.find_first_not_of("abcdefghijklmnopqrstuvwxyz") == std::string::npos &&
                         unit_named(last) != column_unit::unknown;
    if (is_unit) {
      unit = std::move(last);
      name = name.substr(0, word);
    }
  }
  std::string lower = lower_case(trimmed(name));
  return {std::move(text), std::move(lower), std::move(unit)};
}

[[gnu::cold]] GONIO_INLINE std::string_view without_degree_sign(std::string_view field) {
  for (const std::string_view sign : {"\xC2\xB0", "\xC2\xBA", "\xB0", "\xBA", "deg"})
    if (field.ends_with(sign)) return trimmed(field.substr(0, field.size() - sign.size()));
  return field;
}

[[gnu::cold]] GONIO_INLINE std::string unit_of(std::string_view field) {
  if (field.size() > 1 &&
      ((field.front() == '[' && field.back() == ']') || (field.front() == '(' && field.back() == ')')))
    field = field.substr(1, field.size() - 2);
  return lower_case(trimmed(field));
}

[[gnu::cold]] GONIO_INLINE bool are_units(std::span<const std::string_view> fields) {
  bool has_unit = false;
  for (const std::string_view field : fields) {
    double number = 0.0;
    csv_dialect any;
    if (any.read_number(field, number) == nullptr) return false;
    const column_unit unit = unit_named(unit_of(field));
    has_unit |= unit != column_unit::none && unit != column_unit::unknown;
  }
  return has_unit;
}

}  // namespace gonio::io::detail
