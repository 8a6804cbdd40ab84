/// Measurements: arrays as input, views of the library's memory as output, and their files.

#include "arrays.hpp"
#include "copies.hpp"
#include "spectra.hpp"
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
#include <span>
#include <sstream>
#include <string>
#include <vector>

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

/// Returns wavelengths in nanometres. Throws gonio::error for fewer than two.
gonio::channels channels_of_wavelengths(const py::object& given) {
  const doubles array = finite_rows(given, "wavelengths", {0});
  if (array.size() < 2)
    gonio::refuse({"wavelengths has ", array.size(), " numbers: expected at least two, or none for grey values"});
  return gonio::channels(std::vector<double>(array.data(), array.data() + array.size()));
}

gonio::sample_set spectra_from_arrays(const std::vector<gonio::sample_directions>& directions, const py::object& values,
                                      const py::object& weights, const gonio::channels& kinds) {
  const auto count = static_cast<py::ssize_t>(directions.size());
  const doubles spectra = finite_rows(values, "values", {static_cast<int>(kinds.size())});
  if (spectra.shape(0) != count)
    gonio::refuse({"values has ", spectra.shape(0), " rows, directions has ", count, ": expected the same number"});
  std::optional<channel_numbers> weight;
  if (!weights.is_none()) weight.emplace(finite_rows(weights, "weights", {0}), "weights", count);
  gonio::sample_set samples(kinds);
  samples.reserve(directions.size());
  const auto bands = static_cast<std::size_t>(kinds.size());
  for (std::size_t i = 0; i < directions.size(); ++i)
    samples.add(directions[i], std::span(spectra.data() + i * bands, bands),
                weight ? gonio::channel_weights((*weight)[static_cast<py::ssize_t>(i)]) : 1.0);
  return samples;
}

gonio::sample_set samples_from_arrays(const py::object& directions, const py::object& values, const py::object& weights,
                                      const py::object& wavelengths) {
  const auto pairs = sample_directions_of(directions, "directions");
  gonio::sample_set samples;
  if (!wavelengths.is_none()) {
    samples = spectra_from_arrays(pairs, values, weights, channels_of_wavelengths(wavelengths));
  } else {
    const auto count = static_cast<py::ssize_t>(pairs.size());
    const channel_numbers value(values, "values", count);
    samples.reserve(pairs.size());
    for (py::ssize_t i = 0; i < count; ++i) samples.push_back({pairs[static_cast<std::size_t>(i)], value[i], 1.0});
    if (!weights.is_none()) {
      const channel_numbers weight(weights, "weights", count);
      for (py::ssize_t i = 0; i < count; ++i) samples[static_cast<std::size_t>(i)].weight = weight[i];
    }
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
  const Eigen::Index one = row < 0 ? row + count : row;
  return samples.subset(std::span(&one, 1));
}

constexpr py::ssize_t from_sample_to_sample = sizeof(gonio::sample), from_number_to_number = sizeof(double);

/// Returns a view with a row of `columns` numbers per sample. The first row begins at `first(samples)`, each next row
/// `step` bytes later. Returns an empty array if there is no sample.
template <class First>
py::array_t<double> column_view(const py::object& self, py::ssize_t columns, py::ssize_t step, bool writable,
                                const First& first) {
  auto& samples = self.cast<gonio::sample_set&>();
  const extents shape{static_cast<py::ssize_t>(samples.size()), columns};
  if (samples.empty()) return py::array_t<double>(shape);
  const double* data = first(samples);
  const extents strides{step, from_number_to_number};
  return writable ? view_of(const_cast<double*>(data), shape, strides, self) : read_only(data, shape, strides, self);
}

py::array_t<double> values_of(const py::object& self) {
  const gonio::channels& kinds = self.cast<gonio::sample_set&>().channels();
  const bool spectral = kinds.are_wavelengths();
  return column_view(self, spectral ? kinds.size() : 3,
                     spectral ? kinds.size() * from_number_to_number : from_sample_to_sample, true,
                     [](const gonio::sample_set& s) { return s.values(0).data(); });
}

void add_columns(py::class_<gonio::sample_set>& type) {
  static_assert(sizeof(gonio::direction_pair) == 6 * sizeof(double));
  static_assert(sizeof(gonio::half_difference) == 3 * sizeof(double));
  const auto column = [](py::ssize_t columns, bool writable, auto first) {
    return [=](const py::object& self) { return column_view(self, columns, from_sample_to_sample, writable, first); };
  };
  type.def_property_readonly(
      "directions", column(6, false, [](const gonio::sample_set& s) { return s.directions(0).pair().wi.data(); }),
      "Unit vectors to light and viewer, wi and wo: a read-only view of shape (n, 6).");
  type.def_property_readonly(
      "angles", column(3, false, [](const gonio::sample_set& s) { return &s.directions(0).angles().theta_h; }),
      "theta_h, theta_d and phi_d in radians: a read-only view of shape (n, 3).");
  type.def_property_readonly(
      "values", &values_of,
      "Reflectance in sr^-1: a view of shape (n, 3), or (n, wavelengths). Writing to it changes\n"
      "the samples.");
  type.def_property_readonly("weights",
                             column(3, true, [](const gonio::sample_set& s) { return s.weight(0).of_each().data(); }),
                             "The weight of each sample in each channel: a writable view of shape (n, 3). For spectra, "
                             "the mean of the three.");
  type.def_property_readonly(
      "wavelengths",
      [](const gonio::sample_set& samples) -> py::object {
        if (!samples.channels().are_wavelengths()) return py::none();
        return array_of_numbers(samples.channels().wavelengths());
      },
      "The wavelengths in nanometres, ascending; None for colours.");
}

gonio::sample_set colours_of(const gonio::sample_set& samples, const std::string& light) {
  return samples.under(illuminant_of(light)).colours();
}

/// Returns rows of directions, angles, weights and apertures, the values, and wavelengths. Directions are kept exactly
/// as given.
py::tuple state_of(const gonio::sample_set& samples) {
  constexpr Eigen::Index columns = 6 + 3 + 3 + 2;
  const auto count = static_cast<Eigen::Index>(samples.size());
  const Eigen::Index channels = samples.channels().are_wavelengths() ? samples.channels().size() : 3;
  Eigen::MatrixXd rows(count, columns), values(count, channels);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [wi, wo] = samples.directions(i).pair();
    const auto& [theta_h, theta_d, phi_d] = samples.directions(i).angles();
    rows.row(i) << wi.transpose(), wo.transpose(), theta_h, theta_d, phi_d,
        samples.weight(i).of_each().matrix().transpose(), samples.aperture(i).source, samples.aperture(i).receiver;
    for (Eigen::Index c = 0; c < channels; ++c) values(i, c) = samples.values(i).data()[c];
  }
  const bool spectral = samples.channels().are_wavelengths();
  return py::make_tuple(copy_of(rows), copy_of(values),
                        array_of_numbers(spectral ? samples.channels().wavelengths() : std::vector<double>{}));
}

gonio::sample_set samples_of_state(const py::tuple& state) {
  require_state(state, 3);
  const auto rows = matrix_of<Eigen::MatrixXd>(state[0]), values = matrix_of<Eigen::MatrixXd>(state[1]);
  std::vector<double> wavelengths(py::len(state[2]));
  copy_numbers(state[2], wavelengths.data(), std::ssize(wavelengths));
  gonio::sample_set samples(wavelengths.empty() ? gonio::channels() : gonio::channels(wavelengths));
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    const Eigen::RowVectorXd row = rows.row(i);
    const gonio::half_difference angles{row[6], row[7], row[8]};
    gonio::sample_directions directions(gonio::direction_pair{row.segment<3>(0), row.segment<3>(3)});
    const gonio::half_difference& found = directions.angles();
    if (found.theta_h != angles.theta_h || found.theta_d != angles.theta_d || found.phi_d != angles.phi_d)
      directions = angles;
    const Eigen::ArrayXd value = values.row(i).transpose();
    samples.add(directions, value, gonio::rgb(row.segment<3>(9)), {row[12], row[13]});
  }
  return samples;
}

std::string sentence_of(const gonio::sample_set& samples) {
  if (samples.empty()) return "<gonio.Samples: none>";
  double least = samples.values(0)[0], most = least;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i)
    for (const double value : samples.values(i)) {
      least = std::min(least, value);
      most = std::max(most, value);
    }
  std::ostringstream text;
  text.precision(3);
  text << "<gonio.Samples: " << samples.size();
  if (samples.channels().are_wavelengths()) text << " of " << samples.channels().size() << " wavelengths";
  text << ", from " << least << " to " << most << " sr^-1>";
  return text.str();
}

gonio::sample_set read_samples(const std::filesystem::path& path, const std::optional<std::string>& quantity,
                               const std::map<std::string, std::string>& columns, const std::string& side,
                               const std::string& band, bool spectra) {
  cli::measurement_options options{.quantity = quantity.value_or(""), .columns = {}, .side = side, .band = band};
  for (const auto& [ours, in_file] : columns) options.columns.push_back(ours + '=' + in_file);
  if (!spectra) return cli::read_measurements(path, options);
  gonio::sample_set samples = cli::read_measurement_file(path, options).samples;
  if (!samples.channels().are_wavelengths())
    gonio::refuse({path.native(), ": has no spectra, but spectra=True needs at least two wavelengths"});
  return samples;
}

}  // namespace

void add_samples(py::module_& m) {
  py::class_<gonio::sample_set> type(m, "Samples",
                                     "Measurements: directions, reflectance in sr^-1 without the cosine, and weights.");
  type.def(
      py::init(&samples_from_arrays), py::arg("directions"), py::arg("values"), py::arg("weights") = py::none(),
      py::arg("wavelengths") = py::none(),
      "Makes samples from arrays. directions: shape (n, 6), unit vectors wi and wo, normal +z, or (n, 3), theta_h,\n"
      "theta_d and phi_d in radians. values: (n, 3), or (n,) for grey. weights: (n, 3), (n,) or none. With\n"
      "wavelengths in nanometres, shape (w,), values has the shape (n, w) and weights (n,). The samples keep copies.");
  type.def("__len__", [](const gonio::sample_set& samples) { return samples.size(); });
  type.def("__repr__", [](const gonio::sample_set& samples) { return sentence_of(samples); });
  add_copies(
      type, [](const gonio::sample_set& samples) { return state_of(samples); },
      [](const py::tuple& state) { return samples_of_state(state); });
  add_columns(type);
  type.def("colours", &colours_of, py::arg("illuminant") = "D65",
           "Returns the samples as colours, linear Rec. 709 under an illuminant: 'D65' or 'A'.");
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
        py::arg("spectra") = false, py::call_guard<py::gil_scoped_release>(),
        "Reads samples as the tool does: CSV, or a format of instruments. quantity: the quantity of the values of a\n"
        "CSV file that does not state it, 'brdf', 'brdf-cosine', 'reflectance-factor' or 'percent'. columns: the\n"
        "file's names of columns, {'theta_o': 'Winkel'}. side and band: the block of a Klems matrix or a tensor tree,\n"
        "'front' or 'back', and 'Visible' or 'Solar'. spectra: keep wavelengths instead of converting to colours.");
  m.def(
      "write_samples",
      [](const std::filesystem::path& path, const gonio::sample_set& samples) {
        gonio::io::write_samples(path, samples);
      },
      py::arg("path"), py::arg("samples"), py::call_guard<py::gil_scoped_release>(),
      "Writes samples as CSV. An existing file is replaced only when the new one is complete.");
}

}  // namespace python
