/// gonio-papers model-recovery: whether fits find the parameters that made the data, and how much noise they pass on.

#include "papers/distribution.hpp"
#include "papers/experiments.hpp"
#include "tool/files/json.hpp"
#include "tool/options/model_choice.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"

#include <Eigen/Cholesky>

#include <iostream>
#include <memory>
#include <random>

namespace papers {

namespace {

struct recovery_options {
  Eigen::Index draws = 100, samples = 600, few = 20, starts = 10;
  double noise = 0.01;
  std::uint64_t seed = 0;
  bool print_json = false;
  gonio::thread_count threads;
};

double between(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution(low, high)(random);
}

/// Draws directions above the horizon, half of them within about 20 degrees of the highlight.
std::vector<gonio::direction_pair> draw_pairs(std::mt19937_64& random, std::size_t count) {
  std::vector<gonio::direction_pair> pairs;
  while (pairs.size() < count) {
    const double s = between(random, 0.0, 1.0), right_angle = gonio::radians(90.0);
    const auto pair = gonio::to_directions(
        {right_angle * s * s, right_angle * between(random, 0.0, 1.0), 2.0 * right_angle * between(random, 0.0, 1.0)});
    if (pair.wi.z() > 0.02 && pair.wo.z() > 0.02) pairs.push_back(pair);
  }
  return pairs;
}

/// Draws parameters that a few hundred directions can determine: exponents from 1 to 500, slopes from 0.04 to 0.8,
/// refractive indices from 1.1 to 2.5, tilts from 30 to 60 degrees, others within their bounds; colours from 0.05 to 1.
gonio::model::analytic_lobe draw_lobe(const gonio::model::lobe_kind& kind, std::mt19937_64& random) {
  gonio::model::lobe_kind::values values{};
  const auto about = kind.parameters();
  for (std::size_t i = 0; i < about.size(); ++i) {
    double low = about[i].lowest, high = about[i].highest;
    if (about[i].logarithmic && about[i].unit.empty()) low = 1.0, high = 500.0;
    if (about[i].unit == "slope") low = 0.04, high = 0.8;
    if (about[i].name == "refractive_index") low = 1.1, high = 2.5;
    if (about[i].name == "tilt") low = gonio::radians(30.0), high = gonio::radians(60.0);
    values[i] =
        about[i].logarithmic ? std::exp(between(random, std::log(low), std::log(high))) : between(random, low, high);
  }
  return {kind, {between(random, 0.05, 1.0), between(random, 0.05, 1.0), between(random, 0.05, 1.0)}, values};
}

std::vector<gonio::model::fit_observation> observe(const gonio::model::analytic_brdf& f,
                                                   const std::vector<gonio::direction_pair>& pairs) {
  std::vector<gonio::model::fit_observation> all;
  for (const auto& [wi, wo] : pairs) all.push_back({gonio::model::lobe_geometry(wi, wo), f(wi, wo), 1.0});
  return all;
}

/// Returns all unknowns of a model: the parameters of each lobe, followed by its colour.
Eigen::VectorXd unknowns_of(const gonio::model::analytic_brdf& f) {
  std::vector<double> all;
  for (const gonio::model::analytic_lobe& lobe : f.lobes()) {
    all.insert(all.end(), lobe.parameters().begin(),
               lobe.parameters().begin() + static_cast<std::ptrdiff_t>(lobe.kind().parameters().size()));
    all.insert(all.end(), lobe.colour().begin(), lobe.colour().end());
  }
  return Eigen::Map<const Eigen::VectorXd>(all.data(), std::ssize(all));
}

/// Returns the Fisher information of the unknowns. An observation's weight is the inverse variance of each of its
/// channels.
Eigen::MatrixXd information(const gonio::model::analytic_brdf& f,
                            const std::vector<gonio::model::fit_observation>& observations) {
  const Eigen::Index n = unknowns_of(f).size();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(n, n);
  for (const gonio::model::fit_observation& seen : observations)
    for (Eigen::Index channel = 0; channel < 3; ++channel) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(n);
      Eigen::Index j = 0;
      for (const gonio::model::analytic_lobe& lobe : f.lobes()) {
        gonio::model::lobe_kind::values slopes{};
        const double value = lobe.kind().value_and_slopes(seen.at, lobe.parameters(), slopes);
        for (std::size_t p = 0; p < lobe.kind().parameters().size(); ++p) row[j++] = slopes[p] * lobe.colour()[channel];
        row[j + channel] = value;
        j += 3;
      }
      sum += seen.weight[channel] * row * row.transpose();
    }
  return sum;
}

/// Returns values with noise. The standard deviation in each channel is a share of the mean of the three.
std::vector<gonio::model::fit_observation> observe_with_noise(const gonio::model::analytic_brdf& f,
                                                              const std::vector<gonio::direction_pair>& pairs,
                                                              double noise, std::mt19937_64& random) {
  auto all = observe(f, pairs);
  std::normal_distribution<double> normal;
  for (gonio::model::fit_observation& seen : all) {
    const double deviation = noise * seen.value.mean();
    for (double& channel : seen.value) channel += deviation * normal(random);
    seen.weight = 1.0 / (deviation * deviation);
  }
  return all;
}

json recover(const gonio::model::lobe_kind& kind, const recovery_options& given) {
  std::mt19937_64 random(given.seed);
  const auto& lambert = gonio::model::lobe_kind::of<gonio::model::lambert_shape>();
  const gonio::model::model_fit_options fit{.threads = given.threads};
  Eigen::Index found = 0, evaluations = 0;
  double worst = 0.0;
  std::vector<double> passed_on;
  for (Eigen::Index draw = 0; draw < given.draws; ++draw) {
    // Draw a model, and recover it from exact values.
    const gonio::model::analytic_brdf truth({draw_lobe(lambert, random), draw_lobe(kind, random)});
    const Eigen::VectorXd exact = unknowns_of(truth);
    const auto clean = gonio::model::fit_model({&lambert, &kind}, observe(truth, draw_pairs(random, given.samples)),
                                               gonio::lin(), fit);
    const double off = (unknowns_of(clean.model) - exact).cwiseQuotient(exact).cwiseAbs().maxCoeff();
    worst = std::max(worst, off);
    found += off < 1e-6 ? 1 : 0;
    evaluations += clean.evaluations;

    // Recover it from few noisy values.
    const auto noisy = observe_with_noise(truth, draw_pairs(random, given.few), given.noise, random);
    gonio::model::model_fit_options many = fit;
    many.random_starts = given.starts;
    const auto estimate = gonio::model::fit_model({&lambert, &kind}, noisy, gonio::lin(), many);
    const Eigen::VectorXd error = unknowns_of(estimate.model) - exact;
    // Weight the error by the information. The mean is 1 for an unbiased estimator that reaches the Cramer-Rao bound.
    passed_on.push_back(error.dot(information(truth, noisy) * error) / static_cast<double>(error.size()));
  }
  // Report the share of recoveries and the noise that was passed on.
  const auto near = std::ranges::count_if(passed_on, [](double ratio) { return ratio <= 4.0; });
  const double median = distribution(passed_on).median;
  std::erase_if(passed_on, [](double ratio) { return ratio > 4.0; });
  return {{"lobe", kind.name()},
          {"draws", given.draws},
          {"recovered", found},
          {"worst", worst},
          {"evaluations", static_cast<double>(evaluations) / static_cast<double>(given.draws)},
          {"noise_median", median},
          {"noise_within_4", near},
          {"noise_mean_of_those", passed_on.empty() ? 0.0 : distribution(passed_on).mean}};
}

void run(const recovery_options& given) {
  progress_bar bar;
  json rows = json::array();
  for (const gonio::model::lobe_kind* kind : gonio::model::lobe_kinds()) {
    if (kind->parameters().empty()) continue;
    gonio::report(bar.listener(), std::string(kind->name()), 0.0);
    rows.push_back(recover(*kind, given));
  }
  bar.wipe();
  if (given.print_json) {
    std::cout << rows.dump(2) << '\n';
    return;
  }
  std::cout << "A lobe beside a Lambertian one, " << given.draws << " times at random. Exact: from " << given.samples
            << " samples. With " << 100.0 * given.noise << " % noise: from " << given.few
            << " samples, the squared error in units of Cramer and Rao's bound, of which the mean is 1 where it is "
               "reached.\n\n"
            << "| lobe | exact: found to 1e-6 | worst relative error | evaluations | noise: median | within 4 times "
               "the bound | mean of those |\n"
            << "|---|---|---|---|---|---|---|\n";
  for (const json& row : rows.elements()) {
    std::cout << "| " << row["lobe"].text() << " | " << row["recovered"] << " of " << row["draws"] << " | ";
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.1e", row["worst"].number());
    // Rounding differs between compilers.
    std::cout << (row["worst"].number() < 1e-9 ? "below 1e-9" : text.data()) << " | " << fixed(row["evaluations"], 1)
              << " | " << fixed(row["noise_median"], 2) << " | " << row["noise_within_4"] << " of " << row["draws"]
              << " | " << fixed(row["noise_mean_of_those"], 2) << " |\n";
  }
}

}  // namespace

void add_model_recovery(command& app) {
  auto command = app.add_subcommand(
      "model-recovery",
      "Whether fits to values of analytic models find the parameters again, and how much noise they pass on");
  const auto options = std::make_shared<recovery_options>();
  command.add_option("--draws", options->draws, "Number of random materials for each kind of lobe")
      .check(check::range(1, 100'000))
      .capture_default_str();
  command.add_option("--samples", options->samples, "Number of samples without noise")
      .check(check::range(4, 1'000'000))
      .capture_default_str();
  command.add_option("--few", options->few, "Number of samples with noise")
      .check(check::range(4, 1'000'000))
      .capture_default_str();
  command.add_option("--noise", options->noise, "Relative deviation of the noise")
      .check(check::positive_number())
      .capture_default_str();
  command
      .add_option("--starts", options->starts,
                  "Number of random starts of fits with noise, in addition to the consecutive start")
      .capture_default_str();
  command.add_option("--seed", options->seed, "Seed of all random numbers").capture_default_str();
  command.add_flag("--json", options->print_json, "Print as JSON");
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace papers
