#include "measures_as_json.hpp"

#include <gonio/evaluate/comparison.hpp>
#include <gonio/model/instrument_readings.hpp>

#include <string>

namespace cli {

json per_channel(const gonio::rgb& values) { return json::array({values.x(), values.y(), values.z()}); }

json to_json(const gonio::comparison& errors) {
  return {{"mapped_rms", errors.mapped_rms.mean()},
          {"cosine_rms", errors.cosine_rms.mean()},
          {"delta_e_lights", errors.delta_e_lights},
          {"delta_e_env", errors.delta_e_env},
          {"peak_ratio", errors.peak_ratio.mean()},
          {"channels",
           {{"mapped_rms", per_channel(errors.mapped_rms)},
            {"cosine_rms", per_channel(errors.cosine_rms)},
            {"peak_ratio", per_channel(errors.peak_ratio)}}}};
}

json to_json(const gonio::model::instrument_readings& readings) {
  json gloss, colours = json::array();
  for (std::size_t i = 0; i < readings.gloss.size(); ++i)
    gloss[std::to_string(gonio::model::gloss_angles[i])] = readings.gloss[i];
  for (const auto& [aspecular, lab] : readings.colours)
    colours.push_back({{"aspecular", aspecular}, {"L", lab.x()}, {"a", lab.y()}, {"b", lab.z()}});
  return {{"gloss", gloss},
          {"haze_20", readings.haze},
          {"haze_index", readings.haze_index()},
          {"reflectance_8", per_channel(readings.total)},
          {"reflectance_8_specular_excluded", per_channel(readings.diffuse)},
          {"luminous_reflectance_8", gonio::luminance(readings.total)},
          {"luminous_reflectance_8_specular_excluded", gonio::luminance(readings.diffuse)},
          {"total_integrated_scatter", readings.scatter},
          {"colours", colours}};
}

}  // namespace cli
