#pragma once
/// Bodies of io/measurements/spectral_samples.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/impl/samples.ipp>
#include <gonio/io/measurements/sample_rows.hpp>
#include <gonio/io/measurements/spectral_samples.hpp>
#include <gonio/io/text/text.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// Appends a row's reflectances, sr^-1, to those of the rows above.
GONIO_INLINE void append_spectrum(const parsed_row& row, const sample_directions& at, std::vector<float>& values) {
  require_quantity(row);
  const double factor = brdf_factor(row.quantity.value_or(sample_quantity::brdf), at.pair().wo);
  for (std::size_t column = row.values.first; column < row.values.first + row.values.count; ++column) {
    const double value = factor * row.numbers[column];
    if (std::abs(value) > double{std::numeric_limits<float>::max()}) refuse_beyond_float(row, column, value);
    values.push_back(static_cast<float>(value));
  }
}

/// The wavelengths of a file whose first row has been read.
[[nodiscard]] GONIO_INLINE std::vector<double> wavelengths_of(const sample_rows& rows, const std::string& name) {
  if (!rows.header().wavelengths().empty()) return rows.header().wavelengths();
  if (!rows.wavelength())
    gonio::refuse(
        {name, ": names no wavelengths, expected columns like 400nm,410nm (or one, or value and wavelength)"});
  return {*rows.wavelength()};
}

}  // namespace gonio::io::detail

namespace gonio::io {

[[gnu::cold]] GONIO_INLINE bool names_wavelengths(std::string_view text, const std::string& name,
                                                  const sample_reading& reading) {
  sample_reading silent = reading;
  silent.note = {};
  detail::sample_rows rows(text, name, true, silent);
  return rows.next() && rows.header().wavelengths().size() > 1;
}

GONIO_INLINE spectral_sample_file read_spectral_sample_file(std::string_view text, const std::string& name,
                                                            const sample_reading& reading) {
  spectral_sample_file file;
  std::vector<float> values;
  detail::sample_rows rows(text, name, true, reading);
  while (rows.next()) {
    const detail::parsed_row row = rows.row();
    if (values.empty()) file.samples.wavelengths = detail::wavelengths_of(rows, name);
    file.samples.directions.push_back(detail::row_directions(row));
    detail::append_spectrum(row, file.samples.directions.back(), values);
    if (row.weights.count > 1)
      row.place.refuse("wavelengths have one weight, expected weight, not one for each channel");
    file.samples.weights.push_back(row.numbers[row.weights.first]);
  }
  file.samples.values = Eigen::Map<const cell_matrix>(values.data(), file.samples.size(), file.samples.bands());
  file.quantity = rows.quantity();
  file.provenance = rows.provenance();
  return file;
}

[[gnu::cold]] GONIO_INLINE spectral_sample_file read_spectral_sample_file(const std::filesystem::path& path,
                                                                          const sample_reading& reading) {
  const auto bytes = read_bytes(path);
  return read_spectral_sample_file(as_text(bytes), path.native(), reading);
}

[[gnu::cold]] GONIO_INLINE std::string write_spectral_samples(const spectral_samples& samples,
                                                              const sample_provenance& provenance) {
  std::string text = message_of({comment_lines(provenance), "# quantity: brdf\ntheta_h,theta_d,phi_d,"});
  for (const double wavelength : samples.wavelengths) text += message_of({shortest(wavelength), "nm,"});
  text += "weight\n";
  for (Eigen::Index i = 0; i < samples.size(); ++i) {
    const half_difference& at = samples.directions[i].angles();
    for (const double angle : {at.theta_h, at.theta_d, fold_phi_d(at.phi_d)})
      text += message_of({shortest(degrees(angle)), ","});
    for (const float value : samples.spectrum(i)) text += message_of({shortest(double{value}), ","});
    text += message_of({shortest(samples.weight(i)), "\n"});
  }
  return text;
}

[[gnu::cold]] GONIO_INLINE void write_spectral_samples(const std::filesystem::path& path,
                                                       const spectral_samples& samples,
                                                       const sample_provenance& provenance) {
  try {
    require_usable(samples);
  } catch (const error& unusable) {
    gonio::refuse({path.native(), ": ", unusable.what()});
  }
  detail::write_text(path, write_spectral_samples(samples, provenance));
}

}  // namespace gonio::io
