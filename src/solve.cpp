// The bodies of solve/ except those in solve_dense.cpp and solve_orthogonal.cpp.

#include <gonio/solve/impl/choose_eta.ipp>
#include <gonio/solve/impl/dual_active_set.ipp>
#include <gonio/solve/impl/growing_cholesky.ipp>
#include <gonio/solve/impl/householder_qr.ipp>
#include <gonio/solve/impl/kkt.ipp>
#include <gonio/solve/impl/lasso.ipp>
#include <gonio/solve/impl/leading_eigenpairs.ipp>
#include <gonio/solve/impl/least_squares_problem.ipp>
#include <gonio/solve/impl/levenberg_marquardt.ipp>
#include <gonio/solve/impl/linear_constraints.ipp>
#include <gonio/solve/impl/nnls.ipp>
#include <gonio/solve/impl/normal_equations.ipp>
#include <gonio/solve/impl/quadratic_program.ipp>
#include <gonio/solve/impl/row_active_set.ipp>
#include <gonio/solve/impl/row_equations.ipp>
#include <gonio/solve/impl/row_groups.ipp>
#include <gonio/solve/impl/row_source.ipp>
#include <gonio/solve/impl/scaled_program.ipp>
#include <gonio/solve/impl/signed_solution.ipp>
#include <gonio/solve/impl/solver.ipp>
#include <gonio/solve/impl/tikhonov.ipp>
#include <gonio/solve/impl/working_set.ipp>

namespace gonio {

template class basic_lasso<sign_rule::any>;
template class basic_lasso<sign_rule::non_negative>;
template solution basic_lasso<sign_rule::any>::solve_any(const least_squares_problem&) const;
template solution basic_lasso<sign_rule::any>::solve_any(const normal_equations&) const;
template solution basic_lasso<sign_rule::non_negative>::solve_any(const least_squares_problem&) const;
template solution basic_lasso<sign_rule::non_negative>::solve_any(const normal_equations&) const;

}  // namespace gonio
