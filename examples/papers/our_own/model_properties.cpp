/// gonio-papers model-properties: which analytic models are reciprocal, and how much they reflect.

#include "papers/experiments.hpp"
#include "tool/files/json.hpp"
#include "tool/options/model_choice.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/measures_as_json.hpp"
#include <gonio/model/physical_properties.hpp>

#include <iostream>
#include <memory>

namespace papers {

namespace {

/// Returns typical parameters with a given sharpness from 0 to 1: exponents from 1 to 10^4, roughnesses from 1 to 0.01.
gonio::model::lobe_kind::values of_sharpness(const gonio::model::lobe_kind& kind, double sharpness) {
  auto values = kind.typical();
  const auto about = kind.parameters();
  for (std::size_t i = 0; i < about.size(); ++i) {
    if (!about[i].logarithmic) continue;
    const bool exponent = about[i].highest > 100.0;
    values[i] = exponent ? std::pow(10.0, 4.0 * sharpness) : std::pow(10.0, -2.0 * sharpness);
  }
  return values;
}

json properties_of(const gonio::model::analytic_brdf& f) {
  const auto albedo = gonio::model::find_largest_albedo(f);
  return {{"asymmetry", gonio::model::worst_asymmetry(f).amount},
          {"negative", gonio::model::worst_negative(f).amount},
          {"anisotropy", gonio::model::worst_anisotropy(f).amount},
          {"largest_albedo", albedo.value},
          {"at_degrees", gonio::degrees(albedo.theta)},
          {"albedo_from_above", gonio::model::directional_albedo(f, 0.0).maxCoeff()}};
}

void print_properties(bool as_json) {
  json rows = json::array();
  for (const gonio::model::lobe_kind* kind : gonio::model::lobe_kinds())
    for (const double sharpness : {0.15, 0.5, 0.85}) {
      const auto values = of_sharpness(*kind, sharpness);
      const gonio::model::analytic_brdf f({gonio::model::analytic_lobe(*kind, gonio::rgb::Ones(), values)});
      json row{{"model", to_json(f)[0]}};
      row.update(properties_of(f));
      rows.push_back(std::move(row));
      if (kind->parameters().empty()) break;
    }
  if (as_json) {
    std::cout << rows.dump(2) << '\n';
    return;
  }
  std::cout << "Colour 1; reciprocity and isotropy over " << gonio::model::pair_grid().steps
            << "^3 pairs, as the largest relative difference.\n\n"
            << "| model | parameters | reciprocal | isotropic | albedo from above | largest albedo | at |\n"
            << "|---|---|---|---|---|---|---|\n";
  const auto verdict = [](const json& amount) {
    return amount.number() < 1e-6 ? std::string("yes") : "off by " + fixed(amount, 2);
  };
  for (const json& row : rows.elements()) {
    std::cout << "| " << row["model"]["lobe"].text() << " |";
    for (const auto& [name, value] : row["model"]["parameters"].items())
      std::cout << ' ' << name << ' ' << fixed(value, 3);
    std::cout << " | " << verdict(row["asymmetry"]) << " | " << verdict(row["anisotropy"]) << " | "
              << fixed(row["albedo_from_above"], 3) << " | " << fixed(row["largest_albedo"], 3) << " | "
              << fixed(row["at_degrees"], 0) << " degrees |\n";
  }
}

}  // namespace

void add_model_properties(command& app) {
  auto command = app.add_subcommand("model-properties", "Reciprocity, isotropy and albedo of the analytic models");
  const auto as_json = std::make_shared<bool>(false);
  command.add_flag("--json", *as_json, "Print as JSON");
  command.callback([as_json] { print_properties(*as_json); });
}

}  // namespace papers
