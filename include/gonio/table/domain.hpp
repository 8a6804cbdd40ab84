#pragma once
/// The concept of a domain: what the functions of a basis are functions of.

#include <gonio/table/location.hpp>

#include <Eigen/Core>

#include <concepts>
#include <iterator>
#include <vector>

namespace gonio {

/// Places numbered from 0 to `size()`: the valid cells of a grid for BRDFs, the coordinates of vertices for shapes.
///
/// What the compiler cannot check, and a model must keep: copies are cheap; two that are equal number the same
/// locations alike; `locate_cell(locations, i)`, found beside the type, is the location that reads location i alone. A
/// thing is observed over a domain in three channels of colour, unless the domain says otherwise: `static constexpr int
/// channels = 1;`.
///
/// ```cpp
/// struct wavelengths {
///   std::vector<double> nanometres;
///   static constexpr int channels = 1;
///   Eigen::Index size() const { return nanometres.size(); }
///   bool operator==(const wavelengths&) const = default;
/// };
/// gonio::location locate_cell(const wavelengths&, Eigen::Index i) { return gonio::location_of(i); }
/// static_assert(gonio::domain<wavelengths>);
/// ```
template <class Places>
concept domain = std::copyable<Places> && std::equality_comparable<Places> &&
    requires(const Places& locations, Eigen::Index place) {
  { locations.size() } -> std::convertible_to<Eigen::Index>;
  { locate_cell(locations, place) } -> std::same_as<location>;
};

static_assert(domain<valid_cells>);

/// In how many channels a thing is observed over a domain.
template <domain Places>
inline constexpr int channels_over = 3;

template <domain Places>
requires requires { Places::channels; }
inline constexpr int channels_over<Places> = Places::channels;

/// The channels of what was observed at some wavelengths, or, without any, in colours.
template <domain Places>
[[nodiscard]] Eigen::Index channels_at(const std::vector<double>& wavelengths) noexcept {
  return wavelengths.empty() ? channels_over<Places> : std::ssize(wavelengths);
}

}  // namespace gonio
