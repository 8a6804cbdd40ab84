#pragma once
/// Bodies of io/measurements/speos_brdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/measurements/speos_brdf.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/io/text/words.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

inline constexpr std::string_view speos_header = "OPTIS - brdf surface file",
                                  speos_anisotropic_header = "OPTIS - Anisotropic BSDF surface file";

/// The table of one wavelength: values ordered by `theta`, then by `phi`, degrees.
struct speos_table {
  std::vector<double> theta, phi, values;
};

/// The tables of one azimuth of the light, counted from the anisotropy vector: one for each angle of incidence.
struct speos_turn {
  double azimuth = 0.0;  ///< degrees
  std::vector<double> incidences;
  std::vector<speos_table> tables;
};

/// Takes the rows above the numbers from the front of the text and moves `position` to the last of these rows.
GONIO_INLINE void read_speos_rows(std::string_view& text, text_position& position) {
  const auto line = [&] {
    if (text.empty())
      gonio::refuse({position.name, ": ends after line ", position.line, ", expected a header of seven rows"});
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view whole = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    ++position.line;
    return trimmed(whole);
  };
  const std::string_view header = line();
  if (!header.starts_with(speos_header) && !header.starts_with(speos_anisotropic_header))
    position.refuse({"expected the header '", speos_header, "' or '", speos_anisotropic_header, "'"});
  if (const std::string_view mode = line(); mode != "0")
    position.refuse({"the mode is ", in_quotes(mode), ", expected 0, text: save the file as text in Speos"});
  static_cast<void>(line());  // a comment
  const double size = read_number(line(), position, [] { return "the size of the description"; });
  if (!(size >= 0.0 && size <= static_cast<double>(text.size())))
    position.refuse({"the description has ", shortest(size), " characters, but the file only ", text.size(), " more"});
  const std::string_view description = text.substr(0, static_cast<std::size_t>(size));
  text.remove_prefix(description.size());
  position.line += static_cast<std::size_t>(std::ranges::count(description, '\n'));
  static_cast<void>(line());
}

/// Returns weights of values at ascending nodes (degrees): the weighted sum of the values is the integral over the
/// angle (radians) of `density` times the values, which are linear between nodes.
template <class Density>
[[nodiscard]] std::vector<double> node_weights(const std::vector<double>& nodes, const Density& density) {
  constexpr int steps = 64;
  std::vector<double> weights(nodes.size(), 0.0);
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const double begin = radians(nodes[i]), width = radians(nodes[i + 1]) - begin;
    for (int k = 0; k < steps; ++k) {
      const double share = (k + 0.5) / steps, part = density(begin + share * width) * width / steps;
      weights[i] += (1.0 - share) * part;
      weights[i + 1] += share * part;
    }
  }
  return weights;
}

class speos_reader {
 public:
  speos_reader(std::string_view text, text_position& position) : words_(text, position), size_(text.size()) {}

  [[nodiscard]] sample_collector read();
  /// Reads a file of the anisotropic kind.
  [[nodiscard]] sample_collector read_anisotropic();

 private:
  [[nodiscard]] double count(std::string_view what, double most);
  [[nodiscard]] std::vector<double> ascending(double count, std::string_view what, double lowest, double highest);
  [[nodiscard]] speos_table read_table();
  [[nodiscard]] std::vector<double> azimuth_weights(const std::vector<double>& phi) const;
  [[nodiscard]] double integral(const speos_table& table) const;
  [[nodiscard]] double integral_at(const speos_turn& turn, double incidence) const;
  void scale(speos_table& table, double factor) const;
  template <class ReadValues>
  void add(sample_collector& to, double incidence, double turn, const speos_table& table,
           const ReadValues& read_values) const;
  void require_room(std::size_t wavelengths, const std::vector<speos_turn>& turns) const;
  void read_kind();
  [[nodiscard]] std::vector<speos_turn> read_turns();
  void skip_title();
  void finish();

  word_reader words_;
  std::size_t size_;
  bool has_cosine_ = false;
};

GONIO_INLINE double speos_reader::count(std::string_view what, double most) {
  const double number = words_.read_number(what, 1.0, most);
  if (number != std::floor(number)) words_.position().refuse({what, ": ", shortest(number), " is not a whole number"});
  return number;
}

GONIO_INLINE std::vector<double> speos_reader::ascending(double count, std::string_view what, double lowest,
                                                         double highest) {
  std::vector<double> numbers;
  while (static_cast<double>(numbers.size()) < count) {
    const double number = words_.read_number(what, lowest, highest);
    if (!numbers.empty() && !(number > numbers.back()))
      words_.position().refuse(
          {what, ": ", shortest(number), " follows ", shortest(numbers.back()), ", expected ascending numbers"});
    numbers.push_back(number);
  }
  return numbers;
}

GONIO_INLINE speos_table speos_reader::read_table() {
  constexpr double most_angles = 10'000.0;
  const double thetas = count("the number of angles theta", most_angles),
               phis = count("the number of angles phi", most_angles);
  speos_table table;
  table.phi = ascending(phis, "phi", 0.0, 360.0);
  for (double i = 0.0; i < thetas; ++i) {
    table.theta.push_back(words_.read_number("theta", table.theta.empty() ? 0.0 : table.theta.back(), 90.0));
    for (double k = 0.0; k < phis; ++k) table.values.push_back(words_.read_number("a value"));
  }
  return table;
}

/// Returns the weights of azimuths that cover a whole turn, whose end may be missing, or half of a symmetric turn.
GONIO_INLINE std::vector<double> speos_reader::azimuth_weights(const std::vector<double>& phi) const {
  const auto one = [](double) { return 1.0; };
  constexpr double rounding = 1e-3;
  const double width = phi.back() - phi.front();
  std::vector<double> nodes = phi;
  const bool is_half = std::abs(width - 180.0) < rounding;
  const bool is_open = width - 180.0 > rounding && 360.0 - width > rounding;
  if (phi.size() < 2 || width < 180.0 - rounding)
    words_.position().refuse({"phi covers ", shortest(width), " degrees, expected 180 or 360"});
  if (is_open) nodes.push_back(phi.front() + 360.0);
  std::vector<double> weights = node_weights(nodes, one);
  if (is_open) {
    weights.front() += weights.back();
    weights.pop_back();
  }
  if (is_half)
    for (double& weight : weights) weight *= 2.0;
  return weights;
}

/// Returns the integral of the table times the cosine over its directions: the reflectance up to a factor.
GONIO_INLINE double speos_reader::integral(const speos_table& table) const {
  const std::vector<double> of_phi = azimuth_weights(table.phi),
                            of_theta = node_weights(table.theta, [&](double theta) {
                              return std::sin(theta) * (has_cosine_ ? 1.0 : std::cos(theta));
                            });
  double sum = 0.0;
  for (std::size_t i = 0; i < table.theta.size(); ++i)
    for (std::size_t k = 0; k < table.phi.size(); ++k)
      sum += of_theta[i] * of_phi[k] * table.values[i * table.phi.size() + k];
  if (!(sum > 0.0)) words_.position().refuse("the table above reflects no light and cannot be scaled");
  return sum;
}

/// Multiplies a table by a factor, and divides it by the cosine if the file includes the cosine.
GONIO_INLINE void speos_reader::scale(speos_table& table, double factor) const {
  for (std::size_t i = 0; i < table.theta.size(); ++i)
    for (std::size_t k = 0; k < table.phi.size(); ++k) {
      double& value = table.values[i * table.phi.size() + k];
      value *= factor;
      if (has_cosine_) value /= std::max(std::cos(radians(table.theta[i])), 1e-9);
      if (table.theta[i] < 90.0) require_float_range(value, words_.position());
    }
}

/// Adds samples; `turn` (degrees) is added to both azimuths, `read_values(i, values)` gives the spectrum of value i.
template <class ReadValues>
void speos_reader::add(sample_collector& to, double incidence, double turn, const speos_table& table,
                       const ReadValues& read_values) const {
  const std::vector<bool> are_new = are_new_azimuths(table.phi);
  const direction wi = spherical_direction(radians(incidence), radians(180.0 + turn));
  std::vector<double> values;
  for (std::size_t i = 0; i < table.theta.size(); ++i)
    for (std::size_t k = 0; k < table.phi.size(); ++k) {
      const bool is_at_pole = table.theta[i] == 0.0;  // the same direction for every azimuth
      if (table.theta[i] == 90.0 || !are_new[k] || (is_at_pole && k > 0)) continue;
      values.clear();
      read_values(i * table.phi.size() + k, values);
      to.add({wi, spherical_direction(radians(table.theta[i]), radians(table.phi[k] + turn))}, values);
    }
}

/// Requires pure reflection, and reads whether tables include the cosine.
GONIO_INLINE void speos_reader::read_kind() {
  const bool reflects = words_.read_one_of({"0", "1"}) == 1, transmits = words_.read_one_of({"0", "1"}) == 1;
  if (!reflects || transmits)
    words_.position().refuse(
        "the file has transmission, expected only reflection, '1 0': save the reflection alone in Speos");
  has_cosine_ = words_.read_one_of({"0", "1"}) == 0;
}

GONIO_INLINE void speos_reader::finish() {
  if (words_.peek() == "End") static_cast<void>(words_.read_rest_of_line());  // "End of file"
  if (!words_.peek().empty()) words_.position().refuse("the file continues after its last table");
}

GONIO_INLINE sample_collector speos_reader::read() {
  constexpr double most = 10'000.0;
  read_kind();
  const double incidences = count("the number of angles of incidence", most),
               wavelengths = count("the number of wavelengths", most);
  const std::vector<double> all_incidences = ascending(incidences, "an angle of incidence", 0.0, 90.0);
  sample_collector collector(channels(ascending(wavelengths, "a wavelength", 1.0, 1e6)));
  for (const double incidence : all_incidences) {
    std::vector<speos_table> spectrum;
    while (static_cast<double>(spectrum.size()) < wavelengths) {
      const double reflectance = words_.read_number("the reflectance in percent", 0.0, 100.0);
      spectrum.push_back(read_table());
      scale(spectrum.back(), 0.01 * reflectance / integral(spectrum.back()));
      if (spectrum.back().theta != spectrum.front().theta || spectrum.back().phi != spectrum.front().phi)
        words_.position().refuse("the table above has other directions than the table of the first wavelength");
    }
    add(collector, incidence, 0.0, spectrum.front(), [&](std::size_t i, std::vector<double>& values) {
      for (const speos_table& each : spectrum) values.push_back(each.values[i]);
    });
  }
  finish();
  return collector;
}

// ---- the anisotropic kind ------------------------------------------------------------------------------------------

/// Reads the azimuths of the light and the angles of incidence of each, without their tables.
GONIO_INLINE std::vector<speos_turn> speos_reader::read_turns() {
  constexpr double most = 10'000.0;
  std::vector<speos_turn> turns;
  const double count_of_turns = count("the number of anisotropy angles", most);
  for (const double azimuth : ascending(count_of_turns, "an anisotropy angle", 0.0, 360.0))
    turns.push_back({azimuth, {}, {}});
  for (speos_turn& turn : turns) {
    const double incidences = count("the number of angles of incidence", most);
    turn.incidences = ascending(incidences, "an angle of incidence", 0.0, 90.0);
  }
  return turns;
}

/// Skips a line that is not a number.
GONIO_INLINE void speos_reader::skip_title() {
  double number = 0.0;
  if (io::read_number(words_.peek(), number) != nullptr) static_cast<void>(words_.read_rest_of_line());
}

/// Returns the integral at an angle of incidence: linear between the tables' angles, constant outside their range.
GONIO_INLINE double speos_reader::integral_at(const speos_turn& turn, double incidence) const {
  const std::vector<double>& all = turn.incidences;
  const auto above = static_cast<std::size_t>(std::ranges::lower_bound(all, incidence) - all.begin());
  if (above == 0) return integral(turn.tables.front());
  if (above == all.size()) return integral(turn.tables.back());
  const double share = (incidence - all[above - 1]) / (all[above] - all[above - 1]);
  return (1.0 - share) * integral(turn.tables[above - 1]) + share * integral(turn.tables[above]);
}

/// Limits memory: the file has each value once, samples repeat it for each wavelength.
GONIO_INLINE void speos_reader::require_room(std::size_t wavelengths, const std::vector<speos_turn>& turns) const {
  constexpr std::size_t small = 4'000'000, of_each_byte = 64;
  std::size_t values = 0;
  for (const speos_turn& turn : turns)
    for (const speos_table& table : turn.tables) values += table.values.size();
  if (values > (small + of_each_byte * size_) / wavelengths)
    gonio::refuse({words_.position().name, ": has ", values, " values and a spectrum of ", wavelengths,
                   " wavelengths, which are too many for a file of this size"});
}

/// One spectrum of the reflectance, at one angle of incidence, scales all tables.
GONIO_INLINE sample_collector speos_reader::read_anisotropic() {
  for (int axis = 0; axis < 3; ++axis) static_cast<void>(words_.read_number("the anisotropy vector"));
  read_kind();
  std::vector<speos_turn> turns = read_turns();
  const double incidence = words_.read_number("the spectrum's angle of incidence", 0.0, 90.0),
               azimuth = words_.read_number("the spectrum's anisotropy angle", 0.0, 360.0);
  const auto of_spectrum = std::ranges::find(turns, azimuth, &speos_turn::azimuth);
  if (of_spectrum == turns.end())
    words_.position().refuse(
        {"the spectrum's anisotropy angle ", shortest(azimuth), " is not among the angles of the tables"});
  skip_title();
  std::vector<double> wavelengths, reflectances;
  for (double left = count("the number of wavelengths", 10'000.0); left > 0.0; --left) {
    const double lowest = wavelengths.empty() ? 1.0 : std::nextafter(wavelengths.back(), 2e6);
    wavelengths.push_back(words_.read_number("a wavelength", lowest, 1e6));
    reflectances.push_back(words_.read_number("the reflectance in percent", 0.0, 100.0));
  }
  for (speos_turn& turn : turns)
    while (turn.tables.size() < turn.incidences.size()) turn.tables.push_back(read_table());
  finish();
  const double whole = integral_at(*of_spectrum, incidence);
  require_room(wavelengths.size(), turns);
  sample_collector collector{channels(wavelengths)};
  for (speos_turn& turn : turns)
    for (std::size_t i = 0; i < turn.tables.size(); ++i) {
      speos_table& table = turn.tables[i];
      scale(table, 0.01 / whole);
      add(collector, turn.incidences[i], -turn.azimuth, table, [&](std::size_t at, std::vector<double>& values) {
        for (const double reflectance : reflectances) values.push_back(reflectance * table.values[at]);
      });
    }
  return collector;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE bool looks_like_speos_brdf(std::string_view text) {
  text = without_byte_order_mark(text);
  return text.starts_with(detail::speos_header) || text.starts_with(detail::speos_anisotropic_header);
}

GONIO_INLINE sample_set read_speos_brdf(std::string_view text, const std::string& name) {
  text_position position{name, 0};
  text = without_byte_order_mark(text);
  const bool is_anisotropic = text.starts_with(detail::speos_anisotropic_header);
  detail::read_speos_rows(text, position);
  detail::speos_reader reader(text, position);
  return (is_anisotropic ? reader.read_anisotropic() : reader.read()).samples(name);
}

GONIO_INLINE sample_set read_speos_brdf(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_speos_brdf(as_text(bytes), path.string());
}

}  // namespace gonio::io
