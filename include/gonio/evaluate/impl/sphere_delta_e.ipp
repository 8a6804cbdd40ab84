#pragma once
/// Bodies of evaluate/sphere_delta_e.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/evaluate/sphere_delta_e.hpp>
#include <gonio/render/false_colour.hpp>
#include <gonio/render/sphere.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace gonio {

GONIO_INLINE sphere_appearance sphere_delta_e::expose(const brdf_table& truth, thread_count threads) const {
  const render::sphere_colours colours = visible_colours(truth, threads);
  double sum = 0.0;
  for (Eigen::Index point = 0; point < colours.rows(); ++point) sum += luminance(colours.row(point).transpose());
  const double mean = sum / static_cast<double>(colours.rows());
  return seen_at(mean > 0.0 ? mean_luminance_ / mean : 1.0, colours);
}

GONIO_INLINE sphere_appearance sphere_delta_e::look(const brdf_table& table, double exposure,
                                                    thread_count threads) const {
  GONIO_ASSERT(exposure > 0.0);
  return seen_at(exposure, visible_colours(table, threads));
}

GONIO_INLINE Eigen::ArrayXd sphere_delta_e::differences(const sphere_appearance& a, const sphere_appearance& b) {
  GONIO_ASSERT(a.lab.rows() == b.lab.rows());
  return (a.lab - b.lab).matrix().rowwise().norm();
}

GONIO_INLINE double sphere_delta_e::difference(const sphere_appearance& a, const sphere_appearance& b) {
  GONIO_ASSERT(a.lab.rows() == b.lab.rows());
  return (a.lab - b.lab).matrix().rowwise().norm().mean();
}

GONIO_INLINE image sphere_delta_e::difference_image(const sphere_appearance& a, const sphere_appearance& b,
                                                    double largest, const rgb& background) const {
  const Eigen::ArrayXd values = differences(a, b);
  render::sphere_colours colours(values.size(), 3);
  for (Eigen::Index point = 0; point < values.size(); ++point)
    colours.row(point) = render::difference_colour(values[point], largest).transpose();
  return sphere_.to_image(colours, background);
}

GONIO_INLINE double sphere_delta_e::checked(double mean_luminance) {
  if (!(mean_luminance > 0.0 && std::isfinite(mean_luminance)))
    refuse("a sphere cannot be exposed to a mean luminance of " + std::to_string(mean_luminance) +
           ", expected a positive number");
  return mean_luminance;
}

GONIO_INLINE render::sphere_colours sphere_delta_e::visible_colours(const brdf_table& table,
                                                                    thread_count threads) const {
  const auto negative = [](float value) { return value < 0.0f; };
  if (std::ranges::none_of(table.values(), negative)) return sphere_.apply(table, threads);
  brdf_table clamped = table;
  std::ranges::replace_if(clamped.values(), negative, 0.0f);
  return sphere_.apply(clamped, threads);
}

GONIO_INLINE sphere_appearance sphere_delta_e::seen_at(double exposure, const render::sphere_colours& colours) {
  sphere_appearance seen{render::sphere_colours(colours.rows(), 3), exposure};
  for (Eigen::Index point = 0; point < colours.rows(); ++point)
    seen.lab.row(point) = to_lab(exposure * colours.row(point).transpose()).transpose();
  return seen;
}

}  // namespace gonio
