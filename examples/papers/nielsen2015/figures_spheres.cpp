/// Nielsen et al. 2015, Fig. 7 and 11: the optimal directions of points and of spheres; and the reconstruction of
/// Cornell's paints from simulated images of spheres (Fig. 12).

#include "papers/experiments.hpp"
#include "papers/nielsen2015/nielsen_split.hpp"
#include "papers/our_own/scattered_errors.hpp"
#include "papers/xu2016/figures.hpp"
#include "tool/files/measurement_files.hpp"
#include <gonio/design/published_directions.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/solve/tikhonov.hpp>

#include <algorithm>
#include <cmath>

namespace papers::figures {

namespace {

using angles = std::vector<gonio::half_difference>;

/// Returns the smaller angle between one direction and the plane of the other and the normal, in degrees. Exchanging
/// light and viewer does not change it.
double out_of_plane(const gonio::half_difference& at) {
  const auto [wi, wo] = gonio::to_directions(at);
  const auto from_plane = [](const gonio::direction& in_plane, const gonio::direction& other) {
    const double sine = std::hypot(in_plane.x(), in_plane.y());
    if (sine < 1e-9) return 0.0;
    return std::abs(std::asin(std::clamp((in_plane.x() * other.y() - in_plane.y() * other.x()) / sine, -1.0, 1.0)));
  };
  return gonio::degrees(std::min(from_plane(wi, wo), from_plane(wo, wi)));
}

/// An image of a sphere contains the measured directions whose theta_d is within this many degrees.
constexpr double half_slice = 2.5;

/// The measurements that an image of a sphere would contain, and all other measurements.
struct parted_samples {
  gonio::sample_set seen, others;
};

parted_samples part(const gonio::sample_set& all, const angles& slices) {
  parted_samples parted;
  for (const gonio::sample& each : all) {
    const double theta_d = each.directions.angles().theta_d;
    const bool seen = std::ranges::any_of(slices, [&](const gonio::half_difference& slice) {
      return std::abs(theta_d - slice.theta_d) <= gonio::radians(half_slice);
    });
    (seen ? parted.seen : parted.others).push_back(each);
  }
  return parted;
}

angles slices_of(const gonio::valid_cells& cells, const std::string& set, Eigen::Index n) {
  const gonio::design::sphere_geometry spheres(cells);
  angles slices;
  for (const Eigen::Index slice : sphere_slices(spheres, set, n)) {
    const auto [wi, wo] = spheres.centre(slice);
    slices.push_back(gonio::to_half_difference(wi, wo));
  }
  return slices;
}

std::string printed_slices(const angles& slices) {
  std::string text;
  for (const gonio::half_difference& slice : slices)
    text += (text.empty() ? "" : ", ") + std::to_string(std::lround(gonio::degrees(slice.theta_d)));
  return text;
}

}  // namespace

table paints_from_spheres(const options& given, const gonio::log_relative_pca& prior) {
  table shown{"Measured samples within 2.5 degrees of the theta_d of each image, judged on all the others",
              {{"paint"},
               {"set"},
               {"images", 0},
               {"samples used", 0},
               {"others", 0},
               {"rms of ln(f + 0.001)"},
               {"cosine-weighted relative error"}}};
  for (const std::filesystem::path& file : given.measured_samples) {
    const gonio::sample_set all = read_measurements(file);
    for (const char* set : {"published", "expected-error"})
      for (const Eigen::Index n : {1, 2, 5}) {
        const auto [seen, others] = part(all, slices_of(prior.cells(), set, n));
        if (seen.empty() || others.empty()) continue;
        const auto fit = gonio::decomposition{prior, gonio::tikhonov{given.eta}}.fit(seen);
        logarithmic_error in_logarithms;
        cosine_weighted_error weighted;
        for (const gonio::sample& other : others) {
          const gonio::direction_pair pair = other.directions.pair();
          const gonio::rgb estimate = fit(pair.wi, pair.wo);
          in_logarithms.add(estimate, other.value);
          weighted.add(estimate, other.value, pair);
        }
        shown.rows.push_back(
            {file.stem().string(), set, n, seen.size(), others.size(), in_logarithms.value(), weighted.value()});
      }
  }
  return shown;
}

tables nielsen_7(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  constexpr double nearly_in_plane = 15.0;
  table sets{"Sets of points, and how many of each are within 15 degrees of the plane of incidence",
             {{"n", 0}, {"set"}, {"E", 4}, {"mapped error"}, {"in plane", 0}, {"median out of plane", 1}}};
  table listed{"The directions in degrees; out of plane: of viewer or light from the plane of the other",
               {{"n", 0}, {"set"}, {"theta_h", 0}, {"theta_d", 0}, {"phi_d", 0}, {"out of plane", 0}}};
  for (const Eigen::Index n : gonio::design::nielsen_direction_counts)
    for (const char* set : {"published", "expected-error"}) {
      if (n > static_cast<Eigen::Index>(given.up_to(20))) continue;
      const auto directions = written_points(shipped_directions(), set, n);
      if (!directions) continue;
      std::vector<double> off;
      for (const gonio::half_difference& at : *directions) {
        off.push_back(out_of_plane(at));
        listed.rows.push_back(
            {n, set, gonio::degrees(at.theta_h), gonio::degrees(at.theta_d), gonio::degrees(at.phi_d), off.back()});
      }
      std::ranges::sort(off);
      sets.rows.push_back({n, set, expected_of(lab, given, *directions), lab.error(*directions),
                           std::ranges::count_if(off, [](double angle) { return angle <= nearly_in_plane; }),
                           off[off.size() / 2]});
    }
  return {std::move(sets), std::move(listed)};
}

tables nielsen_11(const options& given, const gonio::progress& listener) {
  const laboratory lab = open_laboratory(given, listener);
  const gonio::design::sphere_geometry spheres(lab.prior().cells());
  table shown{"Images of a sphere: theta_d in degrees, half the angle between light and camera",
              {{"n", 0}, {"set"}, {"theta_d"}, {"mapped error"}}};
  for (const std::size_t n : {1, 2, 3, 4, 5})
    for (const char* set : {"published", "expected-error", "perceived"}) {
      const auto slices = n > given.up_to(5) ? std::vector<Eigen::Index>() : sphere_slices(spheres, set, n);
      if (slices.empty()) continue;
      shown.rows.push_back(
          {n, set, printed_slices(slices_of(lab.prior().cells(), set, n)), lab.error(samples_of(spheres, slices))});
    }
  return {std::move(shown)};
}

}  // namespace papers::figures
