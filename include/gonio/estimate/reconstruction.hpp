#pragma once
/// Reconstructs a material from samples, with the uncertainty of every value and the samples that disagree. `gonio
/// reconstruct` does this by default. Principal components (Nielsen et al. 2015, doi:10.1145/2816795.2818085, Eq. 12)
/// are fitted together with a Gaussian process for the part that the components cannot express (Kennedy and O'Hagan
/// 2001, doi:10.1111/1467-9868.00294). With few samples, the components mainly determine the result; with many, it
/// follows the samples. Results on real materials, with families left out: docs/results/real-materials.md.

#include <gonio/basis/pca.hpp>
#include <gonio/core/random.hpp>
#include <gonio/estimate/aperture_factors.hpp>
#include <gonio/estimate/estimator.hpp>
#include <gonio/estimate/map_samples.hpp>
#include <gonio/estimate/mapped_noise.hpp>
#include <gonio/estimate/reconstructed.hpp>
#include <gonio/estimate/solve_rows.hpp>
#include <gonio/estimate/spectral_spikes.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace gonio {

/// Reconstructs a material from samples in four steps: maps the samples, finds the inliers by the samples' process,
/// takes the mean of the inliers' process as the result, and keeps that process to compute uncertainties. An
/// `estimator`.
///
/// With m observations in the prior, the components have coefficients c ~ N(0, I / m), and the discrepancy has the
/// variance `discrepancy_model::variance`. The mean of the process of their sum is ridge regression in its dual form:
/// `tikhonov` with eta = m error_variance, on the components and the discrepancy's functions around the samples
/// together (docs/decisions/0019-discrepancy-beside-the-prior.md). Noise adds to the error variance of a sample and so
/// lowers its weight.
///
/// ```cpp
/// const auto paint = gonio::reconstruction{prior}.fit(samples);
/// gonio::io::write_merl("paint.binary", paint);
/// const double relative = paint.known_to(wi, wo);
/// for (const Eigen::Index i : paint.rejected()) std::printf("sample %td disagrees with the others\n", i + 1);
/// ```
template <error_metric Metric>
class reconstruction {
 public:
  using result_type = reconstructed<Metric>;
  using basis_type = typename result_type::basis_type;

  /// Throws gonio::error for an impossible model.
  explicit reconstruction(pca<Metric> prior, const discrepancy_model& model = {}, thread_count threads = {});

  /// Returns a copy that rejects no sample and replaces no value.
  [[nodiscard]] reconstruction keeping_all() const {
    reconstruction other = *this;
    other.rejects_ = false;
    return other;
  }

  [[nodiscard]] const pca<Metric>& prior() const noexcept { return prior_; }
  [[nodiscard]] const valid_cells& cells() const noexcept { return prior_.cells(); }
  [[nodiscard]] const discrepancy_model& model() const noexcept { return expected_.model; }
  /// Returns the covariance of a material before it is measured.
  [[nodiscard]] const expected_covariance& expected() const noexcept { return expected_; }

  /// Fits samples in any channels, all channels by one process. Each wavelength is fitted as a grey material. First,
  /// spikes of spectra are replaced (`replace_spikes`). Then inliers are found by the samples' colours, and by three
  /// bands of their invisible wavelengths. For n samples, k components and c centres: O(n^2 (n + k)) up to
  /// `most_centres` samples, O(n (k + c)^2) for more. Throws gonio::error for unusable samples.
  ///
  /// A reading through an aperture is the value in a single direction times a factor. The factor is the mean of the fit
  /// over the aperture's cones, divided by the fit on the cones' axes. The fit is repeated three times, each time with
  /// the readings divided by this factor.
  [[nodiscard]] result_type fit(const sample_set& samples) const;
  /// Replaces single wrong values of spectra, and returns them (spectral_spikes.hpp). Call this before converting
  /// spectra to colours. Does nothing if the channels are not wavelengths.
  std::vector<spectral_spike> replace_spikes(sample_set& samples) const;
  /// Fits samples that are located on the prior's cells. Replaces no values.
  [[nodiscard]] result_type fit_located(located_samples samples, std::vector<Eigen::Index> numbers = {}) const;

  /// Returns the process of samples that are located on the prior's cells, without rejecting any.
  [[nodiscard]] sample_process process_of(const located_samples& samples) const {
    return process_of_mapped(map_samples(prior_, samples, threads_));
  }
  /// Returns the process, in three channels (`channels::three`), of the samples that `fit` would keep. If `fit` would
  /// keep more than `most_centres`, takes `reconstructed::most_known` of them at random.
  [[nodiscard]] sample_process process_of_inliers(const located_samples& samples) const;

 private:
  /// The inliers, the mapped samples, and their processes if there are few enough samples.
  struct selection {
    inliers found;
    std::optional<sample_process> all;      ///< process of all samples
    located_samples kept;                   ///< mapped
    std::optional<sample_process> process;  ///< process of the kept samples
  };

  using solved = std::pair<basis_type, solution>;

  [[nodiscard]] bool has_process(Eigen::Index samples) const noexcept { return samples <= model().most_centres; }
  /// Selects the samples to keep. `colours` has them in three channels.
  [[nodiscard]] selection select(const located_samples& samples, const located_samples& colours) const;
  [[nodiscard]] sample_process process_of_mapped(const located_samples& mapped) const {
    return {expected_, locate_rows(prior_, mapped.locations), mapped, error_variances(mapped)};
  }
  /// Fits samples whose spikes were replaced, in rounds if they were read through apertures.
  [[nodiscard]] result_type fit_readings(const sample_set& samples) const;
  /// Returns the factors by which apertures change the values of the samples at the positions `numbers`, as predicted
  /// by a fit.
  [[nodiscard]] Eigen::MatrixXd aperture_factors(const sample_set& samples, const std::vector<Eigen::Index>& numbers,
                                                 const typename result_type::fit_type& fit) const;
  /// Returns the process of the kept samples or, if they are many, of a random subset.
  [[nodiscard]] sample_process known_by(const selection& chosen) const;

  [[nodiscard]] solved solve(const located_samples& kept, const std::optional<sample_process>& process) const;
  [[nodiscard]] solved solve_around_centres(located_samples kept) const;
  /// Returns a basis of the principal components and of the discrepancy's covariance functions around the centres.
  [[nodiscard]] basis_type functions_around(const std::vector<half_difference>& centres) const {
    return {prior_, {prior_.cells(), prior_.metric(), discrepancy_functions::covariances(centres, model().lengths)}};
  }

  /// Returns the variance of each sample's error in the metric's domain: the model's error variance plus the variance
  /// of the noise.
  [[nodiscard]] Eigen::VectorXd error_variances(const located_samples& samples) const {
    Eigen::VectorXd variances = map_noise(prior_, samples.locations, model().noise, threads_).variance;
    for (Eigen::Index i = 0; i < variances.size(); ++i)
      variances[i] += error_variance_at(model(), samples.locations[i].angles);
    return variances;
  }

  pca<Metric> prior_;
  expected_covariance expected_;
  thread_count threads_;
  bool rejects_ = true;
};

// ---- bodies, outside of the class so that those of `log_relative` can be compiled once ------------------------------

template <error_metric Metric>
reconstruction<Metric>::reconstruction(pca<Metric> prior, const discrepancy_model& model, thread_count threads)
    : prior_(std::move(prior)), expected_{prior_.observations(), model}, threads_(threads) {
  const auto positive = [](double value) { return value > 0.0 && std::isfinite(value); };
  if (!positive(model.error_variance))
    refuse({"the error variance of a discrepancy must be positive and finite, not ", model.error_variance});
  if (!positive(model.variance))
    refuse({"the variance of a discrepancy must be positive and finite, not ", model.variance});
  if (model.most_centres < 1 || model.most_samples < 1 || !(model.effective_samples >= 1.0))
    refuse("most_centres, most_samples and effective_samples of a discrepancy must be at least 1");
}

template <error_metric Metric>
typename reconstruction<Metric>::selection reconstruction<Metric>::select(const located_samples& samples,
                                                                          const located_samples& colours) const {
  const located_samples mapped = map_samples(prior_, colours, threads_);
  selection chosen;
  if (has_process(colours.size())) chosen.all = process_of_mapped(mapped);
  chosen.found = all_inliers(colours.size());
  const Eigen::VectorXd errors = error_variances(mapped);
  const auto judged = [&](const channels& kinds, const located_samples& three, const located_samples& three_mapped) {
    inliers found = find_inliers(prior_, expected_, three, three_mapped, errors, chosen.all, threads_);
    for (outlying_sample& each : found.contradicted) each.channel_names = kinds.names_of_three();
    return found;
  };
  if (rejects_) {
    chosen.found = judged(samples.kinds, colours, mapped);
    if (const std::optional<located_samples> rest = samples.at_invisible_wavelengths()) {
      const located_samples three = rest->in_three_channels();
      chosen.found = detail::inliers_of_both(std::move(chosen.found),
                                             judged(rest->kinds, three, map_samples(prior_, three, threads_)));
    }
  }
  chosen.kept = weighted(mapped, chosen.found);
  if (!has_process(chosen.kept.size())) return chosen;
  if (!chosen.all)
    chosen.process = process_of_mapped(chosen.kept);
  else if (std::count(chosen.found.weights.data(), chosen.found.weights.data() + samples.size(), 1.0) == samples.size())
    chosen.process = chosen.all;
  else
    chosen.process = chosen.all->subset(chosen.found.kept(), chosen.found.weights);
  return chosen;
}

template <error_metric Metric>
sample_process reconstruction<Metric>::known_by(const selection& chosen) const {
  const Eigen::Index count = chosen.kept.size();
  if (chosen.process && count <= result_type::most_known) return *chosen.process;
  const std::vector<Eigen::Index> some = random_choice(count, result_type::most_known, 0);
  return chosen.process ? chosen.process->subset(some) : process_of_mapped(chosen.kept.subset(some));
}

template <error_metric Metric>
sample_process reconstruction<Metric>::process_of_inliers(const located_samples& samples) const {
  const selection chosen = select(samples, samples.in_three_channels());
  return chosen.process ? *chosen.process : known_by(chosen);
}

template <error_metric Metric>
typename reconstruction<Metric>::solved reconstruction<Metric>::solve(
    const located_samples& kept, const std::optional<sample_process>& process) const {
  if (!process) return solve_around_centres(kept);
  return {functions_around(process->at().angles), process->fit()};
}

template <error_metric Metric>
typename reconstruction<Metric>::solved reconstruction<Metric>::solve_around_centres(located_samples kept) const {
  if (kept.size() > model().most_samples) kept = kept.subset(random_choice(kept.size(), model().most_samples, 0));
  const Eigen::VectorXd variances = error_variances(kept), crowding = crowding_variances(model(), kept.locations);
  double alone = 0.0, crowded = 0.0;  // total weights without and with crowding
  for (Eigen::Index i = 0; i < kept.weights.size(); ++i) {
    const Eigen::Index sample = i % kept.size();
    double& weight = kept.weights.data()[i];
    alone += weight / variances[sample];
    weight *= model().error_variance / (variances[sample] + crowding[sample]);
    crowded += weight / model().error_variance;
  }
  std::vector<half_difference> centres;
  for (const Eigen::Index i : random_choice(kept.size(), model().most_centres, 0))
    centres.push_back(kept.locations[i].angles);
  const discrepancy_functions smooth(centres, expected_.observations * model().variance, model().lengths);
  const basis_type whitened{prior_, {prior_.cells(), prior_.metric(), smooth}};
  const row_source rows{kept.size(), whitened.size(), [&](block range, row_block out) {
                          const std::span<const location> all = kept.locations;
                          read_rows_at(whitened, all.subspan(range.begin, range.size()), out);
                        }};
  solution found = solve_rows(tikhonov(expected_.observations * model().error_variance), rows, kept, threads_);
  found.report.residual *= std::sqrt(alone / crowded);  // state the misfit as if no samples were crowded
  // The last weights are those of combinations of covariance functions. Convert them to weights of the functions.
  Eigen::MatrixXd last(smooth.size(), found.weights.cols());
  const Eigen::Index first = found.weights.rows() - last.rows();
  for (Eigen::Index c = 0; c < last.cols(); ++c) std::copy_n(&found.weights(first, c), last.rows(), &last(0, c));
  last = smooth.covariance_weights(last);
  for (Eigen::Index c = 0; c < last.cols(); ++c) std::copy_n(&last(0, c), last.rows(), &found.weights(first, c));
  return {functions_around(centres), std::move(found)};
}

template <error_metric Metric>
std::vector<spectral_spike> reconstruction<Metric>::replace_spikes(sample_set& samples) const {
  if (!rejects_ || !samples.channels().are_wavelengths()) return {};
  const std::vector<Eigen::Index> numbers = counting_positions(samples);
  std::vector<spectral_spike> spikes = detail::find_spikes(
      detail::functions_of(prior_, threads_), [this](const located_samples& some) { return process_of(some); },
      locate_samples(cells(), samples, threads_));
  for (spectral_spike& each : spikes) {
    each.number = numbers[each.number];
    samples.set_value(each.number, each.channel, each.replaced_by);
  }
  return spikes;
}

template <error_metric Metric>
typename reconstruction<Metric>::result_type reconstruction<Metric>::fit(const sample_set& samples) const {
  if (!samples.channels().are_wavelengths()) return fit_readings(samples);
  sample_set right = samples;
  std::vector<spectral_spike> spikes = replace_spikes(right);
  result_type paint = fit_readings(right);
  paint.set_spikes(std::move(spikes));
  return paint;
}

template <error_metric Metric>
typename reconstruction<Metric>::result_type reconstruction<Metric>::fit_readings(const sample_set& samples) const {
  const std::vector<Eigen::Index> numbers = counting_positions(samples);
  const located_samples read = locate_samples(cells(), samples, threads_);
  result_type paint = fit_located(read, numbers);
  // Two rounds lose part of a peak, six make it too bright: docs/decisions/0039-readings-through-apertures.md.
  constexpr int rounds = 3;
  for (int round = 0; round < rounds && samples.have_apertures(); ++round) {
    const Eigen::MatrixXd factors = aperture_factors(samples, numbers, paint.fit());
    located_samples narrowed = read;
    narrowed.values.array() /= factors.array();
    paint = fit_located(std::move(narrowed), numbers);
    paint.set_readings(read);
  }
  return paint;
}

template <error_metric Metric>
Eigen::MatrixXd reconstruction<Metric>::aperture_factors(const sample_set& samples,
                                                         const std::vector<Eigen::Index>& numbers,
                                                         const typename result_type::fit_type& fit) const {
  if (has_process(samples.size()))
    return detail::aperture_factors(
        samples, numbers, [&](const direction& wi, const direction& wo) { return fit.values(wi, wo); }, threads_);
  // With more samples, read a table of the fit.
  if (fit.channels().are_wavelengths()) {
    const spectral_table table = fit.tabulate_spectra(cells(), threads_);
    return detail::aperture_factors(
        samples, numbers,
        [&](const direction& wi, const direction& wo) { return Eigen::ArrayXd(table(wi, wo).template cast<double>()); },
        threads_);
  }
  const brdf_table table = fit.tabulate(cells(), threads_);
  return detail::aperture_factors(
      samples, numbers, [&](const direction& wi, const direction& wo) { return Eigen::ArrayXd(table(wi, wo)); },
      threads_);
}

template <error_metric Metric>
typename reconstruction<Metric>::result_type reconstruction<Metric>::fit_located(
    located_samples samples, std::vector<Eigen::Index> numbers) const {
  channels kinds = samples.kinds;
  const auto colours =
      std::make_shared<const located_samples>(kinds.are_colours() ? std::move(samples) : samples.in_three_channels());
  selection chosen = select(kinds.are_colours() ? *colours : samples, *colours);
  sample_process known = known_by(chosen);
  if (!kinds.are_colours()) {  // keep the samples and the covariance, change the values
    chosen.kept = weighted(map_samples(prior_, samples, threads_), chosen.found);
    if (chosen.process) chosen.process = chosen.process->with_values(chosen.kept.values);
  }
  auto [functions, found] = solve(chosen.kept, chosen.process);
  return {prior_,
          {std::move(functions), std::move(found), std::move(kinds)},
          std::move(known),
          std::move(chosen.found),
          std::move(chosen.all),
          colours,
          std::move(numbers),
          threads_};
}

#if defined(GONIO_COMPILED)
extern template class fitted_brdf<reconstruction<log_relative>::basis_type>;
extern template class reconstruction<log_relative>;
#endif

}  // namespace gonio
