#include "read_as.hpp"

#include "fixed.hpp"
#include "sample_warnings.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace cli {

namespace {

using gonio::io::sample_quantity;

std::string rounded(double angle) { return gonio::io::shortest(std::round(10.0 * angle) / 10.0 + 0.0); }

/// Returns "-60 to 30", or "-45" for a single angle.
std::string span(const std::set<double>& angles) {
  const std::string first = rounded(*angles.begin());
  return angles.size() == 1 ? first : first + " to " + rounded(*angles.rbegin());
}

/// Returns "0, 30, 60", or "0 to 80 (17 angles)" for many.
std::string listed(const std::set<double>& angles) {
  constexpr std::size_t most = 8;
  if (angles.size() > most) return span(angles) + " (" + std::to_string(angles.size()) + " angles)";
  std::string text;
  for (const double each : angles) text += (text.empty() ? "" : ", ") + rounded(each);
  return text;
}

/// The angles of all samples to a tenth of a degree. In the plane of incidence theta_o is negative on the mirror
/// direction's side.
struct measured_angles {
  std::set<double> theta_i, theta_o;
  bool in_plane = true;

  explicit measured_angles(const gonio::sample_set& samples) {
    constexpr double tolerance = 0.5, at_normal = 0.1;
    const auto tenths = [](double radians) { return std::round(10.0 * gonio::degrees(radians)) / 10.0 + 0.0; };
    for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
      const auto [wi, wo] = samples.directions(i).pair();
      const double incident = tenths(gonio::polar_angle(wi)), reflected = tenths(gonio::polar_angle(wo));
      const double turn = gonio::azimuth(wo) - (incident < at_normal ? 0.0 : gonio::azimuth(wi));
      const double apart = std::abs(gonio::degrees(std::remainder(turn, gonio::radians(360.0))));
      theta_i.insert(incident);
      theta_o.insert(apart > 90.0 ? -reflected : reflected);
      if (std::min(incident, reflected) > at_normal && std::min(apart, 180.0 - apart) > tolerance) in_plane = false;
    }
  }
};

const char* described(sample_quantity quantity) {
  switch (quantity) {
    case sample_quantity::brdf:
      return "BRDF in sr^-1";
    case sample_quantity::brdf_cosine:
      return "BRDF times the cosine of theta_o";
    case sample_quantity::reflectance_factor:
      return "reflectance factors (a white diffuser has 1)";
    case sample_quantity::percent:
      return "percent of a white diffuser";
  }
  return "";
}

std::string described(const gonio::channels& channels) {
  const std::vector<double>& wavelengths = channels.wavelengths();
  if (channels.are_colours()) return "red, green and blue";
  if (wavelengths.empty()) return "one channel";
  if (wavelengths.size() == 1) return gonio::io::shortest(wavelengths.front()) + " nm";
  return std::to_string(wavelengths.size()) + " wavelengths, " + gonio::io::shortest(wavelengths.front()) + " to " +
         gonio::io::shortest(wavelengths.back()) + " nm";
}

}  // namespace

json read_as(const gonio::io::sample_file& file) {
  const measured_angles angles(file.samples);
  std::string sentence = counted(std::ssize(file.samples), "sample") +
                         (angles.in_plane ? " in the plane of incidence" : "") + "; theta_i " + listed(angles.theta_i) +
                         " degrees; theta_o ";
  if (angles.in_plane)
    sentence += span(angles.theta_o) + " degrees, negative on the mirror direction's side";
  else
    sentence += "up to " + rounded(std::max(*angles.theta_o.rbegin(), -*angles.theta_o.begin())) + " degrees";
  const sample_quantity quantity = file.quantity.value_or(sample_quantity::brdf);
  sentence += "; " + described(file.samples.channels()) + ", " + described(quantity);
  if (!file.text.dialect.empty()) sentence += "; " + file.text.dialect;
  if (file.text.omitted_rows > 0)
    sentence +=
        "; " + counted(static_cast<std::ptrdiff_t>(file.text.omitted_rows), "row") + " without a reading omitted";

  std::string options = "--quantity " + std::string(name_of(quantity));
  std::vector<std::string> unsure = doubts_of(file);
  if (file.text.assumes_side) {
    options += " --theta-o-sign light";
    unsure.insert(unsure.begin(),
                  "the sign of theta_o: if the mirror direction is at theta_o = theta_i, give --theta-o-sign mirror");
  } else if (file.sign) {
    options += *file.sign == gonio::io::theta_o_sign::light ? " --theta-o-sign light" : " --theta-o-sign mirror";
  }
  return {{"read_as", sentence}, {"options", options}, {"unsure_of", unsure}};
}

}  // namespace cli
