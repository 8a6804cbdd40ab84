/// All solvers on the same problem: one material from the 99 others, on every cell or a tenth of them. Also larger
/// problems with 50 to 800 columns. Counters: objective relative to NNLS, KKT residual, number of non-zero weights.

#include "../../tests/solve/oracles/nnls_block_pivoting.hpp"
#include "../../tests/solve/oracles/nnls_coordinate_descent.hpp"
#include "../real_materials.hpp"
#include <gonio/basis/measured.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/solve/any_solver.hpp>
#include <gonio/solve/choose_eta.hpp>
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/least_squares.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/quadratic_program.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <benchmark/benchmark.h>

#include <map>
#include <random>

namespace {

/// The green channel under the logarithmic metric.
const gonio::measured<gonio::log>& materials() {
  static const gonio::measured<gonio::log> basis{real_materials(), gonio::log{}};
  return basis;
}

constexpr std::size_t channel = 1;

/// Returns the problem of one material from the others over every `step`-th cell. Reading rows copies nothing.
gonio::least_squares_problem problem(std::size_t step) {
  const auto functions = materials().channel(channel);
  const std::size_t target = (std::ranges::find(materials().names(), "blue-acrylic") - materials().names().begin());
  const Eigen::Index rows = (functions.cells().size() + step - 1) / step;
  Eigen::MatrixXd right(rows, 1);
  for (Eigen::Index i = 0; i < rows; ++i) right(i, 0) = functions.row(i * step)[target];
  const gonio::row_source source{rows, functions.size(), [functions, step](gonio::block range, gonio::row_block out) {
                                   for (Eigen::Index i = range.begin; i < range.end; ++i) {
                                     const auto row = functions.row(i * step);
                                     for (Eigen::Index j = 0; j < std::ssize(row); ++j)
                                       out(i - range.begin, j) = double{row[j]};
                                   }
                                 }};
  const Eigen::Index k = functions.size();
  return gonio::least_squares_problem(source, right).subset(gonio::all_but(k, target));
}

const gonio::least_squares_problem& problem_of(std::int64_t step) {
  static std::map<std::int64_t, gonio::least_squares_problem> made;
  const auto found = made.find(step);
  if (found != made.end()) return found->second;
  return made.emplace(step, problem(step)).first->second;
}

template <class Problem>
void report(benchmark::State& state, const gonio::solution& found, const Problem& solved) {
  const gonio::normal_equations& normal = solved.normal();
  state.counters["objective"] = normal.objective(found.weights)[0] / gonio::nnls().solve(normal).report.objective[0];
  state.counters["kkt_residual"] = found.report.kkt_residual[0];
  state.counters["non-zero"] = static_cast<double>((found.weights.array() != 0.0).count());
  state.counters["iterations"] = found.report.iterations;
}

/// Times the solver with the normal equations given, as after the first solve.
template <class Solver>
void from_normal(benchmark::State& state, const Solver& solver) {
  const gonio::normal_equations& normal = problem_of(state.range(0)).normal();
  gonio::solution found = solver.solve(normal);
  for (auto _ : state) benchmark::DoNotOptimize(found = solver.solve(normal));
  report(state, found, normal);
}

/// Times the solver from the rows, including all other work.
template <class Solver>
void from_rows(benchmark::State& state, const Solver& solver) {
  const gonio::least_squares_problem& solved = problem_of(state.range(0));
  gonio::solution found;
  for (auto _ : state) benchmark::DoNotOptimize(found = solver.solve(solved));
  report(state, found, solved);
}

void assembly(benchmark::State& state) {
  (void)materials();  // loaded once, outside the timing
  for (auto _ : state) benchmark::DoNotOptimize(problem(state.range(0)).normal().rhs().sum());
}

/// Returns normal equations of k random positive columns, which are similar to one another, as for reflectance.
const gonio::normal_equations& synthetic(Eigen::Index k) {
  static std::map<Eigen::Index, gonio::normal_equations> made;
  const auto found = made.find(k);
  if (found != made.end()) return found->second;
  std::mt19937 engine(7);
  std::lognormal_distribution<double> value(0.0, 1.0);
  Eigen::MatrixXd a(4 * k, k), b(4 * k, 1);
  for (double& entry : a.reshaped()) entry = value(engine);
  for (double& entry : b.reshaped()) entry = value(engine);
  const Eigen::MatrixXd gram = a.transpose() * a, rhs = a.transpose() * b;
  return made.emplace(k, gonio::normal_equations(gram, rhs, b.colwise().squaredNorm())).first->second;
}

template <class Solver>
void scaling(benchmark::State& state, const Solver& solver) {
  const gonio::normal_equations& normal = synthetic(state.range(0));
  gonio::solution found;
  for (auto _ : state) benchmark::DoNotOptimize(found = solver.solve(normal));
  report(state, found, normal);
}

double lambda(std::int64_t step) {
  return 1e-3 * gonio::largest_lambda(problem_of(step).normal(), gonio::sign_rule::any);
}

/// Registers all benchmarks for the problems on every cell and on a tenth of them.
const bool registered = [] {
  const auto add = [](const std::string& name, auto run) {
    benchmark::RegisterBenchmark(name.c_str(), run)
        ->ArgName("every")
        ->Arg(1)
        ->Arg(10)
        ->UseRealTime()
        ->Unit(benchmark::kMicrosecond);
  };
  const auto scale = [](const std::string& name, auto solver) {
    const auto run = [solver](benchmark::State& state) { scaling(state, solver); };
    benchmark::RegisterBenchmark(("columns/" + name).c_str(), run)
        ->ArgName("k")
        ->Arg(50)
        ->Arg(100)
        ->Arg(200)
        ->Arg(400)
        ->Arg(800)
        ->UseRealTime()
        ->Unit(benchmark::kMicrosecond);
  };
  const auto normal = [&](const std::string& name, auto solver) {
    add("gram/" + name, [solver](benchmark::State& state) { from_normal(state, solver); });
    scale(name, solver);
  };
  const auto rows = [&](const std::string& name, auto solver) {
    add("rows/" + name, [solver](benchmark::State& state) { from_rows(state, solver); });
  };
  add("assembly", assembly);
  normal("nnls", gonio::nnls());
  normal("nnls_block_pivoting", gonio::nnls_block_pivoting());
  normal("nnls_coordinate_descent", gonio::nnls_coordinate_descent());
  normal("quadratic_program", gonio::quadratic_program());
  normal("tikhonov", gonio::tikhonov(1.0));
  normal("truncated_svd", gonio::truncated_svd(0.9999));
  normal("least_squares", gonio::least_squares());
  add("gram/lasso", [](benchmark::State& state) { from_normal(state, gonio::lasso(lambda(state.range(0)))); });
  add("gram/non_negative_lasso",
      [](benchmark::State& state) { from_normal(state, gonio::non_negative_lasso(lambda(state.range(0)))); });
  rows("least_squares", gonio::least_squares());
  rows("automatic_tikhonov_gcv", gonio::automatic_tikhonov(gonio::eta_criterion::generalised_cross_validation));
  rows("automatic_tikhonov_loo", gonio::automatic_tikhonov(gonio::eta_criterion::leave_one_out));
  return true;
}();

}  // namespace
