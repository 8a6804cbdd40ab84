/// gonio-papers streamed-learning: time and memory of learning from many materials that are not held in memory, and the
/// differences from priors that were learned in memory or from all materials at once.

#include "papers/experiments.hpp"
#include "papers/our_own/random_materials.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/basis/add_materials.hpp>
#include <gonio/basis/expand_materials.hpp>
#include <gonio/basis/learn_pca.hpp>
#include <gonio/basis/learn_streamed_pca.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/scratch_materials.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/product.hpp>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace papers {

namespace {

struct streaming_experiment {
  std::vector<Eigen::Index> counts{100, 1000, 10000}, compared{100, 200, 340, 500, 1000};
  Eigen::Index grown = 300, components = 60, wavelengths = 0;  ///< wavelengths: 0 for colours
  std::filesystem::path prior, folder;
  gonio::thread_count threads;
};

double seconds_of(const std::function<void()>& act) {
  const auto start = std::chrono::steady_clock::now();
  act();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// The numbers that a separate process computed, and its peak memory.
template <std::size_t Count>
struct separate_result {
  std::array<double, Count> values{};
  double megabytes = 0.0;
};

/// Runs the work in a separate process, to measure the memory of the work alone.
template <class Work>
auto separately(const Work& work) {
  std::array<int, 2> ends{};
  std::cout.flush();
  if (::pipe(ends.data()) != 0) gonio::refuse("no pipe to a process");
  const pid_t child = ::fork();
  if (child < 0) gonio::refuse("no process for the work");
  if (child == 0) {
    int code = 1;
    try {
      const auto values = work();
      if (::write(ends[1], values.data(), sizeof values) == sizeof values) code = 0;
    } catch (const std::exception& failure) {
      std::fprintf(stderr, "%s\n", failure.what());
    }
    ::_exit(code);
  }
  ::close(ends[1]);
  separate_result<std::tuple_size_v<decltype(work())>> result;
  const bool whole = ::read(ends[0], result.values.data(), sizeof result.values) == sizeof result.values;
  ::close(ends[0]);
  int status = 0;
  rusage used{};
  ::wait4(child, &status, 0, &used);
  if (!whole || !WIFEXITED(status) || WEXITSTATUS(status) != 0) gonio::refuse("the work of a process failed");
  result.megabytes = static_cast<double>(used.ru_maxrss) / 1024.0;
  return result;
}

std::string scientific(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1e", value);
  return text.data();
}

/// Returns a grid with half of MERL's theta_h, a third of its theta_d and a fifth of its phi_d.
gonio::valid_cells coarse_cells() { return gonio::valid_cells(gonio::grid({45, 30, 36})); }

/// Returns smooth spectra at the wanted number of wavelengths from 400 to 700 nm.
std::optional<gonio::model::smooth_spectra> spectra_of(const streaming_experiment& given) {
  if (given.wavelengths == 0) return {};
  std::vector<double> wavelengths;
  for (Eigen::Index i = 0; i < given.wavelengths; ++i)
    wavelengths.push_back(400.0 + 300.0 * static_cast<double>(i) / static_cast<double>(given.wavelengths - 1));
  return gonio::model::smooth_spectra(wavelengths);
}

/// Returns the random materials from `first` up to, but not including, `end`.
gonio::io::scratch_materials random_tables(Eigen::Index first, Eigen::Index end, const streaming_experiment& given) {
  const gonio::valid_cells cells = coarse_cells();
  gonio::io::scratch_materials scratch(given.folder);
  const std::optional<gonio::model::smooth_spectra> spectra = spectra_of(given);
  for (Eigen::Index i = first; i < end; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    const std::string name = "random-" + std::to_string(i);
    if (spectra)
      scratch.append(name, random_spectra(number, *spectra, cells, given.threads));
    else
      scratch.append(name, random_material(number, cells, given.threads));
  }
  return scratch;
}

gonio::streaming_options options_of(const streaming_experiment& given) {
  return {.components = given.components, .threads = given.threads};
}

gonio::streaming_options exact_up_to(Eigen::Index columns, const streaming_experiment& given) {
  gonio::streaming_options options = options_of(given);
  options.exact_columns = columns;
  return options;
}

// ---- time and memory ---------------------------------------------------------------------------

void print_costs(const streaming_experiment& given) {
  std::cout
      << "| materials | tables, MB | in a scratch file, MB | drawing them, s | learning, s | ms a material | peak "
         "memory, MB | found | share of the variance lost |\n|---|---|---|---|---|---|---|---|---|\n";
  for (const Eigen::Index count : given.counts) {
    const auto cost = separately([&] {
      std::array<double, 8> found{};
      gonio::io::scratch_materials scratch(given.folder);
      found[0] = seconds_of([&] { scratch = random_tables(0, count, given); });
      const gonio::material_rows rows = scratch.rows();
      found[1] = seconds_of([&] {
        const auto learned = gonio::learn_streamed_pca(rows, options_of(given));
        found[2] = learned.exact ? 1.0 : 0.0;
        found[3] = learned.prior.explained_variance();
      });
      found[4] = static_cast<double>(scratch.file_size());
      found[5] = 4.0 * static_cast<double>(rows.columns() * rows.cells.size());
      return found;
    });
    const auto& [drawing, learning, exact, kept, in_file, tables, unused, other] = cost.values;
    std::cout << "| " << count << " | " << fixed(1e-6 * tables, 0) << " | " << fixed(1e-6 * in_file, 0) << " | "
              << fixed(drawing, 1) << " | " << fixed(learning, 1) << " | "
              << fixed(1e3 * learning / static_cast<double>(count), 1) << " | " << fixed(cost.megabytes, 0) << " | "
              << (exact != 0.0 ? "by the Gram matrix" : "in a random subspace") << " | " << scientific(1.0 - kept)
              << " |\n"
              << std::flush;
  }
}

// ---- difference from the exact result ----------------------------------------------------------

/// Returns the largest difference of two matrices, relative to the second one's largest entry.
template <class A, class B>
double relative_difference(const A& a, const B& b) {
  return double{(a - b).cwiseAbs().maxCoeff()} / double{b.cwiseAbs().maxCoeff()};
}

/// Returns the residual of `others` after projection onto the span of `columns`.
Eigen::MatrixXd rest_beside(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& others) {
  const Eigen::MatrixXd unit = columns.colwise().normalized();
  const gonio::cholesky factors(gonio::product(unit.transpose(), unit));
  return others - gonio::product(unit, factors.solve(gonio::product(unit.transpose(), others)));
}

/// Returns the share of the second prior's components, by squared norm, outside the span of the first one's.
double outside(const gonio::log_relative_pca& first, const gonio::log_relative_pca& second) {
  const Eigen::MatrixXd of_second = second.components().cast<double>();
  return rest_beside(first.components().cast<double>(), of_second).squaredNorm() / of_second.squaredNorm();
}

void print_same_as_in_memory(const streaming_experiment& given) {
  const auto found = separately([&] {
    const auto expanded = gonio::expand(gonio::io::read_prior(given.prior), given.threads);
    std::vector<Eigen::Index> hundred(100);
    std::iota(hundred.begin(), hundred.end(), Eigen::Index{0});
    const auto set = expanded.subset(hundred);
    gonio::io::scratch_materials scratch(given.folder, 20u << 20);
    for (Eigen::Index m = 0; m < std::ssize(set.names); ++m) scratch.append(set.names[m], set.table(m));
    const auto streamed = gonio::learn_streamed_pca(scratch.rows(), options_of(given)).prior;
    const auto known = gonio::learn_pca(set, gonio::log_relative::to_median_of(set), given.components);
    return std::array<double, 8>{relative_difference(streamed.components(), known.components()),
                                 relative_difference(streamed.coefficients(), known.coefficients()),
                                 relative_difference(streamed.singular_values(), known.singular_values()),
                                 static_cast<double>(set.values.cols())};
  });
  const auto& values = found.values;
  std::cout << "\n100 materials of the prior that ships, expanded to " << fixed(values[3], 0)
            << " columns and streamed from a scratch file, beside `learn_pca` in\nmemory: components differ by at most "
            << scientific(values[0]) << " of the largest entry, coefficients by " << scientific(values[1])
            << ", singular values by " << scientific(values[2]) << ".\n"
            << std::flush;
}

/// Prints a row of the table: the same materials by their Gram matrix and in a random subspace.
void print_both_ways(Eigen::Index materials, const streaming_experiment& given) {
  const auto found = separately([&] {
    const gonio::material_rows rows = random_tables(0, materials, given).rows();
    std::array<double, 8> numbers{};
    std::optional<gonio::streamed_pca> exact, other;
    numbers[0] = seconds_of([&] { exact = gonio::learn_streamed_pca(rows, exact_up_to(rows.columns(), given)); });
    numbers[1] = seconds_of([&] { other = gonio::learn_streamed_pca(rows, exact_up_to(0, given)); });
    const auto squares = [](const gonio::streamed_pca& learned) { return learned.prior.singular_values().cwiseAbs2(); };
    const double variance = squares(*exact).sum() / exact->prior.explained_variance();
    numbers[2] = (squares(*exact) - squares(*other)).cwiseAbs().maxCoeff() / variance;
    numbers[3] = other->residual;
    numbers[4] = exact->prior.explained_variance() - other->prior.explained_variance();
    numbers[5] = outside(other->prior, exact->prior);
    numbers[6] = 1.0 - exact->prior.explained_variance();
    return numbers;
  });
  const auto& [exact, other, error, residual, less, beside, lost, unused] = found.values;
  std::cout << "| " << materials << " | " << 3 * materials << " | " << fixed(exact, 1) << " | " << fixed(other, 1);
  for (const double value : {error, residual, lost, less, beside}) std::cout << " | " << scientific(value);
  std::cout << " |\n" << std::flush;
}

void print_subspace_errors(const streaming_experiment& given) {
  std::cout << "\nThe random subspace (seed 1) beside the exact decomposition, as shares of the variance: by how much "
               "squared singular\nvalues are off at most, and what the residual states; what "
            << given.components
            << " components lose at least, and how much more the\nsubspace's lose. Of the exact components' variation, "
               "what is outside of those found.\n\n| materials | columns | by the Gram matrix, s | in a random "
               "subspace, s | squared singular values | stated | lost | more lost | outside "
               "|\n|---|---|---|---|---|---|---|---|---|\n";
  for (const Eigen::Index materials : given.compared) print_both_ways(materials, given);
}

/// Returns the rms residual of the materials' mapped values outside the span of a prior's components.
double left_of(const gonio::log_relative_pca& prior, const gonio::material_rows& rows) {
  const gonio::mapped_materials mapped(rows, prior.metric());
  const gonio::row_source centred = mapped.first_pass();
  gonio::row_matrix all(centred.rows, centred.columns);
  centred.read({0, centred.rows}, all);
  for (Eigen::Index cell = 0; cell < all.rows(); ++cell)
    all.row(cell).array() += double{mapped.mean()[cell]} - prior.offset(cell);
  const Eigen::MatrixXd rest = rest_beside(prior.components().cast<double>(), all);
  return std::sqrt(rest.squaredNorm() / static_cast<double>(rest.size()));
}

void print_added(const streaming_experiment& given) {
  std::cout
      << "\nA tenth of " << given.grown
      << " materials added to the prior of the others, beside all learned at once: the share of the variance that "
         "is\nlost, and the root mean square of what the components leave of the mapped values of 100 materials "
         "that none has seen.\n\n| | lost | left of unseen ones | seconds |\n|---|---|---|---|\n";
  const auto found = separately([&] {
    const Eigen::Index old_count = given.grown - given.grown / 10;
    const gonio::material_rows unseen = random_tables(1'000'000, 1'000'100, given).rows();
    const gonio::material_rows old_rows = random_tables(0, old_count, given).rows();
    const gonio::material_rows new_rows = random_tables(old_count, given.grown, given).rows();
    const gonio::material_rows all_rows = random_tables(0, given.grown, given).rows();
    const auto old = gonio::learn_streamed_pca(old_rows, options_of(given)).prior;
    const auto stored = gonio::io::read_prior(gonio::io::write_prior(old), "the prior of the others");
    const auto exactly = gonio::add_materials(old, new_rows, options_of(given)).prior;
    gonio::streamed_pca added{old}, all{old};
    const double adding = seconds_of([&] { added = gonio::add_materials(stored, new_rows, options_of(given)); });
    const double learning = seconds_of([&] { all = gonio::learn_streamed_pca(all_rows, options_of(given)); });
    const auto lost = [](const gonio::log_relative_pca& prior) { return 1.0 - prior.explained_variance(); };
    return std::array<double, 12>{lost(old),
                                  left_of(old, unseen),
                                  lost(stored),
                                  left_of(stored, unseen),
                                  lost(exactly),
                                  left_of(exactly, unseen),
                                  lost(added.prior),
                                  left_of(added.prior, unseen),
                                  lost(all.prior),
                                  left_of(all.prior, unseen),
                                  adding,
                                  learning};
  });
  const auto line = [&](const char* what, std::size_t at, const std::string& seconds) {
    std::cout << "| " << what << " | " << scientific(found.values[at]) << " | " << fixed(found.values[at + 1], 5)
              << " | " << seconds << " |\n";
  };
  line("the others", 0, "");
  line("the same, as a file of 8-bit codes", 2, "");
  line("added to the others", 4, "");
  line("added to the file", 6, fixed(found.values[10], 1));
  line("all at once", 8, fixed(found.values[11], 1));
}

void learn_streamed(const streaming_experiment& given) {
  const gonio::valid_cells cells = coarse_cells();
  std::cout << cells.size() << " cells of a grid of 45 x 30 x 36, " << given.components << " components, "
            << given.threads.resolve() << " threads";
  if (given.wavelengths > 0) std::cout << "; each material at " << given.wavelengths << " wavelengths";
  std::cout << ".\n\n";
  print_costs(given);
  if (given.wavelengths > 0) return;
  print_same_as_in_memory(given);
  print_subspace_errors(given);
  print_added(given);
}

}  // namespace

void add_streamed_learning(command& app) {
  auto command = app.add_subcommand("streamed-learning",
                                    "Time, memory and error of learning from materials that do not fit into memory");
  const auto given = std::make_shared<streaming_experiment>();
  command.add_option("--materials", given->counts, "How many synthetic materials to learn from").capture_default_str();
  command
      .add_option("--compared", given->compared,
                  "Numbers of materials for which the exact and the fast decomposition are compared")
      .check(check::range(10, 1024))
      .capture_default_str();
  command.add_option("--grown", given->grown, "Number of materials; a tenth of them is added to a prior of the others")
      .check(check::range(10, 1024))
      .capture_default_str();
  command
      .add_option(
          "--wavelengths", given->wavelengths,
          "Gives each material this number of wavelengths instead of three colours; prints only time and memory")
      .check(check::range(4, 1024));
  command.add_option("--components", given->components, "Number of components to keep")
      .check(check::positive_number())
      .capture_default_str();
  command.add_input_folder("--scratch", given->folder, {}, "Folder of the scratch file (default: the current one)");
  add_prior_option(command, given->prior);
  add_threads_option(command, given->threads);
  command.callback([given] { learn_streamed(*given); });
}

}  // namespace papers
