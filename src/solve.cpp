// The bodies of solve/.

#include <gonio/solve/impl/choose_eta.ipp>
#include <gonio/solve/impl/dense.ipp>
#include <gonio/solve/impl/gram.ipp>
#include <gonio/solve/impl/lasso.ipp>
#include <gonio/solve/impl/least_squares.ipp>
#include <gonio/solve/impl/least_squares_problem.ipp>
#include <gonio/solve/impl/levenberg_marquardt.ipp>
#include <gonio/solve/impl/linear_constraints.ipp>
#include <gonio/solve/impl/nnls_block_pivoting.ipp>
#include <gonio/solve/impl/normal_equations.ipp>
#include <gonio/solve/impl/row_source.ipp>
#include <gonio/solve/impl/solver.ipp>
#include <gonio/solve/impl/symmetric_eigen.ipp>
#include <gonio/solve/impl/tikhonov.ipp>
#include <gonio/solve/impl/truncated_svd.ipp>
