#pragma once
/// Measurements as CSV: a header line names the columns, in any order; each further line is a sample.
/// Directions are `theta_h,theta_d,phi_d` or `theta_i,phi_i,theta_o,phi_o` in degrees, or unit vectors
/// `wi_x,wi_y,wi_z,wo_x,wo_y,wo_z` (normal +z); the reflectance is `r,g,b` in sr^-1 without the cosine, or `value`, one
/// channel of a `quantity`, or columns that are called by their wavelengths, `400nm,410nm,...`, of a `quantity`, as
/// spectrophotometers write them; a `weight`, or one for each colour, is optional. Separator and decimal mark are told
/// from the file (io/text/csv_dialect.hpp), and what the numbers are from `# quantity: ...`
/// (io/measurements/sample_quantity.hpp). A name may be in letters of either case, with a unit behind it.
/// docs/reference/formats.md has all of it.

#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/measurements/sample_header.hpp>
#include <gonio/io/measurements/sample_provenance.hpp>
#include <gonio/io/measurements/sample_quantity.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

/// Samples, and what their file says of them.
struct sample_file {
  sample_set samples = {};                       ///< sr^-1, whatever quantity the file has
  std::optional<sample_quantity> quantity = {};  ///< as stated in the file or by its reader; r,g,b need none
  std::optional<theta_o_sign> sign = {};         ///< as stated in the file or by its reader
  sample_provenance provenance = {};
};

/// Samples from the text of a CSV file; `name` is what errors call it.
[[nodiscard]] sample_file read_sample_file(std::string_view text, const std::string& name,
                                           const sample_reading& reading = {});
[[nodiscard]] sample_set read_samples(std::string_view text, const std::string& name,
                                      const sample_reading& reading = {});

/// Does the text have no column of values? Throws gonio::error for a header line or a first line of numbers that
/// `read_directions` refuses.
[[nodiscard]] bool has_directions_alone(std::string_view text, const std::string& name,
                                        const sample_reading& reading = {});

/// Reads measurements. Throws gonio::error naming file, line, column and value of what is wrong, also if neither file
/// nor `reading` say what the numbers of `value` are. What is ignored or assumed goes to `reading.note`.
[[nodiscard]] sample_file read_sample_file(const std::filesystem::path& path, const sample_reading& reading = {});
[[nodiscard]] sample_set read_samples(const std::filesystem::path& path, const sample_reading& reading = {});

/// Reads directions alone; the file may have columns of reflectance and weights, which are checked and left out.
[[nodiscard]] std::vector<half_difference> read_directions(std::string_view text, const std::string& name,
                                                           const sample_reading& reading = {});
[[nodiscard]] std::vector<half_difference> read_directions(const std::filesystem::path& path,
                                                           const sample_reading& reading = {});

/// Reads the same files as pairs, in which light and viewer are told apart.
[[nodiscard]] std::vector<direction_pair> read_direction_pairs(std::string_view text, const std::string& name,
                                                               const sample_reading& reading = {});
[[nodiscard]] std::vector<direction_pair> read_direction_pairs(const std::filesystem::path& path,
                                                               const sample_reading& reading = {});

/// Writes pairs as `theta_i,phi_i,theta_o,phi_o`, rounded to 1e-9 degrees.
void write_direction_pairs(const std::filesystem::path& path, std::span<const direction_pair> pairs);

/// Samples as CSV text, every number in the fewest digits that read back as the same number. The columns are
/// `theta_h,theta_d,phi_d`, then `r,g,b`, or `value` or a column for each wavelength below `# quantity: brdf`, then
/// `weight`, or `weight_r,weight_g,weight_b` if a sample counts more in one colour than in another. Where they come
/// from stands above, in comment lines.
[[nodiscard]] std::string write_samples(const sample_set& samples, const sample_provenance& provenance = {});

/// Writes measurements. Throws gonio::error if a sample is unusable, before anything is written.
void write_samples(const std::filesystem::path& path, const sample_set& samples,
                   const sample_provenance& provenance = {});

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/samples.ipp>
#endif
