/// gonio learn: principal components of many materials, as a file.

#include "command_line/fixed.hpp"
#include "command_line/materials.hpp"
#include "command_line/progress_bar.hpp"
#include "command_line/thinning.hpp"
#include "command_line/threads_option.hpp"
#include "commands.hpp"
#include <gonio/basis/learn_pca.hpp>
#include <gonio/io/prior.hpp>

#include <iostream>
#include <memory>

namespace cli {

namespace {

struct learn_options {
  material_source materials;
  std::filesystem::path output;
  Eigen::Index components = 60;
  std::string cosine_weight = "product";
  thinning thin{{3, 5}};
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
  add_thin_option(command, options->thin);
  command.add_output("-o,--output", options->output, {".prior"}, "Prior to write (.prior)").required();
  add_threads_option(command, options->threads);
  command.callback([options] {
    progress_bar bar;
    auto materials = read_materials(options->materials, options->threads, bar.listener());
    const std::string source_text = source_of(options->materials, materials.names.size());
    const auto cells = options->thin.of(materials.cells);
    const auto weighting =
        options->cosine_weight == "larger" ? gonio::cosine_weighting::larger : gonio::cosine_weighting::product;
    const auto metric = gonio::log_relative::to_median_of(materials, options->threads).weighted_by(weighting);
    const auto learned =
        gonio::learn_pca(std::move(materials), metric, options->components, options->threads, bar.listener());
    gonio::io::write_prior(options->output, gonio::thin(learned, cells).with_source(source_text));
    std::cout << "kept " << learned.size() << " components of " << source_text << ": "
              << fixed(100.0 * learned.explained_variance(), 2) << " % of the mapped variance\n";
  });
}

}  // namespace cli
