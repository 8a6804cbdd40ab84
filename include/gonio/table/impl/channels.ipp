#pragma once
/// Bodies of table/channels.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/table/channels.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

GONIO_INLINE channels::channels(std::vector<double> wavelengths, illuminant light)
    : size_(std::ssize(wavelengths)), wavelengths_(std::move(wavelengths)), light_(light) {
  require_wavelengths(wavelengths_);
  if (are_wavelengths() && std::ranges::any_of(wavelengths_, is_visible)) colour_.emplace(wavelengths_, light);
}

GONIO_INLINE channels channels::one_value() {
  channels one;
  one.size_ = 1;
  return one;
}

GONIO_INLINE std::string channels::name(Eigen::Index channel) const {
  if (!wavelengths_.empty()) {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "%.8g nm", wavelengths_[channel]);
    return name.data();
  }
  if (size_ == 1) return "value";
  return channel == 0 ? "red" : channel == 1 ? "green" : "blue";
}

GONIO_INLINE rgb channels::colour(std::span<const double> values) const {
  if (size_ == 1) return rgb::Constant(values[0]);
  if (are_colours()) return {values[0], values[1], values[2]};
  return colour_ ? (*colour_)(values) : rgb(rgb::Zero());
}

namespace detail {

/// Returns the range of a third of some channels: the first position, and the position after the last.
[[nodiscard]] inline std::pair<Eigen::Index, Eigen::Index> third_of(Eigen::Index channels, Eigen::Index third) {
  const Eigen::Index first = third * channels / 3;
  return {first, std::max((third + 1) * channels / 3, first + 1)};
}

}  // namespace detail

GONIO_INLINE rgb channels::three(std::span<const double> values) const {
  if (have_colour()) return colour(values);
  rgb means;
  for (Eigen::Index c = 0; c < 3; ++c) {
    const auto [first, end] = detail::third_of(size_, c);
    means[c] = Eigen::Map<const Eigen::ArrayXd>(values.data() + first, end - first).mean();
  }
  return means;
}

GONIO_INLINE std::array<std::string, 3> channels::names_of_three() const {
  std::array<std::string, 3> names{"red", "green", "blue"};
  for (Eigen::Index c = 0; c < 3 && !(are_wavelengths() && have_colour()) && !are_colours(); ++c) {
    const auto [first, end] = detail::third_of(size_, c);
    names[c] = name(end - 1);
    if (end - first > 1) names[c] = name(first).substr(0, name(first).find(' ')) + " to " + names[c];
  }
  return names;
}

GONIO_INLINE channels channels::under(illuminant light) const {
  return are_wavelengths() ? channels(wavelengths_, light) : *this;
}

GONIO_INLINE void require_colour(const channels& all, const std::string& name) {
  if (all.have_colour()) return;
  refuse({name, ": its wavelengths, ", std::lround(all.wavelengths().front()), " to ",
          std::lround(all.wavelengths().back()), " nm, are invisible and have no colour"});
}

}  // namespace gonio
