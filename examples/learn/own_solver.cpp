/// A solver of your own: ridge regression by the Gauss-Seidel method, one weight after the other. It finds the same
/// weights as gonio::tikhonov.

#include <gonio/estimate/decomposition.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <cstdio>

/// Minimises 1/2 x'Q x - m'x + 1/2 eta |x|^2 with Q = A'WA and m = A'Wb.
struct gauss_seidel {
  double eta = 40.0;

  gonio::solution solve(const gonio::least_squares_problem& problem) const {
    const gonio::normal_equations& rows = problem.normal();
    Eigen::MatrixXd penalised = rows.gram();
    penalised.diagonal().array() += eta;
    const gonio::normal_equations all(penalised, rows.rhs());  // same optimality conditions as the penalised problem

    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(all.unknowns(), all.right_hand_sides());
    for (int sweep = 1; sweep <= 100'000; ++sweep) {
      for (Eigen::Index column = 0; column < x.cols(); ++column)
        for (Eigen::Index j = 0; j < x.rows(); ++j)
          x(j, column) += (all.rhs()(j, column) - penalised.col(j).dot(x.col(column))) / penalised(j, j);
      const Eigen::VectorXd kkt_residual = gonio::stationarity(all, x);
      if (kkt_residual.maxCoeff() <= 1e-9) return {x, {problem.residual(x), all.objective(x), kkt_residual, sweep}};
    }
    gonio::refuse({"gauss_seidel did not converge in 100000 sweeps; a larger eta helps, this is ", eta});
  }
};
static_assert(gonio::solver<gauss_seidel>);

int main() {
  const auto prior = gonio::io::read_prior("materials.prior");
  const gonio::sample_set samples = gonio::io::read_samples("measurements.csv");
  const auto ours = gonio::decomposition{prior, gauss_seidel{40.0}}.fit(samples);
  const auto theirs = gonio::decomposition{prior, gonio::tikhonov{40.0}}.fit(samples);

  std::printf("gauss_seidel: %d sweeps, residual of red %.6f\n", ours.report()->iterations, ours.report()->residual[0]);
  std::printf("tikhonov:     residual of red %.6f\n", theirs.report()->residual[0]);
  const double difference = (ours.weights() - theirs.weights()).cwiseAbs().maxCoeff();
  std::printf("the weights %s a millionth\n", difference < 1e-6 ? "agree to" : "differ by more than");
  return difference < 1e-6 ? 0 : 1;
}
