#pragma once
/// Quadratic programs of a sequence, each solved from the active set of the one before: how warm starts are tested.

#include <gonio/solve/quadratic_program.hpp>

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace gonio {

/// The same for a sequence of problems that differ little: each starts from the constraints that were active in the one
/// before, right-hand side by right-hand side. Not thread safe.
template <constraint_policy Constraints = non_negative_weights>
class online_quadratic_program {
 public:
  static constexpr bool non_negative = promises_non_negative<Constraints>;

  online_quadratic_program() = default;
  explicit online_quadratic_program(Constraints constraints) : constraints_(std::move(constraints)) {}

  /// As `quadratic_program::solve`, and with its results. A problem of another size starts afresh.
  [[nodiscard]] solution solve(const least_squares_problem& problem) { return solve_any(problem); }
  [[nodiscard]] solution solve(const normal_equations& normal) { return solve_any(normal); }

  /// The next problem starts afresh.
  void forget() noexcept { active_.clear(); }

 private:
  template <quadratic_problem Problem>
  [[nodiscard]] solution solve_any(const Problem& problem) {
    const normal_equations& normal = problem.normal();
    const linear_constraints constraints = detail::constraints_for(constraints_, normal.unknowns());
    forget_unless_sized(normal, constraints);
    return detail::solve_program(problem, constraints, [&](const auto& solver, Eigen::Index column) {
      auto& last = active_[column];
      const program_optimum found = solver.solve(column, last ? &*last : nullptr);
      last = found.active;
      return found;
    });
  }

  void forget_unless_sized(const normal_equations& normal, const linear_constraints& constraints) {
    const std::size_t bounds = normal.unknowns(), rows = constraints.d.size();
    if (!active_.empty() && active_.front() &&
        (active_.front()->bounds.size() != bounds || active_.front()->rows.size() != rows))
      active_.clear();
    active_.resize(normal.right_hand_sides());
  }

  Constraints constraints_;
  std::vector<std::optional<active_constraints>> active_;
};

}  // namespace gonio
