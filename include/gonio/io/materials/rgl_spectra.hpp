#pragma once
/// Spectra in files of the RGL material database (io/materials/rgl.hpp): writes a spectral table, and reads spectra in
/// any directions.

#include <gonio/core/parallel.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/model/tabulate_adaptively.hpp>
#include <gonio/table/sample_set.hpp>
#include <gonio/table/spectral_table.hpp>

#include <span>
#include <string>
#include <vector>

namespace gonio::io {

/// Returns a spectral table as the spectral variant of a material, for `write_rgl`. pbrt-v4 and Mitsuba's spectral
/// variants interpolate linearly between wavelengths. The material therefore keeps only the wavelengths that suffice
/// within `tolerance` (`model::sufficient_wavelengths`). Throws gonio::error for fewer than two wavelengths. Costs one
/// `model::tabulate_adaptively`, and one `model::tabulate_over` for each three wavelengths.
[[nodiscard]] rgl_material tabulate_adaptively(const spectral_table& table,
                                               double tolerance = model::usual_albedo_tolerance,
                                               const std::string& description = "gonio", thread_count threads = {});

/// Returns the spectra at other wavelengths, in nanometres, by linear interpolation as in renderers. Throws
/// gonio::error for wavelengths that are invalid or outside the range of `spectra`. O(values).
[[nodiscard]] rgl_spectra at_wavelengths(const rgl_spectra& spectra, std::vector<double> wavelengths);

/// Returns the spectra of a material over the valid cells of a grid. Throws gonio::error for a material in RGB and for
/// an anisotropic one. Costs a `tabulate` for each three wavelengths.
[[nodiscard]] spectral_table tabulate_spectra(const rgl_material& material, const valid_cells& cells,
                                              thread_count threads = {});

/// Returns the spectra of a material in some directions, as measurements. Throws gonio::error for a material in RGB,
/// and for directions at or below the horizon.
[[nodiscard]] sample_set sample_spectra(const rgl_material& material, std::span<const sample_directions> directions);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/materials/impl/rgl_spectra.ipp>
#endif
