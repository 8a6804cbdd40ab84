#include "material_library.hpp"

#include <gonio/basis/learn_pca.hpp>
#include <gonio/io/networks.hpp>
#include <gonio/io/rgl.hpp>

#include <algorithm>
#include <utility>

namespace papers {

std::string family_of(const std::string& name) { return name.substr(0, name.find('_')); }

gonio::sample_set samples_of(const real_material& material, const std::vector<gonio::half_difference>& directions) {
  gonio::sample_set samples;
  for (const gonio::half_difference& angles : directions)
    samples.push_back({angles, material.measured(gonio::to_directions(angles)), 1.0});
  return samples;
}

gonio::sample_set of_mean_material(const gonio::sample_set& samples, const gonio::log_relative_pca& prior) {
  gonio::sample_set mean;
  for (const gonio::sample& s : samples) {
    const gonio::location at = gonio::locate(prior.cells(), s.angles());
    const double value = prior.metric().inverse(gonio::offset_at(prior, at), at);
    mean.push_back({s.angles(), gonio::rgb::Constant(std::max(value, 0.0)), 1.0});
  }
  return mean;
}

material_library::material_library(const std::vector<std::filesystem::path>& networks,
                                   const std::filesystem::path& materials, gonio::valid_cells cells,
                                   gonio::thread_count threads, const gonio::progress& listener)
    : cells_(std::move(cells)), folder_(materials), threads_(threads) {
  for (const std::filesystem::path& file : networks)
    sets_.push_back(gonio::model::tabulate_networks(gonio::io::read_networks(file), cells_, threads, listener));
  gonio::material_set measured{cells_, {}, {}};
  const auto files = gonio::io::list_rgl_directory(materials);
  if (files.empty()) gonio::refuse(materials.string() + ": holds no material (*.bsdf)");
  measured.values.resize(cells_.size(), 3 * std::ssize(files));
  for (const auto& [name, path] : files) {
    const gonio::brdf_table table = gonio::tabulate(gonio::io::read_rgl(path).material, cells_, threads);
    measured.values.middleCols(3 * std::ssize(measured.names), 3) =
        Eigen::Map<const gonio::cell_matrix>(table.values().data(), measured.values.rows(), 3);
    measured.names.push_back(name);
  }
  sets_.push_back(std::move(measured));
}

std::vector<real_material> material_library::real_materials() const {
  std::vector<real_material> all;
  for (const auto& [name, path] : gonio::io::list_rgl_directory(folder_)) {
    const auto measured = [f = gonio::io::read_rgl(path).material](const gonio::direction_pair& pair) -> gonio::rgb {
      return f(pair.wi, pair.wo);
    };
    all.push_back({name, family_of(name), sets_.back().table(sets_.back().find(name)), measured});
  }
  return all;
}

gonio::log_relative_pca material_library::prior_without(const std::string& family, Eigen::Index components) const {
  auto set = materials(all(), [&](const std::string& name) { return family_of(name) != family; });
  const auto metric = gonio::log_relative::to_median_of(set, threads_);
  return gonio::learn_pca(std::move(set), metric, components, threads_);
}

}  // namespace papers
