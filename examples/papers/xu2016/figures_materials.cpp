/// Nielsen et al. 2015, Fig. 2 and 12, and Xu et al. 2016, Fig. 2 and 15: the ten materials one by one.

#include "papers/experiments.hpp"
#include "papers/material_result.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/xu2016/figures.hpp"
#include "tool/pages/contact_sheet.hpp"
#include <gonio/basis/project.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/design/sphere_geometry.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/appearance_metric.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/render/exposure.hpp>
#include <gonio/render/horizon_lookup.hpp>
#include <gonio/render/image.hpp>
#include <gonio/render/sphere.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <functional>
#include <span>

namespace papers::figures {

namespace {

using angles = std::vector<gonio::half_difference>;

/// The directions measured of every material. An empty set stands for the projection of the full table.
struct measured_set {
  std::string name;
  angles directions = {};
};

gonio::brdf_table reconstructed(const options& given, const gonio::log_relative_pca& prior,
                                const gonio::brdf_table& truth, const angles& directions) {
  if (directions.empty())
    return gonio::fitted_brdf(prior, Eigen::MatrixXd(gonio::project(prior, truth, given.threads)))
        .tabulate(truth.cells(), given.threads);
  const auto samples = gonio::sample_table(truth, gonio::cells_at(truth.cells(), directions));
  return gonio::decomposition{prior, gonio::tikhonov{given.eta}}.fit(samples).tabulate(truth.cells(), given.threads);
}

/// Tabulates one measure of all estimates, one row per material and one column per set.
table measure_of(const std::string& title, const std::vector<measured_set>& sets,
                 const std::vector<std::vector<material_result>>& results, int digits,
                 const std::function<double(const gonio::comparison&)>& measure) {
  table shown{title, {{"material"}}};
  for (const measured_set& set : sets) shown.columns.push_back({set.name, digits});
  for (std::size_t m = 0; m < results.front().size(); ++m) {
    auto& row = shown.rows.emplace_back(std::vector<json>{results.front()[m].name});
    for (const auto& of_set : results) row.emplace_back(measure(of_set[m].errors));
  }
  auto& mean = shown.rows.emplace_back(std::vector<json>{"mean"});
  for (const auto& of_set : results) mean.emplace_back(mean_over(of_set, measure));
  return shown;
}

gonio::image draw(const gonio::brdf_table& material, gonio::thread_count threads) {
  return gonio::render::render_sphere(gonio::render::horizon_lookup(material), gonio::render::two_lights(),
                                      {.size = 128, .supersampling = 2}, threads);
}

/// Exposes a material's spheres like the sphere of the truth, the last in the row.
void expose_as_truth(std::span<gonio::image> row) {
  const double exposure = gonio::render::exposure_of_spheres(row.last(1));
  for (gonio::image& sphere : row) gonio::render::expose(sphere, exposure);
}

/// Reconstructs the ten materials from each set and tabulates every measure. If a file is given, draws spheres under
/// the papers' two lights.
tables judged(const options& given, const nielsen_split& split, const std::vector<measured_set>& sets,
              const gonio::progress& listener) {
  const gonio::appearance_metric appearance(split.truths.cells, 36, given.threads);
  std::vector<std::vector<material_result>> results(sets.size());
  std::vector<gonio::image> spheres;
  cli::sheet_text text;
  for (std::size_t m = 0; m < split.truths.names.size(); ++m) {
    const std::string& name = split.truths.names[m];
    gonio::report(listener, name, static_cast<double>(m) / static_cast<double>(split.truths.names.size()));
    const gonio::brdf_table truth = split.truths.table(m);
    for (std::size_t s = 0; s < sets.size(); ++s) {
      const auto estimate = reconstructed(given, split.prior, truth, sets[s].directions);
      results[s].push_back({name, gonio::compare(estimate, truth, split.prior.metric(), appearance, given.threads)});
      if (given.spheres.empty()) continue;
      spheres.push_back(draw(estimate, given.threads));
      text.labels.push_back(sets[s].name);
    }
    if (given.spheres.empty()) continue;
    spheres.push_back(draw(truth, given.threads));
    text.labels.push_back(name);
    expose_as_truth(std::span(spheres).last(sets.size() + 1));
  }
  if (!given.spheres.empty()) gonio::io::write_png(given.spheres, cli::contact_sheet(spheres, sets.size() + 1, text));
  return {measure_of("Mapped error, mean over the channels", sets, results, 3,
                     [](const gonio::comparison& errors) { return errors.mapped_rms.mean(); }),
          measure_of("Delta E of spheres under two lights", sets, results, 2,
                     [](const gonio::comparison& errors) { return errors.delta_e_lights; }),
          measure_of("Delta E of spheres under the environment", sets, results, 2,
                     [](const gonio::comparison& errors) { return errors.delta_e_env; })};
}

/// Adds a set, named after its source and its size, unless it is empty.
void add(std::vector<measured_set>& sets, const std::string& name, std::size_t n, angles directions) {
  if (!directions.empty()) sets.push_back({name + ' ' + std::to_string(n), std::move(directions)});
}

/// Returns all samples of the images of a sphere, published or by expected error; none if the size is not printed.
angles sphere_samples(const gonio::valid_cells& cells, const std::string& set, Eigen::Index n) {
  const gonio::design::sphere_geometry spheres(cells);
  return samples_of(spheres, sphere_slices(spheres, set, n));
}

}  // namespace

tables nielsen_2(const options& given, const gonio::progress& listener) {
  const auto split = nielsen_split::learn(given.networks, given.threads, listener, given.weighting);
  std::vector<measured_set> sets;
  for (const char* set : {"published", "expected-error"})
    for (const std::size_t n : {1, 2, 3, 5, 10, 20})
      if (n <= given.up_to(20)) add(sets, set, n, written_points(shipped_directions(), set, n).value_or(angles()));
  sets.push_back({"all"});
  return judged(given, split, sets, listener);
}

tables nielsen_12(const options& given, const gonio::progress& listener) {
  const auto split = nielsen_split::learn(given.networks, given.threads, listener, given.weighting);
  std::vector<measured_set> sets;
  for (const char* set : {"published", "expected-error"})
    for (const std::size_t n : {1, 2, 5})
      if (n <= given.up_to(5)) add(sets, set, n, sphere_samples(split.truths.cells, set, n));
  sets.push_back({"all"});
  tables shown = judged(given, split, sets, listener);
  if (!given.measured_samples.empty()) shown.push_back(paints_from_spheres(given, split.prior));
  return shown;
}

tables xu_2(const options& given, const gonio::progress& listener) {
  const auto split = nielsen_split::learn(given.networks, given.threads, listener, given.weighting);
  const std::vector<measured_set> sets{
      {"one image", samples_of_images(shipped_poses("near-field-25-1-expected-error"))},
      {"5 points, published", gonio::design::nielsen_directions(5)},
      {"two images", samples_of_images(shipped_poses("near-field-25-2-expected-error"))},
      {"20 points, published", gonio::design::nielsen_directions(20)},
      {"one image, perceived", samples_of_images(shipped_poses("near-field-25-1-perceived"))},
      {"two images, perceived", samples_of_images(shipped_poses("near-field-25-2-perceived"))},
      {"all"}};
  return judged(given, split, sets, listener);
}

tables xu_15(const options& given, const gonio::progress& listener) {
  const auto split = nielsen_split::learn(given.networks, given.threads, listener, given.weighting);
  const std::vector<measured_set> sets{
      {"two images, free", samples_of_images(shipped_poses("near-field-25-2-expected-error"))},
      {"fixed camera", samples_of_images(shipped_poses("fixed-camera-25-2-expected-error"))},
      {"fixed camera, printed", samples_of_images(printed_fixed_camera())},
      {"one image", samples_of_images(shipped_poses("near-field-25-1-expected-error"))}};
  return judged(given, split, sets, listener);
}

}  // namespace papers::figures
