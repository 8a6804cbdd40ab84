#pragma once
/// The linear assignment problem: pairs two sets at the least total cost by the Hungarian method (Kuhn, Naval Research
/// Logistics Quarterly 2, 1955, doi:10.1002/nav.3800020109) in O(n^3). Uses dlib, so programs that include this file
/// must link it; docs/decisions/0011-assignment.md gives the reasons.

#include <Eigen/Core>

#include <vector>

namespace gonio::shape {

/// Returns the column assigned to each row, each column at most once, with the least total cost. Makes as many pairs as
/// the shorter side has; the remaining rows get -1. Costs of any sign are rounded to 2^-40 of their range, so the sum
/// is within n / 2^40 of the range of the minimum. O(n^3) for the longer side n: 7 ms for 300, 0.1 s for 1000.
///
/// Throws gonio::error for a cost that is not finite.
[[nodiscard]] std::vector<Eigen::Index> optimal_assignment(const Eigen::MatrixXd& costs);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/assignment.ipp>
#endif
