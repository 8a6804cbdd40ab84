#pragma once
/// What a set of measurements leaves unknown: the expected error of Xu, Nielsen, Yu, Jensen and Ramamoorthi 2016,
/// "Minimal BRDF Sampling for Two-Shot Near-Field Reflectance Acquisition", Eq. 12-15.

#include <gonio/basis/pca.hpp>
#include <gonio/design/design_criterion.hpp>
#include <gonio/solve/row_source.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <cmath>
#include <utility>

namespace gonio {

/// How the expected error weighs what may go wrong.
struct expected_error_options {
  /// Tikhonov's penalty of the reconstruction (Eq. 4).
  double eta = 40.0;
  /// beta of Eq. 15: the deviation of every measurement in the mapped domain.
  double noise = 0.0;
};

/// E(S) of Eq. 15: the mean over the materials that a basis was learned from of the norm, over all cells, of what
/// the reconstruction from the measurements S misses, plus beta times the norm of what noise adds.
///
/// As printed, its norms run over a million cells. But y_i = Q c_i with the materials' coefficients c_i, and |Q x|^2 =
/// x'M x with the k x k matrix M = Q'Q, which is Sigma^2. With Y = S Q C' and W = S Q M C', n x m for n measurements
/// and m observations, K = Y Y' + eta I and B = K^-1 Y (the columns of C are orthonormal, and Y Y' = S Q Q' S'):
///
///   |Q (Q+ - (SQ)+_eta S) y_i|^2 = c_i'M c_i - 2 w_i . b_i + b_i' (W Y') b_i.
///
/// A measurement may also have an error of its own, of variance v: a detector's, or that of a direction which is not
/// quite met (`misplacement_etas`). A weight's variance over the observations is 1 / m, so that the reconstruction
/// which expects the error is penalised by eta + m v there, K = Y Y' + eta I + m diag(v), and every squared error grows
/// by the sum of v_i [K^-1 W Y' K^-1]_ii, by what such errors add to it on average.
///
/// Cells that the components are not known for take no part. Where k is less than all components, what the materials
/// have beyond them is left out: it is the same for all S, but for what it does as noise.
class expected_error {
 public:
  /// What is needed of n measurements and m observations: Y and W, one row for each measurement, and what noise does to
  /// them. Y stands above W in one matrix, because products with both at once are faster than two.
  struct rows {
    row_matrix both;          ///< 2n x m
    Eigen::VectorXd noise;    ///< S O of Eq. 13, n values: 1 for a sample by itself
    Eigen::VectorXd own_eta;  ///< m v of the errors of its own, n values: 0 where there are none

    rows() = default;
    rows(Eigen::Index n, Eigen::Index m) : both(2 * n, m), noise(n), own_eta(Eigen::VectorXd::Zero(n)) {}

    [[nodiscard]] Eigen::Index size() const noexcept { return noise.size(); }
    [[nodiscard]] auto materials() { return both.topRows(size()); }
    [[nodiscard]] auto materials() const { return both.topRows(size()); }
    [[nodiscard]] auto weighted() { return both.bottomRows(size()); }
    [[nodiscard]] auto weighted() const { return both.bottomRows(size()); }
  };

  /// Errors over the cells that the components were learned on, all of which count alike.
  template <error_metric Metric>
  explicit expected_error(const pca<Metric>& basis, const expected_error_options& options = {})
      : expected_error(basis, options, basis.singular_values().array().square().matrix().asDiagonal()) {}

  /// Errors in the norm x'M x of the components' weights; M is k x k, symmetric and positive semidefinite. With M = Q'D
  /// Q and a diagonal D, cells count as much as D says. Throws gonio::error for a negative eta or noise or a wrong
  /// size.
  template <error_metric Metric>
  expected_error(const pca<Metric>& basis, const expected_error_options& options, const Eigen::MatrixXd& norm)
      : options_(options), coefficients_(basis.coefficients().template cast<double>()) {
    detail::require_positive_eta(options.eta);
    if (!(options.noise >= 0.0 && std::isfinite(options.noise)))
      throw error("the noise must be finite and not negative, not " + std::to_string(options.noise));
    const auto k = static_cast<Eigen::Index>(basis.size());
    if (norm.rows() != k || norm.cols() != k)
      throw error("a norm of " + std::to_string(k) + " weights must be a square matrix of as many rows");
    weighted_ = coefficients_ * norm;
    energies_ = coefficients_.cwiseProduct(weighted_).rowwise().sum();
  }

  [[nodiscard]] const expected_error_options& options() const noexcept { return options_; }
  /// C and C M: m x k. A measurement whose row of components is q has the rows C q and C M q of Y and W.
  [[nodiscard]] const Eigen::MatrixXd& coefficients() const noexcept { return coefficients_; }
  [[nodiscard]] const Eigen::MatrixXd& weighted_coefficients() const noexcept { return weighted_; }
  /// c_i'M c_i: the squared error of each observation if nothing is measured.
  [[nodiscard]] const Eigen::VectorXd& energies() const noexcept { return energies_; }

  /// Y and W of measurements, given the components' values at them, n x k, and what noise does to them. O(n k m).
  [[nodiscard]] rows prepare(const Eigen::MatrixXd& components, Eigen::VectorXd noise) const;
  [[nodiscard]] rows prepare(const Eigen::MatrixXd& components) const {
    return prepare(components, Eigen::VectorXd::Ones(components.rows()));
  }

  /// E(S). O(n^2 m) for n measurements and m observations.
  [[nodiscard]] double operator()(const rows& measured) const { return state(measured).error(options_.noise); }

  /// E(S) from the components' values at the measurements, n x k.
  [[nodiscard]] double operator()(const Eigen::MatrixXd& components) const { return (*this)(prepare(components)); }

  /// What is left unknown when some measurements are made, and how to add to them.
  struct remainder {
    Eigen::MatrixXd inverse;         ///< K^-1, n x n
    Eigen::ArrayXd squared_errors;   ///< of each observation
    Eigen::VectorXd own_variances;   ///< v of each measurement's own error
    Eigen::VectorXd noise_response;  ///< C (SQ)+_eta S O: what noise adds to the weights
    double noise_energy = 0.0;       ///< |Q (SQ)+_eta S O|^2

    [[nodiscard]] double error(double noise) const;
  };

  [[nodiscard]] remainder state(const rows& measured) const;

 private:
  expected_error_options options_;
  Eigen::MatrixXd coefficients_, weighted_;
  Eigen::VectorXd energies_;
};

static_assert(design_criterion<expected_error>);

/// Measurements to which another one is added. A = I - (SQ)' K^-1 (SQ), what they leave unknown, then changes by a
/// matrix of rank one: with t = C A q, w = C A M A q, d = eta + q'A q and r = q'A M A q of a candidate q, the squared
/// errors grow by r t^2 / d^2 - 2 t w / d. O(n m) for each candidate. With errors of their own, d contains the
/// candidate's own eta, and with a = K^-1 SQ q, b = K^-1 SQ M A q and its v, all squared errors grow by
/// (v + a'diag(v) a) r / d^2 - 2 a'diag(v) b / d more.
template <class Scalar>
class extended_error {
 public:
  /// One row for each candidate, m columns.
  using matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using column = Eigen::Array<Scalar, Eigen::Dynamic, 1>;

  extended_error(const expected_error& criterion, const expected_error::rows& measured)
      : eta_(static_cast<Scalar>(criterion.options().eta)), noise_(static_cast<Scalar>(criterion.options().noise)) {
    const expected_error::remainder left = criterion.state(measured);
    materials_ = measured.materials().cast<Scalar>();
    weighted_ = measured.weighted().cast<Scalar>();
    inverse_ = left.inverse.cast<Scalar>();
    squared_errors_ = left.squared_errors.cast<Scalar>().transpose();
    own_variances_ = left.own_variances.cast<Scalar>();
    noise_response_ = left.noise_response.cast<Scalar>();
    noise_energy_ = static_cast<Scalar>(left.noise_energy);
  }

  /// E with each of some candidates, whose rows of Y and W and whose own etas are given.
  [[nodiscard]] column operator()(const Eigen::Ref<const matrix>& y, const Eigen::Ref<const matrix>& w,
                                  const Eigen::Ref<const column>& own_eta) const {
    // Take away what the measurements know: from q, then from M q.
    matrix t = y, once = w, known_once, known_twice;
    if (materials_.rows() > 0) {
      known_once = (y * materials_.transpose()) * inverse_;
      t.noalias() -= known_once * materials_;
      once.noalias() -= known_once * weighted_;
    }
    matrix twice = once;
    if (materials_.rows() > 0) {
      known_twice = (once * materials_.transpose()) * inverse_;
      twice.noalias() -= known_twice * materials_;
    }
    const column d = eta_ + own_eta + y.cwiseProduct(t).rowwise().sum().array();
    const column r = t.cwiseProduct(once).rowwise().sum().array();
    const column grown = own_growth(known_once, known_twice, own_eta, d, r);
    column found(y.rows());
    for (Eigen::Index i = 0; i < y.rows(); ++i) {
      const auto step = t.row(i).array() / d[i];
      found[i] = (squared_errors_ + (grown[i] + step * (r[i] * step - Scalar(2) * twice.row(i).array())))
                     .max(Scalar(0))
                     .sqrt()
                     .mean();
    }
    if (noise_ > Scalar(0)) found += noise_ * noise(y, once, d, r);
    return found;
  }

 private:
  /// By how much errors of their own add to each squared error, beyond what they do now.
  [[nodiscard]] column own_growth(const matrix& known_once, const matrix& known_twice,
                                  const Eigen::Ref<const column>& own_eta, const column& d, const column& r) const {
    const column v = own_eta / static_cast<Scalar>(squared_errors_.size());
    column growth = v * r / d.square();
    if (materials_.rows() == 0) return growth;
    const matrix spread = known_once * own_variances_.asDiagonal();
    growth += spread.cwiseProduct(known_once).rowwise().sum().array() * r / d.square();
    growth -= Scalar(2) * spread.cwiseProduct(known_twice).rowwise().sum().array() / d;
    return growth;
  }

  /// |Q (SQ)+_eta 1| with each candidate: (SQ)+_eta 1 grows by A q (1 - q . (SQ)+_eta 1) / d.
  [[nodiscard]] column noise(const Eigen::Ref<const matrix>& y, const matrix& once, const column& d,
                             const column& r) const {
    const column growth = (Scalar(1) - (y * noise_response_).array()) / d;
    const column along = (once * noise_response_).array();
    return (noise_energy_ + growth * (Scalar(2) * along + growth * r)).max(Scalar(0)).sqrt();
  }

  Scalar eta_, noise_;
  matrix materials_, weighted_, inverse_;
  Eigen::Array<Scalar, 1, Eigen::Dynamic> squared_errors_;
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> noise_response_, own_variances_;
  Scalar noise_energy_ = Scalar(0);
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/expected_error.ipp>
#endif
