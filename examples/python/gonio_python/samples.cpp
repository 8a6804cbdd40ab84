/// Measurements: arrays as input, views of the library's memory as output, and their files.

#include "arrays.hpp"
#include "copies.hpp"
#include "subjects.hpp"
#include "tool/files/measurement_files.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <sstream>
#include <string>

namespace python {

namespace {

/// One number per sample, or one per channel.
class channel_numbers {
 public:
  channel_numbers(const py::object& given, const std::string& name, py::ssize_t samples)
      : array_(finite_rows(given, name, {3, 0})), data_(array_.data()), has_channels_(array_.ndim() == 2) {
    if (array_.shape(0) != samples)
      gonio::refuse({name, " has ", array_.shape(0), " rows, directions has ", samples, ": expected the same number"});
  }

  [[nodiscard]] gonio::rgb operator[](py::ssize_t i) const {
    if (!has_channels_) return gonio::rgb::Constant(data_[i]);
    return {data_[3 * i], data_[3 * i + 1], data_[3 * i + 2]};
  }

 private:
  doubles array_;
  const double* data_;
  bool has_channels_;
};

gonio::sample_set samples_from_arrays(const py::object& directions, const py::object& values,
                                      const py::object& weights) {
  const auto places = sample_directions_of(directions, "directions");
  const auto count = static_cast<py::ssize_t>(places.size());
  const channel_numbers value(values, "values", count);
  gonio::sample_set samples;
  samples.reserve(places.size());
  for (py::ssize_t i = 0; i < count; ++i) samples.push_back({places[static_cast<std::size_t>(i)], value[i], 1.0});
  if (!weights.is_none()) {
    const channel_numbers weight(weights, "weights", count);
    for (py::ssize_t i = 0; i < count; ++i) samples[static_cast<std::size_t>(i)].weight = weight[i];
  }
  gonio::require_usable(samples);
  return samples;
}

gonio::sample_set chosen(const gonio::sample_set& samples, const py::object& rows) {
  return samples.subset(rows_of(rows, static_cast<py::ssize_t>(samples.size())));
}

/// Returns the samples at an index. A single number chooses one sample; a number after the last sample raises
/// IndexError, which ends a Python loop over all samples.
gonio::sample_set indexed(const gonio::sample_set& samples, const py::object& index) {
  if (py::isinstance<py::ellipsis>(index)) return samples;
  if (py::isinstance<py::tuple>(index))
    gonio::refuse("samples have one axis: expected a whole number, a slice or an array");
  if (PyIndex_Check(index.ptr()) == 0 || py::isinstance<py::array>(index) || py::isinstance<py::bool_>(index))
    return chosen(samples, index);
  const auto count = static_cast<py::ssize_t>(samples.size());
  const py::ssize_t row = PyNumber_AsSsize_t(index.ptr(), PyExc_IndexError);
  if (PyErr_Occurred() != nullptr) throw py::error_already_set();
  if (row < -count || row >= count)
    throw py::index_error(
        gonio::message_of({"there is no sample in row ", row, ": expected rows from ", -count, " to ", count - 1}));
  return {samples[static_cast<std::size_t>(row < 0 ? row + count : row)]};
}

constexpr py::ssize_t from_sample_to_sample = sizeof(gonio::sample), from_number_to_number = sizeof(double);

/// Returns a view with one row per sample: the `columns` numbers that `place` finds in it. Returns an empty array if
/// there is no sample.
template <class Place>
py::array_t<double> column_view(const py::object& self, py::ssize_t columns, bool writable, const Place& place) {
  auto& samples = self.cast<gonio::sample_set&>();
  const extents shape{static_cast<py::ssize_t>(samples.size()), columns};
  if (samples.empty()) return py::array_t<double>(shape);
  const double* data = place(samples.front());
  const extents strides{from_sample_to_sample, from_number_to_number};
  return writable ? view_of(const_cast<double*>(data), shape, strides, self) : read_only(data, shape, strides, self);
}

void add_columns(py::class_<gonio::sample_set>& type) {
  static_assert(sizeof(gonio::direction_pair) == 6 * sizeof(double));
  static_assert(sizeof(gonio::half_difference) == 3 * sizeof(double));
  type.def_property_readonly(
      "directions",
      [](const py::object& self) {
        return column_view(self, 6, false, [](const gonio::sample& s) { return s.directions.pair().wi.data(); });
      },
      "Unit vectors to light and viewer, wi and wo: a read-only view of shape (n, 6).");
  type.def_property_readonly(
      "angles",
      [](const py::object& self) {
        return column_view(self, 3, false, [](const gonio::sample& s) { return &s.angles().theta_h; });
      },
      "theta_h, theta_d and phi_d in radians: a read-only view of shape (n, 3).");
  type.def_property_readonly(
      "values",
      [](const py::object& self) {
        return column_view(self, 3, true, [](const gonio::sample& s) { return s.value.data(); });
      },
      "Reflectance in sr^-1: a view of shape (n, 3). Writing to it changes the samples.");
  type.def_property_readonly(
      "weights",
      [](const py::object& self) {
        return column_view(self, 3, true, [](const gonio::sample& s) { return s.weight.of_each().data(); });
      },
      "The weight of each sample in each channel: a writable view of shape (n, 3).");
}

/// Returns rows of directions, angles, values, weights and apertures. Directions are kept exactly as given.
py::tuple state_of(const gonio::sample_set& samples) {
  constexpr Eigen::Index columns = 6 + 3 + 3 + 3 + 2;
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(samples.size()), columns);
  Eigen::Index i = 0;
  for (const gonio::sample& each : samples) {
    const auto& [wi, wo] = each.directions.pair();
    const auto& [theta_h, theta_d, phi_d] = each.angles();
    rows.row(i++) << wi.transpose(), wo.transpose(), theta_h, theta_d, phi_d, each.value.matrix().transpose(),
        each.weight.of_each().matrix().transpose(), each.aperture.source, each.aperture.receiver;
  }
  return py::make_tuple(copy_of(rows));
}

gonio::sample_set samples_of_state(const py::tuple& state) {
  require_state(state, 1);
  const auto rows = matrix_of<Eigen::MatrixXd>(state[0]);
  gonio::sample_set samples;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Eigen::RowVectorXd row = rows.row(i);
    const gonio::half_difference angles{row[6], row[7], row[8]};
    gonio::sample_directions directions(gonio::direction_pair{row.segment<3>(0), row.segment<3>(3)});
    const gonio::half_difference& found = directions.angles();
    if (found.theta_h != angles.theta_h || found.theta_d != angles.theta_d || found.phi_d != angles.phi_d)
      directions = angles;
    samples.push_back({directions, gonio::rgb(row.segment<3>(9)), gonio::rgb(row.segment<3>(12)), {row[15], row[16]}});
  }
  return samples;
}

std::string sentence_of(const gonio::sample_set& samples) {
  if (samples.empty()) return "<gonio.Samples: none>";
  double least = samples.front().value[0], most = least;
  for (const gonio::sample& each : samples) {
    least = std::min(least, each.value.minCoeff());
    most = std::max(most, each.value.maxCoeff());
  }
  std::ostringstream text;
  text.precision(3);
  text << "<gonio.Samples: " << samples.size() << ", from " << least << " to " << most << " sr^-1>";
  return text.str();
}

gonio::sample_set read_samples(const std::filesystem::path& path, const std::optional<std::string>& quantity,
                               const std::map<std::string, std::string>& columns, const std::string& side,
                               const std::string& band) {
  cli::measurement_options options{.quantity = quantity.value_or(""), .columns = {}, .side = side, .band = band};
  for (const auto& [ours, in_file] : columns) options.columns.push_back(ours + '=' + in_file);
  return cli::read_measurements(path, options);
}

}  // namespace

void add_samples(py::module_& m) {
  py::class_<gonio::sample_set> type(m, "Samples",
                                     "Measurements: directions, reflectance in sr^-1 without the cosine, and weights.");
  type.def(
      py::init(&samples_from_arrays), py::arg("directions"), py::arg("values"), py::arg("weights") = py::none(),
      "Makes samples from arrays. directions: shape (n, 6), unit vectors wi and wo, normal +z, or (n, 3), theta_h,\n"
      "theta_d and phi_d in radians. values: (n, 3), or (n,) for grey. weights: (n, 3), (n,) or none. The samples\n"
      "keep copies.");
  type.def("__len__", [](const gonio::sample_set& samples) { return samples.size(); });
  type.def("__repr__", [](const gonio::sample_set& samples) { return sentence_of(samples); });
  add_copies(
      type, [](const gonio::sample_set& samples) { return state_of(samples); },
      [](const py::tuple& state) { return samples_of_state(state); });
  add_columns(type);
  type.def(
      "subset", &chosen, py::arg("rows"),
      "Returns copies of some of the samples. rows: a mask of shape (n,) of True and False, a slice, or row numbers\n"
      "in the desired order; negative ones count from the end. Raises Error for rows that do not exist.");
  type.def(
      "__iter__", [](const py::object& self) { return py::reinterpret_steal<py::iterator>(PySeqIter_New(self.ptr())); },
      "Yields each sample as a Samples object with one row.");
  type.def("__getitem__", &indexed, py::arg("index"),
           "Returns the samples at an index; for a single number, a Samples object with one row. Raises IndexError if\n"
           "a sample does not exist.");
  m.def("read_samples", &read_samples, py::arg("path"), py::arg("quantity") = py::none(),
        py::arg("columns") = std::map<std::string, std::string>(), py::arg("side") = "", py::arg("band") = "",
        py::call_guard<py::gil_scoped_release>(),
        "Reads samples as the tool does: CSV, or a format of instruments. quantity: the quantity of the values of a\n"
        "CSV file that does not state it, 'brdf', 'brdf-cosine', 'reflectance-factor' or 'percent'. columns: the\n"
        "file's names of columns, {'theta_o': 'Winkel'}. side and band: the block of a Klems matrix or a tensor tree,\n"
        "'front' or 'back', and 'Visible' or 'Solar'.");
  m.def(
      "write_samples",
      [](const std::filesystem::path& path, const gonio::sample_set& samples) {
        gonio::io::write_samples(path, samples);
      },
      py::arg("path"), py::arg("samples"), py::call_guard<py::gil_scoped_release>(),
      "Writes samples as CSV. An existing file is replaced only when the new one is complete.");
}

}  // namespace python
