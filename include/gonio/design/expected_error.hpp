#pragma once
/// The expected error after a set of measurements: Xu, Nielsen, Yu, Jensen and Ramamoorthi 2016, "Minimal BRDF Sampling
/// for Two-Shot Near-Field Reflectance Acquisition" (doi:10.1145/2980179.2982396), Eq. 12-15.

#include <gonio/basis/pca.hpp>
#include <gonio/design/design_criterion.hpp>
#include <gonio/solve/default_eta.hpp>

#include <Eigen/Core>

#include <utility>

namespace gonio::design {

/// The error sources that the expected error includes. Apart from eta, the defaults give Eq. 15 as printed.
struct expected_error_options {
  /// Tikhonov's penalty of the reconstruction (Eq. 4). The paper uses 40.
  double eta = default_eta;
  /// The standard deviation of every measurement's mapped value. These errors are independent.
  double noise = 0.0;
  /// beta of Eq. 15 with O = 1 (Eq. 13): the size of a shift that is common to the mapped values of all samples.
  double common_shift = 0.0;
  /// Leaves each material out of the basis before reconstructing it. Eq. 15 as printed does not: the basis has seen
  /// every material that the error averages over, so the error is smallest without a penalty.
  bool leave_out = false;
};

/// E(S) of Eq. 15. Each observation that the basis was learned from is reconstructed from the measurements S. E is the
/// mean norm of the errors over all cells, plus beta times the norm of the response to a common shift.
///
/// As printed, the norms run over a million cells. But y_i = Q c_i with the materials' coefficients c_i, and |Q x|^2 =
/// x'M x with the k x k matrix M = Q'Q, which is Sigma^2. Let Y = S Q C' and W = S Q M C', n x m for n measurements and
/// m observations, with the columns y_i and w_i. Let K = Y Y' + eta I and B = K^-1 Y with the columns b_i. The columns
/// of C are orthonormal, so Y Y' = S Q Q' S'. Then
///
///   |Q (Q+ - (SQ)+_eta S) y_i|^2 = c_i'M c_i - 2 w_i . b_i + b_i' (W Y') b_i.
///
/// A measurement may also have an error of its own, of variance v, from the detector or from an inexact direction
/// (`angular_error_penalty`). The variance of a weight over the observations is 1 / m, so a reconstruction that expects
/// this error penalises the measurement by eta + m v: K = Y Y' + eta I + m diag(v). Each squared error grows by the
/// average effect of these errors, the sum of v_i [K^-1 W Y' K^-1]_ii. For independent noise, v is the same for all
/// measurements.
///
/// If a material's channels (colours or wavelengths) are left out, the mean and covariance of the remaining
/// observations change. Woodbury's identity gives the leave-one-out formula for linear fits.
/// (`leave_one_material_out_error` computes the same error as a function of eta.) C_j has the material's rows of C, one
/// per channel, and R_j is the residual of C_j' with all materials in the basis. With the channels x channels matrices
///
///   X = R_j' M R_j,
///   L = I - 1 1' / m - C_j A' K^-1 A C_j',   A = S Q,
///
/// the squared errors are the diagonal of L^-1 X L^-1. The contribution of measurement errors is computed from the
/// basis of all materials.
///
/// Cells outside of the basis are ignored. If the basis does not have all components, the variance of the missing ones
/// is ignored, too. That variance is the same for all S, except for its effect as noise.
class expected_error {
 public:
  /// The inputs for n measurements and m observations: Y and W, one row for each measurement, and the noise. Y and W
  /// are stored as one matrix, because one product with both is faster than two.
  struct rows {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> both;  ///< 2n x m

    Eigen::VectorXd noise;  ///< n values, S O of Eq. 13: the response to a common shift, 1 for a single sample
    Eigen::VectorXd sample_noise_penalty;  ///< n values m v, with the variance v of each measurement's own error

    rows() = default;
    rows(Eigen::Index n, Eigen::Index m) : both(2 * n, m), noise(n), sample_noise_penalty(Eigen::VectorXd::Zero(n)) {}

    [[nodiscard]] Eigen::Index size() const noexcept { return noise.size(); }
    [[nodiscard]] auto materials() { return both.topRows(size()); }
    [[nodiscard]] auto materials() const { return both.topRows(size()); }
    [[nodiscard]] auto weighted() { return both.bottomRows(size()); }
    [[nodiscard]] auto weighted() const { return both.bottomRows(size()); }
  };

  /// Weights all cells of the basis equally.
  template <error_metric Metric>
  explicit expected_error(const pca<Metric>& basis, const expected_error_options& options = {})
      : expected_error(basis, options, basis.singular_values().array().square().matrix().asDiagonal()) {}

  /// Measures errors by the norm x'M x of the components' weights, with M = `norm`, k x k, symmetric and positive
  /// semidefinite. M = Q'D Q with a diagonal D weights the cells by D. Throws gonio::error unless eta is positive, for
  /// negative noise or shift, for a wrong size, and if `leave_out` is set for fewer than two materials.
  template <error_metric Metric>
  expected_error(const pca<Metric>& basis, const expected_error_options& options, const Eigen::MatrixXd& norm)
      : expected_error(basis.coefficients(), basis.channels(), options, norm) {}

  [[nodiscard]] const expected_error_options& options() const noexcept { return options_; }
  /// The number of channels of each material. The observations of a material are consecutive.
  [[nodiscard]] Eigen::Index channels() const noexcept { return channels_; }
  /// C and C M: m x k. A measurement whose row of components is q has the row C q of Y and the row C M q of W.
  [[nodiscard]] const Eigen::MatrixXd& coefficients() const noexcept { return coefficients_; }
  [[nodiscard]] const Eigen::MatrixXd& weighted_coefficients() const noexcept { return weighted_; }
  /// c_i'M c_i: the squared error of each observation if nothing is measured.
  [[nodiscard]] const Eigen::VectorXd& energies() const noexcept { return energies_; }

  /// Returns Y and W, given the components' values at the measurements, n x k, and the response of each measurement to
  /// a common shift. O(n k m).
  [[nodiscard]] rows prepare(const Eigen::MatrixXd& components, Eigen::VectorXd noise) const;
  /// Returns Y and W of single samples, whose response to a common shift is 1.
  [[nodiscard]] rows prepare(const Eigen::MatrixXd& components) const;

  /// Returns E(S). O(n^2 m) for n measurements and m observations.
  [[nodiscard]] double operator()(const rows& measured) const { return state(measured).error(options_.common_shift); }

  /// Returns E(S) from the components' values at the measurements, n x k.
  [[nodiscard]] double operator()(const Eigen::MatrixXd& components) const { return (*this)(prepare(components)); }

  /// m noise^2: the part of each measurement's penalty that is due to noise.
  [[nodiscard]] double noise_eta() const noexcept {
    return static_cast<double>(coefficients_.rows()) * options_.noise * options_.noise;
  }

  /// The errors that remain after some measurements, and the matrices for adding another one.
  struct remainder {
    Eigen::MatrixXd inverse;         ///< K^-1, n x n
    Eigen::VectorXd squared_errors;  ///< squared error of each observation
    Eigen::MatrixXd inverse_unknown,
        missed;  ///< L^-1 and L^-1 X L^-1 of all materials, side by side: channels x m; empty unless `leave_out`
    Eigen::VectorXd own_variances;   ///< variance v of each measurement's own error
    double own_energy = 0.0;         ///< contribution of the measurements' own errors to each squared error
    Eigen::VectorXd noise_response;  ///< C (SQ)+_eta S O: the weights' response to a common shift, times C
    double noise_energy = 0.0;       ///< |Q (SQ)+_eta S O|^2

    [[nodiscard]] double error(double common_shift) const;
  };

  [[nodiscard]] remainder state(const rows& measured) const;

 private:
  expected_error(const Eigen::MatrixXf& coefficients, Eigen::Index channels, const expected_error_options& options,
                 const Eigen::MatrixXd& norm);

  /// Sets the members of `remainder` for left-out materials. Takes `known` = Y' K^-1 and `spread` = Y' K^-1 W Y' K^-1,
  /// m x n each. O(n m channels + m channels^2).
  void leave_each_out(const rows& measured, const Eigen::MatrixXd& known, const Eigen::MatrixXd& spread,
                      remainder& left) const;

  expected_error_options options_;
  Eigen::Index channels_;
  Eigen::MatrixXd coefficients_, weighted_;
  Eigen::VectorXd energies_;
};

static_assert(design_criterion<expected_error>);

/// Computes E of some measurements and one more, for many candidates. With A = I - (SQ)' K^-1 (SQ), the covariance of
/// the weights after the measurements is A / m. One more measurement changes A by a matrix of rank one. For a candidate
/// q, let t = C A q, w = C A M A q, d = eta + q'A q and r = q'A M A q. The squared errors grow by r t^2 / d^2 - 2 t w /
/// d. O(n m) for each candidate. If measurements have errors of their own, d includes the candidate's own penalty. With
/// a = K^-1 SQ q, b = K^-1 SQ M A q, the variance v_q of the candidate's own error and the variances v of the
/// measurements' own errors, all squared errors grow by another (v_q + a'diag(v) a) r / d^2 - 2 a'diag(v) b / d. If
/// materials are left out, L decreases by t t' / d, and X changes as the squared errors do (`sum_of_left_out_errors`),
/// for another O(m channels).
template <class Scalar>
class extended_error {
 public:
  /// One row for each candidate, m columns.
  using matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using column = Eigen::Array<Scalar, Eigen::Dynamic, 1>;

  extended_error(const expected_error& criterion, const expected_error::rows& measured);

  /// Returns, for each of some candidates, E of the measurements and this candidate. Takes the candidates' rows of Y
  /// and W and their own penalties.
  [[nodiscard]] column operator()(const Eigen::Ref<const matrix>& y, const Eigen::Ref<const matrix>& w,
                                  const Eigen::Ref<const column>& sample_noise_penalty) const;

 private:
  /// One column for each candidate: this makes products fastest.
  using columns = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  /// -a and -b of each candidate (as defined for this class). Empty without measurements.
  struct knowledge {
    columns once, twice;
  };

  /// On entry `both` holds C q above C M q, one column for each candidate. Replaces them by t above C M A q, and sets
  /// `twice` to w.
  [[nodiscard]] knowledge take_away(columns& both, columns& twice) const;
  [[nodiscard]] Scalar own_growth(const knowledge& known, Eigen::Index candidate, Scalar sample_noise_penalty, Scalar d,
                                  Scalar r) const;
  /// Returns the mean error over all observations if materials are left out. Takes the candidate's t and w, and the
  /// increase `own` of each squared error by the measurements' own errors.
  [[nodiscard]] Scalar mean_of_excluded(const Scalar* t, const Scalar* w, Scalar d, Scalar r, Scalar own) const;

  Scalar eta_, common_shift_;
  Eigen::Index channels_;
  columns both_;               ///< Y' above W'
  columns y_, minus_inverse_;  ///< Y, -K^-1
  column squared_errors_;
  columns inverse_unknown_, missed_;  ///< from `remainder`; empty unless materials are left out
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> noise_response_, own_variances_;
  Scalar noise_energy_, own_energy_;
};

#if defined(GONIO_COMPILED)
/// The searches that move candidates use double; those that try every candidate use float. Candidates in tiles use
/// `error_sweep`.
extern template class extended_error<float>;
extern template class extended_error<double>;
#endif

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/expected_error.ipp>
#endif
