/// The discrepancy next to a prior's components, as functions around 1,000 measurements: constructing them, their rows
/// at measurements, and adding them to all cells of MERL's grid. Compared with Eigen's factorisation, substitution and
/// matrix product of the same sizes, all in double.

#include "../limit.hpp"
#include <gonio/basis/discrepancy.hpp>
#include <gonio/core/random.hpp>

#include <Eigen/Cholesky>

#include <cmath>
#include <vector>

namespace {

constexpr Eigen::Index centres = 1000;

/// Returns the angles of random cells.
std::vector<gonio::half_difference> some_angles(Eigen::Index count, std::uint64_t seed) {
  static const gonio::valid_cells cells;
  std::vector<gonio::half_difference> angles;
  for (const Eigen::Index cell : gonio::random_choice(cells.size(), count, seed)) angles.push_back(cells.angles(cell));
  return angles;
}

const gonio::discrepancy_functions& functions() {
  static const gonio::discrepancy_functions made(some_angles(centres, 1), 1.0);
  return made;
}

double cube(Eigen::Index size) { return std::pow(static_cast<double>(size), 3); }

void make_functions(benchmark::State& state) {
  const auto angles = some_angles(centres, 1);
  for (auto _ : state) benchmark::DoNotOptimize(gonio::discrepancy_functions(angles, 1.0).size());
  count_operations(state, cube(centres) / 3.0);
  limited_by(state, "eigen_cholesky");
}
BENCHMARK(make_functions)->UseRealTime()->Unit(benchmark::kMillisecond);

/// Reads rows at 1,000 other measurements.
void read_rows(benchmark::State& state) {
  const auto angles = some_angles(centres, 2);
  gonio::row_matrix rows(centres, centres);
  static_cast<void>(functions());
  for (auto _ : state) {
    functions().read(angles, rows);
    benchmark::DoNotOptimize(rows.data());
  }
  count_operations(state, cube(centres));
  limited_by(state, "eigen_substitution");
}
BENCHMARK(read_rows)->UseRealTime()->Unit(benchmark::kMillisecond);

/// Counts the operations of its products: for each of 90 theta_d, 180 values of phi_d by 3 x 90 theta_h.
void add_to_all_cells(benchmark::State& state) {
  const gonio::valid_cells cells;
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Ones(centres, 3);
  const auto threads = static_cast<unsigned>(state.range(0));
  static_cast<void>(functions());
  for (auto _ : state) benchmark::DoNotOptimize(functions().combination(weights, cells, {threads}).sum());
  count_operations(state, 2.0 * 90 * 180 * centres * 270);
  limited_by(state, std::to_string(threads) + " x eigen_product");
}
BENCHMARK(add_to_all_cells)->ArgName("threads")->Arg(1)->Arg(2)->UseRealTime()->Unit(benchmark::kMillisecond);

const Eigen::MatrixXd& covariance() {
  static const Eigen::MatrixXd found = [] {
    Eigen::MatrixXd made = gonio::discrepancy_covariance(some_angles(centres, 1));
    made.diagonal().array() += 1e-7;
    return made;
  }();
  return found;
}

void eigen_cholesky(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(covariance().llt().info());
  count_operations(state, cube(centres) / 3.0);
}
BENCHMARK(eigen_cholesky)->UseRealTime()->Unit(benchmark::kMillisecond);

void eigen_substitution(benchmark::State& state) {
  const Eigen::LLT<Eigen::MatrixXd> factors(covariance());
  const Eigen::MatrixXd right = Eigen::MatrixXd::Random(centres, centres);
  Eigen::MatrixXd x;
  for (auto _ : state) {
    x = right;
    factors.matrixL().solveInPlace(x);
    benchmark::DoNotOptimize(x.data());
  }
  count_operations(state, cube(centres));
}
BENCHMARK(eigen_substitution)->UseRealTime()->Unit(benchmark::kMillisecond);

void eigen_product(benchmark::State& state) {
  const Eigen::MatrixXd a = Eigen::MatrixXd::Random(180, centres), b = Eigen::MatrixXd::Random(centres, 270);
  Eigen::MatrixXd product;
  for (auto _ : state) {
    product.noalias() = a * b;
    benchmark::DoNotOptimize(product.data());
  }
  count_operations(state, 2.0 * 180 * centres * 270);
}
BENCHMARK(eigen_product)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
