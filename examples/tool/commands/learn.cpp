/// gonio learn: learns principal components of many materials and writes them to a file.

#include "commands.hpp"
#include "tool/options/materials.hpp"
#include "tool/options/shipped_data.hpp"
#include "tool/options/team.hpp"
#include "tool/options/thinning.hpp"
#include "tool/options/threads_option.hpp"
#include "tool/pages/fixed.hpp"
#include "tool/pages/progress_bar.hpp"
#include <gonio/basis/add_materials.hpp>
#include <gonio/basis/learn_pca.hpp>
#include <gonio/basis/learn_streamed_pca.hpp>
#include <gonio/estimate/learn_streamed_soft_specular.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/soft_specular_prior.hpp>
#include <gonio/io/text/text.hpp>

#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace cli {

namespace {

struct learn_options {
  material_source materials;
  std::filesystem::path output, add_to, scratch;
  Eigen::Index components = 60;
  std::string cosine_weight = "product";
  thinning thin{{3, 5}};
  bool split = false;
  double memory = 2.0;  ///< GiB
  std::uint64_t seed = 1;
  gonio::thread_count threads;
};

/// Returns "117 materials of merl_networks.npy, rgl-bsdf".
std::string source_of(const material_source& source, std::size_t materials) {
  std::string text = std::to_string(materials) + " materials of ";
  const std::size_t start = text.size();
  for (const auto* group : {&source.networks, &source.tables, &source.rgl})
    for (const std::filesystem::path& path : *group)
      text += (text.size() == start ? "" : ", ") + path.lexically_normal().filename().string();
  for (const std::string& name : source.exclude) text += (name == source.exclude.front() ? ", without " : ", ") + name;
  return text;
}

std::string source_of(const material_source& source, const gonio::material_rows& materials) {
  const std::string text = source_of(source, materials.names.size());
  if (materials.wavelengths.empty()) return text;
  return text + ", at " + std::to_string(materials.wavelengths.size()) + " wavelengths from " +
         gonio::io::shortest(materials.wavelengths.front()) + " to " +
         gonio::io::shortest(materials.wavelengths.back()) + " nm";
}

/// Prints "kept 60 components of 45 soft of 90 materials of networks.npy: 99.87 % of the mapped variance".
void print_kept(const gonio::log_relative_pca& learned, const std::string& what) {
  std::cout << "kept " << learned.size() << " components of " << what << ": "
            << fixed(100.0 * learned.explained_variance(), 2) << " % of the mapped variance\n";
}

void print_residual(bool exact, double residual) {
  if (!exact)
    std::cout << "found in a random subspace: squared singular values are accurate to " << fixed(100.0 * residual, 6)
              << " % of the variance\n";
}

gonio::cosine_weighting weighting_of(const learn_options& options) {
  return options.cosine_weight == "larger" ? gonio::cosine_weighting::larger : gonio::cosine_weighting::product;
}

/// Reads the materials once, into a scratch file if they take more than a quarter of --memory.
gonio::material_rows stream(const learn_options& options, const std::optional<gonio::valid_cells>& cells,
                            const gonio::progress& listener, const team& processes) {
  const auto bytes = static_cast<std::uint64_t>(options.memory * 0x1p30);
  const auto folder = options.scratch.empty() ? options.output.parent_path() : options.scratch;
  return stream_materials(options.materials, cells, gonio::io::scratch_materials(folder, bytes / 4), options.threads,
                          listener, processes);
}

/// Learns one prior for soft and one for specular materials. Not distributed over processes.
void learn_split(const learn_options& options, const gonio::streaming_options& streaming) {
  progress_bar bar;
  const auto materials = stream(options, {}, bar.listener(), alone());
  const std::string source = source_of(options.materials, materials.names.size());
  const auto learned = gonio::learn_streamed_soft_specular(materials, streaming, {}, bar.listener());
  const auto prior = learned.prior.on(options.thin.of(materials.cells)).with_source(source);
  gonio::io::write_soft_specular_prior(options.output, prior);
  bar.wipe();
  for (const auto& [half, kind] :
       {std::pair(&prior.soft(), " soft of "), std::pair(&prior.specular(), " specular of ")})
    print_kept(*half, std::to_string(half->names().size()) + kind + source);
  print_residual(learned.exact, learned.residual);
  std::cout << "a material is specular if its highlight contrast is at least " << fixed(prior.threshold(), 3) << '\n';
}

void learn(const learn_options& options, const team& processes) {
  gonio::streaming_options streaming{.components = options.components,
                                     .weighting = weighting_of(options),
                                     .subspace = {.seed = options.seed},
                                     .memory = static_cast<std::uint64_t>(options.memory * 0x1p30),
                                     .threads = options.threads};
  if (options.split) {
    if (processes.writes()) learn_split(options, streaming);
    return;
  }
  streaming.share = processes.groups();
  progress_bar bar;
  const auto finish = [&](const gonio::streamed_pca& learned, const gonio::log_relative_pca& prior,
                          const std::string& source) {
    if (!processes.writes()) return;
    gonio::io::write_prior(options.output, prior.with_source(source));
    bar.wipe();
    print_kept(prior, source);
    print_residual(learned.exact, learned.residual);
  };
  if (!options.add_to.empty()) {
    const auto old = read_prior(options.add_to);
    const auto materials = stream(options, old.cells(), bar.listener(), processes);
    const std::string source =
        old.source() + (old.source().empty() ? "" : "; then ") + source_of(options.materials, materials);
    const auto learned = gonio::add_materials(old, materials, streaming, bar.listener());
    return finish(learned, learned.prior, source);
  }
  const auto materials = stream(options, {}, bar.listener(), processes);
  const auto cells = options.thin.of(materials.cells);
  const auto learned = gonio::learn_streamed_pca(materials, streaming, bar.listener());
  finish(learned, gonio::thin(learned.prior, cells), source_of(options.materials, materials));
}

void learn_together(learn_options options, const team& processes) {
  options.threads = processes.threads(options.threads);
  agree_on_file(processes, options.add_to, "--add-to");
  processes.together([&] { learn(options, processes); });
}

}  // namespace

void add_learn(command& app, const team& processes) {
  auto command = app.add_subcommand("learn", "Learn a prior (principal components) from many materials");
  const auto options = std::make_shared<learn_options>();
  add_material_options(command, options->materials).require_option(1, 3);
  command.add_option("--components", options->components, "Number of components to keep")
      .check(check::positive_number())
      .capture_default_str();
  const auto weight =
      command
          .add_option("--cosine-weight", options->cosine_weight,
                      "Weight of reflectance inside the logarithm: product of both cosines (Nielsen et al. 2015, Eq. "
                      "2), or the larger of them (Xu et al. 2016, section 3). The prior stores which one was used")
          .check(check::one_of({"product", "larger"}))
          .capture_default_str();
  const auto split = command.add_flag(
      "--split", options->split,
      "Write two priors to one file for gonio reconstruct --method soft-specular: one of soft, one of specular "
      "materials, distinguished by the contrast of their highlights (Nielsen et al. 2015, section 8)");
  const auto spectra =
      command
          .add_flag(
              "--spectra", options->materials.as_spectra,
              "Learn spectra of --rgl materials instead of colours. If their wavelengths differ, needs --wavelengths")
          .excludes(split);
  command
      .add_option("--wavelengths", options->materials.wavelengths,
                  "With --spectra: wavelengths FIRST:STEP:LAST in nanometres, as 400:10:700. Reflectance is "
                  "interpolated linearly")
      .needs(spectra);
  const auto thin = add_thin_option(command, options->thin);
  command
      .add_input("--add-to", options->add_to,
                 "Earlier prior (.prior), to which the materials are added. Its cells and its reference are kept; the "
                 "tables that it was learned from are not needed (Ross et al. 2008)")
      .excludes(split)
      .excludes(thin)
      .excludes(weight);
  command
      .add_option("--memory", options->memory,
                  "Memory limit in GiB, not counting the components. Tables that do not fit go to a scratch file")
      .check(check::range(1.0, 65536.0))
      .capture_default_str();
  command.add_input_folder("--scratch", options->scratch, {},
                           "Folder of the scratch file (default: the folder of --output)");
  command
      .add_option("--seed", options->seed,
                  "Seed of the random subspace, which is used if there are more than 1024 columns: three for each "
                  "material, or one for each wavelength (Halko et al. 2011)")
      .capture_default_str();
  command.add_output("-o,--output", options->output, {".prior"}, "Prior to write (.prior)").required();
  add_threads_option(command, options->threads);
  command.callback([options, &processes] { learn_together(*options, processes); });
}

}  // namespace cli
