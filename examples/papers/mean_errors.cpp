#include "papers/mean_errors.hpp"

#include "papers/material_result.hpp"
#include "tool/pages/measures_as_json.hpp"

namespace papers {

json mean_errors(std::span<const material_result> results) {
  return {{"mapped_rms", mean_over(results, [](const auto& e) { return e.mapped_rms.mean(); })},
          {"cosine_rms", mean_over(results, [](const auto& e) { return e.cosine_rms.mean(); })},
          {"delta_e_lights", mean_over(results, [](const auto& e) { return e.delta_e_lights; })},
          {"delta_e_env", mean_over(results, [](const auto& e) { return e.delta_e_env; })},
          {"peak_ratio", mean_over(results, [](const auto& e) { return e.peak_ratio.mean(); })}};
}

json errors_by_name(std::span<const material_result> results) {
  json materials = json::object();
  for (const auto& [name, errors] : results) materials[name] = to_json(errors);
  return materials;
}

}  // namespace papers
