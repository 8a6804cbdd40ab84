#pragma once
/// Bodies of estimate/fitted_spectra.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/estimate/fitted_spectra.hpp>

#include <vector>

namespace gonio {

GONIO_INLINE located_samples locate_samples(const valid_cells& cells, const spectral_samples& samples,
                                            thread_count threads) {
  require_usable(samples);
  std::vector<Eigen::Index> counting;
  for (Eigen::Index i = 0; i < samples.size(); ++i)
    if (samples.weight(i) > 0.0) counting.push_back(i);
  const Eigen::Index n = std::ssize(counting);
  if (n == 0) refuse("all samples have weight zero: nothing is known");
  located_samples found{std::vector<location>(n), Eigen::MatrixXd(n, samples.bands()), Eigen::MatrixXd(n, 1)};
  for (Eigen::Index i = 0; i < n; ++i) {
    found.locations[i].angles = samples.directions[counting[i]].angles();
    for (Eigen::Index band = 0; band < samples.bands(); ++band)
      found.values(i, band) = double{samples.values(counting[i], band)};
    found.weights(i, 0) = samples.weight(counting[i]);
  }
  detail::locate_angles(found, cells, threads);
  return found;
}

}  // namespace gonio
