/// Priors, and estimators as the library has them: one fit, and how sure it is.

#include "brdf_methods.hpp"
#include "subjects.hpp"
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/solve/default_eta.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>

namespace python {

namespace {

using fitted_pca = gonio::fitted_brdf<gonio::log_relative_pca>;
using estimator_type = gonio::reconstruction<gonio::log_relative>;
using reconstructed_brdf = estimator_type::result_type;

/// A matrix of Eigen, column by column in memory.
template <class Matrix>
py::array_t<typename Matrix::Scalar> matrix_view(const Matrix& matrix, const py::object& owner) {
  constexpr py::ssize_t step = sizeof(typename Matrix::Scalar);
  return read_only(matrix.data(), {matrix.rows(), matrix.cols()},
                   {matrix.rowStride() * step, matrix.colStride() * step}, owner);
}

py::array_t<double> weights_of_material(const gonio::log_relative_pca& prior, const std::string& name) {
  const auto found = std::ranges::find(prior.names(), name);
  if (found == prior.names().end()) gonio::refuse("the prior has no material '" + name + "'");
  const Eigen::MatrixXd weights = prior.weights_of(found - prior.names().begin());
  py::array_t<double> array({weights.rows(), weights.cols()});
  for (Eigen::Index i = 0; i < weights.rows(); ++i)
    for (Eigen::Index c = 0; c < weights.cols(); ++c) array.mutable_at(i, c) = weights(i, c);
  return array;
}

void add_prior(py::module_& m) {
  py::class_<gonio::log_relative_pca> prior(
      m, "Prior",
      "What measured materials have in common: principal components in the logarithm of the reflectance relative to a\n"
      "median material (Nielsen et al. 2015). Copies share their memory; the arrays are views of it, to be read.");
  prior.def("__len__", &gonio::log_relative_pca::size, "The number of components.");
  prior.def_property_readonly("names", &gonio::log_relative_pca::names, "The materials that it was learned from.");
  prior.def_property_readonly("source", &gonio::log_relative_pca::source, "What it was learned from, for people.");
  prior.def_property_readonly(
      "wavelengths",
      [](const py::object& self) {
        const auto& wavelengths = self.cast<gonio::log_relative_pca&>().wavelengths();
        return read_only(wavelengths.data(), {static_cast<py::ssize_t>(wavelengths.size())}, {sizeof(double)}, self);
      },
      "The materials' channels in nanometres, ascending: shape (channels,). Colours have none.");
  prior.def_property_readonly("explained_variance", &gonio::log_relative_pca::explained_variance,
                              "Share of the materials' variance that the components keep.");
  prior.def_property_readonly(
      "components",
      [](const py::object& self) { return matrix_view(self.cast<gonio::log_relative_pca&>().components(), self); },
      "Scaled components: shape (cells, k).");
  prior.def_property_readonly(
      "mean",
      [](const py::object& self) {
        const auto& mean = self.cast<gonio::log_relative_pca&>().mean();
        return read_only(mean.data(), {static_cast<py::ssize_t>(mean.size())}, {sizeof(float)}, self);
      },
      "The mean material in the metric's domain: shape (cells,).");
  prior.def_property_readonly(
      "singular_values",
      [](const py::object& self) {
        const auto& values = self.cast<gonio::log_relative_pca&>().singular_values();
        return read_only(values.data(), {values.size()}, {sizeof(double)}, self);
      },
      "Largest first: shape (k,).");
  prior.def("weights_of", &weights_of_material, py::arg("name"),
            "The weights that expand to one of the materials: shape (k, channels).");
  m.def(
      "read_prior",
      [](const std::optional<std::filesystem::path>& path) {
        const std::filesystem::path file = prior_file(path);
        const py::gil_scoped_release released;
        return gonio::io::read_prior(file);
      },
      py::arg("path") = py::none(), "Reads a prior; without a path, the one that ships with the package.");
  m.def(
      "write_prior",
      [](const std::filesystem::path& path, const gonio::log_relative_pca& written) {
        gonio::io::write_prior(path, written);
      },
      py::arg("path"), py::arg("prior"), py::call_guard<py::gil_scoped_release>(), "Writes a prior.");
}

py::object report_of(const fitted_pca& fit) {
  if (!fit.report()) return py::none();
  const auto channels = [](const Eigen::VectorXd& v) { return std::vector<double>(v.begin(), v.end()); };
  py::dict report;
  report["residual"] = channels(fit.report()->residual);
  report["objective"] = channels(fit.report()->objective);
  report["kkt_residual"] = channels(fit.report()->kkt_residual);
  report["iterations"] = fit.report()->iterations;
  return report;
}

void add_decomposition(py::module_& m) {
  py::class_<fitted_pca> fit(m, "Fit", "A BRDF as a combination of a prior's components.");
  fit.def_property_readonly(
      "weights", [](const py::object& self) { return matrix_view(self.cast<fitted_pca&>().weights(), self); },
      "One column for each channel: shape (k, 3). A view, to be read.");
  fit.def_property_readonly("report", &report_of, "What the solver says of the weights, by channel.");
  add_brdf_methods(m, fit);

  using estimator = gonio::decomposition<gonio::log_relative_pca, gonio::tikhonov>;
  py::class_<estimator> type(
      m, "Decomposition",
      "Fits a prior's components with a penalty on the squares of their weights (Nielsen et al.\n"
      "2015, Eq. 12).");
  type.def(py::init([](const gonio::log_relative_pca& prior, double eta, unsigned threads) {
             return estimator(prior, gonio::tikhonov(eta), gonio::thread_count{threads});
           }),
           py::arg("prior"), py::arg("eta") = gonio::default_eta, py::arg("threads") = 0);
  type.def("fit", &estimator::fit<gonio::sample_set>, py::arg("samples"), py::call_guard<py::gil_scoped_release>(),
           "The BRDF that the samples, or all cells of a table, are of.");
  type.def("fit", &estimator::fit<gonio::brdf_table>, py::arg("samples"), py::call_guard<py::gil_scoped_release>());
}

gonio::confidence_level level_of(double probability) {
  if (probability == 0.68) return gonio::confidence_level::sixty_eight_percent;
  if (probability == 0.95) return gonio::confidence_level::ninety_five_percent;
  gonio::refuse({"there are intervals for a probability of 0.68 or 0.95, not of ",
                 std::string(py::str(py::float_(probability)))});
}

/// Intervals and deviations are of directions above the horizon.
direction_pairs pairs_above_horizon(const py::object& wi, const py::object& wo) {
  direction_pairs pairs(wi, wo);
  for (Eigen::Index i = 0; i < pairs.size(); ++i)
    if (!(pairs.wi(i).z() > 0.0 && pairs.wo(i).z() > 0.0))
      gonio::refuse({"pair ", i, " of wi and wo is not above the horizon, where nothing is known"});
  return pairs;
}

py::tuple intervals(const reconstructed_brdf& fit, const py::object& wi, const py::object& wo, double probability) {
  const direction_pairs pairs = pairs_above_horizon(wi, wo);
  const gonio::confidence_level level = level_of(probability);
  py::array_t<double> low = results_for(pairs, 3), high = results_for(pairs, 3);
  double *lowest = low.mutable_data(), *highest = high.mutable_data();
  {
    const py::gil_scoped_release released;
    gonio::for_each_index(pairs.size(), 64, [&](Eigen::Index i) {
      const gonio::reflectance_interval found = fit.interval(pairs.wi(i), pairs.wo(i), level);
      std::copy_n(found.low.data(), 3, lowest + 3 * i);
      std::copy_n(found.high.data(), 3, highest + 3 * i);
    });
  }
  return py::make_tuple(low, high);
}

py::array_t<double> known_to(const reconstructed_brdf& fit, const py::object& wi, const py::object& wo) {
  const direction_pairs pairs = pairs_above_horizon(wi, wo);
  py::array_t<double> shares = results_for(pairs, 1);
  double* to = shares.mutable_data();
  const py::gil_scoped_release released;
  gonio::for_each_index(pairs.size(), 64, [&](Eigen::Index i) { to[i] = fit.known_to(pairs.wi(i), pairs.wo(i)); });
  return shares;
}

std::array<double, 3> channels_of(const gonio::rgb& colour) { return {colour[0], colour[1], colour[2]}; }

std::string sentence_of(const gonio::outlying_sample& each) {
  std::ostringstream text;
  text.precision(3);
  const Eigen::Index worst = each.worst_channel();
  text << "row " << each.number << ": measured " << each.measured[worst] << ", the others say " << each.predicted[worst]
       << " (" << gonio::channels().name(worst) << ")";
  return text.str();
}

void add_outlying_sample(py::module_& m) {
  using outlying = gonio::outlying_sample;
  py::class_<outlying> type(m, "OutlyingSample", "A sample that the others contradict.");
  type.def_readonly("row", &outlying::number, "Of the samples, counted from 0.");
  type.def_property_readonly(
      "measured", [](const outlying& each) { return channels_of(each.measured); }, "sr^-1, by channel.");
  type.def_property_readonly(
      "predicted", [](const outlying& each) { return channels_of(each.predicted); },
      "sr^-1, by channel: from the others.");
  type.def_readonly("deviation", &outlying::deviation, "Of the logarithm of that prediction.");
  type.def_readonly("probability", &outlying::probability, "That the sample is wrong.");
  type.def("__repr__", &sentence_of);
}

/// Throws gonio::error for an impossible model.
estimator_type estimator_of(gonio::log_relative_pca prior, double variance, double noise, bool rejects,
                            unsigned threads) {
  if (!(variance > 0.0 && variance <= 10.0))
    gonio::refuse({"variance is ", variance, ": expected more than 0, at most 10"});
  if (!(noise >= 0.0 && std::isfinite(noise))) gonio::refuse({"noise is ", noise, ": expected at least 0"});
  const estimator_type estimator{
      std::move(prior), {.variance = variance, .noise = noise}, gonio::thread_count{threads}};
  return rejects ? estimator : estimator.keeping_all();
}

void add_reconstruction(py::module_& m) {
  add_outlying_sample(m);
  py::class_<reconstructed_brdf> fit(m, "ReconstructedBrdf",
                                     "A BRDF that says how sure it is, and which samples disagree with it.");
  add_brdf_methods(m, fit);
  fit.def("interval", &intervals, py::arg("wi"), py::arg("wo"), py::arg("probability") = 0.68,
          "Two arrays of shape (..., 3), sr^-1: a value lies between them with a probability of 0.68 or 0.95.");
  fit.def("known_to", &known_to, py::arg("wi"), py::arg("wo"),
          "By how much values are known, relative to them, with a probability of 68 %: 0.06 is to 6 %. Shape (...).");
  fit.def_property_readonly(
      "highlight_known_to_factor", [](const reconstructed_brdf& f) { return f.certainty().highlight_factor; },
      "To which factor the highlight is known, with a probability of 95 %.");
  fit.def_property_readonly("rejected", &reconstructed_brdf::rejected,
                            "Rows of the samples that count less than half, or not at all, the worst first.");
  fit.def_property_readonly("contradicted", &reconstructed_brdf::contradicted,
                            "Samples that the others contradict, the worst first; twenty of them at most.");
  fit.def_property_readonly("outlier_share", &reconstructed_brdf::outlier_share, "Of all samples.");
  py::class_<estimator_type> type(
      m, "Estimator",
      "What `gonio reconstruct` does: a prior's components and what they cannot say are fitted together. variance: of\n"
      "what the components cannot say, in squared logarithms. noise: of the values, relative to them (0.02 is 2 %).\n"
      "reject: leave out samples that the others contradict.");
  type.def(py::init(&estimator_of), py::arg("prior"), py::arg("variance") = gonio::discrepancy_model{}.variance,
           py::arg("noise") = 0.0, py::arg("reject") = true, py::arg("threads") = 0);
  type.def("fit", &estimator_type::fit, py::arg("samples"), py::call_guard<py::gil_scoped_release>(),
           "The BRDF that the samples are of, and how sure that is.");
}

}  // namespace

void add_estimators(py::module_& m) {
  add_prior(m);
  add_decomposition(m);
  add_reconstruction(m);
}

}  // namespace python
