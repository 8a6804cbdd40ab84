#include <gonio/table/domain.hpp>

#include <doctest/doctest.h>

#include <vector>

namespace {

/// The smallest model, from the concept's documentation.
struct wavelengths {
  std::vector<double> nanometres;
  static constexpr int channels = 1;
  [[nodiscard]] std::size_t size() const { return nanometres.size(); }
  [[nodiscard]] bool operator==(const wavelengths&) const = default;
};

[[nodiscard]] gonio::location locate_cell(const wavelengths& /*locations*/, std::size_t i) {
  return gonio::location_of(i);
}

static_assert(gonio::domain<wavelengths>);
static_assert(gonio::channels_over<wavelengths> == 1);
static_assert(gonio::channels_over<gonio::valid_cells> == 3);

}  // namespace

TEST_CASE("a location of a domain reads itself alone") {
  const wavelengths visible{{400.0, 500.0, 600.0}};
  for (std::size_t i = 0; i < visible.size(); ++i)
    CHECK(gonio::interpolate(
              locate_cell(visible, i), [&](std::size_t location) { return visible.nanometres[location]; }, 0.0) ==
          visible.nanometres[i]);
}
