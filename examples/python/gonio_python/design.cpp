/// Design of measurements.

#include "arrays.hpp"
#include "copies.hpp"
#include "subjects.hpp"
#include "tool/options/design_search.hpp"
#include <gonio/core/error.hpp>
#include <gonio/design/apparatus.hpp>
#include <gonio/design/published_directions.hpp>
#include <gonio/evaluate/next_measurement.hpp>
#include <gonio/io/setups/apparatus.hpp>
#include <gonio/io/text/text.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace python {

namespace {

/// Directions to measure, and their quality.
struct found_design {
  std::vector<gonio::direction_pair> directions;
  double value = 0.0;
  cli::design_quality quality;
};

void require_one_of(const std::string& given, const char* name, std::initializer_list<std::string_view> words) {
  if (std::ranges::count(words, std::string_view(given)) > 0) return;
  gonio::refuse({name, " is '", given, "': expected one of ", gonio::io::listed({words.begin(), words.size()}, ", ")});
}

std::vector<gonio::direction_pair> pairs_of(const py::object& directions, const char* name) {
  std::vector<gonio::direction_pair> pairs;
  for (const gonio::sample_directions& each : sample_directions_of(directions, name)) pairs.push_back(each.pair());
  return pairs;
}

/// Returns the usual apparatus or a file's, with noise and angular error replaced if given.
gonio::design::apparatus apparatus_of(const std::optional<std::filesystem::path>& constraint,
                                      const std::optional<double>& noise,
                                      const std::optional<double>& misplaced_degrees) {
  gonio::design::apparatus chosen =
      constraint ? gonio::io::read_apparatus(*constraint) : gonio::design::usual_apparatus();
  chosen.noise = noise.value_or(chosen.noise);
  if (misplaced_degrees) chosen.angular_error = gonio::radians(*misplaced_degrees);
  return chosen;
}

found_design design_for(const gonio::log_relative_pca& prior, Eigen::Index count, const std::string& geometry,
                        const std::string& criterion, const std::string& search, double eta,
                        const std::optional<double>& noise, double common_shift, bool in_sample,
                        const std::optional<double>& misplaced_degrees, const py::object& start,
                        const std::optional<std::filesystem::path>& constraint, std::uint64_t seed, unsigned threads) {
  require_one_of(geometry, "geometry", {"point", "sphere", "near-field", "fixed-camera", "fixed-light"});
  require_one_of(criterion, "criterion", {"expected-error", "perceived", "condition", "a-optimal", "d-optimal"});
  require_one_of(search, "search", {"greedy", "exchange", "descent"});
  cli::design_options options{.count = count,
                              .geometry = geometry,
                              .criterion = criterion,
                              .search = search,
                              .apparatus = apparatus_of(constraint, noise, misplaced_degrees),
                              .eta = eta,
                              .common_shift = common_shift,
                              .in_sample = in_sample,
                              .near_field = {},
                              .start = {},
                              .seed = seed,
                              .threads = gonio::thread_count{threads}};
  if (!start.is_none()) options.start = pairs_of(start, "start");
  const py::gil_scoped_release released;
  const cli::designed found = cli::design(prior, options, interruption());
  return {found.poses, found.value, cli::quality_of(prior, options, found)};
}

/// Returns the quality of given directions.
found_design quality_for(const gonio::log_relative_pca& prior, const py::object& directions, double eta, double noise,
                         bool in_sample) {
  cli::design_options options;
  options.eta = eta;
  options.apparatus.noise = noise;
  options.in_sample = in_sample;
  cli::designed given;
  for (const gonio::sample_directions& each : sample_directions_of(directions, "directions")) {
    given.poses.push_back(each.pair());
    given.samples.push_back(each.angles());
  }
  const py::gil_scoped_release released;
  return {given.poses, given.value, cli::quality_of(prior, options, given)};
}

py::tuple next_for(const gonio::log_relative_pca& prior, const gonio::sample_set& samples, Eigen::Index count,
                   const std::optional<double>& noise, const std::optional<std::filesystem::path>& constraint,
                   unsigned threads) {
  if (count < 1) gonio::refuse({"count is ", count, ": expected at least 1"});
  std::vector<gonio::direction_pair> pairs;
  double remaining = 0.0;
  {
    const py::gil_scoped_release released;
    const gonio::reconstruction estimator{prior, {.noise = noise.value_or(0.0)}, gonio::thread_count{threads}};
    const gonio::measurement_chooser chooser{estimator, apparatus_of(constraint, noise, {}),
                                             gonio::design::default_candidates(), gonio::thread_count{threads}};
    for (const gonio::next_measurement& next : chooser.choose(samples, count)) {
      pairs.push_back(next.pose);
      remaining = next.expected_delta_e;
    }
  }
  return py::make_tuple(array_of(pairs), remaining);
}

py::array_t<double> published(Eigen::Index count) {
  if (!gonio::design::has_nielsen_directions(count))
    gonio::refuse({"there is no published set of ", count, " directions: expected 1, 2, 5, 10 or 20"});
  std::vector<gonio::direction_pair> pairs;
  for (const gonio::half_difference& angles : gonio::design::nielsen_directions(count))
    pairs.push_back(gonio::to_directions(angles));
  return array_of(pairs);
}

py::tuple state_of(const found_design& design) {
  return py::make_tuple(array_of(design.directions), design.value, design.quality.expected_error,
                        design.quality.unknown_share);
}

found_design design_of_state(const py::tuple& state) {
  require_state(state, 4);
  found_design design{{}, state[1].cast<double>(), {state[2].cast<double>(), state[3].cast<double>()}};
  const auto rows = matrix_of<Eigen::MatrixXd>(state[0]);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Eigen::RowVectorXd row = rows.row(i);
    design.directions.push_back({row.segment<3>(0), row.segment<3>(3)});
  }
  return design;
}

}  // namespace

void add_design(py::module_& m) {
  py::class_<found_design> type(m, "Design", "Directions to measure, and the expected error.");
  type.def("__repr__", [](const found_design& d) {
    return "<gonio.Design: " + std::to_string(d.directions.size()) + " directions>";
  });
  add_copies(
      type, [](const found_design& d) { return state_of(d); },
      [](const py::tuple& state) { return design_of_state(state); });
  type.def_property_readonly(
      "directions", [](const found_design& d) { return array_of(d.directions); },
      "Light and viewer of each measurement (for an image: at its centre): shape (n, 6), wi and wo.");
  type.def_readonly("value", &found_design::value, "The value of the criterion.");
  type.def_property_readonly(
      "expected_error", [](const found_design& d) { return d.quality.expected_error; },
      "Expected root mean square error of the logarithm of reflectance, over all cells.");
  type.def_property_readonly(
      "unknown_share", [](const found_design& d) { return d.quality.unknown_share; },
      "`expected_error` as a fraction of the error without measurements.");

  const cli::design_options standard;
  m.def("design", &design_for, py::arg("prior"), py::arg("count") = standard.count, py::kw_only(),
        py::arg("geometry") = standard.geometry, py::arg("criterion") = standard.criterion,
        py::arg("search") = standard.search, py::arg("eta") = standard.eta, py::arg("noise") = py::none(),
        py::arg("common_shift") = standard.common_shift, py::arg("in_sample") = standard.in_sample,
        py::arg("misplaced_degrees") = py::none(), py::arg("start") = py::none(), py::arg("constraint") = py::none(),
        py::arg("seed") = standard.seed, py::arg("threads") = 0,
        "Returns the directions that best distinguish a prior's materials, found as by `gonio design`. start:\n"
        "directions that are measured in addition. constraint: a file that describes an apparatus; by default light\n"
        "and viewer reach 80 degrees, are at least 5 degrees apart, and noise is 2 %. Ctrl-C ends the search.");
  m.def("expected_error", &quality_for, py::arg("prior"), py::arg("directions"), py::kw_only(),
        py::arg("eta") = standard.eta, py::arg("noise") = standard.apparatus.noise,
        py::arg("in_sample") = standard.in_sample,
        "Returns the expected error for your own directions: shape (n, 6) or (n, 3), as for `Samples`.");
  m.def("next_directions", &next_for, py::arg("prior"), py::arg("samples"), py::arg("count") = 1, py::kw_only(),
        py::arg("noise") = py::none(), py::arg("constraint") = py::none(), py::arg("threads") = 0,
        "Returns the best additional measurements, given the samples already measured: directions of shape (count,\n"
        "6), and the expected remaining Delta E of spheres.");
  m.def("published_directions", &published, py::arg("count") = 20,
        "Returns the directions of Nielsen et al. 2015: 1, 2, 5, 10 or 20 of them, shape (count, 6).");
}

}  // namespace python
