#pragma once
/// numpy arrays as the library's input and output.
///
/// Input: a float64 array in C order is read in place, any other array is converted once. Output: a view of memory that
/// an object owns, which keeps the object alive, or a new array.

#include <gonio/core/arrays.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/table/sample_set.hpp>

#include <Eigen/Core>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <vector>

PYBIND11_MAKE_OPAQUE(gonio::sample_set)  // a class of its own, not a list

namespace python {

namespace py = pybind11;

using doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using extents = std::vector<py::ssize_t>;

/// Returns any array of numbers that numpy accepts. Throws gonio::error with `name` unless all are finite.
[[nodiscard]] doubles finite_numbers(const py::object& given, const std::string& name);

/// Returns finite numbers of shape (n, c) with c one of `columns`, where 0 stands for shape (n,).
[[nodiscard]] doubles finite_rows(const py::object& given, const std::string& name, std::initializer_list<int> columns);

/// Returns the shape as text: "(20, 6)".
[[nodiscard]] std::string shape_of(const py::array& array);

/// Unit vectors along the last axis of an array. Vectors whose length is within 0.001 of 1 are normalised; all others
/// are refused.
class direction_array {
 public:
  direction_array(const py::object& given, const std::string& name);

  /// The number of vectors.
  [[nodiscard]] Eigen::Index size() const noexcept { return array_.size() / 3; }
  /// Returns the shape without the last axis, the three coordinates.
  [[nodiscard]] extents shape() const { return {array_.shape(), array_.shape() + array_.ndim() - 1}; }
  [[nodiscard]] gonio::direction operator[](Eigen::Index i) const noexcept {
    return gonio::normalised({data_[3 * i], data_[3 * i + 1], data_[3 * i + 2]});
  }

 private:
  doubles array_;
  const double* data_;
};

/// Light and viewer: two arrays of the same shape, or one of them a single direction.
class direction_pairs {
 public:
  direction_pairs(const py::object& wi, const py::object& wo);

  [[nodiscard]] Eigen::Index size() const noexcept { return std::max(wi_.size(), wo_.size()); }
  [[nodiscard]] const extents& shape() const noexcept { return shape_; }
  [[nodiscard]] gonio::direction wi(Eigen::Index i) const noexcept { return wi_[wi_is_one_ ? 0 : i]; }
  [[nodiscard]] gonio::direction wo(Eigen::Index i) const noexcept { return wo_[wo_is_one_ ? 0 : i]; }

 private:
  direction_array wi_, wo_;
  bool wi_is_one_, wo_is_one_;
  extents shape_;
};

/// Returns pairs from an array of shape (n, 6), wi and wo, or (n, 3): theta_h, theta_d and phi_d in radians. Throws
/// gonio::error for directions at or below the horizon.
[[nodiscard]] std::vector<gonio::sample_directions> sample_directions_of(const py::object& given,
                                                                         const std::string& name);

/// Returns the rows that numpy would choose of `count` rows: by a slice, by a mask of `count` values of True and False,
/// or by whole numbers; negative ones count from the end. Throws gonio::error for anything else.
[[nodiscard]] std::vector<py::ssize_t> rows_of(const py::object& given, py::ssize_t count);

/// Returns the pairs as an array of shape (n, 6).
[[nodiscard]] py::array_t<double> array_of(const std::vector<gonio::direction_pair>& pairs);

/// Returns an uninitialised array for one number per pair or, if `channels` is above 1, for `channels` numbers per
/// pair.
[[nodiscard]] py::array_t<double> results_for(const direction_pairs& pairs, py::ssize_t channels);

/// Returns a view of numbers that `owner` holds.
template <class Number>
[[nodiscard]] py::array_t<Number> view_of(Number* data, extents shape, extents strides, const py::object& owner) {
  return py::array_t<Number>(std::move(shape), std::move(strides), data, owner);
}

/// Returns a read-only view of numbers that `owner` holds.
template <class Number>
[[nodiscard]] py::array_t<Number> read_only(const Number* data, extents shape, extents strides,
                                            const py::object& owner) {
  py::array_t<Number> view(std::move(shape), std::move(strides), data, owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

/// Returns an array that takes ownership of a tensor's numbers.
template <std::size_t Rank>
[[nodiscard]] py::array_t<float> array_of(xt::xtensor<float, Rank>&& tensor) {
  auto held = std::make_unique<xt::xtensor<float, Rank>>(std::move(tensor));
  float* data = held->data();
  const extents shape(held->shape().begin(), held->shape().end());
  const py::capsule owner(held.get(), [](void* kept) { delete static_cast<xt::xtensor<float, Rank>*>(kept); });
  held.release();
  return py::array_t<float>(shape, data, owner);
}

/// Returns an image from an array of shape (rows, columns, 3).
[[nodiscard]] xt::xtensor<float, 3> image_of(const py::object& given, const std::string& name);

}  // namespace python
