/// gonio-papers scattered-samples: finds the best interpolation between neighbouring measurements by leaving some of
/// them out.

#include "tool/options/scattered_samples.hpp"

#include "papers/experiments.hpp"
#include "papers/our_own/left_out_families.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/core/parallel.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/metric/log_relative.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>

namespace papers {

namespace {

struct scattered_samples_options {
  std::filesystem::path materials;
  std::vector<std::filesystem::path> readings;
  std::vector<Eigen::Index> random{100, 500, 2000};
  Eigen::Index left_out = 500;
  gonio::thread_count threads;
};

/// Samples to interpolate, and other samples of the same material for comparison.
struct judged_samples {
  std::string name, family;
  Eigen::Index count = 0;  ///< of samples to interpolate; 0: readings
  gonio::sample_split samples;
};

/// Returns the options to try: the nearest sample alone, then all combinations.
std::vector<gonio::scattered_options> candidates() {
  std::vector<gonio::scattered_options> all;
  for (const double theta_d_scale : {0.7, 1.0, 1.4})
    for (const double phi_d_scale : {0.08, 0.15, 0.25}) {
      const gonio::pair_embedding embedding{theta_d_scale, phi_d_scale};
      all.push_back({1, 1.0, embedding, gonio::interpolation_domain::reflectance});
      for (const auto domain : {gonio::interpolation_domain::reflectance, gonio::interpolation_domain::logarithm})
        for (const Eigen::Index neighbours : {4, 8, 16, 32})
          for (const double exponent : {1.0, 1.5, 2.0, 3.0}) all.push_back({neighbours, exponent, embedding, domain});
    }
  return all;
}

std::string name_of(const gonio::scattered_options& options) {
  if (options.neighbours == 1) return "nearest";
  return std::to_string(options.neighbours) + " neighbours, p " + fixed(options.exponent, 1) + ", " +
         (options.domain == gonio::interpolation_domain::logarithm ? "logarithm" : "reflectance");
}

std::string scales_of(const gonio::scattered_options& options) {
  return "a " + fixed(options.embedding.theta_d_scale, 1) + ", b " + fixed(options.embedding.phi_d_scale, 2);
}

std::vector<judged_samples> samples_of_tables(const scattered_samples_options& given) {
  std::vector<judged_samples> all;
  for (const auto& [name, path] : gonio::io::list_rgl_directory(given.materials)) {
    const auto material = gonio::io::read_rgl(path).material;
    for (const Eigen::Index count : given.random) {
      const auto directions = random_sampling(count + given.left_out, 1).sets.front();
      const auto measured =
          measure([&](const gonio::direction_pair& pair) { return gonio::rgb(material(pair.wi, pair.wo)); }, directions,
                  0.0, 0);
      all.push_back({name, gonio::material_family(name), count, gonio::split_samples(measured, count, all.size())});
    }
  }
  return all;
}

/// Adds goniometers' readings: two thirds to interpolate, and the rest to compare with. All readings count as one
/// family.
void add_readings(const scattered_samples_options& given, std::vector<judged_samples>& to) {
  for (const std::filesystem::path& path : given.readings) {
    const gonio::sample_set readings = read_measurements(path);
    to.push_back(
        {path.stem().string(), "readings", 0, gonio::split_samples(readings, 2 * std::ssize(readings) / 3, to.size())});
  }
}

/// Returns the difference of two values in the log-relative metric, for any reference of the metric.
gonio::rgb mapped_difference(const gonio::rgb& one, const gonio::rgb& other, const gonio::half_difference& at) {
  const gonio::cosine_pair cosine = gonio::cosines(at);
  const double weight = std::max(cosine.i * cosine.o, gonio::log_relative::epsilon);
  gonio::rgb difference;
  for (Eigen::Index c = 0; c < 3; ++c)
    difference[c] =
        gonio::log_relative::forward(one[c], 0.0, weight) - gonio::log_relative::forward(other[c], 0.0, weight);
  return difference;
}

/// Returns the root mean square error over the channels of the samples that were left out.
double error_of(const judged_samples& judged, const gonio::scattered_options& options) {
  const interpolated_samples f = interpolate(judged.samples.some, options);
  double squares = 0.0;
  for (const gonio::sample& s : judged.samples.others) {
    const auto [wi, wo] = s.directions.pair();
    squares += mapped_difference(f(wi, wo), s.value, s.angles()).square().sum();
  }
  return std::sqrt(squares / (3.0 * static_cast<double>(judged.samples.others.size())));
}

/// The errors of all candidates on all samples, and the choices that follow from them.
class choice_of_options {
 public:
  choice_of_options(std::vector<judged_samples> judged, gonio::thread_count threads, progress_bar& bar)
      : judged_(std::move(judged)), tried_(candidates()), errors_(std::ssize(judged_), std::ssize(tried_)) {
    for (Eigen::Index i = 0; i < errors_.rows(); ++i) {
      bar.draw(judged_[i].name, static_cast<double>(i) / static_cast<double>(errors_.rows()));
      gonio::for_each_index(
          errors_.cols(), 1, [&](Eigen::Index j) { errors_(i, j) = error_of(judged_[i], tried_[j]); }, threads);
    }
  }

  /// Returns the allowed candidate with the least geometric mean error over all families but one.
  [[nodiscard]] Eigen::Index best_without(const std::string& family, const auto& allows) const {
    Eigen::Index best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index j = 0; j < errors_.cols(); ++j) {
      if (!allows(tried_[j])) continue;
      double sum = 0.0;
      for (Eigen::Index i = 0; i < errors_.rows(); ++i)
        if (judged_[i].family != family) sum += std::log(errors_(i, j));
      if (sum < least) {
        least = sum;
        best = j;
      }
    }
    return best;
  }

  /// Prints a row for each number of samples: mean errors of candidates chosen on the other families, of the defaults,
  /// and of the best candidate for each set of samples.
  void print_judged() const {
    const auto nearest = [](const gonio::scattered_options& o) { return o.neighbours == 1; };
    const auto linear = [](const gonio::scattered_options& o) {
      return o.neighbours > 1 && o.domain == gonio::interpolation_domain::reflectance;
    };
    const auto any = [](const gonio::scattered_options&) { return true; };
    std::cout << "| samples | sets | nearest | mean of reflectances | best | the defaults | best of its own |\n"
                 "|---|---|---|---|---|---|---|\n";
    for (const Eigen::Index count : counts()) {
      std::array<double, 5> sums{};
      double sets = 0.0;
      for (Eigen::Index i = 0; i < errors_.rows(); ++i) {
        if (judged_[i].count != count) continue;
        const std::string& family = judged_[i].family;
        sums[0] += errors_(i, best_without(family, nearest));
        sums[1] += errors_(i, best_without(family, linear));
        sums[2] += errors_(i, best_without(family, any));
        sums[3] += error_of(judged_[i], {});
        sums[4] += errors_.row(i).minCoeff();
        sets += 1.0;
      }
      std::cout << "| " << (count == 0 ? "readings" : std::to_string(count)) << " | " << fixed(sets, 0);
      for (const double sum : sums) std::cout << " | " << fixed(sum / sets, 3);
      std::cout << " |\n";
    }
  }

  void print_chosen() const {
    std::map<std::string, std::vector<std::string>> chosen;
    for (const std::string& family : families()) {
      const auto& options = tried_[best_without(family, [](const gonio::scattered_options&) { return true; })];
      chosen[name_of(options) + "; " + scales_of(options)].push_back(family);
    }
    std::cout << "\n| best on all other families | for |\n|---|---|\n";
    for (const auto& [options, of] : chosen) {
      std::cout << "| " << options << " | ";
      for (const std::string& family : of) std::cout << (family == of.front() ? "" : ", ") << family;
      std::cout << " |\n";
    }
  }

  /// Prints the mean error over all samples for each value of `name`, with the best values of all other options.
  void print_by(const char* title, const auto& name) const {
    std::map<std::string, double> least;
    for (Eigen::Index j = 0; j < errors_.cols(); ++j) {
      const auto [entry, is_new] = least.emplace(name(tried_[j]), errors_.col(j).mean());
      if (!is_new) entry->second = std::min(entry->second, errors_.col(j).mean());
    }
    std::cout << "\n| " << title << " | mean error |\n|---|---|\n";
    for (const auto& [options, error] : least) std::cout << "| " << options << " | " << fixed(error, 3) << " |\n";
  }

 private:
  [[nodiscard]] std::vector<Eigen::Index> counts() const {
    std::vector<Eigen::Index> all;
    for (const judged_samples& each : judged_)
      if (std::ranges::count(all, each.count) == 0) all.push_back(each.count);
    return all;
  }

  [[nodiscard]] std::set<std::string> families() const {
    std::set<std::string> all;
    for (const judged_samples& each : judged_) all.insert(each.family);
    return all;
  }

  std::vector<judged_samples> judged_;
  std::vector<gonio::scattered_options> tried_;
  Eigen::ArrayXXd errors_;  ///< sets of samples x candidates
};

void print(const choice_of_options& choice) {
  choice.print_judged();
  choice.print_chosen();
  choice.print_by("neighbours and p, with the best of the others", [](const gonio::scattered_options& o) {
    return o.neighbours == 1 ? std::string("nearest")
                             : (o.neighbours < 10 ? " " : "") + std::to_string(o.neighbours) + " neighbours, p " +
                                   fixed(o.exponent, 1);
  });
  choice.print_by("scales, with the best of the others", scales_of);
}

}  // namespace

void add_scattered_samples(command& app) {
  auto command = app.add_subcommand(
      "scattered-samples", "Choose how samples are interpolated between their neighbours, by leaving some out");
  const auto options = std::make_shared<scattered_samples_options>();
  command.add_input_folder("--materials", options->materials, {".bsdf"}, "Folder of measured materials (.bsdf)")
      .required();
  command.add_input("--readings", options->readings, "Readings of a goniometer (.brdf in Cornell's text format, .csv)");
  command.add_option("--random", options->random, "Numbers of random directions").capture_default_str();
  command
      .add_option("--left-out", options->left_out,
                  "Number of random directions that are left out, to measure the error")
      .check(check::positive_number())
      .capture_default_str();
  add_threads_option(command, options->threads);
  command.callback([options] {
    progress_bar bar;
    std::vector<judged_samples> judged = samples_of_tables(*options);
    add_readings(*options, judged);
    const choice_of_options choice(std::move(judged), options->threads, bar);
    bar.wipe();
    print(choice);
  });
}

}  // namespace papers
