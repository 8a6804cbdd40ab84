#pragma once
/// Bodies of io/measurements/bird.hpp: groups measurements by their directions, averages them, and weights the samples.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/bird.hpp>
#include <gonio/io/measurements/impl/bird_data.ipp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// Sums over the measurements at one wavelength in one pair of directions.
struct bird_mean {
  double value = 0.0, squared_uncertainty = 0.0;
  std::array<double, 3> stokes{};
  double count = 0.0;
};

/// The measurements in one pair of directions, by wavelength.
struct bird_group {
  direction_pair pair;
  std::map<double, bird_mean> spectrum;
};

/// Converts the data of a file to samples.
class bird_samples {
 public:
  bird_samples(const bird_data& data, const text_position& position) : data_(data), position_(position) {}

  [[nodiscard]] sample_collector make();

 private:
  [[nodiscard]] const bird_variable& require(std::string_view variable) const;
  void require_count(std::string_view variable, std::size_t count) const;
  [[nodiscard]] double to_radians(std::string_view variable) const;
  void check_units();
  [[nodiscard]] double uncertainty_of(std::size_t measurement) const;
  [[nodiscard]] double wavelength_of(std::size_t measurement) const;
  [[nodiscard]] direction direction_of(std::string_view theta, std::string_view phi, std::size_t measurement) const;
  [[nodiscard]] std::vector<bird_group> grouped() const;
  void add(const bird_group& group, double weight, sample_collector& collector) const;
  void require_unpolarised(const bird_group& group) const;
  [[nodiscard]] static double relative_uncertainty_of(const bird_group& group);

  const bird_data& data_;
  const text_position& position_;
  const bird_variable* wavelengths_ = nullptr;
  double nanometres_ = 1.0;  ///< per unit of the file's wavelengths
};

GONIO_INLINE const bird_variable& bird_samples::require(std::string_view variable) const {
  const bird_variable* found = data_.find(variable);
  if (found == nullptr) gonio::refuse({position_.name, ": data.", variable, " is missing"});
  return *found;
}

GONIO_INLINE void bird_samples::require_count(std::string_view variable, std::size_t count) const {
  const std::size_t expected = require("BRDF").values.size();
  if (count != expected)
    gonio::refuse(
        {position_.name, ": data.", variable, " has ", count, " values, expected ", expected, " as in data.BRDF"});
}

GONIO_INLINE double bird_samples::to_radians(std::string_view variable) const {
  const std::string& unit = require(variable).unit;
  if (unit == "rad") return 1.0;
  if (unit == "deg" || unit == "\xC2\xB0") return radians(1.0);
  gonio::refuse(
      {position_.name, ": data.", variable, ": unit ", in_quotes(std::string_view(unit)), ", expected deg or rad"});
}

GONIO_INLINE void bird_samples::check_units() {
  const auto require_unit = [this](std::string_view variable, const std::string& unit, bool may_be_percent) {
    if (unit != "1/sr" && unit != "sr^-1" && !(may_be_percent && unit == "%"))
      gonio::refuse({position_.name, ": data.", variable, ": unit ", in_quotes(std::string_view(unit)),
                     ", expected sr^-1", may_be_percent ? " or %" : ""});
  };
  const bird_variable& brdf = require("BRDF");
  require_unit("BRDF", brdf.unit, false);
  if (brdf.uncertainty) require_unit("BRDF.uncertainty", brdf.uncertainty_unit, true);
  if (const bird_variable* u = data_.find("uBRDF")) require_unit("uBRDF", u->unit, true);
  for (const std::string_view variable : {"theta_i", "phi_i", "theta_r", "phi_r"})
    static_cast<void>(to_radians(variable));
  for (const auto& [name, variable] : data_.variables) require_count(name, variable.values.size());
  if (!data_.illumination.empty()) require_count("polarization_i", data_.illumination.size());
  const bird_variable *of_light = data_.find("wavelength_i"), *seen = data_.find("wavelength_r");
  wavelengths_ = of_light != nullptr ? of_light : seen;
  if (wavelengths_ == nullptr) return;
  if (of_light != nullptr && seen != nullptr && (of_light->unit != seen->unit || of_light->values != seen->values))
    gonio::refuse({position_.name, ": data.wavelength_r differs from data.wavelength_i: fluorescence is not a BRDF"});
  const std::string& unit = wavelengths_->unit;
  if (unit != "nm" && unit != "\xCE\xBCm" && unit != "\xC2\xB5m")
    gonio::refuse(
        {position_.name, ": wavelengths: unit ", in_quotes(std::string_view(unit)), ", expected nm or micrometres"});
  nanometres_ = unit == "nm" ? 1.0 : 1000.0;
}

GONIO_INLINE double bird_samples::uncertainty_of(std::size_t measurement) const {
  const bird_variable &brdf = require("BRDF"), *of_each = data_.find("uBRDF");
  if (of_each == nullptr && !brdf.uncertainty) return 0.0;
  const double given = of_each != nullptr ? of_each->values[measurement] : *brdf.uncertainty;
  if (!(given >= 0.0)) gonio::refuse({position_.name, ": an uncertainty of ", shortest(given), " is negative"});
  const std::string& unit = of_each != nullptr ? of_each->unit : brdf.uncertainty_unit;
  return unit == "%" ? std::abs(brdf.values[measurement]) * given / 100.0 : given;
}

GONIO_INLINE double bird_samples::wavelength_of(std::size_t measurement) const {
  return wavelengths_ == nullptr ? 0.0 : nanometres_ * wavelengths_->values[measurement];
}

GONIO_INLINE direction bird_samples::direction_of(std::string_view theta, std::string_view phi,
                                                  std::size_t measurement) const {
  const double polar = to_radians(theta) * require(theta).values[measurement];
  const double azimuth = to_radians(phi) * require(phi).values[measurement];
  if (!(polar >= 0.0 && polar < radians(90.1)) || !(std::abs(azimuth) < radians(360.1)))
    gonio::refuse({position_.name, ": measurement ", measurement + 1, ": ", theta, " of ", shortest(degrees(polar)),
                   " and ", phi, " of ", shortest(degrees(azimuth)), " degrees, expected 0 to 90 and 0 to 360"});
  return spherical_direction(polar, azimuth);
}

GONIO_INLINE std::vector<bird_group> bird_samples::grouped() const {
  const bird_variable& brdf = require("BRDF");
  std::vector<bird_group> groups;
  std::map<std::array<double, 4>, std::size_t> known;
  for (std::size_t k = 0; k < brdf.values.size(); ++k) {
    if (std::abs(brdf.values[k]) > double{std::numeric_limits<float>::max()})
      gonio::refuse({position_.name, ": measurement ", k + 1, ": ", shortest(brdf.values[k]),
                     " sr^-1 is outside the range of float"});
    const auto value_of = [&](std::string_view variable) { return require(variable).values[k]; };
    const std::array<double, 4> angles{value_of("theta_i"), value_of("phi_i"), value_of("theta_r"), value_of("phi_r")};
    const auto [at, is_new] = known.try_emplace(angles, groups.size());
    if (is_new) groups.push_back({{direction_of("theta_i", "phi_i", k), direction_of("theta_r", "phi_r", k)}, {}});
    bird_mean& mean = groups[at->second].spectrum[wavelength_of(k)];
    mean.value += brdf.values[k];
    mean.squared_uncertainty += uncertainty_of(k) * uncertainty_of(k);
    mean.count += 1.0;
    for (std::size_t i = 0; i < 3 && !data_.illumination.empty(); ++i) mean.stokes[i] += data_.illumination[k][i];
  }
  return groups;
}

GONIO_INLINE void bird_samples::require_unpolarised(const bird_group& group) const {
  const auto rounded = [](const direction& w) { return shortest(std::round(1e6 * degrees(polar_angle(w))) / 1e6); };
  for (const auto& [wavelength, mean] : group.spectrum)
    for (const double parameter : mean.stokes)
      if (!(std::abs(parameter) <= 1e-6 * mean.count))
        gonio::refuse({position_.name, ": at theta_i ", rounded(group.pair.wi), " and theta_r ", rounded(group.pair.wo),
                       " degrees, the states of polarization_i do not average to unpolarised light, "
                       "expected as much s as p"});
}

GONIO_INLINE void bird_samples::add(const bird_group& group, double weight, sample_collector& collector) const {
  std::vector<double> wavelengths, values;
  for (const auto& [wavelength, mean] : group.spectrum) {
    wavelengths.push_back(wavelength);
    values.push_back(mean.value / mean.count);
  }
  if (wavelengths_ != nullptr) try {
      collector.use_wavelengths(wavelengths);
    } catch (const error& reason) {
      gonio::refuse({position_.name, ": data.wavelength_i: ", reason.what()});
    }
  collector.add(group.pair, values, weight);
}

GONIO_INLINE double bird_samples::relative_uncertainty_of(const bird_group& group) {
  double squared = 0.0, value = 0.0, count = 0.0;
  for (const auto& [wavelength, mean] : group.spectrum) {
    squared += mean.squared_uncertainty;
    value += mean.value;
    count += mean.count;
  }
  return std::sqrt(squared * count) / std::abs(value);
}

GONIO_INLINE sample_collector bird_samples::make() {
  check_units();
  const std::vector<bird_group> groups = grouped();
  std::vector<double> uncertainties;
  for (const bird_group& group : groups) uncertainties.push_back(relative_uncertainty_of(group));
  std::vector<double> finite;
  for (const double u : uncertainties)
    if (std::isfinite(u)) finite.push_back(u);
  const double usual = finite.empty() ? 0.0 : median(finite);
  sample_collector collector;
  collector.use_aperture(data_.cones);
  for (std::size_t i = 0; i < groups.size(); ++i) {
    require_unpolarised(groups[i]);
    // A value of 0 with an uncertainty of 0 has no relative uncertainty.
    const double ratio = std::isnan(uncertainties[i]) ? 1.0 : usual / uncertainties[i];
    const double weight = usual > 0.0 ? std::clamp(ratio * ratio, 0.01, 100.0) : 1.0;
    add(groups[i], weight, collector);
  }
  return collector;
}

[[nodiscard]] GONIO_INLINE sample_collector collect_bird(std::string_view text, const std::string& name) {
  text_position position{name, 0};
  const bird_data data = bird_reader(text, position).read();
  return bird_samples(data, position).make();
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE bool looks_like_bird(std::string_view text) {
  text = without_byte_order_mark(text);
  const std::size_t first = std::min(text.find_first_not_of(" \t\r\n"), text.size());
  if (!text.substr(first).starts_with('{')) return false;
  const auto has = [&](std::string_view key) { return text.find(key) != std::string_view::npos; };
  return has("\"metadata\"") || has("\"data\"");
}

GONIO_INLINE sample_set read_bird(std::string_view text, const std::string& name) {
  return detail::collect_bird(text, name).samples(name);
}

GONIO_INLINE sample_set read_bird(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_bird(as_text(bytes), path.string());
}

}  // namespace gonio::io
