#include "scan_samplings.hpp"

#include "papers/nielsen2015/nielsen_split.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/core/random.hpp>
#include <gonio/design/near_field_geometry.hpp>
#include <gonio/design/sphere_geometry.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/table/valid_cells.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace papers {

namespace {

/// Returns random cells of MERL's grid below some theta_h in degrees. Coverage is counted from 8 degrees farther out.
sampling below(Eigen::Index count, double theta_h) {
  const gonio::valid_cells cells;
  std::vector<gonio::half_difference> all, directions;
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell)
    if (gonio::degrees(cells.angles(cell).theta_h) < theta_h) all.push_back(cells.angles(cell));
  for (const Eigen::Index i : gonio::random_choice(std::ssize(all), count, 0)) directions.push_back(all[i]);
  return {std::to_string(count) + " below " + cli::fixed(theta_h, 0), {directions}, gonio::radians(theta_h + 8.0)};
}

/// Returns directions whose viewers are from -80 to 80 degrees, except close to the light. They are in planes at the
/// angles `azimuths`, in degrees, to the plane of incidence.
sampling in_planes(const std::vector<double>& incidences, const std::vector<double>& azimuths, double step) {
  std::vector<gonio::half_difference> directions;
  for (const double theta_i : incidences)
    for (const double azimuth : azimuths)
      for (double theta_o = -80.0; theta_o <= 80.0; theta_o += step) {
        if (azimuth == 0.0 && std::abs(theta_o - theta_i) < 3.0) continue;
        directions.push_back(
            gonio::to_half_difference(gonio::spherical_direction(gonio::radians(theta_i), 0.0),
                                      gonio::spherical_direction(gonio::radians(theta_o), gonio::radians(azimuth))));
      }
  const std::string planes = azimuths.size() > 1 ? "two planes, " : "one plane, ",
                    lights = incidences.size() > 1 ? std::to_string(incidences.size()) + " lights"
                                                   : "light at " + cli::fixed(incidences[0], 0);
  return {planes + lights + ", steps of " + cli::fixed(step, 1), {directions}};
}

/// Returns the directions of all pixels of a shipped design: one image for each of its pairs.
template <gonio::design::capture_geometry Geometry>
sampling in_images(const Geometry& geometry, const std::string& name) {
  sampling all{name, {{}}};
  for (const gonio::direction_pair& pair :
       gonio::io::read_direction_pairs(shipped_directions() / (name + "-expected-error.csv")))
    std::ranges::copy(geometry.directions(geometry.nearest(pair)), std::back_inserter(all.sets[0]));
  return all;
}

}  // namespace

std::vector<sampling> scan_samplings() {
  std::vector<sampling> all{below(500, 10.0), below(500, 20.0), below(500, 30.0), below(60, 20.0), below(20, 10.0)};
  for (const double step : {1.0, 2.0, 5.0, 10.0})
    for (const double theta_i : {15.0, 45.0}) all.push_back(in_planes({theta_i}, {0.0}, step));
  for (const double step : {1.5, 5.0}) all.push_back(in_planes({0.0, 20.0, 40.0, 60.0}, {0.0}, step));
  all.push_back(in_planes({0.0, 20.0, 40.0, 60.0}, {0.0, 90.0}, 5.0));
  for (const char* count : {"1", "2", "5"})
    all.push_back(in_images(gonio::design::sphere_geometry(gonio::valid_cells()), std::string("sphere-") + count));
  for (const char* count : {"1", "2"})
    all.push_back(in_images(gonio::design::near_field_geometry(), std::string("near-field-25-") + count));
  return all;
}

}  // namespace papers
