#pragma once
/// The least-squares problems of fitting measurements by a basis.
/// Nielsen et al. 2015 (doi:10.1145/2816795.2818085), Eq. 9; Noell, Koehler and Stricker 2014, Eq. 7.

#include <gonio/basis/pca.hpp>
#include <gonio/estimate/map_samples.hpp>
#include <gonio/solve/solver.hpp>

#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#if defined(GONIO_COMPILED)  // decompositions by measured materials are compiled in gonio::compiled
#include <gonio/basis/measured.hpp>
#endif

namespace gonio {

/// The least-squares systems of measurements in a basis. Row i of a system is the basis interpolated at measurement i.
/// Its right-hand side is the mapped value minus the basis' offset at this measurement. The measurement's weight
/// multiplies the squared error. Channels with the same basis and weights share one system, with a right-hand side for
/// each channel. Rows are read from the basis block by block and never copied as a whole.
template <colour_basis Basis>
class basis_equations {
 public:
  basis_equations(Basis functions, located_samples samples, thread_count threads = {})
      : basis_equations(of_mapped(functions, map_samples(functions, std::move(samples), threads), threads)) {}

  /// Makes the equations of samples that `map_samples` has already mapped.
  [[nodiscard]] static basis_equations of_mapped(Basis functions, located_samples mapped, thread_count threads = {}) {
    return {mapped_already{}, std::move(functions), std::move(mapped), threads};
  }

  /// Returns the number of systems: one if all channels have the same basis and weights, otherwise one for each
  /// channel.
  [[nodiscard]] Eigen::Index systems() const noexcept {
    return basis<Basis> && !measured_->weighs_channels_apart() ? 1 : channels();
  }

  /// Returns the system of one channel or, if there is only one system, the system of all channels. Its unknowns are
  /// the weights of all functions of the basis.
  [[nodiscard]] least_squares_problem problem(Eigen::Index system = 0) const;

  [[nodiscard]] std::vector<least_squares_problem> problems() const {
    std::vector<least_squares_problem> all;
    for (Eigen::Index system = 0; system < systems(); ++system) all.push_back(problem(system));
    return all;
  }

  /// Returns the weights of all functions, size() x channels. The solver is called once for each system, in parallel.
  /// Functions that the basis leaves out have weight zero.
  template <solver Solver>
  [[nodiscard]] solution solve(const Solver& solver) const {
    return solve_each([&](const least_squares_problem& problem) { return solver.solve(problem); });
  }

 private:
  struct mapped_already {};
  using solve_function = std::function<solution(const least_squares_problem&)>;

  basis_equations(mapped_already, Basis functions, located_samples mapped, thread_count threads)
      : basis_(std::move(functions)),
        measured_(std::make_shared<const located_samples>(std::move(mapped))),
        threads_(threads) {}

  [[nodiscard]] solution solve_each(const solve_function& solve_one) const;

  [[nodiscard]] Eigen::Index channels() const noexcept { return measured_->values.cols(); }

  Basis basis_;
  std::shared_ptr<const located_samples> measured_;  // mapped
  thread_count threads_;
};

template <colour_basis Basis>
least_squares_problem basis_equations<Basis>::problem(Eigen::Index system) const {
  const auto functions = channel_of(basis_, system);  // a copy, which the problem keeps
  const std::shared_ptr<const located_samples> measured = measured_;
  const row_source rows{std::ssize(measured->locations), Eigen::Index(functions.size()),
                        [functions, measured](block range, row_block out) {
                          const std::span<const location> all = measured->locations;
                          read_rows_at(functions, all.subspan(range.begin, range.size()), out);
                        }};
  Eigen::MatrixXd right = systems() == 1 ? measured->values : Eigen::MatrixXd(measured->values.col(system));
  return {rows, std::move(right), measured->weights_of(system), threads_};
}

template <colour_basis Basis>
solution basis_equations<Basis>::solve_each(const solve_function& solve_one) const {
  const std::vector<Eigen::Index> columns = columns_of(basis_);
  const Eigen::Index unknowns = basis_.size();
  std::vector<solution> found(systems());
  for_each_block(
      found.size(), 1,
      [&](block system) {
        const least_squares_problem whole = problem(system.begin);
        const bool all = std::ssize(columns) == unknowns;
        found[system.begin] = solve_one(all ? whole : whole.subset(columns));
      },
      threads_);
  return scatter_columns(concatenate_columns(found), columns, unknowns);
}

#if defined(GONIO_COMPILED)
extern template class basis_equations<log_relative_pca>;
extern template class basis_equations<measured<log>>;
#endif

}  // namespace gonio
