/// The published sets of measurements, and those that ship with the tool, for the figures.

#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/xu2016/figures.hpp"
#include <gonio/design/near_field_geometry.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/io/measurements/samples.hpp>

namespace papers::figures {

std::vector<gonio::direction_pair> shipped_poses(const std::string& name) {
  return gonio::io::read_direction_pairs(shipped_directions() / (name + ".csv"));
}

std::vector<gonio::half_difference> samples_of_images(const std::vector<gonio::direction_pair>& poses) {
  const gonio::design::near_field_geometry fine(
      {.field_of_view = gonio::radians(figures_field_of_view), .step = gonio::radians(1.0)});
  std::vector<Eigen::Index> candidates;
  for (const gonio::direction_pair& pose : poses) candidates.push_back(fine.nearest(pose));
  return samples_of(fine, candidates);
}

namespace {

gonio::direction_pair at_degrees(double theta_h, double theta_d, double phi_d) {
  return gonio::to_directions({gonio::radians(theta_h), gonio::radians(theta_d), gonio::radians(phi_d)});
}

}  // namespace

std::vector<gonio::direction_pair> printed_fixed_camera() { return {at_degrees(4, 63, 90), at_degrees(39, 34, 124)}; }

std::vector<gonio::direction_pair> printed_fixed_light() {
  std::vector<gonio::direction_pair> images{at_degrees(4, 63, 90), at_degrees(39, 33, 126)};
  // The printed angles are for the fixed camera (a). For the fixed light (b), light and camera are exchanged.
  for (gonio::direction_pair& image : images) std::swap(image.wi, image.wo);
  return images;
}

std::vector<Eigen::Index> sphere_slices(const gonio::design::sphere_geometry& spheres, const std::string& set,
                                        Eigen::Index n) {
  std::vector<Eigen::Index> slices;
  const auto add = [&](const gonio::direction_pair& pose) { slices.push_back(spheres.nearest(pose)); };
  if (set == "published") {
    if (n != 1 && n != 2 && n != 5) return slices;
    for (const auto& slice : gonio::design::nielsen_sphere_directions(n)) add(gonio::to_directions(slice));
    return slices;
  }
  for (const gonio::direction_pair& pose : shipped_poses("sphere-" + std::to_string(n) + '-' + set)) add(pose);
  return slices;
}

}  // namespace papers::figures
