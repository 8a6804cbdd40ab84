#include "component_figure.hpp"

#include "contact_sheet.hpp"
#include "fixed.hpp"
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/render/exposure.hpp>
#include <gonio/render/false_colour.hpp>
#include <gonio/render/horizon_lookup.hpp>
#include <gonio/render/sphere.hpp>

#include <array>
#include <numbers>
#include <vector>

namespace cli {

namespace {

/// Returns an image with pixels `colour(i)`, row by row from the top.
template <class Colour>
gonio::image square_image(int size, const Colour& colour) {
  const std::size_t side = size;
  gonio::image square({side, side, std::size_t{3}});
  for (std::size_t row = 0; row < side; ++row)
    for (std::size_t column = 0; column < side; ++column)
      gonio::set_pixel(square, row, column, colour(static_cast<Eigen::Index>(row * side + column)));
  return square;
}

}  // namespace

component_figure detail::colour_slices(const Eigen::MatrixXd& values, int size,
                                       const Eigen::VectorXd& shares_of_variance, const std::string& name) {
  component_figure figure;
  sheet_text text{{"reference"},
                  name + (name.empty() ? "" : ": ") +
                      "theta_h to the right, theta_d upwards, phi_d 90 degrees; red more, blue less"};
  std::vector<gonio::image> slices{
      square_image(size, [&](Eigen::Index i) { return gonio::rgb::Constant(std::numbers::pi * values(i, 0)); })};
  for (Eigen::Index k = 1; k < values.cols(); ++k) {
    const double largest = values.col(k).cwiseAbs().maxCoeff(), limit = largest > 0.0 ? largest : 1.0;
    figure.limits.push_back(largest);
    slices.push_back(
        square_image(size, [&](Eigen::Index i) { return gonio::render::diverging_colour(values(i, k), limit); }));
    text.labels.push_back(std::to_string(k) + ": " + fixed(100.0 * shares_of_variance[k - 1], 1) + " %");
  }
  figure.image = contact_sheet(slices, slices.size(), text);
  return figure;
}

gonio::image draw_component_spheres(const gonio::log_relative_pca& prior, Eigen::Index count, int size,
                                    gonio::thread_count threads) {
  const Eigen::VectorXd deviations = gonio::weight_deviations(prior.coefficients());
  const auto sphere = [&](Eigen::Index component, double weight) {
    Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(prior.size(), 3);
    weights.row(component).setConstant(weight * deviations[component]);
    const auto table = gonio::fitted_brdf(prior, weights).tabulate(prior.cells(), threads);
    return gonio::render::render_sphere(gonio::render::horizon_lookup(table), gonio::render::two_lights(),
                                        {.size = size, .supersampling = 3}, threads);
  };
  const std::array mean{sphere(0, 0.0)};
  const double exposure = gonio::render::exposure_of_spheres(mean);
  std::vector<gonio::image> spheres;
  sheet_text text{{}, "component: deviations"};
  for (const int weight : {-2, -1, 0, 1, 2})
    for (Eigen::Index component = 0; component < count; ++component) {
      spheres.push_back(weight == 0 ? mean.front() : sphere(component, weight));
      gonio::render::expose(spheres.back(), exposure);
      text.labels.push_back(std::to_string(component + 1) + ": " + (weight > 0 ? "+" : "") + std::to_string(weight));
    }
  return contact_sheet(spheres, static_cast<std::size_t>(count), text);
}

}  // namespace cli
