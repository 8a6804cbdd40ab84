#pragma once
/// Arrays of numpy, as the library reads them and makes them.
///
/// Numbers in: an array of float64 in C order is read where it is, any other is converted once. Values out: a view of
/// what an object holds, which keeps the object alive, or an array that was made for the caller.

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

PYBIND11_MAKE_OPAQUE(gonio::sample_set)  // a class of its own, never a list

namespace python {

namespace py = pybind11;

using doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using extents = std::vector<py::ssize_t>;

/// Whatever numpy takes for an array of numbers, all of them finite. Throws gonio::error that calls it `name`.
[[nodiscard]] doubles finite_numbers(const py::object& given, const std::string& name);

/// The same of shape (n, one of `columns`); 0 among these stands for shape (n).
[[nodiscard]] doubles finite_rows(const py::object& given, const std::string& name, std::initializer_list<int> columns);

/// "(20, 6)".
[[nodiscard]] std::string shape_of(const py::array& array);

/// Unit vectors along the last axis of an array. A length that is off 1 by a thousandth is mended, more is refused.
class direction_array {
 public:
  direction_array(const py::object& given, const std::string& name);

  /// The number of vectors.
  [[nodiscard]] Eigen::Index size() const noexcept { return array_.size() / 3; }
  /// Without the last axis, the three coordinates.
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

/// Pairs from an array of shape (n, 6), wi and wo, or (n, 3): theta_h, theta_d and phi_d in radians. Throws
/// gonio::error for directions at or below the horizon.
[[nodiscard]] std::vector<gonio::sample_directions> sample_directions_of(const py::object& given,
                                                                         const std::string& name);

/// Which of `count` rows are chosen, as numpy understands it: by a slice, by a mask of `count` values of True and
/// False, or by whole numbers, of which negative ones count from the end. Throws gonio::error for anything else.
[[nodiscard]] std::vector<py::ssize_t> rows_of(const py::object& given, py::ssize_t count);

/// The pairs as an array of shape (n, 6).
[[nodiscard]] py::array_t<double> array_of(const std::vector<gonio::direction_pair>& pairs);

/// An array for one number, or as many as `channels`, of each pair.
[[nodiscard]] py::array_t<double> results_for(const direction_pairs& pairs, py::ssize_t channels);

/// A view of numbers that `owner` holds.
template <class Number>
[[nodiscard]] py::array_t<Number> view_of(Number* data, extents shape, extents strides, const py::object& owner) {
  return py::array_t<Number>(std::move(shape), std::move(strides), data, owner);
}

/// The same, which cannot be written to.
template <class Number>
[[nodiscard]] py::array_t<Number> read_only(const Number* data, extents shape, extents strides,
                                            const py::object& owner) {
  py::array_t<Number> view(std::move(shape), std::move(strides), data, owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

/// An array that takes over what a tensor holds.
template <std::size_t Rank>
[[nodiscard]] py::array_t<float> array_of(xt::xtensor<float, Rank>&& tensor) {
  auto held = std::make_unique<xt::xtensor<float, Rank>>(std::move(tensor));
  float* data = held->data();
  const extents shape(held->shape().begin(), held->shape().end());
  const py::capsule owner(held.get(), [](void* kept) { delete static_cast<xt::xtensor<float, Rank>*>(kept); });
  held.release();
  return py::array_t<float>(shape, data, owner);
}

/// An image of shape (rows, columns, 3) from an array.
[[nodiscard]] xt::xtensor<float, 3> image_of(const py::object& given, const std::string& name);

}  // namespace python
