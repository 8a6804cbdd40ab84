#pragma once
/// Measurements as CSV: a header line names the columns, in any order; each further line is a sample. Directions are
/// `theta_h,theta_d,phi_d` or `theta_i,phi_i,theta_o,phi_o` in degrees, or unit vectors `wi_x,wi_y,wi_z,wo_x,wo_y,wo_z`
/// (normal +z). The reflectance is `r,g,b` in sr^-1 without the cosine; `value`, one channel of a `quantity`; or
/// columns named by wavelength, `400nm,410nm,...`, of a `quantity`, as spectrophotometers write them. A `weight`, or
/// one for each colour, is optional. Separator and decimal mark are found from the file (io/text/csv_dialect.hpp), the
/// quantity from `# quantity: ...` (io/measurements/sample_quantity.hpp). Names may have any case and a unit.
/// docs/reference/formats.md describes all of it.

#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/measurements/sample_header.hpp>
#include <gonio/io/measurements/sample_provenance.hpp>
#include <gonio/io/measurements/sample_quantity.hpp>
#include <gonio/table/sample_set.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

/// How `read_sample_file` read a text.
struct sample_text {
  std::string dialect = {};             ///< "semicolon-separated with decimal commas"
  std::vector<std::size_t> lines = {};  ///< the line of each sample, from 1
  std::size_t omitted_rows = 0;         ///< rows, or cells of a matrix, without a value or at 90 degrees
  bool assumes_side = false;            ///< theta_o is assumed positive on the light's side: its sign is not stated
};

/// Samples and the statements of their file.
struct sample_file {
  sample_set samples = {};                       ///< sr^-1, whatever the file's quantity
  std::optional<sample_quantity> quantity = {};  ///< stated by the file or the caller; r,g,b need none
  std::optional<theta_o_sign> sign = {};         ///< stated by the file or the caller
  sample_provenance provenance = {};
  sample_text text = {};  ///< empty for a file in another format
};

/// Reads samples from the text of a CSV file. Errors call the file `name`.
[[nodiscard]] sample_file read_sample_file(std::string_view text, const std::string& name,
                                           const sample_reading& reading = {});
[[nodiscard]] sample_set read_samples(std::string_view text, const std::string& name,
                                      const sample_reading& reading = {});

/// Does the text have no column of values? Throws gonio::error for a header line or a first line of numbers that
/// `read_directions` refuses.
[[nodiscard]] bool has_directions_alone(std::string_view text, const std::string& name,
                                        const sample_reading& reading = {});

/// Reads measurements. Throws gonio::error naming the file, line, column and value of a fault, and if neither the file
/// nor `reading` states the quantity of `value`. `reading.note` receives sentences on ignored columns and on
/// assumptions.
[[nodiscard]] sample_file read_sample_file(const std::filesystem::path& path, const sample_reading& reading = {});
[[nodiscard]] sample_set read_samples(const std::filesystem::path& path, const sample_reading& reading = {});

/// Reads only directions; columns of reflectance and weights are checked and ignored.
[[nodiscard]] std::vector<half_difference> read_directions(std::string_view text, const std::string& name,
                                                           const sample_reading& reading = {});
[[nodiscard]] std::vector<half_difference> read_directions(const std::filesystem::path& path,
                                                           const sample_reading& reading = {});

/// Reads only directions, as pairs, which distinguish light and viewer.
[[nodiscard]] std::vector<direction_pair> read_direction_pairs(std::string_view text, const std::string& name,
                                                               const sample_reading& reading = {});
[[nodiscard]] std::vector<direction_pair> read_direction_pairs(const std::filesystem::path& path,
                                                               const sample_reading& reading = {});

/// Writes pairs as `theta_i,phi_i,theta_o,phi_o`, rounded to 1e-9 degrees.
void write_direction_pairs(const std::filesystem::path& path, std::span<const direction_pair> pairs);

/// The columns of directions in a written file.
enum class direction_columns {
  half_difference,  ///< theta_h,theta_d,phi_d
  pairs             ///< theta_i,phi_i,theta_o,phi_o: also the azimuths, for anisotropic materials; to 1e-9 degrees
};

/// Returns samples as CSV text, every number in the fewest digits that read back as the same number. The columns are
/// those of the directions, then `r,g,b`, `value` or a column for each wavelength, then `weight`, or
/// `weight_r,weight_g,weight_b` if a sample has different weights for its colours, then both half angles if a sample
/// has a cone. Comment lines above state the provenance and, except for `r,g,b`, the quantity (brdf).
[[nodiscard]] std::string write_samples(const sample_set& samples, const sample_provenance& provenance = {},
                                        direction_columns columns = direction_columns::half_difference);

/// Writes measurements. If a sample is unusable, throws gonio::error before anything is written.
void write_samples(const std::filesystem::path& path, const sample_set& samples,
                   const sample_provenance& provenance = {},
                   direction_columns columns = direction_columns::half_difference);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/samples.ipp>
#endif
