#include "measurement_files.hpp"

#include "file_kinds.hpp"
#include "file_start.hpp"
#include "measurement_kinds.hpp"
#include "tool/pages/sample_warnings.hpp"
#include "tool/pages/warning.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

namespace cli {

namespace {

/// Appends the entries of "theta_o=Winkel,g=Y".
void add_columns(const std::string& list, std::vector<gonio::io::column_name>& columns) {
  std::vector<std::string_view> entries;
  gonio::io::split_fields(list, entries);
  for (const std::string_view entry : entries) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == entry.size())
      gonio::refuse({"--columns ", list, ": '", entry, "' is no pair of names, expected one like theta_o=Winkel"});
    columns.push_back({std::string(entry.substr(0, equals)), std::string(entry.substr(equals + 1))});
  }
}

/// Spectra become colours under D65.
gonio::io::sample_file read_csv(const std::filesystem::path& path, const gonio::io::sample_reading& reading) {
  const std::vector<std::byte> bytes = gonio::io::read_bytes(path);
  const std::string_view text = gonio::io::as_text(bytes);
  if (!gonio::io::names_wavelengths(text, path.native(), reading))
    return gonio::io::read_sample_file(text, path.native(), reading);
  return as_colours(path, gonio::io::read_spectral_sample_file(text, path.native(), reading), gonio::illuminant::d65);
}

}  // namespace

gonio::io::sample_reading reading_of(const measurement_options& options) {
  gonio::io::sample_reading reading{.columns = {}, .quantity = {}, .note = warn};
  for (const std::string& list : options.columns) add_columns(list, reading.columns);
  if (!options.quantity.empty()) reading.quantity = gonio::io::quantity_named(options.quantity);
  return reading;
}

void add_measurement_options(command& to, measurement_options& options) {
  const auto& names = gonio::io::sample_quantity_names;
  to.add_option("--quantity", options.quantity,
                "What the numbers of a .csv file of samples are: brdf (sr^-1), brdf-cosine (times the cosine of the "
                "viewer's angle), reflectance-factor (1 is white) or percent (100 is white); needed for a column "
                "value, or columns of wavelengths, "
                "whose file does not say it")
      .check(check::one_of(std::vector<std::string>(names.begin(), names.end())));
  to.add_option("--columns", options.columns, "What a .csv file of samples calls its columns: theta_o=Winkel,g=Y")
      .repeatable();
}

bool holds_measurements(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 3> extensions{".csv", ".tsv", ".txt"};
  return std::ranges::find(extensions, lower_extension(path)) != extensions.end() ||
         measurement_kind_of(path) != nullptr;
}

void require_unused(const measurement_options& options, const std::filesystem::path& path) {
  if (!options.empty()) gonio::refuse({path.native(), ": --quantity and --columns need a .csv file of samples"});
}

gonio::io::sample_file read_measurement_file(const std::filesystem::path& path, const measurement_options& options) {
  gonio::io::sample_file file;
  if (options.light) {
    file = as_colours(path, read_spectra_file(path, options), *options.light);
  } else if (const measurement_kind* kind = measurement_kind_of(path)) {
    require_unused(options, path);  // such a file says what its values are
    file.samples = kind->read(path);
  } else {
    file = read_csv(path, reading_of(options));
  }
  tell_doubts(path, file);
  return file;
}

void tell_doubts(const std::filesystem::path& path, const gonio::io::sample_file& file) {
  for (const std::string& sentence : doubts_of(file)) warn(path.native() + ": " + sentence);
}

gonio::io::spectral_sample_file read_spectra_file(const std::filesystem::path& path,
                                                  const measurement_options& options) {
  const measurement_kind* kind = measurement_kind_of(path);
  if (kind == nullptr) return gonio::io::read_spectral_sample_file(path, reading_of(options));
  require_unused(options, path);
  if (kind->read_spectra == nullptr)
    gonio::refuse({path.native(), ": --spectra and --illuminant need reflectance at wavelengths, which files of ",
                   kind->name, " do not hold"});
  return {kind->read_spectra(path), {}, {}};
}

bool names_wavelengths(const std::filesystem::path& path, const measurement_options& options) {
  if (options.light) return false;
  if (const measurement_kind* kind = measurement_kind_of(path)) {
    if (kind->read_spectra == nullptr) return false;
    try {
      return kind->read_spectra(path).bands() > 1;
    } catch (const gonio::error&) {
      return false;  // a file of the kind without wavelengths, or one that its reader refuses anyhow
    }
  }
  const std::vector<std::byte> bytes = gonio::io::read_bytes(path);
  return gonio::io::names_wavelengths(gonio::io::as_text(bytes), path.native(), reading_of(options));
}

gonio::io::sample_file as_colours(const std::filesystem::path& path, const gonio::io::spectral_sample_file& file,
                                  gonio::illuminant light) {
  const std::vector<double>& wavelengths = file.samples.wavelengths;
  if (wavelengths.size() > 1 && std::ranges::none_of(wavelengths, gonio::is_visible))
    gonio::refuse({path.native(), ": its wavelengths, ", std::lround(wavelengths.front()), " to ",
                   std::lround(wavelengths.back()),
                   " nm, are invisible and have no colour: gonio check and gonio reconstruct -o FILE.bsdf take them"});
  std::optional<double> wavelength;
  if (file.samples.bands() == 1) wavelength = file.samples.wavelengths.front();
  return {file.samples.colours(light), file.quantity, wavelength, file.provenance};
}

gonio::sample_set read_measurements(const std::filesystem::path& path, const measurement_options& options) {
  return read_measurement_file(path, options).samples;
}

json facts_of(const gonio::io::sample_file& file) {
  json facts = json::object();
  if (file.quantity) facts["quantity"] = name_of(*file.quantity);
  if (file.wavelength) facts["wavelength_nm"] = *file.wavelength;
  const auto& [instrument, date, conditions] = file.provenance;
  if (!instrument.empty()) facts["instrument"] = instrument;
  if (!date.empty()) facts["date"] = date;
  if (!conditions.empty()) facts["conditions"] = conditions;
  return facts;
}

void write_table(const std::filesystem::path& path, const gonio::brdf_table& table) { write_file(path, table); }

}  // namespace cli
