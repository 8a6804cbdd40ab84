/// gonio-papers model-from-weights: parameters of an analytic model from the weights of a reconstruction, without
/// expanding its table. J. B. Nielsen's thesis (2016), Sec. 4.6, "Model parameter estimation", proposes to learn this
/// map.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/our_own/left_out_families.hpp"
#include "tool/files/json.hpp"
#include "tool/options/model_choice.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <memory>
#include <optional>
#include <utility>

namespace papers {

namespace {

/// Parameters of a Lambertian lobe and one of GGX in one channel: the logarithms of both lobes' colours, the logarithm
/// of the roughness, and the reflectance at normal incidence.
using channel_parameters = Eigen::Vector4d;

/// Weights of materials, a column for each channel of a material, and the parameters that describe this channel.
struct described_weights {
  Eigen::MatrixXd weights;     ///< components x observations
  Eigen::MatrixXd parameters;  ///< 4 x observations
};

/// Predicts parameters by kernel ridge regression: linear and radial functions of the weights, which are scaled by
/// their deviations.
class parameter_regression {
 public:
  /// Uses the first weights only: `most`, or all if there are fewer.
  parameter_regression(const described_weights& known, Eigen::Index most)
      : scale_(known.weights.topRows(std::min(most, known.weights.rows())).rowwise().norm() /
               std::sqrt(static_cast<double>(known.weights.cols()))),
        points_(scaled(known.weights)),
        mean_(known.parameters.rowwise().mean()),
        least_(known.parameters.rowwise().minCoeff()),
        largest_(known.parameters.rowwise().maxCoeff()) {
    const Eigen::Index n = points_.cols();
    std::vector<double> squares;
    for (Eigen::Index i = 1; i < n; ++i) squares.push_back((points_.col(i) - points_.col(i - 1)).squaredNorm());
    squared_length_ = gonio::median(squares);
    Eigen::MatrixXd system(n, n);
    for (Eigen::Index i = 0; i < n; ++i) system.col(i) = functions_at(points_.col(i));
    system.diagonal().array() += penalty;
    dual_ = system.llt().solve((known.parameters.colwise() - mean_).transpose());
  }

  /// Returns the parameters of one channel, within the range of the known ones.
  [[nodiscard]] channel_parameters operator()(const Eigen::VectorXd& weights) const {
    const Eigen::VectorXd at = functions_at(scaled(weights).col(0));
    return (mean_ + dual_.transpose() * at).cwiseMax(least_).cwiseMin(largest_);
  }

 private:
  static constexpr double penalty = 0.1, width = 4.0;

  [[nodiscard]] Eigen::MatrixXd scaled(const Eigen::MatrixXd& weights) const {
    return weights.topRows(scale_.size()).array().colwise() / scale_.array();
  }
  /// Returns a linear and a radial function of each known point.
  [[nodiscard]] Eigen::VectorXd functions_at(const Eigen::VectorXd& point) const {
    const Eigen::ArrayXd squares = (points_.colwise() - point).colwise().squaredNorm().transpose();
    const Eigen::ArrayXd products = points_.transpose() * point;
    return products + (-squares / (width * squared_length_)).exp();
  }

  Eigen::VectorXd scale_;
  Eigen::MatrixXd points_;
  Eigen::Vector4d mean_, least_, largest_;
  double squared_length_ = 1.0;
  Eigen::MatrixXd dual_;
};

struct from_weights_options : left_out_options {
  Eigen::Index regressed = 8, evaluated = 400;
};

/// The model: a Lambertian lobe and one of GGX.
const model_choice fitted_model;

class from_weights_experiment : left_out_experiment {
 public:
  from_weights_experiment(const from_weights_options& given, progress_bar& bar)
      : left_out_experiment(given, bar),
        given_(given),
        measured_(required_points(shipped_directions(), "perceived", 20)),
        evaluated_(random_sampling(given.evaluated, 1).sets.front()) {}

  /// Returns the errors and seconds of each way, by material.
  [[nodiscard]] json run() {
    json by_material = json::object();
    for (const judged_material& material : measured_materials(given_.materials, library_))
      by_material[material.name] = once({material.name, given_.components, given_.regressed, given_.evaluated},
                                        material.turn, material.name, [&] { return errors_of(material); });
    return by_material;
  }

 private:
  /// A prior without one family, and what its materials say about parameters.
  struct known_family {
    std::string left_out;
    gonio::log_relative_pca prior;
    parameter_regression regression;
  };

  /// Learns the prior without a family. Keeps the last one, because families come one after the other.
  const known_family& known(const std::string& family) {
    if (known_ && known_->left_out == family) return *known_;
    auto prior = library_.prior_without(family, given_.components);
    parameter_regression regression(fitted_materials(prior), given_.regressed);
    return known_.emplace(known_family{family, std::move(prior), std::move(regression)});
  }

  /// Fits the model to a BRDF in the evaluated directions.
  [[nodiscard]] gonio::model::analytic_brdf fit_evaluated(
      const gonio::fitted_brdf<gonio::log_relative_pca>& brdf) const {
    const auto value = [&](const gonio::direction_pair& pair) { return gonio::rgb(brdf(pair.wi, pair.wo).max(0.0)); };
    return fit(gonio::model::fit_observations(measure(value, evaluated_, 0.0, 0)));
  }

  [[nodiscard]] gonio::model::analytic_brdf fit(const std::vector<gonio::model::fit_observation>& observations) const {
    model_choice choice = fitted_model;
    choice.fit.threads = threads_;
    return fit_chosen(choice, observations).model;
  }

  /// Returns a model with the parameters of three channels, whose shape is the mean of theirs.
  [[nodiscard]] static gonio::model::analytic_brdf model_of(const std::array<channel_parameters, 3>& channels) {
    const auto kinds = lobes_named(fitted_model.model);
    gonio::rgb diffuse, specular;
    channel_parameters mean = channel_parameters::Zero();
    for (Eigen::Index c = 0; c < 3; ++c) {
      diffuse[c] = std::exp(channels[c][0]);
      specular[c] = std::exp(channels[c][1]);
      mean += channels[c] / 3.0;
    }
    return gonio::model::analytic_brdf({{*kinds[0], diffuse, {}}, {*kinds[1], specular, {std::exp(mean[2]), mean[3]}}});
  }

  [[nodiscard]] static channel_parameters parameters_of(const gonio::model::analytic_brdf& model, Eigen::Index c) {
    const auto logarithm = [](double value) { return std::log(std::max(value, 1e-4)); };
    const gonio::model::analytic_lobe &diffuse = model.lobes()[0], &specular = model.lobes()[1];
    return {logarithm(diffuse.colour()[c]), logarithm(specular.colour()[c]), std::log(specular.parameters()[0]),
            specular.parameters()[1]};
  }

  /// Fits the model to each material of the prior.
  [[nodiscard]] described_weights fitted_materials(const gonio::log_relative_pca& prior) const {
    const Eigen::Index materials = std::ssize(prior.names());
    described_weights all{Eigen::MatrixXd(prior.size(), 3 * materials), Eigen::MatrixXd(4, 3 * materials)};
    for (Eigen::Index i = 0; i < materials; ++i) {
      const Eigen::MatrixXd weights = prior.weights_of(i);
      const gonio::model::analytic_brdf model = fit_evaluated({prior, weights});
      all.weights.middleCols(3 * i, 3) = weights;
      for (Eigen::Index c = 0; c < 3; ++c) all.parameters.col(3 * i + c) = parameters_of(model, c);
    }
    return all;
  }

  /// Returns Delta E under the environment, and the seconds, of the table and of the models.
  [[nodiscard]] json errors_of(const judged_material& material) {
    const known_family& family = known(material.family);
    const gonio::sample_set samples = measure(material.measured, measured_, 0.0, 0);
    const auto paint = gonio::decomposition{family.prior, gonio::tikhonov{40.0}, threads_}.fit(samples);
    const gonio::brdf_table table = paint.tabulate(library_.cells(), threads_);
    json errors{{"table", {compare(table, material).delta_e_env, 0.0}}};
    const auto add = [&](const char* name, const auto& make) {
      const auto start = std::chrono::steady_clock::now();
      const gonio::model::analytic_brdf model = make();
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
      const gonio::brdf_table made = gonio::tabulate(model, library_.cells(), threads_);
      errors[name] = {compare(made, material).delta_e_env, taken.count()};
    };
    add("weights", [&] {
      std::array<channel_parameters, 3> channels;
      for (Eigen::Index c = 0; c < 3; ++c) channels[c] = family.regression(paint.weights().col(c));
      return model_of(channels);
    });
    add("some cells", [&] { return fit_evaluated(paint); });
    add("all cells",
        [&] { return fit(gonio::model::fit_observations(paint.tabulate(library_.cells(), threads_), threads_)); });
    add("samples", [&] { return fit(gonio::model::fit_observations(samples)); });
    add("truth", [&] { return fit(gonio::model::fit_observations(material.truth, threads_)); });
    return errors;
  }

  const from_weights_options& given_;
  std::vector<gonio::half_difference> measured_, evaluated_;
  std::optional<known_family> known_;
};

void print(const from_weights_options& given, const json& by_material) {
  std::cout << "Delta E env over " << by_material.size()
            << " materials, each reconstructed from 20 designed directions by " << given.components
            << " components, and the milliseconds of finding the model.\n\n"
            << "| result | mean | median | worst | ms, median |\n|---|---|---|---|---|\n";
  const std::string some = std::to_string(given.evaluated);
  const std::vector<std::pair<std::string, std::string>> rows{
      {"table", "the reconstruction itself, a table"},
      {"weights", "model: parameters from " + std::to_string(given.regressed) + " weights"},
      {"some cells", "model: fitted to " + some + " cells of the reconstruction"},
      {"all cells", "model: fitted to all cells of the reconstruction"},
      {"samples", "model: fitted to the 20 samples"},
      {"truth", "model: fitted to all cells of the truth"}};
  for (const auto& [key, name] : rows) {
    std::vector<double> errors, milliseconds;
    for (const auto& [material, result] : by_material.items()) {
      errors.push_back(result[key].elements()[0].number());
      milliseconds.push_back(1000.0 * result[key].elements()[1].number());
    }
    const distribution seen(errors);
    std::cout << "| " << name << " | " << fixed(seen.mean, 2) << " | " << fixed(seen.median, 2) << " | "
              << fixed(seen.worst, 1) << " | " << (key == "table" ? "-" : fixed(distribution(milliseconds).median, 1))
              << " |\n";
  }
}

}  // namespace

void add_model_from_weights(command& app, const team& processes) {
  auto command = app.add_subcommand("model-from-weights",
                                    "Find parameters of an analytic model from the weights of a reconstruction");
  const auto options = std::make_shared<from_weights_options>();
  add_left_out_options(command, *options);
  command.add_option("--regressed", options->regressed, "Number of weights that predict the parameters")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--evaluated", options->evaluated, "Number of directions in which a reconstruction is evaluated")
      .check(check::positive_number())
      .capture_default_str();
  do_together(command, processes, options, [](const auto& given) {
    run_and_print<from_weights_experiment>(given, [&](const json& found) { print(given, found); });
  });
}

}  // namespace papers
