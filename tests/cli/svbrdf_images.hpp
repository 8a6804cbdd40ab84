#pragma once
/// Images for tests of `gonio svbrdf`.

#include "../io/scratch.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/materials/prior.hpp>

#include <array>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

/// Four images of 70 x 375 texels in bands of 43 rows, and a prior of few cells.
struct images_folder {
  scratch::folder folder;
  gonio::log_relative_pca prior = learn(synthetic_materials(gonio::valid_cells(gonio::grid({18, 9, 12})), 12), 6);
  std::vector<gonio::half_difference> angles{{0.1, 0.2, 0.4}, {0.4, 0.5, 1.5}, {0.02, 0.9, 1.0}, {0.9, 0.3, 0.7}};
  std::vector<xt::xtensor<float, 3>> images;

  images_folder() {
    gonio::io::write_prior(folder / "small.prior", prior);
    prior = gonio::io::read_prior(folder / "small.prior");
    std::string list = "{\"quantity\": \"brdf\", \"images\": [";
    for (std::size_t i = 0; i < angles.size(); ++i) {
      std::mt19937 generator(static_cast<unsigned>(i));
      std::uniform_real_distribution<float> value(0.01f, 0.4f);
      xt::xtensor<float, 3> image(std::array<std::size_t, 3>{70, 375, 3});
      for (float& each : image) each = value(generator);
      const std::string name = "image-" + std::to_string(i) + ".npy";
      gonio::io::write_npy(folder / name, image);
      images.push_back(image);
      list += (i > 0 ? "," : "") + entry(name, i);
    }
    scratch::put(folder / "images.json", list + "]}");
  }

  [[nodiscard]] std::string entry(const std::string& name, std::size_t i) const {
    return "{\"image\": \"" + name + "\", \"theta_h\": " + std::to_string(gonio::degrees(angles[i].theta_h)) +
           ", \"theta_d\": " + std::to_string(gonio::degrees(angles[i].theta_d)) +
           ", \"phi_d\": " + std::to_string(gonio::degrees(angles[i].phi_d)) + "}";
  }
  [[nodiscard]] std::string command(const std::string& output, const std::string& list = "images.json",
                                    const std::string& eta = "2.5") const {
    return "svbrdf " + (folder / list).string() + " --prior " + (folder / "small.prior").string() + " --eta " + eta +
           " -o " + (folder / output).string();
  }
  void replace(std::size_t i, const xt::xtensor<float, 3>& image) const {
    gonio::io::write_npy(folder / ("image-" + std::to_string(i) + ".npy"), image);
  }
};
