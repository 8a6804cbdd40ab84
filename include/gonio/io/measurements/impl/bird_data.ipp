#pragma once
/// The object `data` of a BiRD file (io/measurements/bird.hpp), and its reader.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/json_reader.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/aperture.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// A variable of `data`: its numbers, and possibly one uncertainty for all of them.
struct bird_variable {
  std::string unit;
  std::vector<double> values;
  std::optional<double> uncertainty;
  std::string uncertainty_unit;
};

/// The polarisation states of the measurements: Stokes parameters 2 to 4; the first is 1.
using stokes_states = std::vector<std::array<double, 3>>;

/// The content of `data`.
struct bird_data {
  std::map<std::string, bird_variable, std::less<>> variables;
  stokes_states illumination;
  aperture cones;

  [[nodiscard]] const bird_variable* find(std::string_view variable) const {
    const auto found = variables.find(variable);
    return found == variables.end() ? nullptr : &found->second;
  }
};

/// Reads a file key by key.
class bird_reader {
 public:
  bird_reader(std::string_view text, text_position& position) : json_(text, position), name_(position.name) {}

  [[nodiscard]] bird_data read();

 private:
  void read_metadata(const std::string& path);
  [[nodiscard]] std::pair<double, std::string> read_quantity(const std::string& path);
  [[nodiscard]] double half_divergence(const std::pair<double, std::string>& quantity) const;
  void read_data();
  void read_entry(const std::string& key);
  [[nodiscard]] bird_variable read_variable(const std::string& key);
  void read_uncertainty(const std::string& key, bird_variable& variable);
  [[nodiscard]] stokes_states read_polarisation(const std::string& key);
  [[nodiscard]] std::array<double, 3> read_state(const std::string& key);
  void require_constant(const std::string& key);

  json_reader json_;
  std::string name_;
  bird_data data_;
};

GONIO_INLINE bird_data bird_reader::read() {
  bool has_data = false;
  json_.open_object("the file");
  while (const auto key = json_.next_key()) {
    if (*key == "metadata" && json_.peek() == '{')
      read_metadata(*key + '.');
    else if (*key != "data")
      json_.skip();
    else if (std::exchange(has_data, true))
      json_.refuse({"'data' appears twice"});
    else
      read_data();
  }
  json_.finish();
  if (!has_data) gonio::refuse({name_, ": there is no object 'data'"});
  return std::move(data_);
}

/// Reads the cones of receiver and source: enters the objects that contain them, and skips all other entries. Paths end
/// with a point.
GONIO_INLINE void bird_reader::read_metadata(const std::string& path) {
  constexpr std::string_view receiver = "metadata.instrumentation.detection_system.solid_angle.",
                             source = "metadata.instrumentation.illumination_system.beam.divergence.";
  json_.open_object(path);
  while (const auto key = json_.next_key()) {
    const std::string inner = path + *key + '.';
    if (json_.peek() != '{' || !(receiver.starts_with(inner) || source.starts_with(inner)))
      json_.skip();
    else if (inner == receiver)
      data_.cones.receiver = receiver_half_angle(read_quantity(inner).first, json_);
    else if (inner == source)
      data_.cones.source = half_divergence(read_quantity(inner));
    else
      read_metadata(inner);
  }
}

/// Reads a value and its unit.
GONIO_INLINE std::pair<double, std::string> bird_reader::read_quantity(const std::string& path) {
  std::pair<double, std::string> quantity{0.0, ""};
  json_.open_object(path);
  while (const auto key = json_.next_key()) {
    if (*key == "value")
      quantity.first = json_.read_number(path + *key);
    else if (*key == "unit")
      quantity.second = json_.read_string(path + *key);
    else
      json_.skip();
  }
  return quantity;
}

/// Returns half of the full angle of a beam, radians.
GONIO_INLINE double bird_reader::half_divergence(const std::pair<double, std::string>& quantity) const {
  const auto& [value, unit] = quantity;
  const double half_angle = 0.5 * value * (unit == "rad" ? 1.0 : radians(1.0));
  if (!(half_angle >= 0.0 && half_angle <= largest_half_angle))
    json_.refuse({"the beam has a divergence of ", shortest(value), ' ' + unit, ", expected from 0 to 90 degrees"});
  return half_angle;
}

GONIO_INLINE void bird_reader::read_data() {
  json_.open_object("data");
  while (const auto key = json_.next_key()) read_entry(*key);
}

GONIO_INLINE void bird_reader::read_entry(const std::string& key) {
  constexpr std::array<std::string_view, 8> numeric{"theta_i", "phi_i", "theta_r",      "phi_r",
                                                    "BRDF",    "uBRDF", "wavelength_i", "wavelength_r"};
  if (std::ranges::find(numeric, key) != numeric.end()) {
    if (!data_.variables.try_emplace(key, read_variable(key)).second)
      json_.refuse({in_quotes(std::string_view(key)), " appears twice"});
  } else if (key == "polarization_i") {
    data_.illumination = read_polarisation(key);
  } else if (key == "polarization_r") {
    for (const std::array<double, 3>& state : read_polarisation(key))
      if (state != std::array<double, 3>{})
        json_.refuse({"polarization_r: the light was analysed after reflection, expected unpolarised detection ('u')"});
  } else if (key == "adhoc_variables") {
    json_.open_object(key);
    while (const auto variable = json_.next_key()) require_constant(*variable);
  } else if (key == "variables") {
    json_.refuse({"data.variables is from a draft of the format, expected data.theta_i and so on (schema 1.0)"});
  } else {
    json_.skip();
  }
}

GONIO_INLINE bird_variable bird_reader::read_variable(const std::string& key) {
  bird_variable variable;
  json_.open_object(key);
  while (const auto field = json_.next_key()) {
    if (*field == "unit") {
      variable.unit = json_.read_string(key + ".unit");
    } else if (*field == "values") {
      json_.open_array(key + ".values");
      while (json_.next_element()) variable.values.push_back(json_.read_number(key));
    } else if (*field == "uncertainty" && key == "BRDF") {
      read_uncertainty(key, variable);
    } else {
      json_.skip();
    }
  }
  return variable;
}

GONIO_INLINE void bird_reader::read_uncertainty(const std::string& key, bird_variable& variable) {
  json_.open_object(key + ".uncertainty");
  while (const auto field = json_.next_key()) {
    if (*field == "value")
      variable.uncertainty = json_.read_number(key + ".uncertainty");
    else if (*field == "unit")
      variable.uncertainty_unit = json_.read_string(key + ".uncertainty.unit");
    else
      json_.skip();
  }
}

GONIO_INLINE stokes_states bird_reader::read_polarisation(const std::string& key) {
  stokes_states states;
  json_.open_object(key);
  while (const auto field = json_.next_key()) {
    if (*field != "values") {
      json_.skip();  // the values themselves show whether they are letters or Stokes vectors
      continue;
    }
    json_.open_array(key + ".values");
    while (json_.next_element()) states.push_back(read_state(key));
  }
  return states;
}

GONIO_INLINE std::array<double, 3> bird_reader::read_state(const std::string& key) {
  if (json_.peek() == '"') {
    const std::string state = json_.read_string(key);
    if (state == "s") return {1.0, 0.0, 0.0};
    if (state == "p") return {-1.0, 0.0, 0.0};
    if (state != "u")
      json_.refuse({key, ": ", in_quotes(std::string_view(state)), ", expected s, p, u or a Stokes vector"});
    return {};
  }
  std::array<double, 4> stokes{};
  std::size_t count = 0;
  json_.open_array(key);
  while (json_.next_element()) {
    const double number = json_.read_number(key);
    if (count == 4 || !(std::abs(number) <= 1.0))
      json_.refuse({key, ": expected Stokes vectors of 4 numbers from -1 to 1"});
    stokes[count++] = number;
  }
  if (count != 4 || stokes[0] != 1.0) json_.refuse({key, ": expected Stokes vectors of 4 numbers, the first 1"});
  return {stokes[1], stokes[2], stokes[3]};
}

GONIO_INLINE void bird_reader::require_constant(const std::string& key) {
  json_.open_object(key);
  while (const auto field = json_.next_key()) {
    if (*field != "values") {
      json_.skip();
      continue;
    }
    std::optional<std::string_view> first;
    json_.open_array(key);
    while (json_.next_element()) {
      const std::string_view value = json_.skip();
      if (!first) first = value;
      if (*first != value)
        json_.refuse(
            {"adhoc_variables: ", in_quotes(std::string_view(key)), " varies, expected one file for each value"});
    }
  }
}

}  // namespace gonio::io::detail
