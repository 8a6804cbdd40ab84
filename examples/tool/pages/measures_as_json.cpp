#include "measures_as_json.hpp"

#include <gonio/evaluate/comparison.hpp>

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

}  // namespace cli
