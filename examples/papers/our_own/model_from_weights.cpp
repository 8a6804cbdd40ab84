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
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <chrono>
#include <iostream>
#include <map>
#include <memory>

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

/// Some cells of a prior, at which weights are found and evaluated.
class evaluated_cells {
 public:
  evaluated_cells(const gonio::log_relative_pca& prior, Eigen::Index count)
      : prior_(prior), rows_(std::min(count, prior.cells().size()), prior.size()) {
    for (const Eigen::Index cell : gonio::random_cells(prior.cells(), rows_.rows(), 0)) {
      const std::span<const float> row = prior.row(cell);
      rows_.row(std::ssize(locations_)) = Eigen::Map<const Eigen::RowVectorXf>(row.data(), prior.size()).cast<double>();
      locations_.push_back(gonio::locate_cell(prior.cells(), cell));
      const auto [wi, wo] = gonio::to_directions(prior.cells().angles(cell));
      geometry_.emplace_back(wi, wo);
    }
  }

  /// Returns the reflectance for the weights of three channels, as input of a fit.
  [[nodiscard]] std::vector<gonio::model::fit_observation> reflectance(const Eigen::MatrixXd& weights) const {
    const Eigen::MatrixXd mapped = rows_ * weights;
    std::vector<gonio::model::fit_observation> all;
    for (Eigen::Index i = 0; i < mapped.rows(); ++i) {
      gonio::rgb value;
      for (Eigen::Index c = 0; c < 3; ++c)
        value[c] = prior_.metric().inverse(mapped(i, c) + gonio::offset_at(prior_, locations_[i]), locations_[i]);
      all.push_back({geometry_[i], value.max(0.0), 1.0});
    }
    return all;
  }

 private:
  gonio::log_relative_pca prior_;
  Eigen::MatrixXd rows_;
  std::vector<gonio::location> locations_;
  std::vector<gonio::model::lobe_geometry> geometry_;
};

struct from_weights_options : left_out_options {
  std::filesystem::path folder = shipped_directions();
  Eigen::Index regressed = 8, evaluated = 400;
};

/// The model: a Lambertian lobe and one of GGX.
const model_choice fitted_model;

class from_weights_experiment : left_out_experiment {
 public:
  from_weights_experiment(const from_weights_options& given, progress_bar& bar)
      : left_out_experiment(given, bar), given_(given), points_(*written_points(given.folder, "perceived", 20)) {}

  /// Returns the errors and seconds of each way, by material.
  [[nodiscard]] json run() {
    json by_material = json::object();
    for (const judged_material& material : measured_materials(given_.materials, library_))
      by_material[material.name] = once({material.name, given_.components, given_.regressed, given_.evaluated},
                                        material.turn, material.name, [&] { return errors_of(material); });
    return by_material;
  }

 private:
  /// What is known about the priors without one family.
  struct known_family {
    gonio::log_relative_pca prior;
    evaluated_cells cells;
    parameter_regression by_materials;
  };

  const known_family& known(const std::string& family) {
    if (const auto found = known_.find(family); found != known_.end()) return *found->second;
    auto prior = library_.prior_without(family, given_.components);
    const evaluated_cells cells(prior, given_.evaluated);
    known_.clear();  // families come one after the other
    const auto added = known_.emplace(family, std::unique_ptr<known_family>(new known_family{
                                                  prior, cells, {fitted_materials(prior, cells), given_.regressed}}));
    return *added.first->second;
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
  [[nodiscard]] described_weights fitted_materials(const gonio::log_relative_pca& prior,
                                                   const evaluated_cells& cells) const {
    const Eigen::Index materials = std::ssize(prior.names());
    described_weights all{Eigen::MatrixXd(prior.size(), 3 * materials), Eigen::MatrixXd(4, 3 * materials)};
    for (Eigen::Index i = 0; i < materials; ++i) {
      const Eigen::MatrixXd weights = prior.weights_of(i);
      const gonio::model::analytic_brdf model = fit(cells.reflectance(weights));
      all.weights.middleCols(3 * i, 3) = weights;
      for (Eigen::Index c = 0; c < 3; ++c) all.parameters.col(3 * i + c) = parameters_of(model, c);
    }
    return all;
  }

  /// Returns Delta E under the environment, and the seconds, of the table and of the models.
  [[nodiscard]] json errors_of(const judged_material& material) {
    const known_family& family = known(material.family);
    const gonio::sample_set samples = measure(material.measured, points_, 0.0, 0);
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
      for (Eigen::Index c = 0; c < 3; ++c) channels[c] = family.by_materials(paint.weights().col(c));
      return model_of(channels);
    });
    add("some cells", [&] { return fit(family.cells.reflectance(paint.weights())); });
    add("all cells",
        [&] { return fit(gonio::model::fit_observations(paint.tabulate(library_.cells(), threads_), threads_)); });
    add("samples", [&] { return fit(gonio::model::fit_observations(samples)); });
    add("truth", [&] { return fit(gonio::model::fit_observations(material.truth, threads_)); });
    return errors;
  }

  const from_weights_options& given_;
  std::vector<gonio::half_difference> points_;
  std::map<std::string, std::unique_ptr<known_family>> known_;
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
  command.add_input_folder("--directions", options->folder, {".csv"}, "Folder of designed sets");
  command.add_option("--regressed", options->regressed, "Number of weights that predict the parameters")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--evaluated", options->evaluated, "Number of cells at which weights are evaluated")
      .check(check::positive_number())
      .capture_default_str();
  do_together(command, processes, options, [](const auto& given) {
    run_and_print<from_weights_experiment>(given, [&](const json& found) { print(given, found); });
  });
}

}  // namespace papers
