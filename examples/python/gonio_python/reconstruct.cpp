/// `gonio reconstruct` in Python, with the same code: methods by name, with the tool's defaults.

#include "arrays.hpp"
#include "copies.hpp"
#include "json_to_python.hpp"
#include "subjects.hpp"
#include "tool/options/reconstruct_choice.hpp"
#include "words.hpp"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <variant>

namespace python {

namespace {

using paths = std::vector<std::filesystem::path>;

/// Converts Python's arguments to the tool's options; None means not given.
class given_options {
 public:
  template <class Option, class Value>
  void take(const char* name, Option& option, const std::optional<Value>& value) {
    if (!value) return;
    option = *value;
    names_.insert(name);
  }
  /// Takes a number, and checks the bounds that the command line checks by itself.
  template <class Option, class Value>
  void take(const char* name, Option& option, const std::optional<Value>& value, double lowest,
            double highest = std::numeric_limits<double>::max()) {
    if (value && !(static_cast<double>(*value) >= lowest && static_cast<double>(*value) <= highest))
      gonio::refuse({in_python(name), std::string(py::str(py::cast(*value))), ": expected ", bounds(lowest, highest)});
    take(name, option, value);
  }
  void take_flag(const char* name, bool& option, bool value) {
    option = value;
    if (value) names_.insert(name);
  }

  [[nodiscard]] bool operator()(const std::string& name) const { return names_.contains(name); }

 private:
  static std::string bounds(double lowest, double highest) {
    const auto text = [](double bound) { return std::string(py::str(py::int_(static_cast<long>(bound)))); };
    if (highest == std::numeric_limits<double>::max()) return "at least " + text(lowest);
    return text(lowest) + " to " + text(highest);
  }

  std::set<std::string> names_;
};

/// Returns the text of a number, or gcv or loo.
std::optional<std::string> eta_text(const py::object& eta) {
  if (eta.is_none()) return std::nullopt;
  if (py::isinstance<py::str>(eta)) return eta.cast<std::string>();
  return std::string(py::repr(py::float_(eta)));
}

/// A prior's file, or a prior that was read.
using given_prior = std::optional<std::variant<std::filesystem::path, gonio::log_relative_pca>>;

void take_prior(const given_prior& prior, cli::material_source& materials, given_options& given) {
  if (!prior) return;
  if (const auto* held = std::get_if<gonio::log_relative_pca>(&*prior))
    given.take("--prior", materials.held_prior, std::optional(*held));
  else
    given.take("--prior", materials.prior, std::optional(std::get<std::filesystem::path>(*prior)));
}

struct reconstructed {
  gonio::brdf_table table;
  std::optional<gonio::brdf_table> uncertainty;
  py::object details;
  std::string sentence;
  std::vector<std::string> warnings;
};

reconstructed reconstruct_from(const gonio::sample_set& samples, const std::string& method, const given_prior& prior,
                               const std::optional<paths>& networks, const std::optional<paths>& merl,
                               const std::optional<paths>& rgl, const std::optional<std::vector<std::string>>& exclude,
                               const std::optional<std::string>& metric, std::optional<double> root,
                               const std::optional<std::string>& solver, const py::object& eta,
                               std::optional<double> lambda_share, std::optional<double> variance,
                               std::optional<double> noise, std::optional<double> misplaced_degrees,
                               std::optional<double> discrepancy, bool reject, bool uncertainty,
                               const py::object& gamma, bool as_printed, std::optional<int> iterations,
                               std::optional<std::uint64_t> seed, std::optional<Eigen::Index> neighbours,
                               unsigned threads) {
  cli::reconstruct_options options;
  given_options given;
  options.method = method;
  options.threads.value = threads;
  options.materials.prior = prior_file({});
  take_prior(prior, options.materials, given);
  given.take("--networks", options.materials.networks, networks);
  given.take("--merl", options.materials.tables, merl);
  given.take("--rgl", options.materials.rgl, rgl);
  given.take("--exclude", options.materials.exclude, exclude);
  given.take("--metric", options.metric, metric);
  given.take("--root", options.root, root);
  given.take("--solver", options.solver.name, solver);
  given.take("--eta", options.solver.eta, eta_text(eta));
  given.take("--lambda", options.solver.lambda, lambda_share);
  given.take("--variance", options.solver.variance, variance);
  given.take("--noise", options.noise, noise, 0.0);
  given.take("--misplaced", options.angular_error, misplaced_degrees);
  given.take("--discrepancy", options.discrepancy, discrepancy, 0.0, 10.0);
  given.take_flag("--no-reject", options.keeps_all, !reject);
  given.take_flag("--uncertainty", options.keeps_uncertainty, uncertainty);
  given.take("--gamma", options.gamma, eta_text(gamma));
  given.take_flag("--as-printed", options.as_printed, as_printed);
  given.take("--iterations", options.iterations, iterations, 1.0, 10'000.0);
  given.take("--seed", options.seed, seed);
  given.take("--neighbours", options.neighbours, neighbours, 1.0, gonio::scattered_options::most_neighbours);
  cli::take_given(options, given);

  std::optional<cli::reconstruction> found;
  {
    const py::gil_scoped_release released;
    found.emplace(cli::reconstruct(options, samples));
  }
  for (std::string& sentence : found->warnings) sentence = in_python(sentence);
  warn(found->warnings);
  return {std::move(found->table), std::move(found->uncertainty), to_python(found->details), found->sentence,
          found->warnings};
}

}  // namespace

void add_reconstruct(py::module_& m) {
  py::class_<reconstructed> type(m, "Reconstruction", "The result of `gonio reconstruct`.");
  type.def_property_readonly(
      "table", [](reconstructed& r) -> gonio::brdf_table& { return r.table; },
      py::return_value_policy::reference_internal, "The BRDF.");
  type.def_property_readonly(
      "uncertainty", [](reconstructed& r) { return r.uncertainty ? &*r.uncertainty : nullptr; },
      py::return_value_policy::reference_internal,
      "The relative uncertainty of each direction with a probability of 68 %, if requested.");
  type.def_readonly("details", &reconstructed::details, "The details that the tool prints with --json.");
  type.def_readonly("sentence", &reconstructed::sentence, "The result as a sentence.");
  type.def_readonly("warnings", &reconstructed::warnings,
                    "The warnings that were also issued through Python's warnings.");

  type.def(
      "_repr_html_", [](const py::object& self) { return sphere_as_html(self.attr("table"), self); },
      "Returns HTML for notebooks: a small sphere and the repr.");
  type.def("__repr__", [](const reconstructed& r) { return "<gonio.Reconstruction: " + r.sentence + '>'; });
  add_copies(
      type,
      [](const reconstructed& r) { return py::make_tuple(r.table, r.uncertainty, r.details, r.sentence, r.warnings); },
      [](const py::tuple& state) {
        require_state(state, 5);
        return reconstructed{state[0].cast<gonio::brdf_table>(), state[1].cast<std::optional<gonio::brdf_table>>(),
                             state[2], state[3].cast<std::string>(), state[4].cast<std::vector<std::string>>()};
      });

  const auto nothing = py::none();
  m.def("reconstruct", &reconstruct_from, py::arg("samples"), py::arg("method") = cli::reconstruct_options{}.method,
        py::kw_only(), py::arg("prior") = nothing, py::arg("networks") = nothing, py::arg("merl") = nothing,
        py::arg("rgl") = nothing, py::arg("exclude") = nothing, py::arg("metric") = nothing, py::arg("root") = nothing,
        py::arg("solver") = nothing, py::arg("eta") = nothing, py::arg("lambda_share") = nothing,
        py::arg("variance") = nothing, py::arg("noise") = nothing, py::arg("misplaced_degrees") = nothing,
        py::arg("discrepancy") = nothing, py::arg("reject") = true, py::arg("uncertainty") = false,
        py::arg("gamma") = nothing, py::arg("as_printed") = false, py::arg("iterations") = nothing,
        py::arg("seed") = nothing, py::arg("neighbours") = nothing, py::arg("threads") = 0,
        "Completes a BRDF from samples as `gonio reconstruct` does. method: pca, soft-specular, linear, correction, "
        "rbf,\n"
        "pull-push or scattered. The other arguments are the tool's options (docs/reference/tool.md); None\n"
        "means the tool's default. prior: a Prior or the path of one; None means the prior that ships with the\n"
        "package. A method refuses an argument that it would ignore.");
}

}  // namespace python
