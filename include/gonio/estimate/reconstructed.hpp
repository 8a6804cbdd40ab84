#pragma once
/// A material reconstructed from samples, with the uncertainty of every value: the posterior of a Gaussian process
/// whose mean is the reconstruction (Rasmussen and Williams, "Gaussian Processes for Machine Learning", 2006, Eq.
/// 2.24). docs/results/real-materials.md states how often the intervals contain the measured values of materials whose
/// families are not in the prior.

#include <gonio/basis/discrepancy.hpp>
#include <gonio/basis/joined.hpp>
#include <gonio/basis/pca.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/estimate/inliers.hpp>
#include <gonio/estimate/mirror_envelope.hpp>
#include <gonio/estimate/sample_process.hpp>
#include <gonio/estimate/spectral_spikes.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace gonio {

/// An interval that contains the reflectance with a given probability, sr^-1.
struct reflectance_interval {
  rgb low, high;
};

/// The probabilities for which intervals are offered.
enum class confidence_level { sixty_eight_percent, ninety_five_percent };

/// Returns half the width of an interval in standard deviations of the model: a conformal factor (Lee, Barber and
/// Willett 2023, doi:10.48550/arXiv.2306.06342). The factor is a quantile of reconstruction errors in units of these
/// deviations, for measured materials whose families are not in the prior, and samples in all directions, below some
/// theta_h, in planes, or in images. The interval holds for such materials, averaged over directions. `unknown` is the
/// variance after measuring divided by the variance before. It changes only the 68 % factor, because errors near
/// samples have heavier tails than errors far from all samples. The factor does not depend on the number of samples, so
/// intervals are too wide after thousands of samples all over the hemisphere.
[[nodiscard]] double deviations_of(confidence_level level, double unknown) noexcept;

/// The uncertainty of a reconstruction in a few numbers.
struct certainty {
  /// Half the width of the 68 % interval relative to the value, for a logarithmic metric: the median over all
  /// directions.
  double known_to = 0.0;
  /// The median of `known_to` over the directions whose light or viewer is more than 80 degrees from the normal.
  double known_to_at_grazing = 0.0;
  /// The highlight is known to within this factor with a probability of 95 %: the median over half vectors within 5
  /// degrees of the normal and difference angles up to 70 degrees.
  double highlight_factor = 1.0;
  /// `measured_to` is the largest angle in radians between the normal and the half vector of a kept sample.
  /// `known_to_outside` is the median of `known_to` over directions whose half vector is more than 4 degrees farther
  /// from the normal than `measured_to`. It is 0 if these directions are less than a fifth of all directions.
  double measured_to = 0.0, known_to_outside = 0.0;
};

/// A sample and its prediction from all other samples.
struct sample_residual {
  Eigen::Index number = 0;          ///< its position among the given samples
  rgb measured;                     ///< sr^-1
  rgb predicted;                    ///< sr^-1, from all other samples
  double relative_deviation = 0.0;  ///< combined deviation of prediction and sample, for a logarithmic metric
  double disagreement = 0.0;        ///< `sample_predictions::disagreement`
  bool rejected = false;
};

namespace detail {

/// Summarises half the widths of intervals: `everywhere` has those of the 68 % intervals at `certainty_cells`,
/// `highlight` those of the 95 % intervals at `highlight_angles`.
[[nodiscard]] certainty certainty_of(std::vector<double> everywhere, std::vector<double> highlight, double measured_to);

/// Return the directions at which certainty is evaluated: over the whole hemisphere, and in the highlight.
[[nodiscard]] const valid_cells& certainty_cells();
[[nodiscard]] std::vector<half_difference> highlight_angles();

}  // namespace detail

/// The result of `reconstruction`: a fit in the channels of its samples, its uncertainty, and the samples that
/// disagree. A value type; copies share the data.
template <error_metric Metric>
class reconstructed {
 public:
  using basis_type = joined<pca<Metric>, discrepancy<Metric>>;
  using fit_type = fitted_brdf<basis_type>;

  /// The uncertainty uses at most this many samples, chosen at random, and ignores the others. If these are in all
  /// directions, the stated deviations are too large.
  static constexpr Eigen::Index most_known = 500;

  /// Called by `reconstruction`. `known` is the process of the fitted samples, or of a subset of them. `all` is the
  /// process of all `samples`, if they are few enough. `numbers` are the positions of `samples` in the caller's set.
  reconstructed(pca<Metric> prior, fit_type fit, sample_process known, inliers found, std::optional<sample_process> all,
                std::shared_ptr<const located_samples> samples, std::vector<Eigen::Index> numbers, thread_count threads)
      : prior_(std::move(prior)),
        fit_(std::move(fit)),
        known_(std::move(known)),
        doubting_(known_.with_doubts()),
        scale_(doubting_.scale_of_material()),
        found_(std::move(found)),
        kept_(std::ssize(found_.kept())),
        all_(std::move(all)),
        samples_(std::move(samples)),
        numbers_(std::move(numbers)),
        threads_(threads) {
    for (Eigen::Index& i : found_.rejected) i = number_of(i);
    for (outlying_sample& each : found_.contradicted) each.number = number_of(each.number);
  }

  /// Returns the reflectance in sr^-1 as a colour, at least zero; zero below the horizon. Fills dips in the mirror
  /// direction (`mirror_envelope`): if theta_h is below 8 degrees, evaluates the fit also at each of the prior's rows
  /// from theta_h to 8 degrees.
  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return {0.0, 0.0, 0.0};
    return filled<rgb>(
        located(wi, wo), [&](const location& at) { return fit_.at(at); }, luminance);
  }
  /// Returns the location of two directions on the prior's cells.
  [[nodiscard]] location located(const direction& wi, const direction& wo) const {
    return locate(prior_.cells(), to_half_difference(wi, wo));
  }
  /// Returns the reflectance in each channel of the samples.
  [[nodiscard]] Eigen::ArrayXd values(const direction& wi, const direction& wo) const {
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return fit_.values(wi, wo);
    return filled<Eigen::ArrayXd>(
        located(wi, wo), [&](const location& at) { return fit_.values(at); },
        [&](const Eigen::ArrayXd& values) { return brightness(fit_.channels(), values); });
  }
  /// Tabulates all directions as colours.
  [[nodiscard]] brdf_table tabulate(const valid_cells& cells) const {
    brdf_table table = fit_.tabulate(cells, threads_);
    fill_mirror_dips(table, threads_);
    return table;
  }
  /// Tabulates all directions by wavelength. The samples must have wavelengths.
  [[nodiscard]] spectral_table tabulate_spectra(const valid_cells& cells) const {
    spectral_table table = fit_.tabulate_spectra(cells, threads_);
    fill_mirror_dips(table, fit_.channels(), threads_);
    return table;
  }
  /// Returns the weights, their functions, and the solver's report.
  [[nodiscard]] const fit_type& fit() const noexcept { return fit_; }

  /// Called by `reconstruction`: sets the readings through apertures. `residuals` and `contradicted` then report
  /// readings, not the corrected values that were fitted.
  void set_readings(const located_samples& read) {
    readings_ = read.kinds.are_colours() ? read.values : read.in_three_channels().values;
    for (outlying_sample& each : found_.contradicted) {
      const Eigen::Index i =
          numbers_.empty() ? each.number : std::ranges::find(numbers_, each.number) - numbers_.begin();
      each.predicted *= factor(i);
      each.measured = detail::first_three(readings_, i);
    }
  }
  /// Called by `reconstruction`: sets the values that were replaced before the fit.
  void set_spikes(std::vector<spectral_spike> spikes) { spikes_ = std::move(spikes); }

  // ---- uncertainty ----

  /// Returns the standard deviation of a value in the metric's domain. If the metric is a logarithm, the deviation is
  /// relative to the value. O(n (n + k)) for n samples, at most `most_known`, and k components.
  [[nodiscard]] double deviation(const location& at) const {
    return std::sqrt(scale_) * doubting_.deviations(locate_rows(prior_, {&at, 1}))[0];
  }
  /// Returns the deviation for two directions above the horizon.
  [[nodiscard]] double deviation(const direction& wi, const direction& wo) const { return deviation(located(wi, wo)); }

  /// Returns half the width of an interval in the metric's domain.
  [[nodiscard]] double half_width(const location& at, confidence_level level) const {
    return half_widths({&at, 1}, level)[0];
  }
  /// Returns half the widths of the intervals at p locations. O(p n (n + k)), in a fifth of the time of p single
  /// calls.
  [[nodiscard]] std::vector<double> half_widths(std::span<const location> locations, confidence_level level) const {
    std::vector<double> all(locations.size());
    for_each_block(
        std::ssize(locations), 64,
        [&](block range) {
          const located_rows others = locate_rows(prior_, locations.subspan(range.begin, range.size()));
          const Eigen::VectorXd before = doubting_.deviations_before(others), after = doubting_.deviations(others);
          for (Eigen::Index i = 0; i < range.size(); ++i) {
            const double unknown = after[i] / before[i];
            all[range.begin + i] = deviations_of(level, unknown * unknown) * std::sqrt(scale_) * after[i];
          }
        },
        threads_);
    return all;
  }

  /// Returns the interval around a value at a location, for each channel separately; never below zero.
  [[nodiscard]] reflectance_interval interval(const rgb& value, const location& at, confidence_level level) const {
    return interval(value, at, half_width(at, level));
  }
  /// Returns the same for one of the `half_widths`.
  [[nodiscard]] reflectance_interval interval(const rgb& value, const location& at, double half_width) const {
    const auto moved = [&](double by) {
      rgb other;
      for (Eigen::Index c = 0; c < 3; ++c)
        other[c] = reflectance_of(prior_.metric(), prior_.metric().forward(value[c], at) + by, at);
      return other;
    };
    return {moved(-half_width), moved(half_width)};
  }
  /// Returns the interval around the value for two directions above the horizon.
  [[nodiscard]] reflectance_interval interval(const direction& wi, const direction& wo, confidence_level level) const {
    return interval((*this)(wi, wo), located(wi, wo), level);
  }

  /// Returns half the width of the 68 % interval relative to the value, if the metric is a logarithm.
  [[nodiscard]] double known_to(const location& at) const {
    return std::expm1(half_width(at, confidence_level::sixty_eight_percent));
  }
  /// Returns `known_to` for two directions above the horizon.
  [[nodiscard]] double known_to(const direction& wi, const direction& wo) const { return known_to(located(wi, wo)); }
  /// Returns `known_to` for all given cells. A coarse grid is enough, because the uncertainty is smooth.
  [[nodiscard]] std::vector<double> known_to(const valid_cells& cells) const {
    std::vector<double> all = half_widths_at(cells);
    for (double& each : all) each = std::expm1(each);
    return all;
  }

  /// Returns the uncertainty in a few numbers. Computes 1,440 intervals.
  [[nodiscard]] gonio::certainty certainty() const {
    std::vector<location> lobe;
    for (const half_difference& angles : detail::highlight_angles()) lobe.push_back(locate(prior_.cells(), angles));
    double measured_to = 0.0;
    for (const Eigen::Index i : found_.kept())
      measured_to = std::max(measured_to, samples_->locations[i].angles.theta_h);
    return detail::certainty_of(half_widths_at(detail::certainty_cells()),
                                half_widths(lobe, confidence_level::ninety_five_percent), measured_to);
  }

  /// Returns how well the materials of the prior explain the samples.
  [[nodiscard]] gonio::familiarity familiarity() const { return known_.familiarity(); }

  // ---- samples ----

  /// Returns the inlier weight, from 0 to 1, of each sample of positive weight.
  [[nodiscard]] const Eigen::VectorXd& inlier_weights() const noexcept { return found_.weights; }
  /// Returns the positions of the samples that are probably wrong, the worst first.
  [[nodiscard]] const std::vector<Eigen::Index>& rejected() const noexcept { return found_.rejected; }
  /// Returns the samples that all other samples contradict, the worst first; see `inliers`.
  [[nodiscard]] const std::vector<outlying_sample>& contradicted() const noexcept { return found_.contradicted; }
  /// Returns the values of spectra that were replaced before the fit, the most certainly wrong first.
  [[nodiscard]] const std::vector<spectral_spike>& spikes() const noexcept { return spikes_; }
  /// Returns the mean probability that a sample is wrong.
  [[nodiscard]] double outlier_share() const noexcept { return found_.outlier_share; }
  /// Returns the number of samples whose inlier weight is at least 0.01.
  [[nodiscard]] Eigen::Index kept() const noexcept { return kept_; }

  /// Returns each sample of positive weight, with its prediction from all other samples. Rejected samples are included.
  /// O(n^3) for n samples. Throws gonio::error for more than `discrepancy_model::most_centres` samples.
  [[nodiscard]] std::vector<sample_residual> residuals() const {
    if (!all_)
      refuse({"residuals can be computed for at most ", known_.expected().model.most_centres, " samples, not ",
              samples_->size()});
    const sample_predictions others = all_->predicted_without();
    const Eigen::VectorXd disagreement = others.disagreement();
    std::vector<Eigen::Index> rejected = found_.rejected;
    std::ranges::sort(rejected);
    std::vector<sample_residual> told;
    for (Eigen::Index i = 0; i < samples_->size(); ++i) {
      const location& at = samples_->locations[i];
      const double offset = offset_at(prior_, at);
      sample_residual each{.number = number_of(i),
                           .measured = detail::first_three(readings_.size() > 0 ? readings_ : samples_->values, i),
                           .predicted = rgb::Zero(),
                           .relative_deviation = std::expm1(others.deviation[i]),
                           .disagreement = disagreement[i],
                           .rejected = std::ranges::binary_search(rejected, number_of(i))};
      for (Eigen::Index c = 0; c < 3; ++c)
        each.predicted[c] = reflectance_of(prior_.metric(), others.mean(i, c) + offset, at);
      if (readings_.size() > 0) each.predicted *= factor(i);
      told.push_back(each);
    }
    return told;
  }

 private:
  /// Returns half the widths of the 68 % intervals at some cells.
  [[nodiscard]] std::vector<double> half_widths_at(const valid_cells& cells) const {
    std::vector<location> locations;
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell)
      locations.push_back(locate(prior_.cells(), cells.angles(cell)));
    return half_widths(locations, confidence_level::sixty_eight_percent);
  }
  /// Returns a value of the fit. If it is in a dip at the mirror direction, raises it by the values at the prior's rows
  /// of larger theta_h.
  template <class Value, class Evaluate, class Brightness>
  [[nodiscard]] Value filled(const location& at, Evaluate&& evaluate, Brightness&& brightness_of) const {
    const Value own = evaluate(at);
    if (!mirror_envelope<Value>::reaches(at.angles)) return own;
    mirror_envelope<Value> envelope(at.angles.theta_d);
    const grid& rows = prior_.cells().grid();
    for (auto row = static_cast<int>(rows.theta_h_coordinate(mirror_envelope<Value>::theta_h)); row >= 0; --row) {
      half_difference farther = at.angles;
      farther.theta_h = rows.theta_h(row);
      if (farther.theta_h <= at.angles.theta_h) break;
      const Value value = evaluate(locate(prior_.cells(), farther));
      static_cast<void>(envelope.next(value, brightness_of(value)));
    }
    return envelope.next(own, brightness_of(own));
  }
  /// Returns the ratio of a reading through an aperture to the value in a single direction.
  [[nodiscard]] rgb factor(Eigen::Index i) const {
    const rgb read = detail::first_three(readings_, i), narrowed = detail::first_three(samples_->values, i);
    return (narrowed == 0.0).select(1.0, read / narrowed);
  }
  [[nodiscard]] Eigen::Index number_of(Eigen::Index i) const { return numbers_.empty() ? i : numbers_[i]; }

  pca<Metric> prior_;
  fit_type fit_;
  sample_process known_, doubting_;
  double scale_;
  inliers found_;
  Eigen::Index kept_;
  std::optional<sample_process> all_;
  std::shared_ptr<const located_samples> samples_;
  std::vector<Eigen::Index> numbers_;
  thread_count threads_;
  std::vector<spectral_spike> spikes_ = {};
  Eigen::MatrixXd readings_ = {};  ///< n x 3, if samples were read through apertures
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/estimate/impl/reconstructed.ipp>
#endif
