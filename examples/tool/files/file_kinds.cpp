#include "file_kinds.hpp"

#include "file_start.hpp"
#include "measurement_kinds.hpp"
#include "tool/pages/elapsed_time.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/sample_warnings.hpp"
#include "tool/pages/warning.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/io/materials/rgl_spectra.hpp>
#include <gonio/io/materials/table_npy.hpp>
#include <gonio/io/materials/utia.hpp>
#include <gonio/io/measurements/openmaterial.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/measurements/zemax_table.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/model/clipped_brdf.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <utility>

namespace cli {

namespace {

namespace fs = std::filesystem;
namespace io = gonio::io;

using bytes = std::span<const std::byte>;

[[noreturn]] void refuse_samples(const fs::path& path) {
  gonio::refuse(
      {path.native(), ": needs a whole material, but the input holds samples: complete them with 'gonio reconstruct'"});
}

/// Does the file hold an anisotropic material?
bool is_anisotropic(const file_content& content) {
  if (const auto* material = std::get_if<io::rgl_material>(&content)) return material->material.is_anisotropic();
  const auto* grid = std::get_if<gonio::model::angle_grid_brdf>(&content);
  return grid != nullptr && grid->is_anisotropic();
}

/// Calls `use` with the BRDF of a complete material. `path` is to be written.
template <class Use>
auto with_any_brdf(const fs::path& path, const file_content& content, Use&& use) {
  if (std::holds_alternative<gonio::sample_set>(content)) refuse_samples(path);
  if (const auto* table = std::get_if<gonio::brdf_table>(&content)) return use(*table);
  if (const auto* material = std::get_if<io::rgl_material>(&content)) return use(material->material);
  if (const auto* grid = std::get_if<gonio::model::angle_grid_brdf>(&content)) return use(*grid);
  return use(std::get<io::mbsdf_material>(content).reflection);
}

/// Calls `use` with the BRDF of a complete isotropic material.
template <class Use>
auto with_brdf(const fs::path& path, const file_content& content, Use&& use) {
  if (is_anisotropic(content))
    gonio::refuse({path.native(), ": needs an isotropic material, but the input is anisotropic: write a .bsdf file"});
  return with_any_brdf(path, content, std::forward<Use>(use));
}

gonio::brdf_table as_table(const fs::path& path, const file_content& content, gonio::thread_count threads) {
  if (const auto* table = std::get_if<gonio::brdf_table>(&content)) return *table;
  return with_brdf(path, content, [&](const auto& f) { return gonio::tabulate(f, gonio::valid_cells(), threads); });
}

/// Returns the cells at which negative values are counted.
gonio::valid_cells cells_of(const file_content& content) {
  const auto* table = std::get_if<gonio::brdf_table>(&content);
  return table != nullptr ? table->cells() : gonio::valid_cells();
}

/// Must negative values be written as 0? If so, warns the user.
template <gonio::brdf Brdf>
bool must_be_clipped(const fs::path& path, const Brdf& f, const gonio::valid_cells& cells, const writing& how) {
  if (how.keeps_negative) return false;
  gonio::model::clipped_values found;
  if constexpr (std::same_as<Brdf, gonio::model::angle_grid_brdf>)
    found = gonio::model::count_negative_values(
        f, cells, f.is_anisotropic() ? gonio::model::cell_azimuths::all : gonio::model::cell_azimuths::zero);
  else
    found = gonio::model::count_negative_values(f, cells);
  if (found.cells == 0) return false;
  const auto percent = [&](Eigen::Index channel) { return fixed(100.0 * found.added[channel], 2) + " %"; };
  warn(path.native() + ": " + std::to_string(found.cells) + " of " + std::to_string(cells.size()) +
       " cells have a negative value, written as 0. That adds " + percent(0) + " red, " + percent(1) + " green and " +
       percent(2) + " blue to the reflected light (--keep-negative keeps them)");
  return true;
}

/// Calls `use` with the BRDF of a complete material, isotropic or not, without negative values unless `how` keeps them.
template <class Use>
auto with_clipped_brdf(const fs::path& path, const file_content& content, const writing& how, Use&& use) {
  return with_any_brdf(path, content, [&](const auto& f) {
    const gonio::brdf_view view(f);
    return must_be_clipped(path, f, cells_of(content), how) ? use(gonio::model::clipped_brdf(view)) : use(view);
  });
}

io::rgl_material as_rgl(const fs::path& path, const file_content& content, const writing& how) {
  if (const auto* material = std::get_if<io::rgl_material>(&content)) {
    if (!must_be_clipped(path, material->material, cells_of(content), how)) return *material;
    return {gonio::model::clipped(material->material, how.threads), material->description, {}};
  }
  return with_clipped_brdf(path, content, how, [&](const auto& f) -> io::rgl_material {
    if (is_anisotropic(content))
      return {gonio::model::tabulate_adaptively(f, gonio::model::anisotropic_resolution{}, how.threads),
              path.stem().string(),
              {}};
    return {gonio::model::tabulate_keeping_albedo(f, how.albedo_tolerance, how.threads), path.stem().string(), {}};
  });
}

/// Refuses an anisotropic material for an isotropic format.
void require_isotropic(const fs::path& path, const file_content& content) {
  with_brdf(path, content, [](const auto&) {});
}

void write_zemax(const fs::path& path, const file_content& content, const writing& how) {
  const io::zemax_resolution resolution =
      is_anisotropic(content) ? io::zemax_resolution{} : io::zemax_resolution{.rotations = 1};
  const auto grid = with_clipped_brdf(
      path, content, how, [&](const auto& f) { return io::tabulate_about_specular(f, resolution, how.threads); });
  io::write_zemax_table(path, grid, path.stem().string() + ", written by gonio");
}

/// Returns the requested grid, else the grid of the file's polar angles or difference angles, else the default.
gonio::model::polar_grid polar_grid_of(const file_content& content, const writing& how) {
  if (how.polar_steps != 0) return {how.polar_steps, 2 * how.polar_steps};
  if (const auto* material = std::get_if<io::mbsdf_material>(&content)) return material->reflection.grid();
  const auto* table = std::get_if<gonio::brdf_table>(&content);
  if (table == nullptr) return {};
  const gonio::grid_extents extents = table->cells().grid().extents();
  return {std::clamp<Eigen::Index>(extents.theta_d, 2, 360), std::clamp<Eigen::Index>(extents.phi_d, 2, 720)};
}

io::mbsdf_material as_mbsdf(const fs::path& path, const file_content& content, const writing& how) {
  require_isotropic(path, content);
  const auto* material = std::get_if<io::mbsdf_material>(&content);
  const auto tabulated = [&](const auto& f) -> io::mbsdf_material {
    return {gonio::model::tabulate_polar(f, polar_grid_of(content, how), how.threads),
            {{"name", path.stem().string()}, {"software", "gonio"}, {"values", "BRDF in 1/sr, linear Rec. 709"}}};
  };
  if (material == nullptr || how.polar_steps != 0) return with_clipped_brdf(path, content, how, tabulated);
  if (!must_be_clipped(path, material->reflection, cells_of(content), how)) return *material;
  return {tabulated(gonio::model::clipped_brdf(gonio::brdf_view(material->reflection))).reflection, material->metadata};
}

void write_merl(const fs::path& path, const file_content& content, const writing& how) {
  io::write_merl(path, as_table(path, content, how.threads));
}

void write_array(const fs::path& path, const file_content& content, const writing& how) {
  const gonio::brdf_table table = as_table(path, content, how.threads);
  if (how.as_halves)
    io::write_table_npy_halves(path, table);
  else
    io::write_table_npy(path, table);
}

void write_bsdf(const fs::path& path, const file_content& content, const writing& how) {
  constexpr double large = 100.0;
  if (how.as_zemax) return write_zemax(path, content, how);
  if (const auto* given = std::get_if<io::rgl_material>(&content); given != nullptr && given->spectra) {
    const double megabytes = 4e-6 * static_cast<double>(given->spectra->values.values.size());
    if (megabytes > large)
      warn(path.native() + ": " + std::to_string(given->spectra->wavelengths.size()) + " wavelengths take " +
           fixed(megabytes, 0) + " MB");
    return io::write_rgl(path, *given);  // avoids a copy
  }
  io::rgl_material material = as_rgl(path, content, how);
  if (how.as_spectra) material.spectra = io::upsampled_spectra(material.material);
  io::write_rgl(path, material);
}

void write_mbsdf(const fs::path& path, const file_content& content, const writing& how) {
  io::write_mbsdf(path, as_mbsdf(path, content, how));
}

void write_openmaterial(const fs::path& path, const file_content& content, const writing& how) {
  require_isotropic(path, content);
  io::openmaterial_metadata metadata{.name = path.stem().string(), .description = "Written by gonio."};
  if (metadata.name.ends_with("_brdf")) metadata.name.resize(metadata.name.size() - 5);
  io::openmaterial_steps steps;
  if (how.polar_steps != 0) steps = {how.polar_steps, 2 * how.polar_steps};
  io::write_openmaterial(path, with_clipped_brdf(path, content, how, [&](const auto& f) {
                           return io::write_openmaterial(f, metadata, steps, how.threads);
                         }));
}

void write_samples(const fs::path& path, const file_content& content, const writing& /*how*/) {
  const auto* samples = std::get_if<gonio::sample_set>(&content);
  if (samples == nullptr)
    gonio::refuse(
        {path.native(), ": needs samples, but the input is a whole material: measure it with 'gonio sample'"});
  // Half and difference angles suffice unless the material is anisotropic.
  io::write_samples(
      path, *samples, {},
      looks_anisotropic(*samples) ? io::direction_columns::pairs : io::direction_columns::half_difference);
}

bool ends_as(const fs::path& path, const file_kind& kind) {
  return std::ranges::find(kind.extensions, lower_extension(path)) != kind.extensions.end();
}

bool begins_as(bytes content, const file_kind& kind) {
  return !kind.magic.empty() && io::as_text(content).starts_with(kind.magic);
}

/// Returns "MERL table (.binary, .gz), ..." for the kinds that can be written, or for all.
std::string listed(bool only_written) {
  std::string all;
  for (const file_kind& kind : file_kinds()) {
    if (only_written && kind.write == nullptr) continue;
    all += (all.empty() ? "" : ", ") + std::string(kind.name) + " (";
    for (const std::string_view extension : kind.extensions)
      all += (extension == kind.extensions.front() ? "" : " ") + std::string(extension);
    all += ")";
  }
  return all;
}

}  // namespace

const std::vector<file_kind>& file_kinds() {
  static const std::vector<file_kind> kinds{
      {"RGL material",
       {".bsdf"},
       {"tensor_file\0", 12},
       [](bytes content, const std::string& name) -> file_content {
         io::rgl_material material = io::read_rgl(content, name);
         static_cast<void>(io::colours_of(material, name));  // refuses invisible wavelengths: a material needs colours
         return material;
       },
       &write_bsdf},
      {"MDL measurement",
       {".mbsdf"},
       "NVIDIA ARC MBSDF",
       [](bytes content, const std::string& name) -> file_content { return io::read_mbsdf(content, name); },
       &write_mbsdf},
      {"OpenMATERIAL table", {".xompt"}, "", nullptr, &write_openmaterial},
      {"UTIA material",
       {".bin"},
       "",
       [](bytes content, const std::string& name) -> file_content { return io::read_utia(content, name); }},
      {"table as an array",
       {".npy"},
       "\x93NUMPY",
       [](bytes content, const std::string& name) -> file_content { return io::read_table_npy(content, name); },
       &write_array},
      {"MERL table, compressed",
       {".gz"},
       "\x1f\x8b",
       [](bytes content, const std::string& name) -> file_content { return io::read_merl_any(content, name); }},
      {"MERL table",
       {".binary"},
       "",
       [](bytes content, const std::string& name) -> file_content { return io::read_merl(content, name); },
       &write_merl},
      {"samples", {".csv"}, "", nullptr, &write_samples},
  };
  return kinds;
}

file_content read_file(const fs::path& path, const measurement_options& reading) {
  if (holds_measurements(path)) return read_measurements(path, reading);
  require_unused(reading, path);
  const std::vector<std::byte> content = io::read_bytes(path);
  const auto begins = [&](const file_kind& kind) { return begins_as(content, kind); };
  const auto ends = [&](const file_kind& kind) { return ends_as(path, kind); };
  const std::vector<file_kind>& kinds = file_kinds();
  auto found = std::ranges::find_if(kinds, begins);
  if (found == kinds.end()) found = std::ranges::find_if(kinds, ends);
  if (found == kinds.end()) gonio::refuse({path.native(), ": unknown kind of file, expected one of: ", listed(false)});
  return found->parse(content, path.string());
}

namespace {

bool is_zemax_table(const fs::path& path) {
  const measurement_kind* kind = measurement_kind_of(path);
  return kind != nullptr && kind->name == "Zemax BSDF";
}

/// Reads a complete material.
file_content read_whole(const fs::path& path) {
  if (holds_measurements(path))
    gonio::refuse(
        {path.native(), ": holds samples, expected a whole material: complete them with 'gonio reconstruct'"});
  const std::vector<std::byte> content = io::read_bytes(path);
  const auto is_kind = [&](const file_kind& kind) { return begins_as(content, kind) || ends_as(path, kind); };
  const std::vector<file_kind>& kinds = file_kinds();
  const auto found = std::ranges::find_if(kinds, is_kind);
  if (found == kinds.end() || found->parse == nullptr) return io::read_merl(content, path.string());
  return found->parse(content, path.string());
}

}  // namespace

file_content read_file_for(const fs::path& output, const fs::path& path, const measurement_options& reading) {
  if (written_kind(output).write == &write_samples || !is_zemax_table(path)) return read_file(path, reading);
  require_unused(reading, path);
  return io::read_zemax_table(path);
}

gonio::brdf_table read_table(const fs::path& path, gonio::thread_count threads) {
  const file_content content = read_whole(path);
  if (is_anisotropic(content)) gonio::refuse({path.native(), ": is anisotropic, expected an isotropic material"});
  return as_table(path, content, threads);
}

any_material read_material(const fs::path& path, gonio::thread_count threads) {
  const file_content content = is_zemax_table(path) ? file_content(io::read_zemax_table(path)) : read_whole(path);
  if (!is_anisotropic(content)) return as_table(path, content, threads);
  if (const auto* grid = std::get_if<gonio::model::angle_grid_brdf>(&content)) return *grid;
  return std::get<io::rgl_material>(content).material;
}

bool holds_table(const fs::path& path) {
  const auto is_kind = [&](const file_kind& kind) { return kind.parse != nullptr && ends_as(path, kind); };
  return std::ranges::any_of(file_kinds(), is_kind) && !holds_measurements(path);
}

const file_kind& written_kind(const fs::path& path) {
  for (const file_kind& kind : file_kinds())
    if (kind.write != nullptr && ends_as(path, kind)) return kind;
  gonio::refuse({path.native(), ": unknown kind of output, expected one of: ", listed(true)});
}

void write_file(const fs::path& path, const file_content& content, const writing& how) {
  const elapsed_time waiting("writing " + path.string());
  written_kind(path).write(path, content, how);
}

void write_spectra(const fs::path& path, const gonio::spectral_table& table, const std::string& description,
                   const writing& how) {
  const elapsed_time waiting("writing " + path.string());
  const file_content content = io::tabulate_adaptively(table, how.albedo_tolerance, description, how.threads);
  const std::size_t written = std::get<io::rgl_material>(content).spectra->wavelengths.size();
  if (written < table.wavelengths().size())
    warn(path.native() + ": " + std::to_string(written) + " of " + std::to_string(table.bands()) +
         " wavelengths written; the others are interpolated linearly, within " +
         io::shortest(std::round(1e6 * how.albedo_tolerance) / 1e4) + " %");
  write_bsdf(path, content, how);
}

}  // namespace cli
