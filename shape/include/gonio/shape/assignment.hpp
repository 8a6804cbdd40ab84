#pragma once
/// Which of two sets belong together at the least total cost: the linear assignment problem, solved by the Hungarian
/// method (Kuhn, Naval Research Logistics Quarterly 2, 1955, doi:10.1002/nav.3800020109) as dlib has it, in O(n^3).
/// Programs that include this link dlib; docs/decisions/0011-assignment.md says why.

#include <Eigen/Core>

#include <vector>

namespace gonio::shape {

/// For each row the column it is assigned to, no column twice, such that the costs of all assigned pairs have the least
/// sum. As many pairs are made as the shorter side has; rows beyond the number of columns are assigned to -1. Costs of
/// any sign are rounded to a 2^40th of their range, so that the sum is within n / 2^40 of the range of the least one.
/// The time is O(n^3) for the longer side n: 7 ms for 300, 0.1 s for 1000.
///
/// Throws gonio::error for a cost that is not finite.
[[nodiscard]] std::vector<Eigen::Index> optimal_assignment(const Eigen::MatrixXd& costs);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/assignment.ipp>
#endif
