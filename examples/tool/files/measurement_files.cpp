#include "measurement_files.hpp"

#include "file_kinds.hpp"
#include "file_start.hpp"
#include "measurement_kinds.hpp"
#include "tool/pages/elapsed_time.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/sample_warnings.hpp"
#include "tool/pages/warning.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/model/measured_properties.hpp>
#include <gonio/table/viewer_side.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

namespace cli {

namespace {

/// Returns the light's azimuth to a tenth of a degree; nothing if the light is within 0.1 degrees of the normal.
std::optional<double> rotation_of(const gonio::direction_pair& pair) {
  constexpr double least_incidence = 0.1;
  if (gonio::degrees(gonio::polar_angle(pair.wi)) < least_incidence) return {};
  const double azimuth = std::round(10.0 * gonio::degrees(gonio::azimuth(pair.wi))) / 10.0;
  return azimuth < 0.0 ? azimuth + 360.0 : azimuth + 0.0;
}

/// Appends the entries of "theta_o=Winkel,g=Y".
void add_columns(const std::string& list, std::vector<gonio::io::column_name>& columns) {
  std::vector<std::string_view> entries;
  gonio::io::split_fields(list, entries);
  for (const std::string_view entry : entries) {
    const std::size_t equals = entry.find('=');
    if (equals == std::string_view::npos || equals == 0 || equals + 1 == entry.size())
      gonio::refuse({"--columns ", list, ": '", entry, "' is not a pair of names, expected one like theta_o=Winkel"});
    columns.push_back({std::string(entry.substr(0, equals)), std::string(entry.substr(equals + 1))});
  }
}

constexpr std::size_t most_rotations = 36;

/// Returns the rotations of a sample: the light's azimuths in degrees, ascending. Stops once there are more than
/// `most_rotations`.
std::vector<double> rotations_of(const gonio::sample_set& samples) {
  std::vector<double> all;
  for (Eigen::Index i = 0; i < std::ssize(samples) && all.size() <= most_rotations; ++i)
    if (const auto azimuth = rotation_of(samples.directions(i).pair());
        azimuth && std::ranges::count(all, *azimuth) == 0)
      all.push_back(*azimuth);
  std::ranges::sort(all);
  return all;
}

std::string listed(const std::vector<double>& rotations) {
  std::string text;
  for (const double each : rotations) text += (text.empty() ? "" : ", ") + gonio::io::shortest(each);
  return text;
}

/// "; the azimuths are 0, 90".
std::string azimuths_in_words(const std::vector<double>& rotations) {
  if (rotations.empty()) return "; the light is always along the normal";
  if (rotations.size() > most_rotations) return "; there are more than " + std::to_string(most_rotations) + " azimuths";
  return (rotations.size() == 1 ? "; the azimuth is " : "; the azimuths are ") + listed(rotations);
}

/// Returns the samples of the rotation that --rotation states. Without --rotation, returns all samples, but compares
/// pairs that differ only by a rotation about the normal: warns if their median difference is above 10 %, throws if it
/// is above 25 %.
gonio::sample_set of_one_rotation(const gonio::sample_set& samples, const std::filesystem::path& path,
                                  const measurement_options& options) {
  constexpr double noticeable = 0.1, anisotropic = 0.25;
  constexpr Eigen::Index fewest_pairs = 5;
  const std::vector<double> rotations = rotations_of(samples);
  if (options.rotation) {
    std::vector<Eigen::Index> chosen;
    for (Eigen::Index i = 0; i < std::ssize(samples); ++i)
      if (rotation_of(samples.directions(i).pair()) == *options.rotation) chosen.push_back(i);
    if (chosen.empty())
      gonio::refuse({path.native(), ": no sample has the light at an azimuth of --rotation ",
                     gonio::io::shortest(*options.rotation), azimuths_in_words(rotations)});
    return samples.subset(chosen);
  }
  if (options.takes_anisotropic || rotations.size() < 2 || rotations.size() > most_rotations) return samples;
  const gonio::model::equal_samples turned = gonio::model::compare_equal_samples(samples.in_three_channels()).turned;
  if (turned.pairs < fewest_pairs || turned.median < noticeable) return samples;
  const std::string sentence = path.native() + ": " + std::to_string(turned.pairs) +
                               " pairs of samples that differ only by a rotation about the normal have values " +
                               fixed(100.0 * turned.median, 0) + " % apart (median)";
  if (turned.median > anisotropic)
    gonio::refuse(
        {sentence, ": the sample is anisotropic; choose one of its rotations with --rotation: ", listed(rotations)});
  warn(sentence + ": the sample is treated as isotropic");
  return samples;
}

/// Converts values to a BRDF from the quantity that the user states. It overrides the file's format, according to which
/// the values already are a BRDF.
gonio::sample_set of_quantity(const gonio::sample_set& samples, gonio::io::sample_quantity quantity) {
  gonio::sample_set changed(samples.channels());
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    const double factor = brdf_factor(quantity, samples.directions(i).pair().wo);
    std::vector<double> values(samples.values(i).begin(), samples.values(i).end());
    for (double& value : values) value *= factor;
    changed.add(samples.directions(i), values, samples.weight(i), samples.aperture(i));
  }
  return changed;
}

}  // namespace

gonio::io::sample_reading reading_of(const measurement_options& options) {
  gonio::io::sample_reading reading{.columns = {}, .quantity = {}, .note = warn};
  reading.sign = options.sign;
  for (const std::string& list : options.columns) add_columns(list, reading.columns);
  if (!options.quantity.empty()) reading.quantity = gonio::io::quantity_named(options.quantity);
  return reading;
}

void add_measurement_options(command& to, measurement_options& options) {
  const auto& names = gonio::io::sample_quantity_names;
  to.add_option("--quantity", options.quantity,
                "Quantity of the values: brdf (sr^-1), brdf-cosine (times the cosine of the viewer's angle), "
                "reflectance-factor (1 is white) or percent (100 is white). Needed if a .csv file of values or "
                "wavelengths does not state it (docs/reference/formats.md)")
      .check(check::one_of(std::vector<std::string>(names.begin(), names.end())));
  to.add_option("--columns", options.columns, "Names of the columns of a .csv file: theta_o=Winkel,g=Y").repeatable();
  using gonio::io::theta_o_sign;
  to.add_choice(
      "--theta-o-sign", [&options](int sign) { options.sign = static_cast<theta_o_sign>(sign); },
      {{"light", static_cast<int>(theta_o_sign::light)}, {"mirror", static_cast<int>(theta_o_sign::mirror)}},
      "Side of the normal on which a positive theta_o lies (light or mirror), for files without azimuths or with equal "
      "azimuths of light and viewer. Default: as the file's format defines it, with a warning if the highlight is on "
      "the light's side");
  to.add_option("--rotation", options.rotation,
                "Azimuth of the light in degrees: read only the samples with this azimuth, one rotation of an "
                "anisotropic material")
      .check(check::range(0.0, 360.0));
  to.add_option("--side", options.side,
                "Side to read from a Klems matrix or a tensor tree: front or back (default: front, or back if there is "
                "no front)")
      .check(check::one_of(std::vector<std::string>{"front", "back"}));
  to.add_option("--band", options.band,
                "Wavelengths to read from a Klems matrix or a tensor tree, by their name in the file: Visible, Solar");
}

void add_aperture_options(command& to, aperture_option& given) {
  const auto add = [&to](const std::string& whose, double& half_angle) {
    to.add_option("--" + whose + "-half-angle", half_angle,
                  "Half angle in degrees of the cone of the " + whose +
                      ", seen from the sample; each reading averages over it (0: a single direction)")
        .check(check::range(0.0, gonio::degrees(gonio::largest_half_angle)));
  };
  add("source", given.source);
  add("receiver", given.receiver);
}

bool holds_measurements(const std::filesystem::path& path) {
  constexpr std::array<std::string_view, 3> extensions{".csv", ".tsv", ".txt"};
  return std::ranges::find(extensions, lower_extension(path)) != extensions.end() ||
         measurement_kind_of(path) != nullptr;
}

void require_unused(const measurement_options& options, const std::filesystem::path& path) {
  if (!options.empty())
    gonio::refuse({path.native(), ": --quantity, --columns, --theta-o-sign, --side and --band need a file of samples"});
}

namespace {

void require_no_block(const measurement_options& options, const std::filesystem::path& path, std::string_view kind) {
  if (!options.side.empty() || !options.band.empty())
    gonio::refuse({path.native(), ": --side and --band need a Klems matrix or a tensor tree, not ", kind});
}

gonio::sample_set read_kind(const measurement_kind& kind, const std::filesystem::path& path,
                            const measurement_options& options) {
  if (kind.read_block == nullptr) {
    require_no_block(options, path, kind.name);
    return kind.read(path);
  }
  using side = gonio::io::window_block::side;
  gonio::io::window_block wanted;
  if (!options.side.empty()) wanted.of = options.side == "back" ? side::back : side::front;
  if (!options.band.empty()) wanted.wavelength = options.band;
  return kind.read_block(path, wanted);
}

}  // namespace

gonio::io::sample_file read_measurement_file(const std::filesystem::path& path, const measurement_options& options) {
  const elapsed_time waiting("reading " + path.string());
  gonio::io::sample_file file;
  if (const measurement_kind* kind = measurement_kind_of(path)) {
    if (!options.columns.empty()) gonio::refuse({path.native(), ": --columns needs a .csv file, not ", kind->name});
    file.samples = read_kind(*kind, path, options);
    if (!options.quantity.empty()) {
      file.quantity = gonio::io::quantity_named(options.quantity);
      file.samples = of_quantity(file.samples, *file.quantity);
    }
    file.sign = options.sign;
    if (file.sign == gonio::io::theta_o_sign::mirror) file.samples = gonio::with_viewers_turned(file.samples);
  } else {
    require_no_block(options, path, "samples as CSV");
    file = gonio::io::read_sample_file(path, reading_of(options));
  }
  if (options.light) {
    if (!file.samples.channels().are_wavelengths())
      gonio::refuse({path.native(), ": --illuminant needs at least two wavelengths"});
    file.samples = file.samples.under(*options.light);
  }
  file.samples = of_one_rotation(file.samples, path, options);
  if (const gonio::aperture aperture = options.aperture.in_radians(); !aperture.is_point()) {
    if (file.samples.have_apertures())
      gonio::refuse({path.native(),
                     ": contains the half angles of its readings: omit --source-half-angle and --receiver-half-angle"});
    file.samples = file.samples.through(aperture);
  }
  for (const std::string& sentence : doubts_of(file)) warn(path.native() + ": " + sentence);
  return file;
}

gonio::sample_set as_colours(const std::filesystem::path& path, const gonio::sample_set& samples) {
  if (!samples.channels().are_wavelengths()) return samples;
  if (const std::vector<double>& all = samples.channels().wavelengths(); !samples.channels().have_colour())
    gonio::refuse({path.native(), ": its wavelengths, ", std::lround(all.front()), " to ", std::lround(all.back()),
                   " nm, are invisible and have no colour: use gonio check or gonio reconstruct -o FILE.bsdf"});
  return samples.colours();
}

gonio::io::sample_file read_colour_file(const std::filesystem::path& path, const measurement_options& options) {
  gonio::io::sample_file file = read_measurement_file(path, options);
  file.samples = as_colours(path, file.samples);
  return file;
}

gonio::sample_set read_measurements(const std::filesystem::path& path, const measurement_options& options) {
  return read_colour_file(path, options).samples;
}

json facts_of(const gonio::io::sample_file& file) {
  json facts = json::object();
  if (file.quantity) facts["quantity"] = name_of(*file.quantity);
  const std::vector<double>& wavelengths = file.samples.channels().wavelengths();
  if (wavelengths.size() == 1) facts["wavelength_nm"] = wavelengths.front();
  if (wavelengths.size() > 1) facts["wavelengths_nm"] = wavelengths;
  const auto& [instrument, date, conditions] = file.provenance;
  if (!instrument.empty()) facts["instrument"] = instrument;
  if (!date.empty()) facts["date"] = date;
  if (!conditions.empty()) facts["conditions"] = conditions;
  return facts;
}

void write_table(const std::filesystem::path& path, const gonio::brdf_table& table) { write_file(path, table); }

}  // namespace cli
