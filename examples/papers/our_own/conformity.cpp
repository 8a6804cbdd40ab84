/// gonio-papers conformity: how often `gonio check` is wrong on measured materials when the prior has not seen their
/// families.

#include "papers/experiments.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/our_own/colour_shift.hpp"
#include "papers/our_own/conformity_channels.hpp"
#include "papers/our_own/detection_rates.hpp"
#include "papers/our_own/left_out_families.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/learn_pca.hpp>
#include <gonio/conformity/conformity.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/materials/rgl.hpp>

#include <array>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <utility>

namespace papers {

namespace {

struct conformity_experiment_options : left_out_options {
  std::filesystem::path folder = shipped_directions();
  std::string set = "perceived";
  std::vector<Eigen::Index> designed{5, 20}, random{5, 20, 100};
  std::vector<double> noise{0.01, 0.02, 0.05};
  Eigen::Index repetitions = 100;
};

using directions = std::vector<gonio::half_difference>;
using estimator = gonio::reconstruction<gonio::log_relative>;

/// A measured surface. Negative values, of colours outside the gamut, are 0.
struct known_surface {
  std::string name;
  reflectance measured;
  /// Factors of the channels that make the surface look 1, 2, 4 and 8 Delta E lighter, redder and bluer.
  std::map<int, std::array<gonio::rgb, 3>> shifts = {};

  [[nodiscard]] reflectance times(const gonio::rgb& factor) const {
    return [f = measured, factor](const gonio::direction_pair& pair) -> gonio::rgb { return factor * f(pair); };
  }
};

constexpr std::array shift_names{"lighter", "redder", "bluer"};

class conformity_experiment {
 public:
  conformity_experiment(const conformity_experiment_options& given, progress_bar& bar)
      : given_(given),
        bar_(bar),
        library_(given.networks, given.materials, given.thin, bar.listener(), given.threads),
        judge_(library_.cells(), 36, given.threads) {
    for (const auto& [name, path] : gonio::io::list_rgl_directory(given.materials))
      surfaces_.push_back({name, [f = gonio::io::read_rgl(path).material](const gonio::direction_pair& pair) {
                             return gonio::rgb(f(pair.wi, pair.wo).max(0.0));
                           }});
    for (const Eigen::Index count : given.designed) designed_[count] = required_points(given.folder, given.set, count);
  }

  void run() {
    Eigen::Index number = 0;
    for (known_surface& surface : surfaces_) {
      bar_.draw(surface.name, static_cast<double>(number) / static_cast<double>(surfaces_.size()));
      seed_ = 1'000'000 * static_cast<std::uint64_t>(++number);
      find_shifts(surface);
      const std::string family = gonio::material_family(surface.name);
      const estimator without =
          learned([&](const std::string& name) { return gonio::material_family(name) != family; });
      compare_same_directions(without, surface);
      compare_with_tolerance(without, surface);
      compare_other_directions(without, surface);
      compare_channels(without, surface);
      judge_familiarity(without, surface, "unseen");
    }
    const estimator all = learned([](const std::string&) { return true; });
    for (const known_surface& surface : surfaces_) judge_familiarity(all, surface, "seen");
  }

  void print() const {
    print_same_directions();
    print_roc();
    print_tolerance();
    print_other_directions();
    print_channels();
    print_familiarity();
  }

 private:
  template <class Keep>
  [[nodiscard]] estimator learned(const Keep& keep) const {
    gonio::material_set set = library_.materials(library_.all(), keep);
    const auto metric = gonio::log_relative::to_median_of(set, given_.threads);
    return estimator{gonio::learn_pca(std::move(set), metric, given_.components, given_.threads)};
  }

  void find_shifts(known_surface& surface) const {
    const gonio::brdf_table table = library_.measured().table(library_.measured().find(surface.name));
    for (const int wanted : {1, 2, 4, 8})
      surface.shifts[wanted] = {factor_of(judge_, table, {1.0, 1.0, 1.0}, wanted, given_.threads),
                                factor_of(judge_, table, {1.0, 0.0, 0.0}, wanted, given_.threads),
                                factor_of(judge_, table, {0.0, 0.0, 1.0}, wanted, given_.threads)};
  }

  /// Returns the p-values of many pairs of measurements, each with its own noise.
  [[nodiscard]] std::vector<double> repeated(
      Eigen::Index times, const std::function<double(std::uint64_t part, std::uint64_t reference)>& once) {
    std::vector<double> all(times);
    const std::uint64_t seed = seed_;
    gonio::for_each_index(
        times, 1, [&](Eigen::Index i) { all[i] = once(seed + 2 * i, seed + 2 * i + 1); }, given_.threads);
    seed_ += 2 * static_cast<std::uint64_t>(times);
    return all;
  }

  [[nodiscard]] static double p_of(const estimator& known, const gonio::sample_set& part,
                                   const gonio::sample_set& reference, const gonio::conformity_options& options) {
    const gonio::valid_cells& cells = known.prior().cells();
    return gonio::check_conformity(known, gonio::locate_samples(cells, part, {1}),
                                   gonio::locate_samples(cells, reference, {1}), options)
        .p_value;
  }

  /// Returns the p-values of `times` comparisons. The noise is known if `stated`, otherwise estimated from repeats in
  /// `where`.
  [[nodiscard]] std::vector<double> compared(const estimator& known, const reflectance& part,
                                             const reflectance& reference, const directions& where, double noise,
                                             Eigen::Index times, double tolerance = 0.0, bool stated = true) {
    return repeated(times, [&](std::uint64_t first, std::uint64_t second) {
      const gonio::sample_set a = measure(part, where, noise, first), b = measure(reference, where, noise, second);
      gonio::conformity_options options{.part = {noise}, .reference = {noise}, .tolerance = {tolerance}};
      if (!stated) {
        const auto& cells = known.prior().cells();
        const auto of_part = gonio::noise_of_repeats(known.prior().metric(), gonio::locate_samples(cells, a, {1}));
        const auto of_reference = gonio::noise_of_repeats(known.prior().metric(), gonio::locate_samples(cells, b, {1}));
        options.part = options.reference = gonio::pooled_noise(of_part, of_reference);
      }
      return p_of(known, a, b, options);
    });
  }

  [[nodiscard]] double middle_noise() const { return given_.noise[given_.noise.size() / 2]; }

  [[nodiscard]] Eigen::Index few() const { return std::max<Eigen::Index>(given_.repetitions / 10, 1); }

  static std::string row_name(Eigen::Index count, double noise) {
    return std::to_string(count) + " | " + fixed(100.0 * noise, 0);
  }

  void compare_same_directions(const estimator& known, const known_surface& surface) {
    for (const auto& [count, where] : designed_) {
      for (const double noise : given_.noise)
        compare_shifts(known, surface, where, noise, row_name(count, noise), true);
      directions twice = where;
      twice.insert(twice.end(), where.begin(), where.end());
      const double noise = middle_noise();
      compare_shifts(known, surface, twice, noise,
                     std::to_string(count) + ", twice each | unknown, " + fixed(100.0 * noise, 0), false);
    }
  }

  void compare_shifts(const estimator& known, const known_surface& surface, const directions& where, double noise,
                      const std::string& row, bool stated) {
    const auto compared_with = [&](const reflectance& part, Eigen::Index times) {
      return compared(known, part, surface.measured, where, noise, times, 0.0, stated);
    };
    results_.add(row, surface.name, compared_with(surface.measured, given_.repetitions));
    for (const auto& [wanted, factors] : surface.shifts)
      for (std::size_t kind = 0; kind < factors.size(); ++kind) {
        const std::vector<double> found = compared_with(surface.times(factors[kind]), few());
        results_.add(row + " shifted " + std::to_string(wanted), surface.name, found);
        results_.add(row + " shifted " + std::to_string(wanted) + shift_names[kind], surface.name, found);
      }
    for (const known_surface& other : surfaces_)
      if (other.name != surface.name) results_.add(row + " others", surface.name, compared_with(other.measured, 1));
  }

  /// Compares parts within the tolerance, at its limit and outside it.
  void compare_with_tolerance(const estimator& known, const known_surface& surface) {
    constexpr double noise = 0.02;
    for (const auto& [count, where] : designed_)
      for (const double factor : tolerance_factors) {
        const reflectance part = surface.times(gonio::rgb::Constant(factor));
        results_.add("tolerance " + std::to_string(count) + fixed(factor, 2), surface.name,
                     compared(known, part, surface.measured, where, noise, given_.repetitions, tolerated));
      }
  }

  /// Compares with a reference that is measured in random directions, drawn anew each time.
  void compare_other_directions(const estimator& known, const known_surface& surface) {
    constexpr double noise = 0.02;
    const gonio::valid_cells cells;
    for (const Eigen::Index of_reference : given_.random)
      for (const auto& entry : designed_) {
        const directions& where = entry.second;
        const std::string row = std::to_string(of_reference) + " | " + std::to_string(entry.first) + " predicted";
        const auto predicted = [&](const reflectance& part, Eigen::Index times) {
          return repeated(times, [&](std::uint64_t first, std::uint64_t second) {
            directions drawn;
            for (const Eigen::Index cell : gonio::random_cells(cells, of_reference, second))
              drawn.push_back(cells.angles(cell));
            return p_of(known, measure(part, where, noise, first), measure(surface.measured, drawn, noise, second),
                        {.part = {noise}, .reference = {noise}});
          });
        };
        results_.add(row, surface.name, predicted(surface.measured, given_.repetitions / 2));
        for (const int wanted : {2, 4, 8})
          for (const gonio::rgb& factor : surface.shifts.at(wanted))
            results_.add(row + " shifted " + std::to_string(wanted), surface.name,
                         predicted(surface.times(factor), few()));
        for (const known_surface& other : surfaces_)
          if (other.name != surface.name) results_.add(row + " others", surface.name, predicted(other.measured, 1));
      }
  }

  /// Compares matching parts in other channels. A row's name has the channels first, then the directions.
  void compare_channels(const estimator& known, const known_surface& surface) {
    const double noise = middle_noise();
    const directions designed = designed_.rbegin()->second, in_plane = directions_in_plane();
    directions twice = designed;
    twice.insert(twice.end(), designed.begin(), designed.end());
    const gonio::valid_cells all, &cells = known.prior().cells();
    const auto alike = [&](const std::string& row, const gonio::channels& kinds, const directions& part,
                           const directions& reference, bool stated) {
      results_.add(row, surface.name, repeated(given_.repetitions / 2, [&](std::uint64_t first, std::uint64_t second) {
                     directions others = reference;
                     if (others.empty())
                       for (const Eigen::Index cell : gonio::random_cells(all, 20, second))
                         others.push_back(all.angles(cell));
                     const auto a = gonio::locate_samples(
                                    cells, measure_channels(surface.measured, kinds, part, noise, first), {1}),
                                b = gonio::locate_samples(
                                    cells, measure_channels(surface.measured, kinds, others, noise, second), {1});
                     gonio::conformity_options options{.part = {noise}, .reference = {noise}};
                     if (!stated)
                       options.part = options.reference =
                           gonio::pooled_noise(gonio::noise_of_repeats(known.prior().metric(), a),
                                               gonio::noise_of_repeats(known.prior().metric(), b));
                     return gonio::check_conformity(known, a, b, options).p_value;
                   }));
    };
    for (const auto& [name, kinds] : compared_channels()) {
      alike(name + channel_rows[0], kinds, designed, designed, true);
      alike(name + channel_rows[1], kinds, twice, twice, false);
      alike(name + channel_rows[2], kinds, in_plane, in_plane, true);
      alike(name + channel_rows[3], kinds, designed, {}, true);
      alike(name + channel_rows[4], kinds, designed, in_plane, true);
    }
  }

  /// Tests the familiarity of samples as measured, and with their values in a random order that matches no material.
  void judge_familiarity(const estimator& known, const known_surface& surface, const std::string& whether) {
    constexpr double noise = 0.02;
    const estimator noisy{known.prior(), {.noise = noise}};
    for (const auto& [count, where] : designed_) {
      const gonio::sample_set samples = measure(surface.measured, where, noise, seed_++);
      gonio::sample_set shuffled = samples;
      const auto order = gonio::random_choice(std::ssize(samples), std::ssize(samples), seed_++);
      for (Eigen::Index i = 0; i < std::ssize(samples); ++i)
        shuffled[i].value = samples[order[(i + 1) % std::ssize(samples)]].value;
      const auto add = [&](const std::string& what, const gonio::sample_set& judged) {
        const auto found = noisy.process_of(gonio::locate_samples(known.prior().cells(), judged)).familiarity();
        const std::string row = std::to_string(count) + what;
        results_.add(row, surface.name, {found.p_value});
        results_.add(row + " scale", surface.name, {found.scale});
        results_.add(row + " components", surface.name, {found.components});
      };
      add(whether, samples);
      if (whether == "seen") add("shuffled", shuffled);
    }
  }

  [[nodiscard]] std::vector<std::string> rows_of_same_directions() const {
    std::vector<std::string> rows;
    for (const auto& [count, where] : designed_) {
      for (const double noise : given_.noise) rows.push_back(row_name(count, noise));
      rows.push_back(std::to_string(count) + ", twice each | unknown, " + fixed(100.0 * middle_noise(), 0));
    }
    return rows;
  }

  void print_same_directions() const;
  void print_roc() const;
  void print_tolerance() const;
  void print_other_directions() const;
  void print_channels() const;
  void print_familiarity() const;

  static constexpr std::array channel_rows{" | designed", " | designed, twice each, unknown noise", " | in plane",
                                           " | designed, from 20 others", " | designed, from those in plane"};
  static constexpr double tolerated = 0.05;
  static constexpr std::array tolerance_factors{1.0, 1.05, 1.07, 1.1};

  const conformity_experiment_options& given_;
  progress_bar& bar_;
  material_library library_;
  gonio::appearance_metric judge_;
  std::vector<known_surface> surfaces_;
  std::map<Eigen::Index, directions> designed_;
  std::uint64_t seed_ = 0;
  p_values results_;
};

void conformity_experiment::print_same_directions() const {
  std::cout
      << "The same directions; per cent of parts that are said to differ, at false alarms of 1 % (and of 5 %).\n\n"
         "| directions | noise, % | false alarms (95 % interval) | false alarms at 5 % | Delta E 1 | Delta E 2 | "
         "Delta E 2, worst material | Delta E 4 | other materials |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const std::string& row : rows_of_same_directions()) {
    const std::vector<double> alike = results_.all(row);
    const auto found = [&](const std::string& what) {
      return percent(p_values::below(results_.all(row + what), 0.01));
    };
    const auto [least, name] = results_.worst(row + " shifted 2", 0.01);
    std::cout << "| " << row << " | " << with_interval(alike, 0.01) << " | " << with_interval(alike, 0.05) << " | "
              << found(" shifted 1") << " | " << found(" shifted 2") << " | " << percent(least) << ", " << name << " | "
              << found(" shifted 4") << " | " << found(" others") << " |\n";
  }
}

void conformity_experiment::print_roc() const {
  std::cout
      << "\nROC of Delta E 2, the same directions: per cent that are found, by the false alarms that are allowed, "
         "and the three shifts at 1 %.\n\n| directions | noise, % | at 0.1 % | at 1 % | at 5 % | at 10 % | area | "
         "lighter | redder | bluer |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const std::string& row : rows_of_same_directions()) {
    const std::vector<double> shifted = results_.all(row + " shifted 2");
    std::cout << "| " << row;
    for (const double level : {0.001, 0.01, 0.05, 0.1}) std::cout << " | " << percent(p_values::below(shifted, level));
    std::cout << " | " << fixed(area(results_.all(row), shifted), 3);
    for (const char* kind : shift_names)
      std::cout << " | " << percent(p_values::below(results_.all(row + " shifted 2" + kind), 0.01));
    std::cout << " |\n";
  }
}

void conformity_experiment::print_tolerance() const {
  std::cout << "\nA tolerance of " << fixed(100.0 * tolerated, 0)
            << " %, noise of 2 %, false alarms of 1 %: per cent that are said to differ of parts that are so much "
               "brighter.\n\n| directions";
  for (const double factor : tolerance_factors) std::cout << " | " << fixed(100.0 * (factor - 1.0), 0) << " %";
  std::cout << " |\n|---|---|---|---|---|\n";
  for (const auto& [count, where] : designed_) {
    std::cout << "| " << count;
    for (const double factor : tolerance_factors)
      std::cout << " | "
                << fixed(100.0 * p_values::below(results_.all("tolerance " + std::to_string(count) + fixed(factor, 2)),
                                                 0.01),
                         2);
    std::cout << " |\n";
  }
}

void conformity_experiment::print_other_directions() const {
  std::cout
      << "\nOther directions: the reference has random ones, and predicts all of the part. Noise of 2 %; per cent "
         "that are said to differ at false alarms of 1 %.\n\n| of the reference | of the part | false alarms (95 % "
         "interval) | false alarms at 5 % | Delta E 2 | Delta E 4 | Delta E 8 | other materials "
         "|\n|---|---|---|---|---|---|---|---|\n";
  for (const Eigen::Index of_reference : given_.random)
    for (const auto& entry : designed_) {
      const std::string row = std::to_string(of_reference) + " | " + std::to_string(entry.first);
      const std::vector<double> alike = results_.all(row + " predicted");
      std::cout << "| " << row << " | " << with_interval(alike, 0.01) << " | " << with_interval(alike, 0.05);
      for (const char* what : {" shifted 2", " shifted 4", " shifted 8", " others"})
        std::cout << " | " << percent(p_values::below(results_.all(row + " predicted" + what), 0.01));
      std::cout << " |\n";
    }
}

void conformity_experiment::print_channels() const {
  std::cout << "\nParts that are alike, in other channels; noise of " << fixed(100.0 * middle_noise(), 0)
            << " %.\n\n| channels | directions | false alarms at 1 % (95 % interval) | at 5 % |\n|---|---|---|---|\n";
  for (const auto& [name, kinds] : compared_channels())
    for (const char* row : channel_rows)
      std::cout << "| " << name << row << " | " << with_interval(results_.all(name + row), 0.01) << " | "
                << with_interval(results_.all(name + row), 0.05) << " |\n";
}

void conformity_experiment::print_familiarity() const {
  std::cout << "\nIs it a known material? By a prior that has not seen its family, by one that has, and of values in "
               "another order.\n\n| directions | material | p below 1 %, per cent | scale, median | of it components, "
               "median, per cent |\n|---|---|---|---|---|\n";
  for (const auto& [count, where] : designed_)
    for (const char* what : {"seen", "unseen", "shuffled"}) {
      const std::string row = std::to_string(count) + what;
      std::cout << "| " << count << " | " << what << " | " << percent(p_values::below(results_.all(row), 0.01)) << " | "
                << fixed(gonio::median(results_.all(row + " scale")), 2) << " | "
                << fixed(100.0 * gonio::median(results_.all(row + " components")), 0) << " |\n";
    }
}

}  // namespace

void add_conformity(command& app) {
  auto command = app.add_subcommand(
      "conformity",
      "How often gonio check is wrong on measured materials, by priors that have not seen their families");
  const auto options = std::make_shared<conformity_experiment_options>();
  add_left_out_options(command, *options);
  command.add_input_folder("--directions", options->folder, {".csv"}, "Folder of designed sets");
  command.add_option("--set", options->set, "Name of the designed sets: perceived for point-20-perceived.csv")
      .capture_default_str();
  command.add_option("--designed", options->designed, "Numbers of designed directions in which parts are measured")
      .capture_default_str();
  command.add_option("--random", options->random, "Numbers of random directions in which references are measured")
      .capture_default_str();
  command.add_option("--noise", options->noise, "Relative deviations of the measurements").capture_default_str();
  command.add_option("--repetitions", options->repetitions, "Number of matching parts of each material")
      .check(check::range(2, 1'000'000))
      .capture_default_str();
  command.callback([options] {
    progress_bar bar;
    conformity_experiment work(*options, bar);
    work.run();
    bar.wipe();
    work.print();
  });
}

}  // namespace papers
