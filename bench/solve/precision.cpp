/// The cost of accumulating a Gram matrix in float. Describes each of the ten test materials by the 99 others. Products
/// and block sums of the normal equations are in float, then in double. Evaluates both in double. No timings.

#include "../../tests/solve/oracles/nnls_block_pivoting.hpp"
#include "../real_materials.hpp"
#include <gonio/basis/measured.hpp>
#include <gonio/evaluate/test_materials.hpp>
#include <gonio/metric/lin.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/metric/root.hpp>
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/least_squares.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/quadratic_program.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

namespace {

/// The two Gram matrices of one channel of all materials.
struct products {
  Eigen::MatrixXd exact, rounded;
};

class study {
 public:
  study(std::string metric, std::vector<products> channels, std::vector<Eigen::Index> targets)
      : metric_(std::move(metric)), channels_(std::move(channels)), targets_(std::move(targets)) {}

  /// Prints the matrices' condition, and the largest error of an entry relative to its columns' lengths.
  void describe() const {
    double condition = 0.0, error = 0.0;
    for (const auto& [exact, rounded] : channels_) {
      const Eigen::VectorXd values =
          Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(exact, Eigen::EigenvaluesOnly).eigenvalues();
      condition = std::max(condition, values.maxCoeff() / values.minCoeff());
      const Eigen::VectorXd norms = exact.diagonal().cwiseSqrt();
      error = std::max(error, ((rounded - exact).array() / (norms * norms.transpose()).array()).abs().maxCoeff());
    }
    std::printf("| %s | %.1e | %.1e |\n", metric_.c_str(), condition, error);
  }

  template <class Solver>
  void run(const std::string& name, const Solver& solver) const {
    std::vector<double> residuals, weights;
    int refused = 0;
    for (const auto& [exact, rounded] : channels_)
      for (const Eigen::Index target : targets_) {
        const auto columns = gonio::all_but(exact.rows(), target);
        const auto normal = gonio::leave_one_out(exact, target, columns);
        const gonio::solution best = solver.solve(normal);
        try {
          const gonio::solution found = solver.solve(gonio::leave_one_out(rounded, target, columns));
          residuals.push_back(normal.residual(found.weights)[0] / best.report.residual[0] - 1.0);
          weights.push_back((found.weights - best.weights).norm() / best.weights.norm());
        } catch (const gonio::error&) {
          ++refused;
        }
      }
    if (residuals.empty()) return;
    std::ranges::sort(residuals);
    std::ranges::sort(weights);
    std::printf("| %s | %s | %.1e | %.1e | %.1e | %.1e | %d of %zu |\n", metric_.c_str(), name.c_str(),
                residuals[residuals.size() / 2], residuals.back(), weights[weights.size() / 2], weights.back(), refused,
                residuals.size() + refused);
  }

 private:
  std::string metric_;
  std::vector<products> channels_;
  std::vector<Eigen::Index> targets_;
};

template <class Metric>
study make_study(const std::string& name, const gonio::material_set& materials, const Metric& metric) {
  const Eigen::Index count = std::ssize(materials.names);
  const gonio::measured basis{materials, metric};
  std::vector<products> channels;
  for (std::size_t c = 0; c < 3; ++c) {
    const auto functions = basis.channel(c);
    gonio::cell_matrix rows(materials.values.rows(), count);
    for (Eigen::Index cell = 0; cell < rows.rows(); ++cell)
      std::ranges::copy(functions.row(cell), rows.row(cell).data());
    channels.push_back({gonio::gram<double>(rows), gonio::gram<float>(rows)});
  }
  std::vector<Eigen::Index> targets;
  for (const std::string& material : gonio::nielsen_test_materials()) targets.push_back(materials.find(material));
  return {name, std::move(channels), std::move(targets)};
}

}  // namespace

int main() {
  const auto materials = real_materials();
  const std::vector<study> studies{make_study("lin", materials, gonio::lin{}),
                                   make_study("root", materials, gonio::root{}),
                                   make_study("log", materials, gonio::log{})};
  std::printf("| metric | condition | float error of an entry |\n|---|---|---|\n");
  for (const study& one : studies) one.describe();
  std::printf(
      "\n| metric | solver | residual grows: median | worst | weights change: median | worst | refused |\n"
      "|---|---|---|---|---|---|---|\n");
  for (const study& one : studies) {
    one.run("nnls", gonio::nnls());
    one.run("nnls_block_pivoting", gonio::nnls_block_pivoting());
    one.run("quadratic_program", gonio::quadratic_program());
    one.run("tikhonov 1", gonio::tikhonov(1.0));
    one.run("non_negative_lasso 1", gonio::non_negative_lasso(1.0));
    one.run("lasso 1", gonio::lasso(1.0));
    one.run("truncated_svd 0.9999", gonio::truncated_svd(0.9999));
    one.run("least_squares", gonio::least_squares());
  }
}
