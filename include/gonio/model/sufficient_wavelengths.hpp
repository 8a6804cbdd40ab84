#pragma once
/// Finds the wavelengths of a spectral table that suffice for readers that interpolate linearly, as renderers do:
/// `sufficient_wavelengths(table)`.
///
/// From each chosen wavelength, the search continues with the farthest possible wavelength: Imai and Iri,
/// "Computational-geometric methods for polygonal approximations of a curve" (1986, doi:10.1016/S0734-189X(86)80027-5),
/// for the curves of all cells at once.

#include <gonio/core/parallel.hpp>
#include <gonio/model/tabulate_adaptively.hpp>
#include <gonio/table/spectral_table.hpp>

#include <Eigen/Core>

#include <vector>

namespace gonio::model {

/// Returns the indices of a table's wavelengths that suffice. At every other wavelength, the relative error of linear
/// interpolation is at most `tolerance`
/// - for the albedo at 0, 20, 40, 60 and 80 degrees of wi;
/// - for f cos(theta_i) cos(theta_o) at each cell, relative to this value or to a tenth of albedo / pi at 0 degrees,
///   whichever is larger. Without the cosines, grazing cells would determine the result, because a reconstruction
///   divides their values by almost zero.
///
/// The result includes the first and last wavelength, and the first and last visible one. If the tolerance is 0, it
/// includes all. Throws gonio::error for a tolerance below 0. O(values).
[[nodiscard]] std::vector<Eigen::Index> sufficient_wavelengths(const spectral_table& table,
                                                               double tolerance = usual_albedo_tolerance,
                                                               thread_count threads = {});

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/sufficient_wavelengths.ipp>
#endif
