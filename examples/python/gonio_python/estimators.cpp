/// Priors and the library's estimators: a fit, and its uncertainty.

#include "brdf_methods.hpp"
#include "cells.hpp"
#include "copies.hpp"
#include "spectra.hpp"
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
#include <optional>
#include <sstream>
#include <string>
#include <vector>

namespace python {

namespace {

using fitted_pca = gonio::fitted_brdf<gonio::log_relative_pca>;
using estimator_type = gonio::reconstruction<gonio::log_relative>;

/// The arguments of an estimator. An estimator is pickled by its arguments; its result by the arguments and the
/// samples, which unpickling fits again.
struct estimator_arguments {
  gonio::log_relative_pca prior;
  double variance = 0.0, noise = 0.0;
  bool rejects = true;
  unsigned threads = 0;
};

struct configured_estimator : estimator_type {
  estimator_arguments arguments;
};

struct reconstructed_brdf : estimator_type::result_type {
  estimator_arguments arguments;
  gonio::sample_set samples;
};

/// Returns a view of an Eigen matrix, which is column-major.
template <class Matrix>
py::array_t<typename Matrix::Scalar> matrix_view(const Matrix& matrix, const py::object& owner) {
  constexpr py::ssize_t step = sizeof(typename Matrix::Scalar);
  return read_only(matrix.data(), {matrix.rows(), matrix.cols()},
                   {matrix.rowStride() * step, matrix.colStride() * step}, owner);
}

py::array_t<double> weights_of_material(const gonio::log_relative_pca& prior, const std::string& name) {
  const auto found = std::ranges::find(prior.names(), name);
  if (found == prior.names().end()) gonio::refuse("the prior has no material '" + name + "'");
  return copy_of(prior.weights_of(found - prior.names().begin()));
}

py::tuple state_of_prior(const gonio::log_relative_pca& prior) {
  return py::make_tuple(state_of(prior.cells()), array_of_numbers(prior.metric().reference()),
                        static_cast<int>(prior.metric().weighting()), prior.names(), copy_of(prior.singular_values()),
                        copy_of(prior.components()), array_of_numbers(prior.mean()), copy_of(prior.coefficients()),
                        prior.explained_variance(), prior.source(), array_of_numbers(prior.wavelengths()));
}

gonio::log_relative_pca prior_of_state(const py::tuple& state) {
  require_state(state, 11);
  const gonio::valid_cells cells = cells_of_state(state[0].cast<py::tuple>());
  std::vector<float> reference(static_cast<std::size_t>(cells.size())), mean(reference.size());
  copy_numbers(state[1], reference.data(), cells.size());
  copy_numbers(state[6], mean.data(), cells.size());
  std::vector<double> wavelengths(py::len(state[10]));
  copy_numbers(state[10], wavelengths.data(), std::ssize(wavelengths));
  const gonio::log_relative metric(cells, reference, static_cast<gonio::cosine_weighting>(state[2].cast<int>()));
  return gonio::log_relative_pca({cells, metric, state[3].cast<std::vector<std::string>>(),
                                  matrix_of<Eigen::MatrixXd>(state[4]).col(0), matrix_of<gonio::cell_matrix>(state[5]),
                                  mean, matrix_of<Eigen::MatrixXf>(state[7]), state[8].cast<double>(),
                                  state[9].cast<std::string>(), wavelengths});
}

/// Adds the properties needed to evaluate a prior's cell without gonio.
void add_domain(py::class_<gonio::log_relative_pca>& prior) {
  prior.def_property_readonly("cells", &gonio::log_relative_pca::cells,
                              "The cells over which components, mean and reference have their values.");
  prior.def_property_readonly(
      "reference",
      [](const py::object& self) {
        const auto reference = self.cast<gonio::log_relative_pca&>().metric().reference();
        return read_only(reference.data(), {static_cast<py::ssize_t>(reference.size())}, {sizeof(float)}, self);
      },
      "The median material, sr^-1, to which the metric is relative: shape (cells,).");
  prior.def_property_readonly(
      "cosine_weight",
      [](const py::object& self) {
        const auto& f = self.cast<gonio::log_relative_pca&>();
        py::array_t<double> weights(extents{f.cells().size()});
        for (Eigen::Index cell = 0; cell < f.cells().size(); ++cell)
          weights.mutable_at(cell) = f.metric().cosine_weight(gonio::cosines(f.cells().angles(cell)));
        return weights;
      },
      "The cosine weight c of each cell in the metric: shape (cells,). A fit with weights w has the mapped values\n"
      "y = components @ w + mean and the reflectance (exp(y) (reference c + .001) - .001) / c in\n"
      "sr^-1, at least 0.");
}

void add_prior(py::module_& m) {
  py::class_<gonio::log_relative_pca> prior(
      m, "Prior",
      "The prior of measured materials: principal components of the logarithm of reflectance relative to a median\n"
      "material (Nielsen et al. 2015). Copies share their memory; the arrays are read-only views of it.");
  prior.def("__len__", &gonio::log_relative_pca::size, "The number of components.");
  prior.def_property_readonly("names", &gonio::log_relative_pca::names, "The materials that it was learned from.");
  prior.def_property_readonly("source", &gonio::log_relative_pca::source,
                              "A description of the data that the prior was learned from.");
  prior.def_property_readonly(
      "wavelengths",
      [](const py::object& self) {
        const auto& wavelengths = self.cast<gonio::log_relative_pca&>().wavelengths();
        return read_only(wavelengths.data(), {static_cast<py::ssize_t>(wavelengths.size())}, {sizeof(double)}, self);
      },
      "The channels of the materials in nanometres, ascending: shape (channels,). Empty for RGB.");
  prior.def_property_readonly("explained_variance", &gonio::log_relative_pca::explained_variance,
                              "The fraction of the materials' variance that the components explain.");
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
      "The singular values, largest first: shape (k,).");
  prior.def("__repr__", [](const gonio::log_relative_pca& f) {
    return gonio::message_of(
        {"<gonio.Prior: ", f.size(), " components of ", f.names().size(), " materials, ", sentence_of(f.cells()), ">"});
  });
  add_domain(prior);
  add_copies(prior, &state_of_prior, &prior_of_state);
  prior.def("weights_of", &weights_of_material, py::arg("name"),
            "Returns the weights that expand to one of the materials: shape (k, channels).");
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

/// Returns the report from a dictionary with the keys that `report_of` writes.
std::optional<gonio::solve_report> report_of_state(const py::handle& state) {
  if (state.is_none()) return std::nullopt;
  const auto channels = [&](const char* name) -> Eigen::VectorXd {
    const auto numbers = state[name].cast<std::vector<double>>();
    return Eigen::Map<const Eigen::VectorXd>(numbers.data(), std::ssize(numbers));
  };
  return gonio::solve_report{channels("residual"), channels("objective"), channels("kkt_residual"),
                             state["iterations"].cast<int>()};
}

void add_fit_copies(py::class_<fitted_pca>& fit) {
  add_copies(
      fit, [](const fitted_pca& f) { return py::make_tuple(f.functions(), copy_of(f.weights()), report_of(f)); },
      [](const py::tuple& state) {
        require_state(state, 3);
        return fitted_pca(state[0].cast<gonio::log_relative_pca>(), matrix_of<Eigen::MatrixXd>(state[1]),
                          report_of_state(state[2]));
      });
}

/// Returns the BRDF for weights of the first components.
fitted_pca brdf_of_weights(const gonio::log_relative_pca& prior, const py::object& given) {
  const doubles weights = finite_rows(given, "weights", {3});
  if (weights.shape(0) > prior.size())
    gonio::refuse({"weights have the shape ", shape_of(weights), ", but the prior has ", prior.size(), " components"});
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(prior.size(), 3);
  all.topRows(weights.shape(0)) = matrix_of<Eigen::MatrixXd>(weights);
  return {prior, std::move(all)};
}

py::array_t<double> gradients(const fitted_pca& fit, const py::object& wi, const py::object& wo, unsigned threads) {
  const direction_pairs pairs(wi, wo);
  const Eigen::Index channels = fit.weights().cols(), size = fit.weights().size();
  py::array_t<double> found = results_for(pairs, size);
  double* to = found.mutable_data();
  {
    const py::gil_scoped_release released;
    gonio::for_each_index(
        pairs.size(), 64,
        [&](Eigen::Index i) {
          const Eigen::MatrixXd slopes = fit.gradient(pairs.wi(i), pairs.wo(i));
          std::copy_n(slopes.data(), size, to + size * i);
        },
        gonio::thread_count{threads});
  }
  extents shape(found.shape(), found.shape() + found.ndim() - 1);
  shape.push_back(channels);
  shape.push_back(size / channels);
  return found.reshape(shape);
}

using decomposition_type = gonio::decomposition<gonio::log_relative_pca, gonio::tikhonov>;

/// A decomposition and its arguments.
struct configured_decomposition : decomposition_type {
  gonio::log_relative_pca prior;
  double eta = 0.0;
  unsigned threads = 0;
};

configured_decomposition decomposition_of(const gonio::log_relative_pca& prior, double eta, unsigned threads) {
  return {decomposition_type(prior, gonio::tikhonov(eta), gonio::thread_count{threads}), prior, eta, threads};
}

void add_decomposition(py::module_& m) {
  py::class_<fitted_pca> fit(m, "Fit", "A BRDF as a combination of a prior's components.");
  fit.def_property_readonly(
      "weights", [](const py::object& self) { return matrix_view(self.cast<fitted_pca&>().weights(), self); },
      "The weights, one column per channel: shape (k, 3), or (k, wavelengths). A read-only view.");
  fit.def("gradient", &gradients, py::arg("wi"), py::arg("wo"), py::arg("threads") = 0,
          "Returns the derivatives of the values by the weights, for arrays of directions of shape (..., 3): shape\n"
          "(..., 3, k), the derivative of each channel by that channel's weights. `np.einsum('nc,nck->kc',\n"
          "slopes_of_loss, gradient)` is the gradient of a loss of n values.");
  add_spectra(fit, [](const fitted_pca& f) -> const fitted_pca& { return f; });
  fit.def_property_readonly("report", &report_of, "The solver's report on the weights, by channel.");
  fit.def("__repr__", [](const fitted_pca& f) {
    return gonio::message_of({"<gonio.Fit: ", f.weights().rows(), " components>"});
  });
  add_fit_copies(fit);
  add_brdf_methods(m, fit);
  auto prior = py::reinterpret_borrow<py::class_<gonio::log_relative_pca>>(py::type::of<gonio::log_relative_pca>());
  prior.def("brdf", &brdf_of_weights, py::arg("weights"),
            "Returns the BRDF for weights of the first components, red, green and blue: shape (up to k, 3).");

  py::class_<configured_decomposition> type(
      m, "Decomposition",
      "Fits a prior's components with a penalty on the squares of their weights (Nielsen et al. 2015, Eq. 12).");
  type.def(py::init(&decomposition_of), py::arg("prior"), py::arg("eta") = gonio::default_eta, py::arg("threads") = 0);
  type.def("__repr__", [](const configured_decomposition& self) {
    return "<gonio.Decomposition: eta " + std::string(py::str(py::float_(self.eta))) + '>';
  });
  add_copies(
      type, [](const configured_decomposition& self) { return py::make_tuple(self.prior, self.eta, self.threads); },
      [](const py::tuple& state) {
        require_state(state, 3);
        return decomposition_of(state[0].cast<gonio::log_relative_pca>(), state[1].cast<double>(),
                                state[2].cast<unsigned>());
      });
  type.def("fit", &configured_decomposition::fit<gonio::sample_set>, py::arg("samples"),
           py::call_guard<py::gil_scoped_release>(),
           "Returns the BRDF fitted to the samples, or to all cells of a table.");
  type.def("fit", &configured_decomposition::fit<gonio::brdf_table>, py::arg("samples"),
           py::call_guard<py::gil_scoped_release>());
}

gonio::confidence_level level_of(double probability) {
  if (probability == 0.68) return gonio::confidence_level::sixty_eight_percent;
  if (probability == 0.95) return gonio::confidence_level::ninety_five_percent;
  gonio::refuse({"there are intervals for a probability of 0.68 or 0.95, not of ",
                 std::string(py::str(py::float_(probability)))});
}

/// Returns pairs above the horizon, for which intervals and deviations exist. Throws gonio::error for any other pair.
direction_pairs pairs_above_horizon(const py::object& wi, const py::object& wo) {
  direction_pairs pairs(wi, wo);
  for (Eigen::Index i = 0; i < pairs.size(); ++i)
    if (!(pairs.wi(i).z() > 0.0 && pairs.wo(i).z() > 0.0))
      gonio::refuse({"pair ", i, " of wi and wo is not above the horizon"});
  return pairs;
}

std::vector<gonio::location> locations_of(const reconstructed_brdf& fit, const direction_pairs& pairs) {
  std::vector<gonio::location> locations;
  for (Eigen::Index i = 0; i < pairs.size(); ++i) locations.push_back(fit.located(pairs.wi(i), pairs.wo(i)));
  return locations;
}

py::tuple intervals(const reconstructed_brdf& fit, const py::object& wi, const py::object& wo, double probability) {
  const direction_pairs pairs = pairs_above_horizon(wi, wo);
  const gonio::confidence_level level = level_of(probability);
  py::array_t<double> low = results_for(pairs, 3), high = results_for(pairs, 3);
  double *lowest = low.mutable_data(), *highest = high.mutable_data();
  {
    const py::gil_scoped_release released;
    const std::vector<gonio::location> locations = locations_of(fit, pairs);
    const std::vector<double> widths = fit.half_widths(locations, level);
    gonio::for_each_index(pairs.size(), 64, [&](Eigen::Index i) {
      const gonio::reflectance_interval found = fit.interval(fit(pairs.wi(i), pairs.wo(i)), locations[i], widths[i]);
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
  const auto widths = fit.half_widths(locations_of(fit, pairs), gonio::confidence_level::sixty_eight_percent);
  std::ranges::transform(widths, to, [](double width) { return std::expm1(width); });
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
  py::class_<outlying> type(m, "OutlyingSample", "A sample that contradicts the others.");
  type.def_readonly("row", &outlying::number, "The row of the samples, counted from 0.");
  type.def_property_readonly(
      "measured", [](const outlying& each) { return channels_of(each.measured); },
      "The measured value, sr^-1, by channel.");
  type.def_property_readonly(
      "predicted", [](const outlying& each) { return channels_of(each.predicted); },
      "The prediction from all other samples, sr^-1, by channel.");
  type.def_readonly("deviation", &outlying::deviation, "The standard deviation of the logarithm of the prediction.");
  type.def_readonly("probability", &outlying::probability, "The probability that the sample is wrong.");
  type.def("__repr__", &sentence_of);
}

void add_spectral_spike(py::module_& m) {
  using spike = gonio::spectral_spike;
  py::class_<spike> type(m, "SpectralSpike", "A value of a spectrum that was replaced before the fit.");
  type.def_readonly("row", &spike::number, "The row of the samples, counted from 0.");
  type.def_readonly("band", &spike::channel, "The position of the wavelength, counted from 0.");
  type.def_readonly("measured", &spike::measured, "The measured value, sr^-1.");
  type.def_readonly("replaced_by", &spike::replaced_by, "The value that the fit used, sr^-1.");
  type.def_readonly("probability", &spike::probability, "The probability that the measured value is wrong.");
  type.def("__repr__", [](const spike& each) {
    std::ostringstream text;
    text.precision(3);
    text << "<gonio.SpectralSpike: row " << each.number << ", band " << each.channel << ", measured " << each.measured
         << ", replaced by " << each.replaced_by << " sr^-1>";
    return text.str();
  });
}

/// Returns the estimator for these arguments. Throws gonio::error if one of them is invalid.
configured_estimator estimator_of(const estimator_arguments& given) {
  if (!(given.variance > 0.0 && given.variance <= 10.0))
    gonio::refuse({"variance is ", given.variance, ": expected more than 0, at most 10"});
  if (!(given.noise >= 0.0 && std::isfinite(given.noise)))
    gonio::refuse({"noise is ", given.noise, ": expected a finite fraction of at least 0 (0.02 is 2 %)"});
  if (given.noise > 0.5)
    warn({gonio::message_of({"noise of ", std::lround(100.0 * given.noise), " % is very large: 0.02 is 2 %"})});
  const estimator_type estimator{
      given.prior, {.variance = given.variance, .noise = given.noise}, gonio::thread_count{given.threads}};
  return {given.rejects ? estimator : estimator.keeping_all(), given};
}

reconstructed_brdf fit_of(const configured_estimator& estimator, const gonio::sample_set& samples) {
  return {estimator.fit(samples), estimator.arguments, samples};
}

py::tuple state_of_arguments(const estimator_arguments& given) {
  return py::make_tuple(given.prior, given.variance, given.noise, given.rejects, given.threads);
}

configured_estimator estimator_of_state(const py::tuple& state) {
  require_state(state, 5);
  return estimator_of({state[0].cast<gonio::log_relative_pca>(), state[1].cast<double>(), state[2].cast<double>(),
                       state[3].cast<bool>(), state[4].cast<unsigned>()});
}

std::string sentence_of(const reconstructed_brdf& fit) {
  return gonio::message_of(
      {"<gonio.ReconstructedBrdf: of ", fit.samples.size(), " samples, ", fit.rejected().size(), " rejected>"});
}

void add_estimator(py::module_& m) {
  py::class_<configured_estimator> type(
      m, "Estimator",
      "Reconstructs a BRDF as `gonio reconstruct` does: fits a prior's components together with a model of what\n"
      "the components cannot represent. variance: the variance of the logarithm of reflectance in that model.\n"
      "noise: the relative noise of the values (0.02 is 2 %). reject: leave out samples that contradict all others,\n"
      "in brightness or in colour.");
  type.def(
      py::init([](const gonio::log_relative_pca& prior, double variance, double noise, bool reject, unsigned threads) {
        return estimator_of({prior, variance, noise, reject, threads});
      }),
      py::arg("prior"), py::arg("variance") = gonio::discrepancy_model{}.variance, py::arg("noise") = 0.0,
      py::arg("reject") = true, py::arg("threads") = 0);
  type.def("__repr__", [](const configured_estimator& self) {
    return "<gonio.Estimator: noise " + std::string(py::str(py::float_(self.arguments.noise))) + '>';
  });
  add_copies(
      type, [](const configured_estimator& self) { return state_of_arguments(self.arguments); }, &estimator_of_state);
  type.def("fit", &fit_of, py::arg("samples"), py::call_guard<py::gil_scoped_release>(),
           "Returns the BRDF fitted to the samples, with its uncertainty.");
}

void add_reconstruction(py::module_& m) {
  add_outlying_sample(m);
  add_spectral_spike(m);
  py::class_<reconstructed_brdf> fit(m, "ReconstructedBrdf",
                                     "A reconstructed BRDF with its uncertainty and the samples that contradict it.");
  add_brdf_methods(m, fit);
  fit.def("interval", &intervals, py::arg("wi"), py::arg("wo"), py::arg("probability") = 0.68,
          "Returns two arrays of shape (..., 3), sr^-1: the value lies between them with a probability of 0.68 or\n"
          "0.95.");
  fit.def("known_to", &known_to, py::arg("wi"), py::arg("wo"),
          "Returns the relative uncertainty of values with a probability of 68 %: 0.06 is 6 %. Shape (...).");
  fit.def_property_readonly(
      "highlight_known_to_factor", [](const reconstructed_brdf& f) { return f.certainty().highlight_factor; },
      "The factor to which the highlight is known, with a probability of 95 %.");
  fit.def_property_readonly(
      "rejected", [](const reconstructed_brdf& f) { return f.rejected(); },
      "Rows of the samples that the fit left out, the worst first: they are probably wrong.");
  fit.def_property_readonly(
      "contradicted", [](const reconstructed_brdf& f) { return f.contradicted(); },
      "Samples that contradict all others, the worst first; at most twenty.");
  fit.def_property_readonly(
      "outlier_share", [](const reconstructed_brdf& f) { return f.outlier_share(); },
      "The estimated fraction of outliers among all samples.");
  fit.def_property_readonly(
      "spikes", [](const reconstructed_brdf& f) { return f.spikes(); },
      "Values of spectra that neither their neighbours nor the other samples explain, and that were replaced.");
  add_spectra(
      fit, [](const reconstructed_brdf& f) -> const auto& { return f.fit(); });
  fit.def("__repr__", [](const reconstructed_brdf& f) { return sentence_of(f); });
  add_copies(
      fit, [](const reconstructed_brdf& f) { return py::make_tuple(state_of_arguments(f.arguments), f.samples); },
      [](const py::tuple& state) {
        require_state(state, 2);
        return fit_of(estimator_of_state(state[0].cast<py::tuple>()), state[1].cast<gonio::sample_set>());
      });
}

}  // namespace

void add_estimators(py::module_& m) {
  add_prior(m);
  add_decomposition(m);
  add_reconstruction(m);
  add_estimator(m);
}

}  // namespace python
