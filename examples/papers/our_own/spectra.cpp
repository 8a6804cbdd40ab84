/// gonio-papers spectra: spectral measurements reconstructed wavelength by wavelength, compared with reconstructed
/// colours.

#include "papers/experiments.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/basis/expand_materials.hpp>
#include <gonio/basis/learn_streamed_pca.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/model/smooth_spectra.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace papers {

namespace {

struct spectra_options {
  std::vector<std::filesystem::path> samples;
  std::filesystem::path prior;
  std::vector<Eigen::Index> counts{5, 20, 100};
  Eigen::Index repetitions = 20;
  bool compares_priors = false;
  gonio::thread_count threads;
};

using spectral_fit_estimator = gonio::reconstruction<gonio::log_relative>;
using gonio::illuminant;

spectral_fit_estimator keeping_all(gonio::log_relative_pca prior, gonio::thread_count threads) {
  return spectral_fit_estimator{std::move(prior), {}, threads}.keeping_all();
}

/// Errors in the directions that were not fitted.
struct path_errors {
  double spectral_rms = 0.0;  ///< of ln(f + 0.001), all wavelengths
  // Mean Delta E under an illuminant: of colours that may be out of gamut, and of colours clipped to a display's gamut.
  double daylit = 0.0, lamplit = 0.0;
  double shown_daylit = 0.0, shown_lamplit = 0.0;
  double other_lamp = 0.0;  ///< under A, of spectra computed from colours fitted under D65
};

struct measure {
  double path_errors::*which;
  const char* title;
  int digits;
};

constexpr std::array measures{
    measure{&path_errors::spectral_rms, "spectral rms", 3},
    measure{&path_errors::daylit, "Delta E, D65", 2},
    measure{&path_errors::lamplit, "Delta E, A", 2},
    measure{&path_errors::shown_daylit, "clipped, D65", 2},
    measure{&path_errors::shown_lamplit, "clipped, A", 2},
    measure{&path_errors::other_lamp, "Delta E, A, fitted under D65", 2},
};

/// The samples that were not fitted in one repetition.
struct held_out {
  const gonio::sample_set& samples;
  gonio::spectral_colour daylit, lamplit;

  explicit held_out(const gonio::sample_set& all)
      : samples(all), daylit(all.channels().wavelengths()), lamplit(all.channels().wavelengths(), illuminant::a) {}

  [[nodiscard]] const gonio::spectral_colour& colour(illuminant light) const {
    return light == illuminant::a ? lamplit : daylit;
  }

  /// Returns the root mean square difference of ln(f + 0.001) over directions and wavelengths. Negative values count as
  /// zero.
  template <class Spectrum>
  [[nodiscard]] double rms(const Spectrum& spectrum_in) const {
    constexpr double offset = 1e-3;
    double sum = 0.0;
    for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
      const Eigen::ArrayXd estimate = spectrum_in(i), truth = truth_in(i);
      sum += ((estimate.max(0.0) + offset) / (truth.max(0.0) + offset)).log().square().mean();
    }
    return std::sqrt(sum / static_cast<double>(samples.size()));
  }

  /// Returns the mean CIELAB difference of pi f, over the directions in which the material is no brighter than a white
  /// diffuser: first of unclipped colours, then of colours as a display shows them.
  template <class Colour>
  [[nodiscard]] std::pair<double, double> delta_e(illuminant light, const Colour& colour_in) const {
    double sum = 0.0, shown = 0.0, count = 0.0;
    for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
      const gonio::rgb truth = std::numbers::pi * colour(light)(samples.values(i));
      if (gonio::luminance(truth) > 1.0) continue;
      const gonio::rgb estimate = std::numbers::pi * gonio::rgb(colour_in(i));
      sum += (gonio::unclipped_lab(estimate) - gonio::unclipped_lab(truth)).matrix().norm();
      shown += gonio::delta_e(estimate, truth);
      count += 1.0;
    }
    return {sum / count, shown / count};
  }

  [[nodiscard]] Eigen::ArrayXd truth_in(Eigen::Index i) const {
    return Eigen::Map<const Eigen::ArrayXd>(samples.values(i).data(), samples.channels().size());
  }
  [[nodiscard]] gonio::rgb colour_of(illuminant light, const Eigen::ArrayXd& spectrum) const {
    return colour(light)(std::span<const double>(spectrum.data(), static_cast<std::size_t>(spectrum.size())));
  }
};

/// Fits each wavelength like a grey material.
path_errors fit_wavelengths(const spectral_fit_estimator& estimator, const gonio::sample_set& fitted,
                            const held_out& others) {
  const auto fit = estimator.fit(fitted);
  const auto spectrum_in = [&](Eigen::Index i) -> Eigen::ArrayXd {
    const auto& [wi, wo] = others.samples.directions(i).pair();
    return fit.values(wi, wo);
  };
  const auto under = [&](illuminant light) {
    return others.delta_e(light, [&](Eigen::Index i) { return others.colour_of(light, spectrum_in(i)); });
  };
  const auto [daylit, shown_daylit] = under(illuminant::d65);
  const auto [lamplit, shown_lamplit] = under(illuminant::a);
  return {others.rms(spectrum_in), daylit, lamplit, shown_daylit, shown_lamplit, lamplit};
}

/// The three channels in which colours are fitted.
enum class colour_space { rgb, xyz };

/// A fit of three channels that returns linear Rec. 709. XYZ is relative to white and not negative.
class colour_fit {
 public:
  colour_fit(const spectral_fit_estimator& estimator, const gonio::sample_set& fitted, colour_space space,
             illuminant light)
      : space_(space), fit_(estimator.fit(channels_of(fitted.under(light).colours(), space))) {}

  [[nodiscard]] gonio::rgb operator()(const gonio::direction_pair& at) const {
    const gonio::rgb found = fit_(at.wi, at.wo);
    return space_ == colour_space::rgb ? found : gonio::from_xyz(found * gonio::to_xyz(gonio::rgb::Ones()));
  }

 private:
  [[nodiscard]] static gonio::sample_set channels_of(gonio::sample_set samples, colour_space space) {
    if (space == colour_space::xyz)
      for (gonio::sample& each : samples) each.value = gonio::to_xyz(each.value) / gonio::to_xyz(gonio::rgb::Ones());
    return samples;
  }

  colour_space space_;
  spectral_fit_estimator::result_type fit_;
};

/// Fits colours under each illuminant. The spectra are the smoothest ones of the colours under D65.
path_errors fit_colours(const spectral_fit_estimator& estimator, const gonio::sample_set& fitted, colour_space space,
                        const gonio::model::smooth_spectra& smooth, const held_out& others) {
  const colour_fit daylit(estimator, fitted, space, illuminant::d65), lamplit(estimator, fitted, space, illuminant::a);
  const auto at = [&](Eigen::Index i) { return others.samples.directions(i).pair(); };
  const auto spectrum_in = [&](Eigen::Index i) -> Eigen::ArrayXd { return smooth(daylit(at(i))); };
  const auto under_d65 = others.delta_e(illuminant::d65, [&](Eigen::Index i) { return daylit(at(i)); });
  const auto under_a = others.delta_e(illuminant::a, [&](Eigen::Index i) { return lamplit(at(i)); });
  const auto other_lamp =
      others.delta_e(illuminant::a, [&](Eigen::Index i) { return others.colour_of(illuminant::a, spectrum_in(i)); });
  return {others.rms(spectrum_in), under_d65.first, under_a.first, under_d65.second, under_a.second, other_lamp.first};
}

/// The errors of one method in all repetitions.
using all_errors = std::vector<path_errors>;

/// "0.123 (0.101)": mean and median over the repetitions.
std::string described(const all_errors& errors, const measure& one) {
  std::vector<double> all;
  double sum = 0.0;
  for (const path_errors& each : errors) {
    all.push_back(each.*one.which);
    sum += each.*one.which;
  }
  return fixed(sum / static_cast<double>(all.size()), one.digits) + " (" + fixed(gonio::median(all), one.digits) + ")";
}

/// "18 of 20": the number of repetitions in which the first method has the smaller error.
std::string wins(const all_errors& first, const all_errors& second, const measure& one) {
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < first.size(); ++i) count += first[i].*one.which < second[i].*one.which ? 1 : 0;
  return std::to_string(count) + " of " + std::to_string(first.size());
}

struct comparison {
  all_errors wavelengths, rgb, xyz;
};

std::pair<gonio::sample_set, gonio::sample_set> parted(const gonio::sample_set& all, Eigen::Index count,
                                                       Eigen::Index seed) {
  const std::vector<Eigen::Index> chosen = gonio::random_choice(std::ssize(all), count, seed);
  std::vector<Eigen::Index> rest;
  for (Eigen::Index i = 0; i < std::ssize(all); ++i)
    if (!std::ranges::binary_search(chosen, i)) rest.push_back(i);
  return {all.subset(chosen), all.subset(rest)};
}

comparison compare(const spectral_fit_estimator& estimator, const gonio::sample_set& all, Eigen::Index count,
                   const spectra_options& given) {
  const gonio::model::smooth_spectra smooth(all.channels().wavelengths());
  comparison found;
  for (Eigen::Index r = 0; r < given.repetitions; ++r) {
    const auto [fitted, unused] = parted(all, count, r);
    const held_out others(unused);
    found.wavelengths.push_back(fit_wavelengths(estimator, fitted, others));
    found.rgb.push_back(fit_colours(estimator, fitted, colour_space::rgb, smooth, others));
    found.xyz.push_back(fit_colours(estimator, fitted, colour_space::xyz, smooth, others));
  }
  return found;
}

/// Prints a row of a table: its first columns, and one for each measure.
template <class EntryOf>
void print_row(const std::string& start, const EntryOf& entry_of) {
  std::cout << start;
  for (const measure& one : measures) std::cout << ' ' << entry_of(one) << " |";
  std::cout << '\n';
}

void print_rows(const std::string& material, Eigen::Index count, const comparison& found) {
  const auto print = [&](const char* name, const auto& entry_of) {
    print_row("| " + material + " | " + std::to_string(count) + " | " + name + " |", entry_of);
  };
  print("wavelengths", [&](const measure& one) { return described(found.wavelengths, one); });
  print("RGB", [&](const measure& one) { return described(found.rgb, one); });
  print("XYZ", [&](const measure& one) { return described(found.xyz, one); });
  print("wavelengths nearer than RGB", [&](const measure& one) { return wins(found.wavelengths, found.rgb, one); });
  print("wavelengths nearer than XYZ", [&](const measure& one) { return wins(found.wavelengths, found.xyz, one); });
}

// ---- a prior of spectra ------------------------------------------------------------------------

/// Learns the same number of components from a prior's materials, converted to the smoothest spectra of their colours.
gonio::log_relative_pca learn_as_spectra(const gonio::log_relative_pca& prior, const std::vector<double>& wavelengths,
                                         gonio::thread_count threads) {
  const gonio::model::smooth_spectra smooth(wavelengths);
  const gonio::material_set set = gonio::expand(prior, threads);
  const Eigen::Index bands = std::ssize(wavelengths);
  const auto read = [&](gonio::block range, gonio::cell_rows out) {
    for (Eigen::Index i = 0; i < range.size(); ++i)
      for (Eigen::Index m = 0; m < std::ssize(set.names); ++m) {
        const Eigen::Array3f colour = set.values.row(range.begin + i).segment<3>(3 * m).transpose();
        out.row(i).segment(bands * m, bands) = smooth(colour.cast<double>()).cast<float>().matrix().transpose();
      }
  };
  return gonio::learn_streamed_pca({set.cells, set.names, read, wavelengths},
                                   {.components = prior.size(), .threads = threads})
      .prior;
}

void compare_priors(const std::string& name, const gonio::sample_set& all, const spectra_options& given) {
  const auto colours = gonio::io::read_prior(given.prior);
  const spectral_fit_estimator by_colours = keeping_all(colours, given.threads),
                               by_spectra =
                                   keeping_all(learn_as_spectra(colours, all.channels().wavelengths(), given.threads),
                                               given.threads);
  for (const Eigen::Index count : given.counts) {
    all_errors of_colours, of_spectra;
    for (Eigen::Index r = 0; r < given.repetitions; ++r) {
      const auto [fitted, unused] = parted(all, count, r);
      const held_out others(unused);
      of_colours.push_back(fit_wavelengths(by_colours, fitted, others));
      of_spectra.push_back(fit_wavelengths(by_spectra, fitted, others));
    }
    const std::string start = "| " + name + " | " + std::to_string(count) + " | ";
    print_row(start + "colours |", [&](const measure& one) { return described(of_colours, one); });
    print_row(start + "spectra |", [&](const measure& one) { return described(of_spectra, one); });
    print_row(start + "spectra nearer |", [&](const measure& one) { return wins(of_spectra, of_colours, one); });
  }
}

/// Reads all files before anything is printed. Throws gonio::error if one has too few measurements.
std::vector<gonio::sample_set> read_all(const spectra_options& given) {
  std::vector<gonio::sample_set> all;
  for (const std::filesystem::path& file : given.samples) {
    all.push_back(read_measurement_file(file).samples);
    if (!all.back().channels().are_wavelengths())
      gonio::refuse({file.native(), ": names no wavelengths, expected columns like 400nm,410nm"});
    const Eigen::Index most = std::ranges::max(given.counts);
    if (most >= std::ssize(all.back()))
      gonio::refuse(
          {file.native(), ": no sample is left for the comparison after fitting ", most, " of ", all.back().size()});
  }
  return all;
}

void run(const spectra_options& given) {
  const std::vector<gonio::sample_set> files = read_all(given);
  const spectral_fit_estimator estimator = keeping_all(gonio::io::read_prior(given.prior), given.threads);
  std::cout << "Directions that were not fitted, means (medians) of " << given.repetitions << " random sets each.\n\n"
            << "| material | fitted | " << (given.compares_priors ? "materials of the prior" : "what is fitted")
            << " |";
  for (const measure& one : measures) std::cout << ' ' << one.title << " |";
  std::cout << "\n|---|---|---|---|---|---|---|---|---|\n";
  if (given.compares_priors) {
    for (Eigen::Index file = 0; file < std::ssize(files); ++file)
      compare_priors(given.samples[file].stem().string(), files[file], given);
    return;
  }
  for (Eigen::Index file = 0; file < std::ssize(files); ++file)
    for (const Eigen::Index count : given.counts)
      print_rows(given.samples[file].stem().string(), count, compare(estimator, files[file], count, given));
}

}  // namespace

void add_spectra(command& app) {
  auto command = app.add_subcommand(
      "spectra", "Reconstruct spectral measurements wavelength by wavelength, and compare with reconstructed colours");
  const auto options = std::make_shared<spectra_options>();
  command
      .add_input("--samples", options->samples,
                 "Spectral measurements (.csv with columns like 400nm, or .brdf in Cornell's text format)")
      .required();
  add_prior_option(command, options->prior);
  command.add_flag("--prior-of-spectra", options->compares_priors,
                   "Fit wavelengths with the prior, and with a prior of the same materials as the smoothest spectra of "
                   "their colours");
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
