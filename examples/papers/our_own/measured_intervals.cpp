/// gonio-papers measured-intervals: how often intervals contain measurements that were not fitted.

#include "papers/experiments.hpp"
#include "papers/our_own/rank_correlation.hpp"
#include "tool/files/json.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/core/random.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/io/materials/prior.hpp>

#include <cmath>
#include <iostream>
#include <memory>

namespace papers {

namespace {

struct measured_intervals_options {
  std::vector<std::filesystem::path> samples;
  std::filesystem::path prior;
  std::vector<Eigen::Index> counts{5, 20, 100, 500};
  Eigen::Index repetitions = 10;
  gonio::thread_count threads;
};

/// Counts over the directions that were not fitted, each channel separately.
struct tally {
  double values = 0.0, within_68 = 0.0, within_95 = 0.0, rank = 0.0;
  std::vector<double> errors;  ///< in the metric's domain, of all channels
};

/// Fits some randomly chosen measurements and examines all others.
void count_repetition(const gonio::reconstruction<gonio::log_relative>& estimator, const gonio::located_samples& all,
                      Eigen::Index count, std::uint64_t seed, tally& sum) {
  const std::vector<Eigen::Index> chosen = gonio::random_choice(all.size(), count, seed);
  const auto known = estimator.fit_located(all.subset(chosen));
  const auto& metric = estimator.prior().metric();
  std::vector<double> deviations, errors;
  for (Eigen::Index i = 0; i < all.size(); ++i) {
    if (std::ranges::binary_search(chosen, i)) continue;
    const gonio::location& at = all.locations[i];
    const gonio::rgb truth = all.values.row(i).head<3>().transpose().array().max(0.0), value = known.fit().at(at);
    const auto holds = [&](gonio::confidence_level level) {
      const auto [low, high] = known.interval(value, at, level);
      return static_cast<double>((truth >= low && truth <= high).count());
    };
    sum.values += 3.0;
    sum.within_68 += holds(gonio::confidence_level::sixty_eight_percent);
    sum.within_95 += holds(gonio::confidence_level::ninety_five_percent);
    double error = 0.0;
    for (Eigen::Index c = 0; c < 3; ++c)
      error += std::abs(metric.forward(value[c], at) - metric.forward(truth[c], at)) / 3.0;
    deviations.push_back(known.deviation(at));
    errors.push_back(error);
  }
  sum.rank += rank_correlation(deviations, errors);
  sum.errors.insert(sum.errors.end(), errors.begin(), errors.end());
}

void run(const measured_intervals_options& given) {
  const gonio::reconstruction estimator{gonio::io::read_prior(given.prior), {}, given.threads};
  std::cout << "Directions that were not fitted, " << given.repetitions << " random sets each.\n\n"
            << "| material | fitted | others | median error, mapped | within 68 % | within 95 % | rank correlation |\n"
            << "|---|---|---|---|---|---|---|\n";
  for (const std::filesystem::path& file : given.samples) {
    const gonio::located_samples all =
        gonio::locate_samples(estimator.prior().cells(), read_measurements(file), given.threads);
    for (const Eigen::Index count : given.counts) {
      tally sum;
      for (Eigen::Index r = 0; r < given.repetitions; ++r) count_repetition(estimator, all, count, r, sum);
      std::cout << "| " << file.stem().string() << " | " << count << " | " << all.size() - count << " | "
                << fixed(gonio::median(sum.errors), 3) << " | " << fixed(100.0 * sum.within_68 / sum.values, 1) << " | "
                << fixed(100.0 * sum.within_95 / sum.values, 1) << " | "
                << fixed(sum.rank / static_cast<double>(given.repetitions), 2) << " |\n";
    }
  }
}

}  // namespace

void add_measured_intervals(command& app) {
  auto command = app.add_subcommand("measured-intervals",
                                    "How often intervals hold in directions that were measured, but not fitted");
  const auto options = std::make_shared<measured_intervals_options>();
  command.add_input("--samples", options->samples, "Measurements (.csv, or .brdf in Cornell's text format)").required();
  add_prior_option(command, options->prior);
  command.add_option("--counts", options->counts, "Numbers of measurements that are fitted")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--repetitions", options->repetitions, "Number of random sets of each size")
      .check(check::positive_number())
      .capture_default_str();
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace papers
