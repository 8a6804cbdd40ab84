/// Analytic models: their fits, formula materials, and texts for renderers.

#include "brdf_methods.hpp"
#include "copies.hpp"
#include "json_to_python.hpp"
#include "subjects.hpp"
#include "tool/options/model_choice.hpp"
#include <gonio/io/materials/renderer_material.hpp>
#include <gonio/model/formula_materials.hpp>

#include <pybind11/stl.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace python {

namespace {

using gonio::model::cell_weighting;
using gonio::model::fit_norm;

/// Returns the value that `known` has for a word.
template <class Value>
Value named(const std::string& word, const char* name, const std::map<std::string, Value>& known) {
  if (const auto found = known.find(word); found != known.end()) return found->second;
  std::string words;
  for (const auto& [each, value] : known) words += (words.empty() ? "" : ", ") + each;
  gonio::refuse({name, " is '", word, "': expected one of ", words});
}

cli::model_choice choice_of(const std::string& model, const std::string& metric, const std::string& loss,
                            bool cosine_weighted, bool fresnel, double largest_albedo, Eigen::Index starts,
                            std::uint64_t seed, unsigned threads) {
  cli::model_choice choice;
  choice.model = model;
  choice.metric = named<std::string>(metric, "metric", {{"lin", "lin"}, {"log", "log"}, {"cubic", "cubic"}});
  choice.fresnel = fresnel;
  choice.fit.norm =
      named<fit_norm>(loss, "loss", {{"l1", fit_norm::l1}, {"l2", fit_norm::l2}, {"huber", fit_norm::huber}});
  choice.fit.cosine_weighted = cosine_weighted;
  if (starts < 0 || starts > 10'000) gonio::refuse({"starts is ", starts, ": expected 0 to 10000"});
  choice.fit.largest_albedo = largest_albedo;
  choice.fit.random_starts = starts;
  choice.fit.seed = seed;
  choice.fit.threads.value = threads;
  return choice;
}

gonio::model::model_fit fit_samples(const gonio::sample_set& samples, const std::string& model,
                                    const std::string& metric, const std::string& loss, bool cosine_weighted,
                                    bool fresnel, double largest_albedo, Eigen::Index starts, std::uint64_t seed,
                                    unsigned threads) {
  const auto choice = choice_of(model, metric, loss, cosine_weighted, fresnel, largest_albedo, starts, seed, threads);
  return cli::fit_chosen(choice, gonio::model::fit_observations(samples));
}

gonio::model::model_fit fit_table(const gonio::brdf_table& table, const std::string& model, const std::string& metric,
                                  const std::string& loss, bool cosine_weighted, bool fresnel, double largest_albedo,
                                  Eigen::Index starts, std::uint64_t seed, unsigned threads,
                                  const std::string& cell_weights) {
  const auto choice = choice_of(model, metric, loss, cosine_weighted, fresnel, largest_albedo, starts, seed, threads);
  const auto weighting = named<cell_weighting>(cell_weights, "cell_weights",
                                               {{"equal", cell_weighting::equal},
                                                {"solid-angle", cell_weighting::solid_angle},
                                                {"cosine", cell_weighting::cosine}});
  return cli::fit_chosen(choice, gonio::model::fit_observations(table, choice.fit.threads, weighting));
}

/// Returns the kind, the colour and the parameters of each lobe.
py::tuple state_of_lobes(const gonio::model::analytic_brdf& f) {
  py::list lobes;
  for (const gonio::model::analytic_lobe& lobe : f.lobes())
    lobes.append(py::make_tuple(std::string(lobe.kind().name()), array_of_numbers(lobe.colour()),
                                array_of_numbers(lobe.parameters())));
  return py::make_tuple(lobes);
}

gonio::model::analytic_brdf brdf_of_lobes(const py::tuple& state) {
  require_state(state, 1);
  std::vector<gonio::model::analytic_lobe> lobes;
  for (const py::handle each : state[0]) {
    const auto lobe = py::reinterpret_borrow<py::tuple>(each);
    require_state(lobe, 3);
    gonio::rgb colour;
    gonio::model::lobe_kind::values parameters{};
    copy_numbers(lobe[1], colour.data(), colour.size());
    copy_numbers(lobe[2], parameters.data(), std::ssize(parameters));
    lobes.emplace_back(gonio::model::lobe_kind_named(lobe[0].cast<std::string>()), colour, parameters);
  }
  return gonio::model::analytic_brdf(std::move(lobes));
}

std::string sentence_of(const gonio::model::analytic_brdf& f) {
  std::string names;
  for (const gonio::model::analytic_lobe& lobe : f.lobes())
    names += (names.empty() ? "" : " + ") + std::string(lobe.kind().name());
  return "<gonio.AnalyticBrdf: " + names + '>';
}

void add_model_copies(py::class_<gonio::model::model_fit>& type) {
  using gonio::model::model_fit;
  add_copies(
      type,
      [](const model_fit& fit) {
        return py::make_tuple(fit.model, fit.loss, fit.evaluations, fit.converged, fit.promised_gain);
      },
      [](const py::tuple& state) {
        require_state(state, 5);
        return model_fit{state[0].cast<gonio::model::analytic_brdf>(), state[1].cast<double>(),
                         state[2].cast<Eigen::Index>(), state[3].cast<bool>(), state[4].cast<double>()};
      });
}

/// A formula with its name.
struct named_formula : gonio::model::formula_brdf {
  std::string name;
};

named_formula formula_named(const std::string& name) { return {gonio::model::formula_material(name), name}; }

void add_formulas(py::module_& m) {
  py::class_<named_formula> formula(
      m, "FormulaBrdf", "A material given by a formula: it is in no database, and its true values are known.");
  formula.def("__repr__", [](const named_formula& f) { return "<gonio.FormulaBrdf: " + f.name + '>'; });
  add_copies(
      formula, [](const named_formula& f) { return py::make_tuple(f.name); },
      [](const py::tuple& state) {
        require_state(state, 1);
        return formula_named(state[0].cast<std::string>());
      });
  add_brdf_methods(m, formula);
  m.def("formula_material", &formula_named, py::arg("name"), "Returns a formula material by its name.");
  m.def("formula_material_names", &gonio::model::formula_material_names);
}

void add_fit_function(py::module_& m) {
  using gonio::model::model_fit;
  py::class_<model_fit> type(m, "ModelFit", "A fitted model, and information on its minimum.");
  type.def_readonly("model", &model_fit::model, "The fitted BRDF.");
  type.def_readonly("loss", &model_fit::loss, "The weighted mean of the norm of the residual.");
  type.def_readonly("evaluations", &model_fit::evaluations, "The number of evaluations of the loss.");
  type.def_readonly("converged", &model_fit::converged, "Did the fit reach a minimum?");
  type.def_readonly("promised_gain", &model_fit::promised_gain, "The predicted gain of one more step.");
  type.def("__repr__", [](const model_fit& fit) {
    return "<gonio.ModelFit: " + sentence_of(fit.model) + (fit.converged ? ", converged>" : ", not converged>");
  });
  add_model_copies(type);
  const cli::model_choice standard;
  m.def("fit_model", &fit_samples, py::arg("measurements"), py::arg("model") = standard.model, py::kw_only(),
        py::arg("metric") = standard.metric, py::arg("loss") = "huber",
        py::arg("cosine_weighted") = standard.fit.cosine_weighted, py::arg("fresnel") = standard.fresnel,
        py::arg("largest_albedo") = standard.fit.largest_albedo, py::arg("starts") = standard.fit.random_starts,
        py::arg("seed") = standard.fit.seed, py::arg("threads") = 0, py::call_guard<py::gil_scoped_release>(),
        "Fits an analytic model as `gonio fit` does: a lobe plus a Lambertian lobe, or with 'sum:ward+ggx' the named\n"
        "lobes. measurements: samples or a table, whose cells are weighted by cell_weights (equal, solid-angle,\n"
        "cosine). The model reflects at most the fraction largest_albedo of light incident at up to 88 degrees; inf:\n"
        "no limit.");
  m.def("fit_model", &fit_table, py::arg("measurements"), py::arg("model") = standard.model, py::kw_only(),
        py::arg("metric") = standard.metric, py::arg("loss") = "huber",
        py::arg("cosine_weighted") = standard.fit.cosine_weighted, py::arg("fresnel") = standard.fresnel,
        py::arg("largest_albedo") = standard.fit.largest_albedo, py::arg("starts") = standard.fit.random_starts,
        py::arg("seed") = standard.fit.seed, py::arg("threads") = 0, py::arg("cell_weights") = "equal",
        py::call_guard<py::gil_scoped_release>());
}

}  // namespace

void add_models(py::module_& m) {
  py::class_<gonio::model::analytic_brdf> analytic(m, "AnalyticBrdf", "A sum of lobes.");
  analytic.def_property_readonly(
      "lobes", [](const gonio::model::analytic_brdf& f) { return to_python(cli::to_json(f)); },
      "Each lobe's name, colour and parameters.");
  analytic.def("mitsuba", &gonio::io::mitsuba_material, "Returns the material as XML of Mitsuba 3.");
  analytic.def("pbrt", &gonio::io::pbrt_material, "Returns the material as text of pbrt-v4.");
  analytic.def("materialx", &gonio::io::materialx_material, py::arg("name") = "material",
               "Returns the material as a document of MaterialX.");
  analytic.def("gltf", &gonio::io::gltf_material, "Returns a sphere of the material as a glTF file.");
  analytic.def("osl", &gonio::io::osl_shader, "Returns a shader for Blender's Cycles in the Open Shading Language.");
  analytic.def("__repr__", [](const gonio::model::analytic_brdf& f) { return sentence_of(f); });
  add_copies(analytic, &state_of_lobes, &brdf_of_lobes);
  add_brdf_methods(m, analytic);
  add_fit_function(m);
  add_formulas(m);
}

}  // namespace python
