// measured_paint.cpp
#include "measured_paint.hpp"

#include <gonio/io/materials/merl.hpp>
#include <gonio/render.hpp>

measured_paint read_paint(const std::string& merl_file) {
  using sampler = gonio::render::half_vector_sampler<gonio::render::lookup_table<Eigen::half>, float>;
  const auto table = gonio::render::lookup_table<Eigen::half>::of(gonio::io::read_merl(merl_file));
  const auto held = std::make_shared<const sampler>(table);
  return {held, gonio::render::bsdf_view(*held)};
}
