#include "materials.hpp"

#include "chosen_networks.hpp"
#include "shipped_data.hpp"
#include <gonio/basis/expand_materials.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/materials/merl_directory.hpp>
#include <gonio/io/materials/rgl_spectra.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string_view>
#include <utility>

namespace cli {

namespace {

/// A material's name, and a function that returns its values over given cells: all channels of a cell, then the next.
struct named_table {
  std::string name;
  std::function<std::vector<float>(const gonio::valid_cells&)> tabulate;
};

std::vector<float> values_of(const gonio::brdf_table& table) { return {table.values().begin(), table.values().end()}; }

void require_isotropic(const gonio::io::rgl_material& material, const std::filesystem::path& path) {
  if (material.material.is_anisotropic())
    gonio::refuse({path.native(), ": is anisotropic, expected an isotropic material (--exclude leaves it out)"});
}

gonio::model::adaptive_brdf colours_of_isotropic(const std::filesystem::path& path) {
  gonio::io::rgl_material material = gonio::io::read_rgl(path);
  require_isotropic(material, path);
  return gonio::io::colours_of(std::move(material), path);
}

/// Returns the materials of all sources. Reads only networks now, other files when `tabulate` is called.
std::vector<named_table> tables_of(const material_source& source, gonio::thread_count threads) {
  std::vector<named_table> all;
  for (const std::filesystem::path& file : source.networks) {
    const gonio::model::named_networks known = gonio::io::read_networks(file);
    for (std::size_t i = 0; i < known.names.size(); ++i)
      all.push_back({known.names[i], [network = known.networks[i], threads](const gonio::valid_cells& cells) {
                       const auto set = gonio::model::tabulate_networks({{"one"}, {network}}, cells, threads);
                       return values_of(set.table(0));
                     }});
  }
  for (const std::filesystem::path& folder : source.tables)
    for (const auto& [name, path] : gonio::io::list_merl_directory(folder))
      all.push_back({name, [path, threads](const gonio::valid_cells& cells) {
                       const gonio::brdf_table table = gonio::io::read_merl_any(path, {{}, cells});
                       return values_of(table.cells() == cells ? table : gonio::resample(table, cells, threads));
                     }});
  for (const std::filesystem::path& folder : source.rgl)
    for (const auto& [name, path] : gonio::io::list_rgl_directory(folder))
      all.push_back({name, [path, threads](const gonio::valid_cells& cells) {
                       return values_of(gonio::tabulate(colours_of_isotropic(path), cells, threads));
                     }});
  return all;
}

/// Returns 400, 410, ... 700 for 400:10:700.
std::vector<double> wavelengths_in(const std::string& text) {
  std::array<double, 3> numbers{};
  std::string_view left = text;
  bool is_range = std::ranges::count(text, ':') == 2;
  for (std::size_t i = 0; i < numbers.size() && is_range; ++i) {
    const std::size_t end = std::min(left.find(':'), left.size());
    is_range = gonio::io::read_number(left.substr(0, end), numbers[i]) == nullptr;
    left.remove_prefix(std::min(end + 1, left.size()));
  }
  const auto [first, step, last] = numbers;
  if (!is_range || !(first > 0.0 && step > 0.0 && last >= first))
    gonio::refuse({"--wavelengths ", text, ": expected FIRST:STEP:LAST in nanometres, as 400:10:700"});
  if (!(last - first < 1024.0 * step)) gonio::refuse({"--wavelengths ", text, ": expected at most 1024 wavelengths"});
  std::vector<double> all;
  for (int i = 0; first + i * step <= last + 1e-6 * step; ++i) all.push_back(std::min(first + i * step, last));
  return all;
}

gonio::io::rgl_material read_spectral_material(const std::filesystem::path& path) {
  gonio::io::rgl_material material = gonio::io::read_rgl(path);
  if (!material.spectra)
    gonio::refuse({path.native(), ": is in RGB, but --spectra needs spectra (gonio convert --spectra writes them)"});
  require_isotropic(material, path);
  return material;
}

/// Returns the spectra of a file over cells, at the requested wavelengths.
std::vector<float> spectra_over(const gonio::valid_cells& cells, const std::filesystem::path& path,
                                const std::vector<double>& wavelengths, bool resampled, gonio::thread_count threads) {
  gonio::io::rgl_material material = read_spectral_material(path);
  if (material.spectra->wavelengths != wavelengths) {
    if (!resampled)
      gonio::refuse({path.native(),
                     ": its wavelengths differ from those of the first material: give --wavelengths FIRST:STEP:LAST"});
    try {
      material.spectra = gonio::io::at_wavelengths(*material.spectra, wavelengths);
    } catch (const gonio::error& refusal) {
      gonio::refuse({path.native(), ": ", refusal.what()});
    }
  }
  const gonio::spectral_table table = gonio::io::tabulate_spectra(material, cells, threads);
  return {table.values().data(), table.values().data() + table.values().size()};
}

/// Returns the materials of folders of spectra, none of them read yet.
std::vector<named_table> spectra_of(const material_source& source, const std::vector<double>& wavelengths,
                                    gonio::thread_count threads) {
  std::vector<named_table> all;
  const bool resampled = !source.wavelengths.empty();
  for (const std::filesystem::path& folder : source.rgl)
    for (const auto& [name, path] : gonio::io::list_rgl_directory(folder))
      all.push_back({name, [path, wavelengths, resampled, threads](const gonio::valid_cells& cells) {
                       return spectra_over(cells, path, wavelengths, resampled, threads);
                     }});
  return all;
}

[[noreturn]] void refuse_all_excluded() { gonio::refuse("--exclude leaves no material"); }

/// Returns the requested wavelengths, or those of the first material; none for colours.
std::vector<double> wavelengths_of(const material_source& source) {
  if (!source.as_spectra) return {};
  if (!source.networks.empty() || !source.tables.empty())
    gonio::refuse("--spectra needs --rgl, without --networks and --merl");
  if (!source.wavelengths.empty()) return wavelengths_in(source.wavelengths);
  for (const std::filesystem::path& folder : source.rgl)
    for (const auto& [name, path] : gonio::io::list_rgl_directory(folder))
      if (std::ranges::find(source.exclude, name) == source.exclude.end())
        return read_spectral_material(path).spectra->wavelengths;
  refuse_all_excluded();
}

void exclude(std::vector<named_table>& all, const std::vector<std::string>& names) {
  for (const std::string& name : names)
    if (std::erase_if(all, [&](const named_table& each) { return each.name == name; }) == 0)
      gonio::refuse("--exclude: there is no material named '" + name + "' in --networks, --merl or --rgl");
}

void require_different(const std::vector<named_table>& all) {
  std::map<std::string, int> seen;
  for (const named_table& each : all)
    if (++seen[each.name] > 1)
      gonio::refuse("two materials of --networks, --merl and --rgl are named '" + each.name + "': rename one");
}

/// Returns the materials in colours, or at some wavelengths.
std::vector<named_table> chosen_tables(const material_source& source, const std::vector<double>& wavelengths,
                                       gonio::thread_count threads) {
  std::vector<named_table> all =
      wavelengths.empty() ? tables_of(source, threads) : spectra_of(source, wavelengths, threads);
  exclude(all, source.exclude);
  if (all.empty()) refuse_all_excluded();
  require_different(all);
  return all;
}

gonio::material_set read_mixed(const material_source& source, gonio::thread_count threads,
                               const gonio::progress& listener) {
  const std::vector<named_table> all = chosen_tables(source, {}, threads);
  gonio::material_set set{gonio::valid_cells(), {}, {}};
  const auto cells = static_cast<Eigen::Index>(set.cells.size());
  set.values.resize(cells, 3 * std::ssize(all));
  for (const named_table& each : all) {
    const auto done = std::ssize(set.names);
    gonio::report(listener, "reading " + each.name, static_cast<double>(done) / static_cast<double>(all.size()));
    const std::vector<float> values = each.tabulate(set.cells);
    set.values.middleCols(3 * done, 3) = Eigen::Map<const gonio::cell_matrix>(values.data(), cells, 3);
    set.names.push_back(each.name);
  }
  return set;
}

}  // namespace

namespace {

void agree_on_names(const team& processes, const std::vector<std::string>& names) {
  processes.agree_on(checksum_of(names), "list of materials");
}

/// Returns the checksum of a few cells of materials that each process has read.
std::uint32_t checksum_of(const gonio::material_rows& materials) {
  const Eigen::Index cells = materials.cells.size(), most = std::min<Eigen::Index>(cells, 64);
  gonio::cell_matrix rows(most, materials.columns());
  for (Eigen::Index i = 0; i < most; ++i)
    materials.read({i * cells / most, i * cells / most + 1}, rows.middleRows(i, 1));
  return gonio::io::checksum(std::as_bytes(std::span(rows.data(), static_cast<std::size_t>(rows.size()))));
}

/// Reads a single folder of MERL tables over their own cells.
gonio::material_rows stream_folder(const material_source& source, gonio::io::scratch_materials& scratch,
                                   const gonio::progress& listener, const team& processes) {
  std::optional<gonio::material_rows> materials;
  processes.together([&] {
    gonio::io::for_each_table(
        source.tables.front(), source.exclude,
        [&](const std::string& name, gonio::brdf_table table, std::size_t) { scratch.append(name, std::move(table)); },
        listener);
    materials = scratch.rows();
  });
  agree_on_names(processes, materials->names);
  if (!processes.is_alone()) processes.agree_on(checksum_of(*materials), "materials");
  return *materials;
}

}  // namespace

gonio::log_relative_pca prior_of(const material_source& source) {
  return source.held_prior ? *source.held_prior : read_prior(source.prior);
}

option_group add_material_options(command& to, material_source& source) {
  option_group group = to.add_option_group("source", "Sources of the materials (one or more)");
  group.add_input("--networks", source.networks, "Files of networks (.npy, names in merl_names.txt beside each)");
  group.add_input_folders("--merl", source.tables, {".binary", ".gz"},
                          "Folders of MERL tables (.binary or .binary.gz)");
  group.add_input_folders("--rgl", source.rgl, {".bsdf"}, "Folders of materials of the RGL database (.bsdf)");
  to.add_option("--exclude", source.exclude, "Name of a material to leave out (repeatable)").repeatable();
  return group;
}

gonio::material_set read_materials(const material_source& source, gonio::thread_count threads,
                                   const gonio::progress& listener) {
  if (source.is_prior()) return gonio::expand(prior_of(source), threads);
  const std::size_t sources = source.networks.size() + source.tables.size() + source.rgl.size();
  if (sources == 1 && !source.tables.empty())
    return gonio::io::read_merl_directory(source.tables.front(), source.exclude, listener);
  if (sources == 1 && !source.networks.empty()) {
    const std::filesystem::path& file = source.networks.front();
    const auto chosen = networks_except(gonio::io::read_networks(file), source.exclude, file);
    return gonio::model::tabulate_networks(chosen, gonio::valid_cells(), threads, listener);
  }
  return read_mixed(source, threads, listener);
}

gonio::material_rows stream_materials(const material_source& source, const std::optional<gonio::valid_cells>& cells,
                                      gonio::io::scratch_materials scratch, gonio::thread_count threads,
                                      const gonio::progress& listener, const team& processes) {
  if (!cells && !source.as_spectra && source.networks.empty() && source.rgl.empty() && source.tables.size() == 1)
    return stream_folder(source, scratch, listener, processes);
  std::vector<double> wavelengths;
  std::vector<named_table> all;
  processes.together([&] {
    wavelengths = wavelengths_of(source);
    all = chosen_tables(source, wavelengths, threads);
  });
  std::vector<std::string> names;
  for (const named_table& each : all) names.push_back(each.name);
  for (const double wavelength : wavelengths) names.push_back(gonio::io::shortest(wavelength));
  agree_on_names(processes, names);
  const gonio::valid_cells over = cells ? *cells : gonio::valid_cells();
  const Eigen::Index channels = gonio::channels_at<gonio::valid_cells>(wavelengths);
  for (std::size_t begin = 0; begin < all.size(); begin += processes.size()) {
    const std::size_t own = begin + processes.number();
    gonio::report(listener, "reading " + all[begin].name, static_cast<double>(begin) / static_cast<double>(all.size()));
    std::vector<float> values(static_cast<std::size_t>(channels * over.size()));
    processes.together([&] {
      if (own < all.size()) values = all[own].tabulate(over);
    });
    std::vector<std::vector<float>> each = processes.exchange_rows(std::move(values), over.size());
    for (std::size_t i = 0; i < each.size() && begin + i < all.size(); ++i)
      scratch.append(all[begin + i].name, over, wavelengths,
                     Eigen::Map<const gonio::cell_matrix>(each[i].data(), over.size(), channels));
  }
  return scratch.rows();
}

}  // namespace cli
