#pragma once
/// Measurements of spectra as CSV: the files of io/measurements/samples.hpp whose columns of reflectance are called by
/// their wavelengths, as spectrophotometers write them: `theta_i,phi_i,theta_o,phi_o,400nm,410nm,...`. The quantity
/// must be stated. A file of one wavelength, `633nm` or `value` beside a column `wavelength`, is read, too.

#include <gonio/io/measurements/sample_header.hpp>
#include <gonio/io/measurements/sample_provenance.hpp>
#include <gonio/io/measurements/sample_quantity.hpp>
#include <gonio/table/spectral_samples.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace gonio::io {

/// Samples, and what their file says of them.
struct spectral_sample_file {
  spectral_samples samples = {};                 ///< sr^-1, whatever quantity the file has
  std::optional<sample_quantity> quantity = {};  ///< as stated in the file or by its reader
  sample_provenance provenance = {};
};

/// Does the text of a CSV file of samples name two wavelengths or more in its header line? Throws gonio::error for a
/// header line or a first sample that `read_samples` refuses.
[[nodiscard]] bool names_wavelengths(std::string_view text, const std::string& name,
                                     const sample_reading& reading = {});

/// Samples from the text of a CSV file; `name` is what errors call it. Throws gonio::error naming line, column and
/// value of what is wrong, and for a file without wavelengths.
[[nodiscard]] spectral_sample_file read_spectral_sample_file(std::string_view text, const std::string& name,
                                                             const sample_reading& reading = {});

/// Reads such a file.
[[nodiscard]] spectral_sample_file read_spectral_sample_file(const std::filesystem::path& path,
                                                             const sample_reading& reading = {});

/// Samples as CSV text: `theta_h,theta_d,phi_d`, a column for each wavelength, `weight`, below `# quantity: brdf`.
/// Every number is in the fewest digits that read back as the same number.
[[nodiscard]] std::string write_spectral_samples(const spectral_samples& samples,
                                                 const sample_provenance& provenance = {});

/// Writes such a file beside its target and renames it. Throws gonio::error if a sample is unusable, before anything is
/// written.
void write_spectral_samples(const std::filesystem::path& path, const spectral_samples& samples,
                            const sample_provenance& provenance = {});

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/spectral_samples.ipp>
#endif
