/// gonio learn: principal components of many materials, as a file.

#include "command_line/fixed.hpp"
#include "command_line/materials.hpp"
#include "command_line/progress_bar.hpp"
#include "command_line/thinning.hpp"
#include "command_line/threads_option.hpp"
#include "commands.hpp"
#include <gonio/basis/learn_pca.hpp>
#include <gonio/estimate/soft_specular_decomposition.hpp>
#include <gonio/io/prior.hpp>
#include <gonio/io/soft_specular_prior.hpp>

#include <iostream>
#include <memory>
#include <string>
#include <utility>

namespace cli {

namespace {

struct learn_options {
  material_source materials;
  std::filesystem::path output;
  Eigen::Index components = 60;
  std::string cosine_weight = "product";
  thinning thin{{3, 5}};
  bool split = false;
  gonio::thread_count threads;
};

/// "117 materials of networks in merl_networks.npy, rgl-bsdf".
std::string source_of(const material_source& source, std::size_t materials) {
  std::string text = std::to_string(materials) + " materials of ";
  const std::size_t start = text.size();
  for (const auto* group : {&source.networks, &source.tables, &source.rgl})
    for (const std::filesystem::path& path : *group)
      text += (text.size() == start ? "" : ", ") + path.lexically_normal().filename().string();
  for (const std::string& name : source.exclude) text += (name == source.exclude.front() ? ", without " : ", ") + name;
  return text;
}

/// "kept 60 components of 45 soft of 90 materials of networks.npy: 99.87 % of the mapped variance".
void print_kept(const gonio::log_relative_pca& learned, const std::string& what) {
  std::cout << "kept " << learned.size() << " components of " << what << ": "
            << fixed(100.0 * learned.explained_variance(), 2) << " % of the mapped variance\n";
}

/// One prior for the soft and one for the specular materials.
void learn_split(const learn_options& options, const gonio::material_set& materials, const gonio::log_relative& metric,
                 const std::string& source, const gonio::progress& listener) {
  const auto cells = options.thin.of(materials.cells);
  const auto learned =
      gonio::learn_soft_specular_prior(materials, metric, options.components, {}, options.threads, listener);
  gonio::io::write_soft_specular_prior(options.output, learned.on(cells).with_source(source));
  const auto half = [&](const gonio::log_relative_pca& prior, const char* kind) {
    print_kept(prior, std::to_string(prior.names().size()) + ' ' + kind + " of " + source);
  };
  half(learned.soft(), "soft");
  half(learned.specular(), "specular");
  std::cout << "a material is specular from a highlight contrast of " << fixed(learned.threshold(), 3) << " on\n";
}

void learn(const learn_options& options) {
  progress_bar bar;
  auto materials = read_materials(options.materials, options.threads, bar.listener());
  const std::string source = source_of(options.materials, materials.names.size());
  const auto weighting =
      options.cosine_weight == "larger" ? gonio::cosine_weighting::larger : gonio::cosine_weighting::product;
  const auto metric = gonio::log_relative::to_median_of(materials, options.threads).weighted_by(weighting);
  if (options.split) return learn_split(options, materials, metric, source, bar.listener());
  const auto cells = options.thin.of(materials.cells);
  const auto learned =
      gonio::learn_pca(std::move(materials), metric, options.components, options.threads, bar.listener());
  gonio::io::write_prior(options.output, gonio::thin(learned, cells).with_source(source));
  print_kept(learned, source);
}

}  // namespace

void add_learn(command& app) {
  auto command = app.add_subcommand("learn", "Learn a prior (principal components) from many materials");
  const auto options = std::make_shared<learn_options>();
  add_material_options(command, options->materials).require_option(1, 3);
  command.add_option("--components", options->components, "Number of components to keep")
      .check(check::positive_number())
      .capture_default_str();
  command
      .add_option("--cosine-weight", options->cosine_weight,
                  "What weights a reflectance before its logarithm is taken: product of both cosines (Nielsen et al. "
                  "2015, Eq. 2), or the larger of them (Xu et al. 2016, section 3). The prior keeps it")
      .check(check::one_of({"product", "larger"}))
      .capture_default_str();
  command.add_flag("--split", options->split,
                   "Two priors in one file, of the soft and of the specular half of the materials by the contrast of "
                   "their highlights, for gonio reconstruct --method soft-specular (Nielsen et al. 2015, section 8)");
  add_thin_option(command, options->thin);
  command.add_output("-o,--output", options->output, {".prior"}, "Prior to write (.prior)").required();
  add_threads_option(command, options->threads);
  command.callback([options] { learn(*options); });
}

}  // namespace cli
