#pragma once
/// The linear assignment problem: pairs the elements of two sets at the least total cost by the Hungarian method (Kuhn,
/// Naval Research Logistics Quarterly 2, 1955, doi:10.1002/nav.3800020109). Programs that include this file must link
/// dlib; docs/decisions/0011-assignment.md gives the reasons.

#include <Eigen/Core>

#include <vector>

namespace gonio::shape {

/// Returns the column assigned to each row, or -1, at the least total cost. Assigns each column at most once, and as
/// many as the smaller dimension of `costs`. Rounds costs, of any sign, to 2^-40 of their range. The total therefore
/// exceeds the minimum by at most n / 2^40 of that range, where n is the larger dimension. O(n^3): 7 ms for n = 300,
/// 0.1 s for n = 1000.
///
/// Throws gonio::error for a cost that is not finite.
[[nodiscard]] std::vector<Eigen::Index> optimal_assignment(const Eigen::MatrixXd& costs);

}  // namespace gonio::shape

#if !defined(GONIO_COMPILED)
#include <gonio/shape/impl/assignment.ipp>
#endif
