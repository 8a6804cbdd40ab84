/// The outputs of gonio reconstruct from a fit: its table, and its spectra if wavelengths are kept.

#include "reconstruct_methods.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace cli {

reconstruction described_spectra(gonio::spectral_table spectra, const reconstruct_options& options) {
  using gonio::io::shortest;
  const gonio::channels kinds(spectra.wavelengths(), options.reading.light.value_or(gonio::illuminant::d65));
  if (!kinds.have_colour() && !options.holds_spectra_alone())
    gonio::refuse(
        "none of the wavelengths is visible, so there are no colours: only -o FILE.bsdf is available, without images");
  reconstruction result{kinds.have_colour() ? spectra.colours(kinds.light(), options.threads)
                                            : gonio::brdf_table(gonio::valid_cells(gonio::grid({1, 1, 1})))};
  const std::vector<double>& wavelengths = kinds.wavelengths();
  result.details = {{"wavelengths_nm", wavelengths}};
  if (kinds.are_wavelengths()) result.details["illuminant"] = kinds.light() == gonio::illuminant::a ? "A" : "D65";
  result.sentence = kinds.are_wavelengths()
                        ? std::to_string(wavelengths.size()) + " wavelengths from " + shortest(wavelengths.front()) +
                              " to " + shortest(wavelengths.back()) + " nm, "
                        : "one wavelength, " + shortest(wavelengths.front()) + " nm, ";
  result.spectra = std::move(spectra);
  return result;
}

json listed(const Eigen::ArrayXd& numbers) { return std::vector<double>(numbers.begin(), numbers.end()); }

std::string in_words(const Eigen::ArrayXd& numbers, int digits) {
  if (numbers.size() > 3) return fixed(numbers.minCoeff(), digits) + " to " + fixed(numbers.maxCoeff(), digits);
  std::string words;
  for (const double number : numbers) words += (words.empty() ? "" : " ") + fixed(number, digits);
  return words;
}

void describe_residuals(const gonio::solve_report& report, Eigen::Index samples, reconstruction& result) {
  const Eigen::ArrayXd residual = report.residual.array() / std::sqrt(static_cast<double>(samples));
  result.details["mapped_residual_rms"] = listed(residual);
  result.details["kkt_residual"] = listed(report.kkt_residual);
  result.sentence += "residual in the mapped domain (rms) " + in_words(residual, 3);
}

reconstruction by_threes(const reconstruct_options& options, const gonio::sample_set& samples,
                         const std::function<gonio::brdf_table(const gonio::sample_set&)>& complete) {
  if (!options.fits_spectra) return {complete(samples)};
  return described_spectra(
      gonio::tabulate_by_threes(gonio::valid_cells(), samples.channels().wavelengths(),
                                [&](Eigen::Index first) {
                                  gonio::sample_set three;
                                  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
                                    const auto values = samples.values(i).subspan(static_cast<std::size_t>(first));
                                    gonio::rgb some;
                                    for (std::size_t c = 0; c < 3; ++c)
                                      some[static_cast<Eigen::Index>(c)] = values[std::min(c, values.size() - 1)];
                                    three.push_back({samples.directions(i), some, samples.weight(i)});
                                  }
                                  return complete(three);
                                }),
      options);
}

}  // namespace cli
