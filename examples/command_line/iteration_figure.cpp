#include "iteration_figure.hpp"

#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/evaluate/sphere_delta_e.hpp>
#include <gonio/render/slice.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace cli {

namespace {

constexpr int cells_across = 72;  // of a slice's measured cells, and points across a sphere
constexpr int tile = 2 * cells_across;
constexpr std::size_t margin = 6;
const gonio::rgb paper = gonio::rgb::Constant(0.35);

/// Each pixel as a square of 2 x 2.
gonio::image doubled(const gonio::image& image) {
  gonio::image large({2 * image.shape(0), 2 * image.shape(1), std::size_t{3}});
  for (std::size_t row = 0; row < large.shape(0); ++row)
    for (std::size_t column = 0; column < large.shape(1); ++column)
      gonio::set_pixel(large, row, column, gonio::pixel(image, row / 2, column / 2));
  return large;
}

template <gonio::brdf Brdf>
gonio::image slice(const Brdf& f, gonio::thread_count threads) {
  return gonio::render::render_slice(f, {.rows = tile, .columns = tile}, threads);
}

/// A factor's colour: blue for a half or less, green for 1, red for 2 or more; the mean of the channels' logarithms.
gonio::rgb factor_colour(const gonio::rgb& sigma) {
  return gonio::render::false_colour(sigma.max(1e-6).log().mean() / std::numbers::ln2, {-1.0, 1.0});
}

/// A slice of factors in false colour. `sigma(wi, wo)` is a factor for each channel.
template <class Sigma>
gonio::image factor_slice(const Sigma& sigma, gonio::thread_count threads) {
  const auto colour = [&](const gonio::direction& wi, const gonio::direction& wo) noexcept -> gonio::rgb {
    return factor_colour(sigma(wi, wo)) / std::numbers::pi;  // which the slice multiplies by
  };
  return slice(colour, threads);
}

/// How far a sample is from the slice at phi_d = 90 degrees, in radians.
double distance_to_slice(const gonio::sample& s) {
  const double turns = s.angles().phi_d / std::numbers::pi;
  return std::abs(turns - std::floor(turns) - 0.5) * std::numbers::pi;
}

/// The samples that a slice shows, the nearest last: those within half a degree or, if these are fewer than 400, the
/// 400 nearest.
std::vector<Eigen::Index> samples_near_slice(const gonio::sample_set& samples) {
  constexpr std::size_t enough = 400;
  std::vector<Eigen::Index> order(samples.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return std::pair(distance_to_slice(samples[i]), i); });
  std::size_t count = std::min(enough, order.size());
  while (count < order.size() && distance_to_slice(samples[order[count]]) <= gonio::radians(0.51)) ++count;
  order.resize(count);
  std::ranges::reverse(order);
  return order;
}

/// A slice of what is known at samples: a square of 2 x 2 pixels for each, and of 4 x 4 where they are few.
template <class Colour>
gonio::image sparse_slice(const gonio::sample_set& samples, const gonio::rgb& nothing, Colour&& colour) {
  const gonio::grid nodes({cells_across, cells_across, 1}, gonio::cell_anchor::centre);
  const auto shown = samples_near_slice(samples);
  const int reach = shown.size() <= 400 ? 1 : 0;
  gonio::image image = gonio::uniform_image(tile, tile, nothing);
  for (const Eigen::Index i : shown) {
    const gonio::half_difference in_slice{samples[i].angles().theta_h, samples[i].angles().theta_d, 0.0};
    const gonio::cell_index cell = nodes.nearest(in_slice);
    const int left = 2 * cell.theta_h, top = tile - 2 - 2 * cell.theta_d;
    for (int row = std::max(top - reach, 0); row < std::min(top + 2 + reach, tile); ++row)
      for (int column = std::max(left - reach, 0); column < std::min(left + 2 + reach, tile); ++column)
        gonio::set_pixel(image, row, column, colour(i));
  }
  return image;
}

/// Images in columns of equal tiles; a column may end before the others.
gonio::image in_columns(const std::vector<std::vector<gonio::image>>& columns) {
  std::size_t rows = 0;
  for (const auto& column : columns) rows = std::max(rows, column.size());
  constexpr std::size_t step = std::size_t{tile} + margin;
  gonio::image canvas = gonio::uniform_image(margin + rows * step, margin + columns.size() * step, paper);
  for (std::size_t x = 0; x < columns.size(); ++x)
    for (std::size_t y = 0; y < columns[x].size(); ++y)
      gonio::render::paste(canvas, columns[x][y], margin + y * step, margin + x * step);
  return canvas;
}

/// Spheres under the environment, all at the exposure of one of them.
class gallery {
 public:
  gallery(const gonio::brdf_table& reference, gonio::thread_count threads)
      : threads_(threads),
        delta_e_(reference.cells(), gonio::render::environment_lighting{}, cells_across,
                 gonio::sphere_delta_e::middle_grey, threads),
        reference_(delta_e_.expose(reference, threads)) {}

  [[nodiscard]] gonio::image sphere(const gonio::brdf_table& table) const {
    const gonio::render::sphere_colours colours = reference_.exposure * delta_e_.sphere().apply(table, threads_);
    return doubled(delta_e_.sphere().to_image(colours, paper));
  }

  struct verdict {
    gonio::image image;
    double mean = 0.0;
  };
  /// The CIELAB differences of a table's sphere to that of the reference.
  [[nodiscard]] verdict difference(const gonio::brdf_table& table) const {
    const auto seen = delta_e_.look(table, reference_.exposure, threads_);
    return {doubled(delta_e_.difference_image(seen, reference_, {}, paper)), delta_e_.difference(seen, reference_)};
  }

 private:
  gonio::thread_count threads_;
  gonio::sphere_delta_e delta_e_;
  gonio::sphere_appearance reference_;
};

}  // namespace

iteration_figure::iteration_figure(gonio::correction corrections, gonio::sample_set samples,
                                   std::optional<gonio::brdf_table> truth, gonio::thread_count threads)
    : corrections_(std::move(corrections)), samples_(std::move(samples)), truth_(std::move(truth)), threads_(threads) {
  if (truth_) truth_ = gonio::resample(*truth_, gonio::valid_cells(), threads_);
}

/// Keeps the start, rounds 1 and 2, and the last two.
void iteration_figure::keep(moment now) {
  moments_.push_back(std::move(now));
  if (moments_.size() > 5) moments_.erase(moments_.begin() + 3);
}

gonio::image iteration_figure::draw_input() const {
  return sparse_slice(samples_, {1.0, 0.0, 0.0},
                      [&](std::size_t i) { return gonio::rgb(std::numbers::pi * samples_[i].value); });
}

/// From the table and not from the run, which may look at some of the samples only.
gonio::image iteration_figure::draw_factors(const moment& before) const {
  return sparse_slice(samples_, gonio::rgb::Zero(), [&](std::size_t i) {
    const gonio::location at = gonio::locate(before.estimate.cells(), samples_[i].angles());
    const Eigen::Array3f measured = samples_[i].value.cast<float>(), estimate = before.estimate.at(at).cast<float>();
    const Eigen::Array3f sigma = corrections_.rule().factor.quotient(measured, estimate);
    return factor_colour(sigma.cast<double>());
  });
}

gonio::image iteration_figure::draw_correction(const moment& round) const {
  return factor_slice(gonio::fitted_brdf{corrections_, round.weights}, threads_);
}

gonio::image iteration_figure::draw_true_correction(const moment& before) const {
  const auto sigma = [&](const gonio::direction& wi, const gonio::direction& wo) noexcept -> gonio::rgb {
    const Eigen::Array3f truth = (*truth_)(wi, wo).cast<float>(), estimate = before.estimate(wi, wo).cast<float>();
    return Eigen::Array3f(corrections_.rule().factor.quotient(truth, estimate)).cast<double>();
  };
  return factor_slice(sigma, threads_);
}

iteration_image iteration_figure::draw() const {
  const gallery spheres(truth_ ? *truth_ : moments_.back().estimate, threads_);
  iteration_image result;
  std::vector<std::vector<gonio::image>> columns;

  // What is given.
  if (truth_)
    columns.push_back({slice(*truth_, threads_), spheres.sphere(*truth_), draw_input()});
  else
    columns.push_back({draw_input()});

  for (std::size_t i = 0; i < moments_.size(); ++i) {
    if (i > 2 && i + 1 < moments_.size()) continue;  // kept for the last, which it comes before
    const moment& now = moments_[i];
    if (i > 0) {
      const moment& before = moments_[i - 1];
      columns.push_back({draw_factors(before), draw_correction(now)});
      if (truth_) columns.back().push_back(draw_true_correction(before));
    }
    columns.push_back({slice(now.estimate, threads_), spheres.sphere(now.estimate)});
    if (!truth_) continue;
    auto [image, mean] = spheres.difference(now.estimate);
    columns.back().push_back(std::move(image));
    result.differences.emplace_back(now.round, mean);
  }
  result.image = in_columns(columns);
  return result;
}

}  // namespace cli
