#pragma once
/// What a set of measurements leaves unknown: the expected error of Xu, Nielsen, Yu, Jensen and Ramamoorthi 2016,
/// "Minimal BRDF Sampling for Two-Shot Near-Field Reflectance Acquisition" (doi:10.1145/2980179.2982396), Eq. 12-15.

#include <gonio/basis/pca.hpp>
#include <gonio/design/design_criterion.hpp>
#include <gonio/solve/default_eta.hpp>

#include <Eigen/Core>

#include <utility>

namespace gonio::design {

/// How the expected error weighs what may go wrong. With its defaults, but for eta, it is Eq. 15 as printed without
/// noise.
struct expected_error_options {
  /// Tikhonov's penalty of the reconstruction (Eq. 4), which the paper sets to 40.
  double eta = default_eta;
  /// The deviation of every measurement's mapped value, independent of all others'.
  double noise = 0.0;
  /// beta of Eq. 15 with O = 1 (Eq. 13): the size of one shift that the mapped values of all samples share.
  double common_shift = 0.0;
  /// Is each material left out of the basis before it is reconstructed? As printed, it is not: the basis has seen all
  /// materials that the error is the mean over, so that it is least without any penalty.
  bool leave_out = false;
};

/// E(S) of Eq. 15: the mean over the materials that a basis was learned from of the norm, over all cells, of what
/// the reconstruction from the measurements S misses, plus beta times the norm of what a common shift adds.
///
/// As printed, its norms run over a million cells. But y_i = Q c_i with the materials' coefficients c_i, and |Q x|^2 =
/// x'M x with the k x k matrix M = Q'Q, which is Sigma^2. With Y = S Q C' and W = S Q M C', n x m for n measurements
/// and m observations, K = Y Y' + eta I and B = K^-1 Y (the columns of C are orthonormal, and Y Y' = S Q Q' S'):
///
///   |Q (Q+ - (SQ)+_eta S) y_i|^2 = c_i'M c_i - 2 w_i . b_i + b_i' (W Y') b_i.
///
/// A measurement may also have an error of its own, of variance v: a detector's, or that of a direction which is not
/// quite met (`angular_error_penalty`). A weight's variance over the observations is 1 / m, so that the
/// reconstruction which expects the error is penalised by eta + m v there, K = Y Y' + eta I + m diag(v), and every
/// squared error grows by the sum of v_i [K^-1 W Y' K^-1]_ii, by what such errors add to it on average. Independent
/// noise is such an error of the same variance everywhere.
///
/// Without a material's channels, its colours or wavelengths, the others have another mean and covariance, and the
/// whole is Woodbury's identity once more (`leave_one_material_out_error`, of which this is the same error for samples
/// in cells). It comes to the formula of leave-one-out for linear fits: with the material's rows C_j of C, one for each
/// channel, and the matrices of as many rows and columns
///
///   X = (what is missed of C_j' with all in the basis)' M (the same),   L = I - 1 1' / m - C_j A' K^-1 A C_j',   A = S
///   Q,
///
/// its squared errors are the diagonal of L^-1 X L^-1. What errors of the measurements add is taken from the basis of
/// all.
///
/// Cells that the components are not known for take no part. Where k is less than all components, what the materials
/// have beyond them is left out: it is the same for all S, but for what it does as noise.
class expected_error {
 public:
  /// What is needed of n measurements and m observations: Y and W, one row for each measurement, and what noise does to
  /// them. Y stands above W in one matrix, because products with both at once are faster than two.
  struct rows {
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> both;  ///< 2n x m

    Eigen::VectorXd noise;  ///< S O of Eq. 13, n values: 1 for a sample by itself
    Eigen::VectorXd
        sample_noise_penalty;  ///< m v of the errors of its own, noise among them, n values: 0 where there are none

    rows() = default;
    rows(Eigen::Index n, Eigen::Index m) : both(2 * n, m), noise(n), sample_noise_penalty(Eigen::VectorXd::Zero(n)) {}

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
  /// Q and a diagonal D, cells count as much as D says. Throws gonio::error for a negative eta, noise or shift, a
  /// wrong size, and fewer than two materials to leave out.
  template <error_metric Metric>
  expected_error(const pca<Metric>& basis, const expected_error_options& options, const Eigen::MatrixXd& norm)
      : expected_error(basis.coefficients(), basis.channels(), options, norm) {}

  [[nodiscard]] const expected_error_options& options() const noexcept { return options_; }
  /// The channels of each material: so many observations, one after the other.
  [[nodiscard]] Eigen::Index channels() const noexcept { return channels_; }
  /// C and C M: m x k. A measurement whose row of components is q has the rows C q and C M q of Y and W.
  [[nodiscard]] const Eigen::MatrixXd& coefficients() const noexcept { return coefficients_; }
  [[nodiscard]] const Eigen::MatrixXd& weighted_coefficients() const noexcept { return weighted_; }
  /// c_i'M c_i: the squared error of each observation if nothing is measured.
  [[nodiscard]] const Eigen::VectorXd& energies() const noexcept { return energies_; }

  /// Y and W of measurements, given the components' values at them, n x k, and what noise does to them. O(n k m).
  [[nodiscard]] rows prepare(const Eigen::MatrixXd& components, Eigen::VectorXd noise) const;
  /// The same for samples by themselves.
  [[nodiscard]] rows prepare(const Eigen::MatrixXd& components) const;

  /// E(S). O(n^2 m) for n measurements and m observations.
  [[nodiscard]] double operator()(const rows& measured) const { return state(measured).error(options_.common_shift); }

  /// E(S) from the components' values at the measurements, n x k.
  [[nodiscard]] double operator()(const Eigen::MatrixXd& components) const { return (*this)(prepare(components)); }

  /// m beta^2, which noise adds to each measurement's own eta.
  [[nodiscard]] double noise_eta() const noexcept {
    return static_cast<double>(coefficients_.rows()) * options_.noise * options_.noise;
  }

  /// What is left unknown when some measurements are made, and how to add to them.
  struct remainder {
    Eigen::MatrixXd inverse;                  ///< K^-1, n x n
    Eigen::VectorXd squared_errors;           ///< of each observation
    Eigen::MatrixXd inverse_unknown, missed;  ///< L^-1 and L^-1 X L^-1 of one material beside another: channels x m,
                                              ///< if they are left out
    Eigen::VectorXd own_variances;            ///< v of each measurement's own error
    double own_energy = 0.0;                  ///< what these add to each squared error
    Eigen::VectorXd noise_response;           ///< C (SQ)+_eta S O: what a common shift adds to the weights
    double noise_energy = 0.0;                ///< |Q (SQ)+_eta S O|^2

    [[nodiscard]] double error(double common_shift) const;
  };

  [[nodiscard]] remainder state(const rows& measured) const;

 private:
  expected_error(const Eigen::MatrixXf& coefficients, Eigen::Index channels, const expected_error_options& options,
                 const Eigen::MatrixXd& norm);

  /// What `remainder` has of materials left out, given what Y' K^-1 and Y' K^-1 W Y' K^-1 make of the measurements: m x
  /// n each. O(n m channels + m channels^2).
  void leave_each_out(const rows& measured, const Eigen::MatrixXd& known, const Eigen::MatrixXd& spread,
                      remainder& left) const;

  expected_error_options options_;
  Eigen::Index channels_;
  Eigen::MatrixXd coefficients_, weighted_;
  Eigen::VectorXd energies_;
};

static_assert(design_criterion<expected_error>);

/// Measurements to which another one is added. A = I - (SQ)' K^-1 (SQ), what they leave unknown, then changes by a
/// matrix of rank one: with t = C A q, w = C A M A q, d = eta + q'A q and r = q'A M A q of a candidate q, the squared
/// errors grow by r t^2 / d^2 - 2 t w / d. O(n m) for each candidate. With errors of their own, d contains the
/// candidate's own eta, and with a = K^-1 SQ q, b = K^-1 SQ M A q and its v, all squared errors grow by
/// (v + a'diag(v) a) r / d^2 - 2 a'diag(v) b / d more. Where materials are left out, L falls by t t' / d, and X changes
/// as the squared errors do (`sum_of_left_out_errors`): O(m channels) more.
template <class Scalar>
class extended_error {
 public:
  /// One row for each candidate, m columns.
  using matrix = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using column = Eigen::Array<Scalar, Eigen::Dynamic, 1>;

  extended_error(const expected_error& criterion, const expected_error::rows& measured);

  /// E with each of some candidates, whose rows of Y and W and whose own etas are given.
  [[nodiscard]] column operator()(const Eigen::Ref<const matrix>& y, const Eigen::Ref<const matrix>& w,
                                  const Eigen::Ref<const column>& sample_noise_penalty) const;

 private:
  /// One column for each candidate, as products are fastest.
  using columns = Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>;

  /// What the measurements know of each candidate: a and b above, times -1. Empty if there are none.
  struct knowledge {
    columns once, twice;
  };

  /// Makes the columns of q and M q, one above the other, those of t and w, and those of M A q that of C A M A q.
  [[nodiscard]] knowledge take_away(columns& both, columns& twice) const;
  [[nodiscard]] Scalar own_growth(const knowledge& known, Eigen::Index candidate, Scalar sample_noise_penalty, Scalar d,
                                  Scalar r) const;
  /// The mean over the observations of materials left out, given the candidate's t and A w and what own errors add.
  [[nodiscard]] Scalar mean_left_out(const Scalar* t, const Scalar* w, Scalar d, Scalar r, Scalar own) const;

  Scalar eta_, common_shift_;
  Eigen::Index channels_;
  columns both_;               ///< Y' above W'
  columns y_, minus_inverse_;  ///< Y, -K^-1
  column squared_errors_;
  columns inverse_unknown_, missed_;  ///< of `remainder`: none unless materials are left out
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> noise_response_, own_variances_;
  Scalar noise_energy_, own_energy_;
};

#if defined(GONIO_COMPILED)
/// Steps of a descent are made in double; many candidates in single precision, unless they stand in tiles
/// (`error_sweep`).
extern template class extended_error<float>;
extern template class extended_error<double>;
#endif

}  // namespace gonio::design

#if !defined(GONIO_COMPILED)
#include <gonio/design/impl/expected_error.ipp>
#endif
