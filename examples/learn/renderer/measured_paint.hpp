// measured_paint.hpp
#pragma once
#include <gonio/render/bsdf_view.hpp>

#include <memory>
#include <string>

struct measured_paint {
  std::shared_ptr<const void> held;  // owns the data of the view
  gonio::render::bsdf_view bsdf;
};
measured_paint read_paint(const std::string& merl_file);
