/// gonio-papers spectra: spectral measurements reconstructed wavelength by wavelength, against the same as colours.

#include "command_line/fixed.hpp"
#include "command_line/measurement_files.hpp"
#include "command_line/prior_option.hpp"
#include "command_line/threads_option.hpp"
#include "papers/experiments.hpp"
#include <gonio/core/random.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/discrepancy_decomposition.hpp>
#include <gonio/estimate/fitted_spectra.hpp>
#include <gonio/io/prior.hpp>
#include <gonio/model/smooth_spectra.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>

namespace papers {

namespace {

struct spectra_options {
  std::vector<std::filesystem::path> samples;
  std::filesystem::path prior;
  std::vector<Eigen::Index> counts{5, 20, 100};
  Eigen::Index repetitions = 20;
  gonio::thread_count threads;
};

using spectral_fit_estimator = gonio::discrepancy_decomposition<gonio::log_relative>;
using gonio::illuminant;

/// Of the directions that were not fitted.
struct path_errors {
  double spectral_rms = 0.0;  ///< of ln(f + 0.001), all wavelengths
  double daylight = 0.0;      ///< mean Delta E under D65
  double incandescent = 0.0;  ///< mean Delta E under A
  double other_lamp = 0.0;    ///< the same of the spectra, where colours were fitted under D65
};

/// What was not fitted, in one repetition.
struct held_out {
  const gonio::spectral_samples& samples;
  gonio::spectral_colour daylit, lamplit;

  explicit held_out(const gonio::spectral_samples& all)
      : samples(all), daylit(all.wavelengths), lamplit(all.wavelengths, illuminant::a) {}

  [[nodiscard]] const gonio::spectral_colour& colour(illuminant light) const {
    return light == illuminant::a ? lamplit : daylit;
  }

  /// Root mean square of the difference of ln(f + 0.001) over directions and wavelengths; negative values count as
  /// zero.
  template <class Spectrum>
  [[nodiscard]] double rms(const Spectrum& spectrum_in) const {
    constexpr double offset = 1e-3;
    double sum = 0.0;
    for (Eigen::Index i = 0; i < samples.size(); ++i) {
      const Eigen::ArrayXd estimate = spectrum_in(i), truth = truth_in(i);
      sum += ((estimate.max(0.0) + offset) / (truth.max(0.0) + offset)).log().square().mean();
    }
    return std::sqrt(sum / static_cast<double>(samples.size()));
  }

  /// Mean CIELAB difference of pi f, over the directions in which the material is no brighter than a white diffuser.
  template <class Colour>
  [[nodiscard]] double delta_e(illuminant light, const Colour& colour_in) const {
    double sum = 0.0, count = 0.0;
    for (Eigen::Index i = 0; i < samples.size(); ++i) {
      const gonio::rgb truth = std::numbers::pi * colour(light)(samples.spectrum(i));
      if (gonio::luminance(truth) > 1.0) continue;
      const gonio::rgb estimate = std::numbers::pi * gonio::rgb(colour_in(i));
      sum += (gonio::unclipped_lab(estimate) - gonio::unclipped_lab(truth)).matrix().norm();
      count += 1.0;
    }
    return sum / count;
  }

  [[nodiscard]] Eigen::ArrayXd truth_in(Eigen::Index i) const {
    return samples.values.row(i).transpose().cast<double>().array();
  }
  [[nodiscard]] gonio::rgb colour_of(illuminant light, const Eigen::ArrayXd& spectrum) const {
    return colour(light)(std::span<const double>(spectrum.data(), static_cast<std::size_t>(spectrum.size())));
  }
};

/// Each wavelength as a grey material.
path_errors fit_wavelengths(const spectral_fit_estimator& estimator, const gonio::spectral_samples& fitted,
                            const held_out& others) {
  const auto fit = gonio::fit_spectra(estimator, fitted);
  const auto spectrum_in = [&](Eigen::Index i) -> Eigen::ArrayXd {
    const auto& [wi, wo] = others.samples.directions[i].pair();
    return fit(wi, wo);
  };
  const auto under = [&](illuminant light) {
    return others.delta_e(light, [&](Eigen::Index i) { return others.colour_of(light, spectrum_in(i)); });
  };
  const double incandescent = under(illuminant::a);
  return {others.rms(spectrum_in), under(illuminant::d65), incandescent, incandescent};
}

/// Colours under each illuminant; the spectra are the smoothest of those under D65.
path_errors fit_colours(const spectral_fit_estimator& estimator, const gonio::spectral_samples& fitted,
                        const gonio::model::smooth_spectra& smooth, const held_out& others) {
  const auto under = [&](const auto& fit) {
    return [&](Eigen::Index i) -> gonio::rgb {
      const auto& [wi, wo] = others.samples.directions[i].pair();
      return fit(wi, wo);
    };
  };
  const auto daylit = estimator.fit(fitted.colours(illuminant::d65)),
             lamplit = estimator.fit(fitted.colours(illuminant::a));
  const auto spectrum_in = [&](Eigen::Index i) -> Eigen::ArrayXd { return smooth(under(daylit)(i)); };
  return {others.rms(spectrum_in), others.delta_e(illuminant::d65, under(daylit)),
          others.delta_e(illuminant::a, under(lamplit)), others.delta_e(illuminant::a, [&](Eigen::Index i) {
            return others.colour_of(illuminant::a, spectrum_in(i));
          })};
}

/// Both ways of all repetitions.
struct comparison {
  std::vector<path_errors> wavelengths, colours;

  /// "0.123 (0.101)": mean and median over the repetitions.
  [[nodiscard]] static std::string described(const std::vector<path_errors>& errors, double path_errors::*which,
                                             int digits) {
    std::vector<double> all;
    double sum = 0.0;
    for (const path_errors& each : errors) {
      all.push_back(each.*which);
      sum += each.*which;
    }
    return fixed(sum / static_cast<double>(all.size()), digits) + " (" + fixed(gonio::median(all), digits) + ")";
  }
  /// In how many repetitions the wavelengths are nearer.
  [[nodiscard]] Eigen::Index wins(double path_errors::*which) const {
    Eigen::Index count = 0;
    for (std::size_t i = 0; i < wavelengths.size(); ++i) count += wavelengths[i].*which < colours[i].*which ? 1 : 0;
    return count;
  }
};

comparison compare(const spectral_fit_estimator& estimator, const gonio::spectral_samples& all, Eigen::Index count,
                   const spectra_options& given) {
  const gonio::model::smooth_spectra smooth(all.wavelengths);
  comparison both;
  for (Eigen::Index r = 0; r < given.repetitions; ++r) {
    const std::vector<Eigen::Index> chosen = gonio::random_choice(all.size(), count, r);
    std::vector<Eigen::Index> rest;
    for (Eigen::Index i = 0; i < all.size(); ++i)
      if (!std::ranges::binary_search(chosen, i)) rest.push_back(i);
    const gonio::spectral_samples fitted = all.subset(chosen), unused = all.subset(rest);
    const held_out others(unused);
    both.wavelengths.push_back(fit_wavelengths(estimator, fitted, others));
    both.colours.push_back(fit_colours(estimator, fitted, smooth, others));
  }
  return both;
}

void print_rows(const std::string& material, Eigen::Index count, const comparison& both) {
  constexpr std::array measures{&path_errors::spectral_rms, &path_errors::daylight, &path_errors::incandescent,
                                &path_errors::other_lamp};
  const std::string start = "| " + material + " | " + std::to_string(count) + " | ";
  std::string wavelengths = start + "wavelengths |", colours = start + "colours |", wins = start + "wavelengths win |";
  for (const auto which : measures) {
    const int digits = which == &path_errors::spectral_rms ? 3 : 2;
    wavelengths += ' ' + comparison::described(both.wavelengths, which, digits) + " |";
    colours += ' ' + comparison::described(both.colours, which, digits) + " |";
    wins += ' ' + std::to_string(both.wins(which)) + " of " + std::to_string(both.colours.size()) + " |";
  }
  std::cout << wavelengths << '\n' << colours << '\n' << wins << '\n';
}

void run(const spectra_options& given) {
  const spectral_fit_estimator estimator{gonio::io::read_prior(given.prior), {}, given.threads};
  std::cout << "Directions that were not fitted, means (medians) of " << given.repetitions << " random sets each.\n\n"
            << "| material | fitted | what is fitted | spectral rms | Delta E, D65 | Delta E, A | Delta E, A, of what "
               "was fitted under D65 |\n|---|---|---|---|---|---|---|\n";
  for (const std::filesystem::path& file : given.samples) {
    const gonio::spectral_samples all = read_spectra_file(file).samples;
    for (const Eigen::Index count : given.counts) {
      if (count >= all.size())
        gonio::refuse({file.native(), ": no sample is left to judge by after ", count, " of ", all.size()});
      print_rows(file.stem().string(), count, compare(estimator, all, count, given));
    }
  }
}

}  // namespace

void add_spectra(command& app) {
  auto command = app.add_subcommand(
      "spectra", "Spectral measurements reconstructed wavelength by wavelength, against the same as colours");
  const auto options = std::make_shared<spectra_options>();
  command
      .add_input("--samples", options->samples,
                 "Spectral measurements (.csv with columns like 400nm, or .brdf in Cornell's text format)")
      .required();
  add_prior_option(command, options->prior);
  command.add_option("--counts", options->counts, "Numbers of measurements that are fitted")
      .check(check::positive_number())
      .capture_default_str();
  command.add_option("--repetitions", options->repetitions, "Random sets of each number")
      .check(check::positive_number())
      .capture_default_str();
  add_threads_option(command, options->threads);
  command.callback([options] { run(*options); });
}

}  // namespace papers
