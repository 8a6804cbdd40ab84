#pragma once
/// Python's ways to copy an object: copy.copy, copy.deepcopy, and pickle, by which processes exchange objects. A pickle
/// can be read only by the version of gonio that wrote it.

#include "arrays.hpp"
#include <gonio/core/error.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>

namespace python {

/// Throws gonio::error unless a pickle has as many parts as this version writes.
inline void require_state(const py::tuple& state, std::size_t size) {
  if (state.size() != size)
    gonio::refuse({"a pickle of another version of gonio has ", state.size(), " parts: expected ", size});
}

/// Adds copy.copy and copy.deepcopy to a class whose copies share no writable memory.
template <class Type, class... Extra>
void add_copies(py::class_<Type, Extra...>& type) {
  type.def("__copy__", [](const Type& self) { return self; });
  type.def(
      "__deepcopy__", [](const Type& self, const py::dict&) { return self; }, py::arg("memo"));
}

/// Adds copy.copy, copy.deepcopy and pickle: `state(object)` returns a tuple, `from_state(tuple)` restores the object.
template <class Type, class... Extra, class State, class FromState>
void add_copies(py::class_<Type, Extra...>& type, State&& state, FromState&& from_state) {
  add_copies(type);
  type.def(py::pickle(std::forward<State>(state), std::forward<FromState>(from_state)));
}

/// Returns a copy of a matrix; a vector gets shape (n, 1).
template <class Matrix>
[[nodiscard]] py::array_t<typename Matrix::Scalar> copy_of(const Matrix& matrix) {
  using number = typename Matrix::Scalar;
  py::array_t<number> array({matrix.rows(), matrix.cols()});
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) array.mutable_at(i, j) = matrix(i, j);
  return array;
}

/// Returns the matrix of an array that `copy_of` made.
template <class Matrix>
[[nodiscard]] Matrix matrix_of(const py::handle& given) {
  using number = typename Matrix::Scalar;
  const auto array = given.cast<py::array_t<number, py::array::c_style | py::array::forcecast>>();
  if (array.ndim() != 2) gonio::refuse("a pickle lacks a matrix");
  Matrix matrix(array.shape(0), array.shape(1));
  for (Eigen::Index i = 0; i < matrix.rows(); ++i)
    for (Eigen::Index j = 0; j < matrix.cols(); ++j) matrix(i, j) = array.at(i, j);
  return matrix;
}

/// Returns a copy of contiguous numbers.
template <class Numbers>
[[nodiscard]] auto array_of_numbers(const Numbers& numbers) {
  using number = std::remove_cvref_t<decltype(*numbers.data())>;
  return py::array_t<number>(extents{static_cast<py::ssize_t>(numbers.size())}, numbers.data());
}

/// Copies the numbers of an array that `array_of_numbers` made to `to`. Throws gonio::error unless it has `count`
/// numbers.
template <class Number>
void copy_numbers(const py::handle& given, Number* to, Eigen::Index count) {
  const auto array = given.cast<py::array_t<Number, py::array::c_style | py::array::forcecast>>();
  if (array.size() != count) gonio::refuse({"a pickle holds ", array.size(), " numbers: expected ", count});
  std::copy_n(array.data(), count, to);
}

}  // namespace python
