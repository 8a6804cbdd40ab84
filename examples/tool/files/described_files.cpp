#include "described_files.hpp"

#include "described_materials.hpp"
#include "exr_files.hpp"
#include "file_start.hpp"
#include "lab/recorded_frames.hpp"
#include "measurement_kinds.hpp"
#include "tiff_files.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/pages/measures_as_json.hpp"
#include "tool/pages/read_as.hpp"
#include "tool/pages/sample_facts.hpp"
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/exposure_times.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/images/pnm.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/soft_specular_prior.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/io/measurements/reference_reflectance.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/measurements/scan_journal.hpp>
#include <gonio/io/setups/apparatus.hpp>
#include <gonio/io/setups/camera_calibration.hpp>
#include <gonio/io/text/csv_reader.hpp>
#include <gonio/model/measured_properties.hpp>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <span>
#include <string_view>
#include <vector>

namespace cli {

namespace {

using path_type = std::filesystem::path;

/// The properties by which a file is recognised.
struct file_look {
  explicit file_look(const path_type& of) : path(of), extension(lower_extension(of)), start(file_start(of)) {
    std::error_code ignored;
    if (start.empty()) static_cast<void>(gonio::io::read_bytes(of));  // its error says why the file cannot be read
    size = std::filesystem::file_size(of, ignored);
  }

  path_type path;
  std::string extension;  ///< with the dot, in lower case
  std::string start;      ///< from `file_start`
  std::uintmax_t size = 0;
};

/// A kind of file: how it is recognised, and how it is described with or without the user's options for samples.
struct described_kind {
  bool (*recognises)(const file_look& file);
  json (*describe)(const path_type& path);
  json (*describe_measurements)(const path_type& path, const measurement_options& reading) = nullptr;
};

json grid_facts(const gonio::valid_cells& cells) {
  const auto [theta_h, theta_d, phi_d] = cells.grid().extents();
  return {{"grid", {theta_h, theta_d, phi_d}},
          {"anchor", cells.grid().anchor() == gonio::cell_anchor::centre ? "centre" : "lower corner"},
          {"minimum_cosine", cells.minimum_cosine()},
          {"valid_cells", cells.size()}};
}

json describe_table(const path_type& path) {
  const gonio::brdf_table table = gonio::io::read_merl_any(path);
  const gonio::model::table_values values = gonio::model::summarise(table);
  json facts{{"kind", "MERL table"}};
  facts.update(grid_facts(table.cells()));
  facts["minimum"] = per_channel(values.minimum);
  facts["mean"] = per_channel(values.mean);
  facts["maximum"] = per_channel(values.maximum);
  facts["cells_with_negative_values"] = values.negative_cells;
  return facts;
}

/// Is it a MERL table? Yes, if its name ends in .binary, if it is compressed, or if it consists of three int32 and the
/// number of float64 that these require.
bool is_table(const file_look& file) {
  if (file.extension == ".binary") return true;
  if (file.start.starts_with("\x1F\x8B")) return true;
  std::array<std::int32_t, 3> extents{};
  if (file.start.size() < sizeof extents) return false;
  std::copy_n(file.start.data(), sizeof extents, reinterpret_cast<char*>(extents.data()));
  std::uint64_t cells = 1;
  for (const std::int32_t extent : extents) {
    if (extent < 1 || extent > 4096) return false;
    cells *= static_cast<std::uint64_t>(extent);
  }
  return file.size == sizeof extents + 3 * sizeof(double) * cells;
}

json describe_soft_specular_prior(const path_type& path) {
  const gonio::soft_specular_prior prior = gonio::io::read_soft_specular_prior(path);
  const auto half = [](const gonio::log_relative_pca& one) {
    return json{{"materials", one.names().size()},
                {"components", one.size()},
                {"explained_variance", one.explained_variance()},
                {"names", one.names()}};
  };
  json facts{{"kind", "soft and specular prior"}, {"source", prior.soft().source()}, {"threshold", prior.threshold()}};
  facts.update(grid_facts(prior.cells()));
  facts["soft"] = half(prior.soft());
  facts["specular"] = half(prior.specular());
  return facts;
}

/// Reads all bands, which also checks them.
json describe_svbrdf(const path_type& path) {
  const gonio::io::svbrdf_map map(path);
  const gonio::io::svbrdf_header& header = map.header();
  double uncertainty = 0.0, disagreement = 0.0, contradicted = 0.0, texels = 0.0;
  for (Eigen::Index number = 0; number < header.bands(); ++number) {
    const gonio::io::svbrdf_band band = map.read_band(number);
    for (Eigen::Index i = 0; i < header.texels_of_band(number); ++i) {
      if (!band.has_material(i)) continue;
      texels += 1.0;
      uncertainty += gonio::from_half(band.uncertainty[static_cast<std::size_t>(i)]);
      const float value = gonio::from_half(band.disagreement[static_cast<std::size_t>(i)]);
      disagreement += value;
      contradicted += value > 3.0f ? 1.0 : 0.0;
    }
  }
  const double all = static_cast<double>(header.rows) * static_cast<double>(header.columns);
  const double divisor = std::max(texels, 1.0);
  return {{"kind", "map of a spatially varying BRDF"},
          {"columns", header.columns},
          {"rows", header.rows},
          {"share_of_the_sample", texels / all},
          {"images", header.directions.size()},
          {"components", header.functions.rows()},
          {"functions", header.functions.cols()},
          {"prior", header.prior_source},
          {"eta", header.eta},
          {"mean_uncertainty", uncertainty / divisor},
          {"mean_disagreement", disagreement / divisor},
          {"share_of_disagreement_above_3", contradicted / divisor}};
}

/// Returns the smallest and the largest half angle in degrees.
json half_angles_of(const gonio::sample_set& samples, double gonio::aperture::*half_angle) {
  double least = gonio::largest_half_angle, most = 0.0;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i) {
    least = std::min(least, samples.aperture(i).*half_angle);
    most = std::max(most, samples.aperture(i).*half_angle);
  }
  return {rounded_degrees(least), rounded_degrees(most)};
}

json describe_samples(const path_type& path, const measurement_options& reading) {
  const gonio::io::sample_file file = read_measurement_file(path, reading);
  json facts{{"kind", "samples"}};
  if (const measurement_kind* kind = measurement_kind_of(path)) facts["format"] = kind->name;
  facts.update(read_as(file));
  facts.update(facts_of(file.samples.in_three_channels()));
  facts.update(facts_of(file));
  if (file.samples.have_apertures())
    for (const auto& [key, half_angle] : {std::pair("source_half_angle", &gonio::aperture::source),
                                          std::pair("receiver_half_angle", &gonio::aperture::receiver)})
      facts[key] = half_angles_of(file.samples, half_angle);
  return facts;
}

json describe_array(const path_type& path) {
  const std::vector<std::byte> bytes = gonio::io::read_bytes(path);
  std::span<const std::byte> left = bytes;
  const gonio::io::npy_layout layout = gonio::io::read_npy_header(left, path.string());
  if (layout.shape.size() == 2 && layout.shape[1] == 675) {
    const auto networks = gonio::io::read_networks(path);
    return {{"kind", "networks"}, {"materials", networks.names.size()}, {"names", networks.names}};
  }
  json shape = json::array();
  for (const std::size_t extent : layout.shape) shape.push_back(extent);
  return {{"kind", layout.shape.size() == 4   ? "table as an array"
                   : layout.shape.size() == 3 ? "image as an array"
                                              : "array"},
          {"shape", shape},
          {"bytes_of_each", layout.word_size}};
}

json image_facts(const char* kind, const gonio::image& image) {
  return {{"kind", kind}, {"columns", image.shape(1)}, {"rows", image.shape(0)}};
}

json code_facts(const char* kind, const gonio::stored_codes& codes) {
  return {{"kind", kind},
          {"columns", codes.columns},
          {"rows", codes.rows},
          {"largest_count", codes.largest},
          {"pixels_at_the_largest", std::ranges::count(codes.values, codes.largest) / 3}};
}

json describe_scan(const path_type& path) {
  const gonio::io::recorded_scan scan = gonio::io::read_scan(path);
  json facts{{"kind", "scan"}, {"poses", scan.poses.size()}, {"measured", scan.measured()}};
  if (scan.subject) facts.update({{"sample", scan.subject->sample}, {"setup", scan.subject->setup}});
  facts["largest_count"] = scan.largest_count;
  return facts;
}

json describe_frames(const path_type& path) {
  const std::vector<gonio::direction_pair> poses = lab::recorded_frames(path).poses();
  json facts{{"kind", "recorded frames"}};
  facts.update(facts_of(poses));
  return facts;
}

bool has_keyword(const file_look& file, std::initializer_list<std::string_view> keywords) {
  std::string_view text = file.start;
  gonio::io::text_position position;
  for (std::string_view line; gonio::io::next_line(text, position, line);)
    if (std::ranges::find(keywords, line.substr(0, line.find_first_of(" \t"))) != keywords.end()) return true;
  return false;
}

/// Does a line in the start of the file begin with a number?
bool is_list_of_numbers(const file_look& file) {
  std::string_view text = file.start;
  gonio::io::text_position position;
  double ignored = 0.0;
  for (std::string_view line; gonio::io::next_line(text, position, line);)
    if (!gonio::io::read_number(line.substr(0, line.find_first_of(" \t,;")), ignored)) return true;
  return false;
}

json facts_of_directions(const std::vector<gonio::direction_pair>& pairs) {
  json facts{{"kind", "directions"}};
  facts.update(facts_of(pairs));
  return facts;
}

json describe_directions(const path_type& path, const gonio::io::sample_reading& reading) {
  return facts_of_directions(gonio::io::read_direction_pairs(path, reading));
}

json describe_exposure_times(const path_type& path) {
  const gonio::io::exposure_times times = gonio::io::read_exposure_times(path);
  const auto by_seconds = [](const auto& entry) { return entry.second; };
  const auto [shortest, longest] = std::ranges::minmax_element(times, {}, by_seconds);
  return {{"kind", "exposure times"}, {"files", times.size()}, {"seconds", {shortest->second, longest->second}}};
}

json describe_csv(const path_type& path, const measurement_options& reading) {
  const file_look file(path);
  gonio::io::csv_reader lines(file.start, path.native());
  static_cast<void>(lines.next());
  const std::vector<std::string_view>& header = lines.fields();
  const auto starts_with = [&](std::initializer_list<std::string_view> names) {
    return std::ranges::mismatch(names, header).in1 == names.end();
  };
  if (starts_with({"file", "seconds"})) return describe_exposure_times(path);
  if (starts_with({"pose"})) return {{"kind", "poses of a machine"}};
  if (starts_with({"round", "error"})) return {{"kind", "history of an iteration"}};
  if (starts_with({"sample", "r", "g", "b", "others_r"})) return {{"kind", "residuals of gonio reconstruct"}};
  if (std::ranges::any_of(header,
                          [](std::string_view name) { return gonio::io::lower_case(name).starts_with("factor"); })) {
    static_cast<void>(gonio::io::read_reference_reflectance(path));
    return {{"kind", "reflectance of a white reference"}};
  }
  const gonio::io::sample_reading how = reading_of(reading);
  const std::vector<std::byte> bytes = gonio::io::read_bytes(path);  // a header line may be longer than the start
  return gonio::io::has_directions_alone(gonio::io::as_text(bytes), path.native(), how)
             ? describe_directions(path, how)
             : describe_samples(path, reading);
}

json describe_apparatus(const path_type& path) {
  const gonio::design::apparatus apparatus = gonio::io::read_apparatus(path);
  const gonio::design::capture_constraint& constraint = apparatus.constraint;
  const auto degrees = [](const gonio::design::polar_range& range) -> json {
    return {rounded_degrees(range.smallest), rounded_degrees(range.largest)};
  };
  return {{"kind", "an apparatus"},
          {"light", degrees(constraint.light)},
          {"viewer", degrees(constraint.viewer)},
          {"in_plane", constraint.plane_tolerance.has_value()},
          {"forbidden_zones", constraint.forbidden.size()},
          {"pairs", constraint.pairs.size()},
          {"noise", apparatus.noise},
          {"dark_signal", apparatus.dark_signal},
          {"misplaced", rounded_degrees(apparatus.angular_error)}};
}

json describe_calibration(const path_type& path) {
  static_cast<void>(gonio::io::read_camera_calibration(path));
  return {{"kind", "calibration of a camera"}};
}

/// The first kind that recognises a file describes it; kinds with a distinctive beginning come first.
constexpr std::array kinds{
    described_kind{[](const file_look& file) { return gonio::io::is_prior(file.path); },
                   [](const path_type& path) { return describe(gonio::io::read_prior(path)); }},
    described_kind{[](const file_look& file) { return gonio::io::is_soft_specular_prior(file.path); },
                   describe_soft_specular_prior},
    described_kind{[](const file_look& file) { return gonio::io::is_svbrdf_map(file.path); }, describe_svbrdf},
    described_kind{[](const file_look& file) { return file.start.starts_with("gonio-shapes"); },
                   [](const path_type&) {
                     return json{{"kind", "shape model"}};
                   }},
    described_kind{[](const file_look& file) { return file.start.starts_with("tensor_file"); }, describe_rgl},
    described_kind{[](const file_look& file) { return file.start.starts_with("NVIDIA ARC MBSDF"); }, describe_mbsdf},
    described_kind{[](const file_look& file) { return file.extension == ".bin"; }, describe_utia},
    described_kind{[](const file_look& file) { return file.start.starts_with("\x93NUMPY"); }, describe_array},
    described_kind{[](const file_look& file) { return file.start.starts_with("\x89PNG"); },
                   [](const path_type& path) { return code_facts("PNG image", gonio::io::read_png_codes(path)); }},
    described_kind{
        [](const file_look& file) { return file.start.starts_with("#?RADIANCE") || file.start.starts_with("#?RGBE"); },
        [](const path_type& path) { return image_facts("Radiance HDR image", gonio::io::read_hdr(path)); }},
    described_kind{[](const file_look& file) { return file.start.starts_with("\x76\x2F\x31\x01"); },
                   [](const path_type& path) { return image_facts("OpenEXR image", read_exr(path)); }},
    described_kind{[](const file_look& file) {
                     return file.start.starts_with(std::string_view("II*\0", 4)) ||
                            file.start.starts_with(std::string_view("MM\0*", 4));
                   },
                   [](const path_type& path) { return code_facts("TIFF image", read_tiff(path)); }},
    described_kind{[](const file_look& file) { return file.extension == ".ppm" || file.extension == ".pgm"; },
                   [](const path_type& path) { return code_facts("Netpbm image", gonio::io::read_pnm(path)); }},
    described_kind{
        [](const file_look& file) { return file.start.starts_with("ply\n") || file.start.starts_with("ply\r"); },
        [](const path_type&) {
          return json{{"kind", "mesh (PLY)"}};
        }},
    described_kind{[](const file_look& file) { return file.extension == ".obj" && has_keyword(file, {"v"}); },
                   [](const path_type&) {
                     return json{{"kind", "mesh (OBJ)"}};
                   }},
    described_kind{[](const file_look& file) { return measurement_kind_of(file.path) != nullptr; }, nullptr,
                   describe_samples},
    described_kind{
        [](const file_look& file) { return file.extension == ".json" && file.start.find("\"frames\"") < 4096; },
        describe_frames},
    described_kind{[](const file_look& file) { return file.extension == ".scan"; }, describe_scan},
    described_kind{[](const file_look& file) { return file.extension == ".csv" || file.extension == ".tsv"; }, nullptr,
                   describe_csv},
    described_kind{[](const file_look& file) {
                     return file.start.starts_with("%YAML") || file.start.find("<opencv_storage>") < 4096;
                   },
                   describe_calibration},
    described_kind{[](const file_look& file) {
                     return file.extension == ".txt" && has_keyword(file, {"position"}) && has_keyword(file, {"size"});
                   },
                   [](const path_type&) {
                     return json{{"kind", "set-up of an image"}};
                   }},
    described_kind{[](const file_look& file) {
                     return file.extension == ".txt" && has_keyword(file, {"light", "viewer", "in_plane", "separation",
                                                                           "light_step", "forbid", "pair"});
                   },
                   describe_apparatus},
    described_kind{[](const file_look& file) { return file.extension == ".txt" && is_list_of_numbers(file); }, nullptr,
                   describe_samples},
    described_kind{is_table, describe_table}};

}  // namespace

json describe(const gonio::log_relative_pca& prior) {
  json facts{{"kind", "prior"},
             {"source", prior.source()},
             {"materials", prior.names().size()},
             {"components", prior.size()},
             {"explained_variance", prior.explained_variance()},
             {"cosine_weight", prior.metric().weighting() == gonio::cosine_weighting::larger ? "larger" : "product"}};
  if (!prior.wavelengths().empty()) facts["wavelengths_nm"] = prior.wavelengths();
  facts.update(grid_facts(prior.cells()));
  facts["names"] = prior.names();
  return facts;
}

json describe_file(const std::filesystem::path& path, const measurement_options& reading) {
  // A shipped file may be in the program itself. It is a prior or a list of directions.
  if (is_shipped(path) && lower_extension(path) == ".prior") return describe(read_prior(path));
  if (is_shipped(path)) return facts_of_directions(cli::read_direction_pairs(path, {}));
  const file_look file(path);
  const auto kind = std::ranges::find_if(kinds, [&](const described_kind& each) { return each.recognises(file); });
  if (kind == kinds.end())
    gonio::refuse({path.native(), ": unknown kind of file, by its first bytes and its extension"});
  if (kind->describe_measurements != nullptr) return kind->describe_measurements(path, reading);
  require_unused(reading, path);
  return kind->describe(path);
}

}  // namespace cli
