/// Our solvers compared with numpy and scipy on the same real matrices in one run. Writes the problem to a scratch
/// folder, times our side, lets rivals.py time theirs (Debian's python3-scipy and, for a competitive BLAS,
/// libopenblas0-pthread), and prints the ratios. Prints a message if Python is missing.

#include "../real_materials.hpp"
#include <gonio/basis/measured.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/quadratic_program.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>

namespace {

using nlohmann::json;

/// Returns the minimum of several runs in microseconds, because noise only adds.
template <class Run>
double best_of(int runs, Run&& run) {
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0; i < runs; ++i) {
    const auto start = std::chrono::steady_clock::now();
    run();
    const std::chrono::duration<double, std::micro> took = std::chrono::steady_clock::now() - start;
    best = std::min(best, took.count());
  }
  return best;
}

template <class Scalar>
void save(const std::filesystem::path& path, const Scalar* data, std::size_t rows, std::size_t columns) {
  xt::xtensor<Scalar, 2> array({rows, columns});
  std::copy_n(data, rows * columns, array.data());
  gonio::io::write_npy(path, array);
}

/// Returns the rivals' times; nothing if they failed.
std::optional<json> time_rivals(const std::filesystem::path& folder) {
  for (const std::string python : {"/usr/bin/python3", "python3"}) {
    if (std::system((python + " -c 'import numpy, scipy' 2> /dev/null").c_str()) != 0) continue;
    json all;
    for (const int threads : {1, 2}) {
      const auto result = folder / "rivals.json";
      const std::string command = "OPENBLAS_NUM_THREADS=" + std::to_string(threads) + " " + python + " " +
                                  GONIO_BENCH_SOURCE + "/solve/rivals.py " + folder.string() + " > " + result.string();
      if (std::system(command.c_str()) != 0) return std::nullopt;
      all[std::to_string(threads)] = json::parse(std::ifstream(result));
    }
    return all;
  }
  std::cerr << "no Python with numpy and scipy: apt-get install python3-scipy libopenblas0-pthread\n";
  return std::nullopt;
}

void print_row(const std::string& what, double ours, const std::string& rival, double theirs) {
  std::printf("| %s | %.1f | %s | %.1f | %.2f |\n", what.c_str(), ours, rival.c_str(), theirs, theirs / ours);
}

}  // namespace

int main() {
  auto materials = real_materials();
  const Eigen::Index target = materials.find("blue-acrylic");
  const gonio::measured basis{std::move(materials), gonio::log{}};
  const auto functions = basis.channel(0);
  const Eigen::Index count = basis.size();
  gonio::cell_matrix rows(std::ssize(basis.cells()), count - 1);
  for (Eigen::Index cell = 0; cell < rows.rows(); ++cell) {
    const auto row = functions.row(cell);
    Eigen::Index column = 0;
    for (Eigen::Index i = 0; i < count; ++i)
      if (i != target) rows(cell, column++) = row[i];
  }
  const Eigen::MatrixXd products = functions.products();
  const auto normal = gonio::leave_one_out(products, target, gonio::all_but(count, target));

  const auto folder = std::filesystem::temp_directory_path() / "gonio-against-python";
  std::filesystem::create_directories(folder);
  const std::size_t k = count - 1;
  save(folder / "rows.npy", rows.data(), rows.rows(), k);
  save(folder / "gram.npy", normal.gram().data(), k, k);
  save(folder / "rhs.npy", normal.rhs().data(), k, 1);

  std::map<std::string, double> ours;
  for (const unsigned threads : {1u, 2u}) {
    const std::string suffix = ", " + std::to_string(threads) + " thread" + (threads > 1 ? "s" : "");
    ours["Gram, float" + suffix] = best_of(5, [&] { (void)gonio::gram<float>(rows, {threads}); });
    ours["Gram, double" + suffix] = best_of(5, [&] { (void)gonio::gram<double>(rows, {threads}); });
  }
  ours["NNLS"] = best_of(200, [&] { (void)gonio::nnls().solve(normal); });
  ours["QP"] = best_of(200, [&] { (void)gonio::quadratic_program().solve(normal); });
  ours["NNLS of all"] = ours["QP of all"] = 0.0;
  for (Eigen::Index other = 0; other < count; ++other) {
    const auto problem = gonio::leave_one_out(products, other, gonio::all_but(count, other));
    ours["NNLS of all"] += best_of(20, [&] { (void)gonio::nnls().solve(problem); });
    ours["QP of all"] += best_of(20, [&] { (void)gonio::quadratic_program().solve(problem); });
  }

  std::printf("%td rows of %zu columns, microseconds (least of several runs)\n\n", rows.rows(), k);
  std::printf("| task | gonio | rival | rival's | rival / gonio |\n|---|---|---|---|---|\n");
  print_row("QP, x >= 0", ours["QP"], "gonio's own NNLS", ours["NNLS"]);
  print_row("QP, each material from the others", ours["QP of all"], "gonio's own NNLS", ours["NNLS of all"]);
  if (const auto rivals = time_rivals(folder)) {
    for (const int threads : {1, 2}) {
      const json& theirs = rivals->at(std::to_string(threads));
      const std::string suffix = ", " + std::to_string(threads) + " thread" + (threads > 1 ? "s" : "");
      print_row("Gram, float" + suffix, ours["Gram, float" + suffix], "numpy", theirs["gram_float"]);
      print_row("Gram, double" + suffix, ours["Gram, double" + suffix], "numpy", theirs["gram_double"]);
    }
    const json& theirs = rivals->at("1");
    print_row("NNLS", ours["NNLS"], "scipy.optimize.nnls on the Cholesky factor", theirs["nnls"]);
    std::printf("\nnumpy's BLAS: %s\n", theirs["blas"].get<std::string>().c_str());
  }
  std::filesystem::remove_all(folder);
}
