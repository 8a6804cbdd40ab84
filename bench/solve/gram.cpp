/// Gram matrices of tall float matrices, compared with Eigen's rank update of the same shape, on one thread and on two.
/// The limit for two threads is twice Eigen's rate on one. GFlop counts n k (k + 1) operations for both.

#include "../limit.hpp"
#include <gonio/solve/gram.hpp>

#include <benchmark/benchmark.h>

#include <map>

namespace {

using float_rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Returns 1.1 million rows of 99 columns, or as many bytes with other numbers of columns.
const float_rows& matrix(Eigen::Index columns) {
  static std::map<Eigen::Index, float_rows> made;
  float_rows& rows = made[columns];
  if (rows.size() == 0) rows = float_rows::Random(1'096'216 * 99 / columns, columns);
  return rows;
}

void count(benchmark::State& state, Eigen::Index columns) {
  const double operations = static_cast<double>(matrix(columns).rows()) * static_cast<double>(columns * (columns + 1));
  count_operations(state, operations);
}

template <class Products>
void ours(benchmark::State& state) {
  const Eigen::Index columns = state.range(0);
  const auto threads = static_cast<unsigned>(state.range(1));
  const float_rows& rows = matrix(columns);
  for (auto _ : state) benchmark::DoNotOptimize(gonio::gram<Products>(rows, {threads}).sum());
  count(state, columns);
  limited_by(state, std::to_string(threads) + (sizeof(Products) == 4 ? " x eigen_float" : " x eigen_double") +
                        "/columns:" + std::to_string(columns));
}

/// Eigen's update uses one thread.
void eigen_float(benchmark::State& state) {
  const Eigen::Index columns = state.range(0);
  const float_rows& rows = matrix(columns);
  for (auto _ : state) {
    Eigen::MatrixXf gram = Eigen::MatrixXf::Zero(columns, columns);
    gram.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
    benchmark::DoNotOptimize(gram.data());
  }
  count(state, columns);
}

/// Eigen's update in double needs a copy of the rows, made here block by block.
void eigen_double(benchmark::State& state) {
  const Eigen::Index columns = state.range(0), block = 256;
  const float_rows& rows = matrix(columns);
  Eigen::MatrixXd part;
  for (auto _ : state) {
    Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(columns, columns);
    for (Eigen::Index begin = 0; begin < rows.rows(); begin += block) {
      part = rows.middleRows(begin, std::min(block, rows.rows() - begin)).transpose().cast<double>();
      gram.selfadjointView<Eigen::Lower>().rankUpdate(part);
    }
    benchmark::DoNotOptimize(gram.data());
  }
  count(state, columns);
}

void shapes(benchmark::internal::Benchmark* benchmark) {
  for (const int columns : {50, 99, 200, 400, 800})
    for (const int threads : {1, 2}) benchmark->Args({columns, threads});
  benchmark->ArgNames({"columns", "threads"})->UseRealTime()->Unit(benchmark::kMillisecond);
}

void one_thread(benchmark::internal::Benchmark* benchmark) {
  for (const int columns : {50, 99, 200, 400, 800}) benchmark->Arg(columns);
  benchmark->ArgName("columns")->UseRealTime()->Unit(benchmark::kMillisecond);
}

BENCHMARK(eigen_float)->Apply(one_thread);
BENCHMARK(ours<float>)->Apply(shapes);
BENCHMARK(eigen_double)->Apply(one_thread);
BENCHMARK(ours<double>)->Apply(shapes);

}  // namespace
