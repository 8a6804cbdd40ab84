#include "report_readings.hpp"

#include <gonio/model/instrument_readings.hpp>
#include <gonio/render/horizon_lookup.hpp>

#include <cmath>
#include <string>

namespace cli {

namespace {

/// Returns the centres of source and receptor: light at `theta_i`, viewer `off_mirror` radians from the mirror
/// direction, away from the normal.
gonio::direction_pair centres_of(const gonio::model::reflectometer& meter) {
  const double theta_o = meter.theta_i + meter.off_mirror;
  return {gonio::direction(-std::sin(meter.theta_i), 0.0, std::cos(meter.theta_i)),
          gonio::direction(std::sin(theta_o), 0.0, std::cos(theta_o))};
}

}  // namespace

json readings_known_to(const gonio::brdf_table& fit, const gonio::brdf_table& uncertainty) {
  const gonio::render::horizon_lookup relative(uncertainty);
  const auto known_to = [&](const gonio::direction_pair& pair) { return double{relative(pair.wi, pair.wo).y()}; };
  json known, gloss, colours = json::array();
  for (const int angle : gonio::model::gloss_angles)
    gloss[std::to_string(angle)] = known_to(centres_of(gonio::model::gloss_meter(angle)));
  const double towards_normal = known_to(centres_of(gonio::model::haze_meter(-1)));
  const double away = known_to(centres_of(gonio::model::haze_meter(+1)));
  for (const double aspecular : gonio::model::aspecular_angles)
    colours.push_back(known_to(gonio::model::aspecular_directions(aspecular)));

  // Reflectance: the integral of the deviation divided by the integral of the fit.
  const auto deviation = [&](const gonio::direction& wi, const gonio::direction& wo) noexcept {
    return gonio::rgb(fit(wi, wo) * relative(wi, wo));
  };
  const double incidence = gonio::radians(8.0), cone = gonio::radians(4.0);
  const auto inside = [&](const auto& f) {
    return gonio::luminance(gonio::model::share_within_cone(f, incidence, cone));
  };
  const auto outside = [&](const auto& f) {
    return gonio::luminance(gonio::model::share_outside_cone(f, incidence, cone, 120));
  };
  const double diffuse = outside(fit), deviation_of_diffuse = outside(deviation);
  const double total = diffuse + inside(fit);

  known["gloss"] = gloss;
  known["haze_20"] = 0.5 * (towards_normal + away);
  known["reflectance_8"] = total > 0.0 ? json((deviation_of_diffuse + inside(deviation)) / total) : json(nullptr);
  known["reflectance_8_specular_excluded"] = diffuse > 0.0 ? json(deviation_of_diffuse / diffuse) : json(nullptr);
  known["colours"] = colours;
  return known;
}

}  // namespace cli
