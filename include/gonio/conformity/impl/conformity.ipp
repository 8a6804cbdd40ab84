#pragma once
/// Bodies of conformity/conformity.hpp.

#include <gonio/conformity/conformity.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/probability.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/product.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

namespace gonio::detail {

GONIO_INLINE void require_possible(const conformity_options& options, Eigen::Index channels) {
  for (const measurement_noise& noise : {options.part, options.reference})
    if (!(noise.relative >= 0.0 && noise.relative <= 0.3) || !(noise.dark >= 0.0 && std::isfinite(noise.dark)))
      refuse({"relative noise must be from 0 to 0.3, and dark noise finite and not negative, not ", noise.relative,
              " and ", noise.dark});
  if (options.part.relative == 0.0 && options.part.dark == 0.0)
    refuse("the noise of the part's measurement must be above 0");
  if (!(options.part.degrees_of_freedom > 0.0) || !(options.reference.degrees_of_freedom > 0.0))
    refuse("estimated noise needs degrees of freedom above 0");
  if (options.tolerance.size() != 1 && std::ssize(options.tolerance) != channels)
    refuse({"expected one tolerance, or one for each of ", channels, " channels, not ", options.tolerance.size()});
  std::vector<double> tolerances = options.tolerance;
  tolerances.push_back(options.peak_tolerance.value_or(0.0));
  tolerances.push_back(options.delta_e);
  for (const double tolerance : tolerances)
    if (!(tolerance >= 0.0 && std::isfinite(tolerance)))
      refuse({"a tolerance must be finite and not negative, not ", tolerance});
  if (options.delta_e > 0.0 && (options.peak_tolerance || std::ranges::max(options.tolerance) > 0.0))
    refuse("a Delta E tolerance cannot be combined with a relative tolerance");
  if (!(options.same_direction >= 0.0 && options.same_direction <= 0.1))
    refuse({"the tolerance of equal directions must be from 0 to 0.1 radians, not ", options.same_direction});
}

GONIO_INLINE double tolerance_of(const conformity_options& options, Eigen::Index channel, const location& at) {
  constexpr double peak = radians(5.0);
  if (options.peak_tolerance && at.angles.theta_h < peak) return *options.peak_tolerance;
  return options.tolerance.size() == 1 ? options.tolerance.front() : options.tolerance[channel];
}

GONIO_INLINE double delta_e_of(const rgb& one, const rgb& other) {
  return std::sqrt(
      (to_unclipped_lab(std::numbers::pi * one) - to_unclipped_lab(std::numbers::pi * other)).square().sum());
}

GONIO_INLINE Eigen::Index distinct_channels(const Eigen::MatrixXd& values) {
  for (Eigen::Index c = 1; c < values.cols(); ++c)
    if (values.col(c) != values.col(0)) return values.cols();
  return std::min<Eigen::Index>(values.cols(), 1);
}

GONIO_INLINE located_samples both_of(const located_samples& part, const located_samples& reference) {
  constexpr Eigen::Index most_of_part = 2500, most = 6000, most_values = 7500;
  const Eigen::Index n = part.size(), all = n + reference.size();
  if (n == 0 || n == all) refuse("a part and a reference need at least one sample each");
  if (n > most_of_part) refuse({"a part can have at most ", most_of_part, " directions, not ", n});
  if (all > most) refuse({"part and reference can have at most ", most, " samples together, not ", all});
  if (part.values.cols() != reference.values.cols())
    refuse({"the part has ", part.values.cols(), " channels, but the reference has ", reference.values.cols()});
  located_samples both{part.locations, Eigen::MatrixXd(all, part.values.cols()), Eigen::MatrixXd::Ones(all, 1)};
  both.locations.insert(both.locations.end(), reference.locations.begin(), reference.locations.end());
  both.values.topRows(n) = part.values;
  both.values.bottomRows(all - n) = reference.values;
  both.values.conservativeResize(Eigen::NoChange, distinct_channels(both.values));
  if (n * both.values.cols() > most_values)
    refuse({"a part can have at most ", most_values, " values, not ", n, " directions of ", both.values.cols(),
            " channels"});
  return both;
}

GONIO_INLINE std::vector<turned_pair> pairs_of(const std::vector<location>& locations) {
  std::vector<turned_pair> pairs;
  for (const location& at : locations) pairs.emplace_back(to_directions(at.angles));
  return pairs;
}

GONIO_INLINE std::vector<Eigen::Index> same_directions(const std::vector<turned_pair>& pairs, Eigen::Index position,
                                                       double limit) {
  const turned_pair here = pairs[position], swapped = here.swapped();
  std::vector<Eigen::Index> same;
  for (Eigen::Index i = 0; i < std::ssize(pairs); ++i)
    if (pairs[i].agrees(here, limit) || pairs[i].agrees(swapped, limit)) same.push_back(i);
  return same;
}

/// For each sample, the positions of others.
using positions_of_samples = std::vector<std::vector<Eigen::Index>>;

/// If the reference's samples in one direction differ by more than their noise explains, adds the rest to the noise of
/// all samples in this direction: an instrument may read other values after light and viewer are swapped. Up to the
/// 99.9 % quantile of their variance, all of it counts as explained.
GONIO_INLINE void add_contradictions(const positions_of_samples& references_of, conformity_samples& samples) {
  const Eigen::MatrixXd noise = samples.noise;
  for (Eigen::Index j = 0; j < samples.mapped.rows(); ++j) {
    const std::vector<Eigen::Index>& references = references_of[j];
    if (references.size() < 2) continue;
    const auto count = static_cast<double>(references.size());
    const double explained = chi_square_quantile(0.999, count - 1.0) / (count - 1.0);
    for (Eigen::Index c = 0; c < noise.cols(); ++c) {
      double mean = 0.0, squares = 0.0, of_noise = 0.0;
      for (const Eigen::Index i : references) mean += samples.mapped(i, c) / count;
      for (const Eigen::Index i : references) {
        squares += (samples.mapped(i, c) - mean) * (samples.mapped(i, c) - mean) / (count - 1.0);
        of_noise += noise(i, c) / count;
      }
      samples.noise(j, c) += std::max(squares - explained * of_noise, 0.0);
    }
  }
}

/// The differences between part and reference are the product of `rows`, n x N, with the mapped values of all N
/// samples. `shared` has the number of the reference's samples in each of the part's n directions.
struct difference_operator {
  Eigen::MatrixXd rows;
  std::vector<Eigen::Index> shared;
  Eigen::MatrixXd channels;  ///< covariance of the channels, relative to the model's variance of one channel
  bool predicts = false;
};

/// Returns the covariance of the reference's channels, relative to the model's variance of one channel. The prior
/// assumption, a correlation of 0.9, is typical of most materials and counts as ten measurements, as in
/// `sample_process`.
[[nodiscard]] inline Eigen::MatrixXd channel_covariance(const Eigen::MatrixXd& whitened) {
  constexpr double before = sample_process::known_before, correlation = 0.9;
  Eigen::MatrixXd known = Eigen::MatrixXd::Constant(whitened.cols(), whitened.cols(), correlation);
  known.diagonal().setOnes();
  return (before * known + product(whitened.transpose(), whitened)) / (before + static_cast<double>(whitened.rows()));
}

/// Returns the differences of the part from the reference. In each direction, the reference is the mean of its
/// measurements in this direction or, if there are none, its prediction.
[[nodiscard]] inline difference_operator differences(const positions_of_samples& references_of,
                                                     const conformity_samples& samples) {
  const Eigen::Index n = samples.parts, all = samples.mapped.rows(), r = all - n;
  const Eigen::Index channels = samples.mapped.cols();
  difference_operator found{Eigen::MatrixXd::Zero(n, all), std::vector<Eigen::Index>(n),
                            Eigen::MatrixXd::Identity(channels, channels)};
  for (Eigen::Index i = 0; i < n; ++i) {
    found.rows(i, i) = 1.0;
    found.shared[i] = std::ssize(references_of[i]);
    for (const Eigen::Index j : references_of[i]) found.rows(i, j) = -1.0 / static_cast<double>(found.shared[i]);
    found.predicts = found.predicts || found.shared[i] == 0;
  }
  if (!found.predicts) return found;

  // Predict from the whole reference. Assume at least 0.1 % noise, so that the covariance stays invertible if
  // directions are repeated.
  Eigen::MatrixXd among = samples.covariance.bottomRightCorner(r, r);
  among.diagonal() += samples.noise.bottomRows(r).rowwise().mean().cwiseMax(1e-6);
  const cholesky factors(among);
  if (!factors.positive_definite()) refuse("the covariance of the reference is not positive definite");
  found.channels = channel_covariance(factors.solve_lower(samples.mapped.bottomRows(r)));
  const Eigen::MatrixXd weights = factors.solve(samples.covariance.bottomLeftCorner(r, n));
  for (Eigen::Index i = 0; i < n; ++i)
    if (found.shared[i] == 0) found.rows.row(i).tail(r) = -weights.col(i).transpose();
  return found;
}

/// Returns the covariance of all differences, with the channels of a direction adjacent: n c x n c.
[[nodiscard]] inline Eigen::MatrixXd covariance_of(const difference_operator& by, const conformity_samples& samples) {
  const Eigen::Index n = samples.parts, channels = samples.mapped.cols();
  const Eigen::MatrixXd model = by.predicts ? product(product(by.rows, samples.covariance), by.rows.transpose())
                                            : Eigen::MatrixXd(Eigen::MatrixXd::Zero(n, n));
  Eigen::MatrixXd all(channels * n, channels * n);
  for (Eigen::Index c = 0; c < channels; ++c) {
    const Eigen::MatrixXd scaled = by.rows * samples.noise.col(c).asDiagonal();
    const Eigen::MatrixXd noise = product(scaled, by.rows.transpose());
    for (Eigen::Index d = 0; d < channels; ++d)
      for (Eigen::Index j = 0; j < n; ++j)
        for (Eigen::Index i = 0; i < n; ++i)
          all(channels * i + c, channels * j + d) = by.channels(c, d) * model(i, j) + (c == d ? noise(i, j) : 0.0);
  }
  return all;
}

/// Returns the inverse by the adjugate. Eigen's inverse needs its LU module, which would slow down every includer.
[[nodiscard]] inline Eigen::Matrix3d inverse_of(const Eigen::Matrix3d& m) {
  Eigen::Matrix3d inverse;
  for (Eigen::Index i = 0; i < 3; ++i)
    for (Eigen::Index j = 0; j < 3; ++j) {
      const Eigen::Index a = (j + 1) % 3, b = (j + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
      inverse(i, j) = m(a, c) * m(b, d) - m(a, d) * m(b, c);
    }
  return inverse / m.row(0).dot(inverse.col(0));
}

GONIO_INLINE double least_within(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& residuals,
                                 const Eigen::VectorXd& tolerance) {
  Eigen::VectorXd gradient = product(matrix, residuals), left = residuals;
  if (tolerance.maxCoeff() == 0.0) return left.dot(gradient);
  constexpr int most_sweeps = 2000;
  double movement = 1.0;
  for (int sweep = 0; sweep < most_sweeps && movement > 1e-9 * tolerance.maxCoeff(); ++sweep) {
    movement = 0.0;
    for (Eigen::Index j = 0; j < left.size(); ++j) {
      if (!(matrix(j, j) > 0.0)) continue;
      const double before = residuals[j] - left[j];
      const double step = std::clamp(before + gradient[j] / matrix(j, j), -tolerance[j], tolerance[j]) - before;
      if (step == 0.0) continue;
      left[j] -= step;
      gradient -= step * matrix.col(j);
      movement = std::max(movement, std::abs(step));
    }
  }
  return std::max(left.dot(gradient), 0.0);
}

GONIO_INLINE double least_within(const Eigen::Matrix3d& matrix, const Eigen::Vector3d& residuals,
                                 const Eigen::Matrix3d& jacobian, double length) {
  // With u = J x, minimise (s - u)' A (s - u) for |u| <= length: the minimum satisfies (A + m I) u = A s.
  const Eigen::Matrix3d inverse = inverse_of(jacobian);
  const Eigen::Matrix3d a = inverse.transpose() * matrix * inverse;
  const Eigen::Vector3d s = jacobian * residuals, as = a * s;
  if (s.norm() <= length) return 0.0;
  const auto at = [&](double multiplier) -> Eigen::Vector3d {
    return inverse_of(a + multiplier * Eigen::Matrix3d::Identity()) * as;
  };
  double low = 0.0, high = as.norm() / length;  // |u| <= |A s| / m
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (at(middle).norm() > length ? low : high) = middle;
  }
  const Eigen::Vector3d left = s - at(high);
  return left.dot(a * left);
}

/// Holm's step-down adjustment: S. Holm, "A simple sequentially rejective multiple test procedure", Scandinavian
/// Journal of Statistics 6, 1979.
inline void adjust(std::vector<compared_direction>& directions) {
  std::vector<Eigen::Index> order(directions.size());
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::ranges::sort(order, {}, [&](Eigen::Index i) { return std::pair(directions[i].p_value, i); });
  double least = 0.0;
  for (Eigen::Index k = 0; k < std::ssize(order); ++k) {
    compared_direction& each = directions[order[k]];
    least = std::max(least, std::min(each.p_value * static_cast<double>(std::ssize(order) - k), 1.0));
    each.adjusted_p_value = least;
  }
}

[[nodiscard]] inline Eigen::MatrixXd precision_of(const Eigen::MatrixXd& covariance) {
  const cholesky factors(covariance);
  if (!factors.positive_definite()) refuse("the covariance of part and reference is not positive definite");
  return factors.inverse();
}

/// The differences of all directions with their covariance and tolerance. The c channels of a direction are adjacent: n
/// c rows.
struct stacked_differences {
  Eigen::Index channels;  ///< c
  Eigen::VectorXd residuals;
  Eigen::MatrixXd covariance;
  Eigen::VectorXd tolerance;

  [[nodiscard]] stacked_differences subset(const std::vector<Eigen::Index>& directions) const {
    std::vector<Eigen::Index> rows;
    for (const Eigen::Index i : directions)
      for (Eigen::Index c = 0; c < channels; ++c) rows.push_back(channels * i + c);
    return {channels, residuals(rows), covariance(rows, rows), tolerance(rows)};
  }
};

/// The degrees of freedom of the covariance of differences. Those for predictions were chosen on measured materials
/// whose families are not in the prior. The errors of predictions have heavier tails than a normal distribution, and
/// heavier still if the reference has few samples r. See docs/results/conformity.md.
struct freedoms {
  double measured, shift, total, direction;

  freedoms(double noise, Eigen::Index r, bool predicts) : measured(noise), shift(noise), total(noise) {
    const auto samples = static_cast<double>(r);
    direction = std::min({noise, std::sqrt(samples), 4.0});
    if (!predicts) return;
    shift = std::min(noise, samples / 3.0);
    total = std::min(noise, std::sqrt(samples));
  }
};

/// Returns the upper tail of a sum of `count` squared normal variables whose variance is known to `freedom` degrees of
/// freedom.
[[nodiscard]] inline double tail_of(double squares, double count, double freedom) {
  return f_tail(squares / count, count, freedom);
}

/// Tests all differences together, and then, by generalised least squares, a shift of each channel that is the same in
/// all directions.
inline void test_together(const stacked_differences& all, const freedoms& known, conformity& found) {
  const Eigen::MatrixXd precision = precision_of(all.covariance);
  found.total_p_value = tail_of(least_within(precision, all.residuals, all.tolerance),
                                static_cast<double>(all.residuals.size()), known.total);
  const Eigen::MatrixXd alike =
      Eigen::MatrixXd::Identity(all.channels, all.channels).replicate(all.residuals.size() / all.channels, 1);
  const Eigen::MatrixXd weights = product(precision, alike);
  const Eigen::MatrixXd shift_covariance = precision_of(product(alike.transpose(), weights));
  const Eigen::MatrixXd shift_by = product(shift_covariance, weights.transpose());
  found.shift = (shift_by * all.residuals).array();
  found.shift_p_value = tail_of(least_within(product(weights, shift_by), all.residuals, all.tolerance),
                                static_cast<double>(all.channels), known.shift);
}

/// Tests each direction alone, and sets `worst_p_value`. `lab_by_mapped` has a matrix for each direction, or is empty.
inline void test_apart(const stacked_differences& all, const std::vector<Eigen::Index>& shared, const freedoms& known,
                       const std::vector<Eigen::Matrix3d>& lab_by_mapped, double delta_e, conformity& found) {
  for (Eigen::Index i = 0; i < std::ssize(shared); ++i) {
    const auto [channels, residuals, covariance, tolerance] = all.subset({i});
    const Eigen::MatrixXd precision = precision_of(covariance);
    compared_direction each{.number = i,
                            .measured = shared[i],
                            .value = {},
                            .expected = {},
                            .difference = residuals.array(),
                            .deviation = covariance.diagonal().array().sqrt()};
    const double squares = lab_by_mapped.empty() ? least_within(precision, residuals, tolerance)
                                                 : least_within(Eigen::Matrix3d(precision), Eigen::Vector3d(residuals),
                                                                lab_by_mapped[static_cast<std::size_t>(i)], delta_e);
    each.p_value = tail_of(squares, static_cast<double>(channels), shared[i] > 0 ? known.measured : known.direction);
    found.directions.push_back(each);
  }
  adjust(found.directions);
  found.worst_p_value = found.directions[found.worst()].adjusted_p_value;
}

GONIO_INLINE conformity compare_samples(conformity_samples samples, const conformity_options& options) {
  // The model's independent error is the same in all measurements of one direction.
  const Eigen::Index n = samples.parts, all = samples.mapped.rows(), channels = samples.mapped.cols();
  positions_of_samples references_of;
  for (Eigen::Index i = 0; i < all; ++i) {
    std::vector<Eigen::Index> same = same_directions(samples.pairs, i, options.same_direction);
    for (const Eigen::Index j : same)
      if (i != j) samples.covariance(i, j) += samples.independent;
    std::erase_if(same, [&](Eigen::Index j) { return j < n; });
    references_of.push_back(std::move(same));
  }
  add_contradictions(references_of, samples);

  const difference_operator by = differences(references_of, samples);
  const Eigen::MatrixXd residuals = product(by.rows, samples.mapped);
  stacked_differences stacked{channels, Eigen::VectorXd(channels * n), covariance_of(by, samples),
                              Eigen::VectorXd(channels * n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    stacked.residuals.segment(channels * i, channels) = residuals.row(i).transpose();
    stacked.tolerance.segment(channels * i, channels) = samples.tolerance.row(i).transpose();
  }

  // Test the directions in which both were measured together, because their differences are noise alone. If there are
  // none, test all directions.
  std::vector<Eigen::Index> together;
  for (Eigen::Index i = 0; i < n; ++i)
    if (by.shared[i] > 0) together.push_back(i);
  const bool predicts = together.empty();
  if (predicts)
    for (Eigen::Index i = 0; i < n; ++i) together.push_back(i);
  const double noise = std::min(options.part.degrees_of_freedom, options.reference.degrees_of_freedom);
  const freedoms known(noise, all - n, predicts);
  conformity found;
  test_together(stacked.subset(together), known, found);
  test_apart(stacked, by.shared, known, samples.lab_by_mapped, options.delta_e, found);
  const double least = std::min({found.shift_p_value, found.total_p_value, found.worst_p_value});
  const bool worst_decides = n == 1 || !samples.lab_by_mapped.empty();
  found.p_value = worst_decides ? found.worst_p_value : std::min(3.0 * least, 1.0);
  return found;
}

}  // namespace gonio::detail

namespace gonio {

GONIO_INLINE measurement_noise pooled_noise(const measurement_noise& a, const measurement_noise& b) {
  const double freedom = a.degrees_of_freedom + b.degrees_of_freedom;
  const double squares =
      a.degrees_of_freedom * a.relative * a.relative + b.degrees_of_freedom * b.relative * b.relative;
  return {.relative = freedom > 0.0 ? std::sqrt(squares / freedom) : 0.0, .degrees_of_freedom = freedom};
}

}  // namespace gonio
