#pragma once
/// Bodies of estimate/soft_specular_decomposition.hpp.

#include <gonio/basis/learn_pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/estimate/highlight_contrast.hpp>
#include <gonio/estimate/soft_specular_decomposition.hpp>

#include <optional>
#include <utility>

namespace gonio {

GONIO_INLINE soft_specular_prior learn_soft_specular_prior(const material_set& materials, const log_relative& reference,
                                                           Eigen::Index components, std::optional<double> threshold,
                                                           thread_count threads, const progress& listener) {
  soft_and_specular halves = split_by_contrast(materials, reference, threshold, {}, threads);
  auto soft = learn_pca(std::move(halves.soft), reference, components, threads, listener);
  auto specular = learn_pca(std::move(halves.specular), reference, components, threads, listener);
  return {std::move(soft), std::move(specular), halves.threshold};
}

GONIO_INLINE soft_specular_penalties penalties_in_proportion(const soft_specular_prior& prior, double eta) {
  const auto share = [&](const log_relative_pca& half) {
    return static_cast<double>(half.names().size()) / static_cast<double>(prior.materials());
  };
  return {eta * share(prior.soft()), eta * share(prior.specular())};
}

GONIO_INLINE soft_or_specular<ridge_reconstruction, ridge_reconstruction> soft_specular_decomposition(
    const soft_specular_prior& prior, const soft_specular_penalties& eta, thread_count threads) {
  return {ridge_reconstruction{prior.soft(), tikhonov{eta.soft}, threads},
          ridge_reconstruction{prior.specular(), tikhonov{eta.specular}, threads}, prior.metric(), prior.threshold()};
}

}  // namespace gonio
