#include "arrays.hpp"

#include <gonio/core/error.hpp>
#include <gonio/core/finite.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace python {

namespace {

/// Returns "values[2, 1]" for the index `number` in C order.
std::string element_name(const py::array& array, const std::string& name, py::ssize_t number) {
  std::string indices;
  for (py::ssize_t axis = array.ndim() - 1; axis >= 0; --axis) {
    indices = std::to_string(number % array.shape(axis)) + (indices.empty() ? "" : ", ") + indices;
    number /= array.shape(axis);
  }
  return indices.empty() ? name : name + '[' + indices + ']';
}

std::string given_as(double value) { return py::str(py::float_(value)); }

/// Converts half and difference angles in radians.
gonio::sample_directions directions_of_angles(const double* angles, const std::string& row) {
  constexpr double right_angle = std::numbers::pi / 2.0;
  for (int i = 0; i < 2; ++i)
    if (!(angles[i] >= 0.0 && angles[i] < right_angle))
      gonio::refuse({row, " has ", i == 0 ? "theta_h " : "theta_d ", given_as(angles[i]),
                     ": expected radians of at least 0 and less than pi/2"});
  if (!(std::abs(angles[2]) <= 2.0 * std::numbers::pi))
    gonio::refuse({row, " has phi_d ", given_as(angles[2]), ": expected radians from -2 pi to 2 pi"});
  return gonio::half_difference{angles[0], angles[1], gonio::fold_phi_d(angles[2])};
}

std::vector<py::ssize_t> rows_of_slice(const py::slice& given, py::ssize_t count) {
  py::ssize_t start = 0, stop = 0, step = 0, length = 0;
  if (!given.compute(count, &start, &stop, &step, &length)) throw py::error_already_set();
  std::vector<py::ssize_t> rows(static_cast<std::size_t>(length));
  for (py::ssize_t i = 0; i < length; ++i) rows[static_cast<std::size_t>(i)] = start + i * step;
  return rows;
}

std::vector<py::ssize_t> rows_of_mask(const py::array& given, py::ssize_t count) {
  if (given.ndim() != 1 || given.shape(0) != count)
    gonio::refuse(
        {"rows is a mask of shape ", shape_of(given), ": expected (", count, ",), one value for each sample"});
  const py::array_t<bool> mask(given);
  std::vector<py::ssize_t> rows;
  for (py::ssize_t i = 0; i < count; ++i)
    if (mask.at(i)) rows.push_back(i);
  return rows;
}

std::vector<py::ssize_t> rows_of_numbers(const py::array& given, py::ssize_t count) {
  if (given.ndim() != 1) gonio::refuse({"rows has shape ", shape_of(given), ": expected (n,)"});
  const py::array_t<py::ssize_t, py::array::forcecast> numbers(given);
  std::vector<py::ssize_t> rows;
  for (py::ssize_t i = 0; i < numbers.size(); ++i) {
    const py::ssize_t row = numbers.at(i);
    if (row < -count || row >= count)
      gonio::refuse({"there is no sample in row ", row, ": expected rows from ", -count, " to ", count - 1});
    rows.push_back(row < 0 ? row + count : row);
  }
  return rows;
}

/// Refuses several rows if all have the length 1: they are probably not angles but the light's unit vectors, given
/// without the viewer's.
void refuse_unit_vectors(const doubles& array, const std::string& name) {
  constexpr py::ssize_t fewest = 3;
  if (array.shape(1) != 3 || array.shape(0) < fewest) return;
  const double* data = array.data();
  for (py::ssize_t i = 0; i < array.shape(0); ++i)
    if (std::abs(gonio::norm_of(data[3 * i], data[3 * i + 1], data[3 * i + 2]) - 1.0) > 1e-6) return;
  gonio::refuse({name, " looks like unit vectors: expected light and viewer side by side, np.hstack([wi, wo]), or ",
                 "theta_h, theta_d and phi_d in radians"});
}

}  // namespace

std::string shape_of(const py::array& array) { return py::str(array.attr("shape")); }

doubles finite_numbers(const py::object& given, const std::string& name) {
  const doubles array = doubles::ensure(given);
  if (!array) gonio::refuse(name + " is not an array of numbers");
  const std::span<const double> numbers(array.data(), static_cast<std::size_t>(array.size()));
  if (gonio::all_finite(numbers)) return array;
  const auto wrong = std::ranges::find_if_not(numbers, [](double x) { return std::isfinite(x); });
  gonio::refuse(
      {element_name(array, name, wrong - numbers.begin()), " is ", given_as(*wrong), ": expected finite numbers"});
}

doubles finite_rows(const py::object& given, const std::string& name, std::initializer_list<int> columns) {
  const doubles array = finite_numbers(given, name);
  std::string expected;
  for (const int count : columns) {
    if (count == 0 ? array.ndim() == 1 : array.ndim() == 2 && array.shape(1) == count) return array;
    expected += (expected.empty() ? "" : " or ") + (count == 0 ? "(n,)" : "(n, " + std::to_string(count) + ')');
  }
  gonio::refuse({name, " has shape ", shape_of(array), ": expected ", expected});
}

direction_array::direction_array(const py::object& given, const std::string& name)
    : array_(finite_numbers(given, name)), data_(array_.data()) {
  if (array_.ndim() < 1 || array_.shape(array_.ndim() - 1) != 3)
    gonio::refuse({name, " has shape ", shape_of(array_), ": expected (..., 3), unit vectors"});
  for (Eigen::Index i = 0; i < size(); ++i) {
    const double* w = data_ + 3 * i;
    const double length = gonio::norm_of(w[0], w[1], w[2]);
    if (!(std::abs(length - 1.0) <= 1e-3))
      gonio::refuse({"vector ", i, " of ", name, " has length ", given_as(length), ": expected 1"});
  }
}

direction_pairs::direction_pairs(const py::object& wi, const py::object& wo)
    : wi_(wi, "wi"), wo_(wo, "wo"), wi_is_one_(wi_.shape().empty()), wo_is_one_(wo_.shape().empty()) {
  if (!wi_is_one_ && !wo_is_one_ && wi_.shape() != wo_.shape())
    gonio::refuse({"wi has ", wi_.size(), " vectors and wo has ", wo_.size(),
                   ": expected arrays of the same shape, or a single vector beside an array"});
  shape_ = wi_is_one_ ? wo_.shape() : wi_.shape();
}

std::vector<gonio::sample_directions> sample_directions_of(const py::object& given, const std::string& name) {
  const doubles array = finite_rows(given, name, {6, 3});
  refuse_unit_vectors(array, name);
  const double* data = array.data();
  const py::ssize_t columns = array.shape(1);
  std::vector<gonio::sample_directions> all;
  all.reserve(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const std::string row = name + '[' + std::to_string(i) + ']';
    const double* numbers = data + columns * i;
    if (columns == 3) {
      all.push_back(directions_of_angles(numbers, row));
    } else {
      for (int first : {0, 3})
        if (const double length = gonio::norm_of(numbers[first], numbers[first + 1], numbers[first + 2]);
            !(std::abs(length - 1.0) <= 1e-3))
          gonio::refuse({row, first == 0 ? ": wi has length " : ": wo has length ", given_as(length), ", expected 1"});
      const auto unit = [&](int first) {
        return gonio::normalised({numbers[first], numbers[first + 1], numbers[first + 2]});
      };
      all.emplace_back(gonio::direction_pair{unit(0), unit(3)});
    }
    const gonio::direction_pair& pair = all.back().pair();
    if (!(pair.wi.z() > 0.0 && pair.wo.z() > 0.0))
      gonio::refuse({row, ": a direction is at or below the horizon (z of wi is ", given_as(pair.wi.z()), ", of wo ",
                     given_as(pair.wo.z()), ")"});
  }
  return all;
}

std::vector<py::ssize_t> rows_of(const py::object& given, py::ssize_t count) {
  if (py::isinstance<py::slice>(given)) return rows_of_slice(given.cast<py::slice>(), count);
  const auto array = py::array::ensure(given);
  if (!array) gonio::refuse("rows is not an array of numbers");
  const char kind = array.dtype().kind();
  if (kind == 'b') return rows_of_mask(array, count);
  if (kind == 'i' || kind == 'u') return rows_of_numbers(array, count);
  if (array.ndim() == 1 && array.size() == 0) return {};  // numpy makes even an empty list an array of doubles
  gonio::refuse({"rows is of type ", std::string(py::str(array.dtype())),
                 ": expected whole numbers, True and False for each sample, or a slice"});
}

py::array_t<double> array_of(const std::vector<gonio::direction_pair>& pairs) {
  static_assert(sizeof(gonio::direction_pair) == 6 * sizeof(double));
  py::array_t<double> array({static_cast<py::ssize_t>(pairs.size()), py::ssize_t{6}});
  double* to = array.mutable_data();
  for (const auto& [wi, wo] : pairs) to = std::copy_n(wo.data(), 3, std::copy_n(wi.data(), 3, to));
  return array;
}

py::array_t<double> results_for(const direction_pairs& pairs, py::ssize_t channels) {
  extents shape = pairs.shape();
  if (channels > 1) shape.push_back(channels);
  return py::array_t<double>(shape);
}

xt::xtensor<float, 3> image_of(const py::object& given, const std::string& name) {
  const doubles array = finite_numbers(given, name);
  if (array.ndim() != 3 || array.shape(2) != 3 || array.size() == 0)
    gonio::refuse({name, " has shape ", shape_of(array), ": expected (rows, columns, 3)"});
  xt::xtensor<float, 3> image(
      {static_cast<std::size_t>(array.shape(0)), static_cast<std::size_t>(array.shape(1)), std::size_t{3}});
  std::transform(array.data(), array.data() + array.size(), image.data(),
                 [](double value) { return static_cast<float>(value); });
  return image;
}

}  // namespace python
