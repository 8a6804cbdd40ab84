#pragma once
/// The command line's choice of a solver: `--solver` and each solver's options.

#include "command.hpp"
#include <gonio/solve/any_solver.hpp>

#include <string>

namespace cli {

struct solver_choice {
  std::string name;  ///< empty: the method's own
  std::string eta;   ///< a number, gcv or loo; empty: the method's own
  double lambda = 0.001;
  double variance = 0.99;
};

/// Adds `--solver`, `--eta`, `--lambda` and `--variance`.
void add_solver_options(command& to, solver_choice& choice);

/// Returns `--eta` as a number. Throws gonio::error unless it is a number.
[[nodiscard]] double number_of_eta(const std::string& text);

/// Returns the chosen solver; `own` has the defaults. Throws gonio::error if an option's value is impossible.
[[nodiscard]] gonio::any_solver make_solver(solver_choice choice, const solver_choice& own);

}  // namespace cli
