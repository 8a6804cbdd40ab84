#pragma once
/// Bodies of estimate/spectral_spikes.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/random.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/core/vector_kernels.hpp>
#include <gonio/estimate/spectral_spikes.hpp>
#include <gonio/solve/product.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <span>
#include <utility>
#include <vector>

namespace gonio::detail {

/// Assumptions about the errors of single values, in the squared units of the metric (natural logarithms). Chosen on
/// Cornell's paints, on materials of the RGL database as smooth spectra, and on synthetic lines and fringes.
struct spike_rule {
  Eigen::Index neighbours = 5;  ///< on each side of a wavelength
  double expected_number = 0.2, penalty = 3.0;
  double error_variance = 2.9;  ///< of a wrong value
  /// The expected scale of the variances of right differences, relative to the samples' process, and its weight as a
  /// number of samples.
  double scale = 0.01, known_before = 10.0;
  double noise = 0.01;  ///< of each value, relative to this value, and relative to the median of its spectrum
};

/// Searches the spectra of samples for values that contradict the others.
class spike_search {
 public:
  spike_search(const prior_functions& prior, const sample_process& process, const located_samples& samples)
      : prior_(prior),
        inverse_(process.inverse()),
        samples_(samples),
        differences_(samples.size(), wavelengths()),
        noise_variances_(samples.size(), wavelengths()),
        outside_(samples.size(), wavelengths()),
        log_odds_(samples.size(), wavelengths()),
        squares_(wavelengths()),
        usual_(wavelengths()),
        variances_(samples.size()) {
    for (Eigen::Index i = 0; i < samples.size(); ++i) compare_with_neighbours(i);
    dual_ = product(inverse_, differences_);
    for (Eigen::Index c = 0; c < wavelengths(); ++c) {
      squares_[c] = dot(&dual_(0, c), &differences_(0, c), samples.size());
      judge_wavelength(c);
    }
  }

  /// Replaces the worst value, then searches again, until no value is probably wrong or a tenth is replaced.
  [[nodiscard]] std::vector<spectral_spike> replace_all() {
    std::vector<spectral_spike> found;
    while (std::ssize(found) < log_odds_.size() / 10) {
      const auto worst = std::max_element(log_odds_.data(), log_odds_.data() + log_odds_.size()) - log_odds_.data();
      const auto k = static_cast<double>(found.size());
      const double odds = log_odds_.data()[worst] - rule_.penalty +
                          std::log((rule_.expected_number + k) / (static_cast<double>(log_odds_.size()) - k));
      if (!(odds > 0.0)) break;
      const Eigen::Index i = worst % samples_.size(), c = worst / samples_.size();
      const double measured = samples_.values(i, c);
      replace(i, c);
      found.push_back({i, c, measured, samples_.values(i, c), 1.0 / (1.0 + std::exp(-odds))});
    }
    return found;
  }

 private:
  [[nodiscard]] Eigen::Index wavelengths() const noexcept { return samples_.values.cols(); }
  [[nodiscard]] std::pair<Eigen::Index, Eigen::Index> around(Eigen::Index c) const noexcept {
    return {std::max<Eigen::Index>(c - rule_.neighbours, 0), std::min(c + rule_.neighbours + 1, wavelengths())};
  }

  /// Computes a sample's differences from the medians of neighbouring wavelengths, the variances of their noise, and
  /// how far each value is outside of the range between the medians on either side.
  void compare_with_neighbours(Eigen::Index i) {
    located_samples mapped = samples_.subset({i}), smooth = mapped, brighter = mapped, lower = mapped, upper = mapped;
    const std::vector<double> spectrum(mapped.values.data(), mapped.values.data() + wavelengths());
    const double noise = rule_.noise * std::max(median(std::vector(spectrum)), 0.0);
    for (Eigen::Index c = 0; c < wavelengths(); ++c) {
      const auto [first, end] = around(c);
      std::vector<double> before(spectrum.begin() + first, spectrum.begin() + c),
          after(spectrum.begin() + c + 1, spectrum.begin() + end), both = before;
      both.insert(both.end(), after.begin(), after.end());
      smooth.values(0, c) = median(both);
      brighter.values(0, c) = std::max(smooth.values(0, c), 0.0) + noise;
      const double below = before.empty() ? smooth.values(0, c) : median(before),
                   above = after.empty() ? smooth.values(0, c) : median(after);
      lower.values(0, c) = std::min(below, above);
      upper.values(0, c) = std::max(below, above);
    }
    for (located_samples* each : {&mapped, &smooth, &brighter, &lower, &upper}) *each = prior_.map(*each);
    std::vector<double> sizes;
    for (Eigen::Index c = 0; c < wavelengths(); ++c) {
      const double value = mapped.values(0, c);
      differences_(i, c) = value - smooth.values(0, c);
      noise_variances_(i, c) = rule_.noise * rule_.noise + std::pow(brighter.values(0, c) - smooth.values(0, c), 2);
      outside_(i, c) = value - std::clamp(value, lower.values(0, c), upper.values(0, c));
      sizes.push_back(std::abs(differences_(i, c)));
    }
    variances_[i] = std::pow(deviation_by_median * median(sizes), 2);
  }

  /// Returns the difference of a value minus its prediction from the same wavelength of all other samples.
  [[nodiscard]] double residual(Eigen::Index i, Eigen::Index c) const { return dual_(i, c) / inverse_(i, i); }

  /// Compares two densities of a value: that of a wrong value and that of a right value. Both are Student's t, because
  /// the scale of the right differences is unknown.
  void judge(Eigen::Index i, Eigen::Index c) {
    const double degrees = rule_.known_before + static_cast<double>(samples_.size() - 1),
                 others = std::max(squares_[c] - dual_(i, c) * residual(i, c), 0.0),
                 scale = (rule_.known_before * rule_.scale + std::min(others, usual_[c])) / degrees,
                 right = scale / inverse_(i, i) + variances_[i] + noise_variances_(i, c),
                 wrong = right + rule_.error_variance;
    // A spike also stands out from its own spectrum; a slope steeper than those of the other samples does not.
    const bool stands_out = residual(i, c) * outside_(i, c) > 0.0;
    const double off = stands_out ? std::min(std::abs(residual(i, c)), std::abs(outside_(i, c))) : 0.0,
                 square = off * off / degrees;
    log_odds_(i, c) =
        0.5 * ((degrees + 1.0) * (std::log1p(square / right) - std::log1p(square / wrong)) - std::log(wrong / right));
  }
  void judge_wavelength(Eigen::Index c) {
    // Other wrong values of this wavelength increase the sum of squares, but hardly the median.
    std::vector<double> residuals;
    for (Eigen::Index i = 0; i < samples_.size(); ++i)
      residuals.push_back(std::abs(dual_(i, c)) / std::sqrt(inverse_(i, i)));
    usual_[c] = static_cast<double>(samples_.size() - 1) * std::pow(deviation_by_median * median(residuals), 2);
    for (Eigen::Index i = 0; i < samples_.size(); ++i) judge(i, c);
  }

  /// Replaces a value by the one that its neighbours and the other samples predict.
  void replace(Eigen::Index i, Eigen::Index c) {
    Eigen::MatrixXd value(1, 1);
    value(0, 0) = prior_.map(samples_.subset({i})).values(0, c) - residual(i, c);
    prior_.invert(std::span(samples_.locations).subspan(i, 1), value);
    samples_.values(i, c) = value(0, 0);

    const auto [first, end] = around(c);
    std::vector<double> before;
    for (Eigen::Index k = first; k < end; ++k) before.push_back(differences_(i, k));
    compare_with_neighbours(i);
    for (Eigen::Index k = first; k < end; ++k) {
      const double change = differences_(i, k) - before[k - first];
      squares_[k] += change * (2.0 * dual_(i, k) + change * inverse_(i, i));
      add_scaled(change, &inverse_(0, i), &dual_(0, k), samples_.size());
      judge_wavelength(k);
    }
    for (Eigen::Index k = 0; k < wavelengths(); ++k) judge(i, k);
  }

  spike_rule rule_;
  const prior_functions& prior_;
  const Eigen::MatrixXd& inverse_;
  located_samples samples_;
  // Samples x wavelengths, in the metric's domain: differences y from the neighbours, the variances of their noise, by
  // how much a value is outside of the range of its neighbours, K^-1 y, and the logarithms of the odds that the values
  // are wrong.
  Eigen::MatrixXd differences_, noise_variances_, outside_, dual_, log_odds_;
  // For each wavelength: y' K^-1 y, and its estimate from the median of the samples' residuals.
  Eigen::VectorXd squares_, usual_;
  Eigen::VectorXd variances_;  ///< of each sample's differences
};

GONIO_INLINE std::vector<spectral_spike> find_spikes(
    const prior_functions& prior, const std::function<sample_process(const located_samples&)>& process_of,
    const located_samples& samples) {
  const Eigen::Index n = samples.size(), groups = (n + most_judged - 1) / most_judged;
  if (n < 3 || samples.values.cols() < fewest_wavelengths_of_spikes) return {};
  // Divide the samples into random groups.
  std::mt19937_64 generator(0);
  std::vector<std::pair<double, Eigen::Index>> keyed;
  for (Eigen::Index i = 0; i < n; ++i) keyed.emplace_back(groups > 1 ? uniform_number(generator) : 0.0, i);
  const std::vector<Eigen::Index> order = in_order(std::move(keyed));
  std::vector<spectral_spike> found;
  keyed.clear();
  for (Eigen::Index group = 0; group < groups; ++group) {
    const std::vector<Eigen::Index> positions(order.begin() + group * n / groups,
                                              order.begin() + (group + 1) * n / groups);
    const located_samples some = samples.subset(positions);
    const sample_process process = process_of(some);
    for (spectral_spike each : spike_search(prior, process, some).replace_all()) {
      each.number = positions[each.number];
      keyed.emplace_back(-each.probability, std::ssize(found));
      found.push_back(each);
    }
  }
  std::vector<spectral_spike> sorted;
  for (const Eigen::Index k : in_order(std::move(keyed))) sorted.push_back(found[k]);
  return sorted;
}

}  // namespace gonio::detail
