#pragma once
/// Which wavelengths of a spectral table suffice for readers that interpolate linearly between them, as renderers do:
/// `sufficient_wavelengths(table)`.
///
/// From each of them on to the farthest that is possible: Imai and Iri, "Computational-geometric methods for polygonal
/// approximations of a curve" (1986, doi:10.1016/S0734-189X(86)80027-5), the curves of all cells at once.

#include <gonio/core/parallel.hpp>
#include <gonio/model/tabulate_adaptively.hpp>
#include <gonio/table/spectral_table.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio::model {

/// Positions of those wavelengths of a table from which all its values follow. At each of the others, what is linear
/// between them is off by at most `tolerance`
/// - of the albedo at 0, 20, 40, 60 and 80 degrees of wi, relative to it;
/// - of each cell's value times both cosines, relative to it, or to a tenth of what a diffuser with the albedo of 0
///   degrees has there: at grazing angles a reconstruction divides what nobody measured by almost nothing.
///
/// Among them are the first and the last, and of those that are visible the first and the last; if the tolerance is 0,
/// all. Throws gonio::error for a tolerance below 0. O(values).
[[nodiscard]] std::vector<Eigen::Index> sufficient_wavelengths(const spectral_table& table,
                                                               double tolerance = usual_albedo_tolerance,
                                                               thread_count threads = {});

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/sufficient_wavelengths.ipp>
#endif
