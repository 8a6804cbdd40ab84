#pragma once
/// Finds single wrong values in spectra, such as the spikes of a spectrometer, and replaces them. Each value is
/// compared with its neighbours in wavelength. The process of the samples (sample_process.hpp) predicts this difference
/// from the same wavelength of all other samples; a narrow feature that the samples share is therefore no spike. A
/// wrong value has an error of large variance, as in wrong_samples.hpp. Constants and results:
/// docs/decisions/0020-wrong-samples.md.

#include <gonio/estimate/inliers.hpp>
#include <gonio/estimate/located_samples.hpp>
#include <gonio/estimate/sample_process.hpp>

#include <Eigen/Core>

#include <functional>
#include <vector>

namespace gonio {

/// A value of a spectrum that was replaced because it contradicts its neighbours in wavelength and the other samples.
struct spectral_spike {
  Eigen::Index number = 0;   ///< position of the sample among the samples
  Eigen::Index channel = 0;  ///< position of the wavelength among the wavelengths
  double measured = 0.0;     ///< sr^-1
  double replaced_by = 0.0;  ///< sr^-1: the neighbours' value plus the difference that the other samples predict
  double probability = 0.0;  ///< probability that the measured value is wrong
};

namespace detail {

/// The smallest number of wavelengths in which a wrong one can be told from its neighbours.
inline constexpr Eigen::Index fewest_wavelengths_of_spikes = 4;

/// Returns the spikes in the spectra of samples, the most certain first. Finds up to three neighbouring wrong values.
/// `process_of` returns the process of some of the samples. Finds none among fewer than three samples or
/// `fewest_wavelengths_of_spikes` wavelengths. O(n m (m + c)) for n samples, m the smaller of n and `most_judged`, and
/// c wavelengths.
[[nodiscard]] std::vector<spectral_spike> find_spikes(
    const prior_functions& prior, const std::function<sample_process(const located_samples&)>& process_of,
    const located_samples& samples);

}  // namespace detail

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/spectral_spikes.ipp>
#endif
