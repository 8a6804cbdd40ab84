#include <gonio/basis/basis.hpp>

#include <doctest/doctest.h>

namespace {

struct identity_metric {
  double forward(double rho, const auto&) const noexcept { return rho; }
  double inverse(double y, const auto&) const noexcept { return y; }
};

/// The archetype, as in the concept's documentation.
struct constant_basis {
  gonio::valid_cells over;
  std::size_t size() const { return 1; }
  const gonio::valid_cells& cells() const { return over; }
  std::span<const float> row(std::size_t) const {
    static constexpr float one = 1;
    return {&one, 1};
  }
  double offset(std::size_t) const { return 0.25; }
  identity_metric metric() const { return {}; }
};
static_assert(gonio::basis<constant_basis>);
static_assert(!gonio::basis<int>);

}  // namespace

TEST_CASE("the archetype of a basis is read at a location") {
  const constant_basis functions{gonio::valid_cells(gonio::grid({5, 5, 5}))};
  const auto at = gonio::locate(functions.cells(), {0.3, 0.4, 0.5});
  CHECK(at.count == 8);
  CHECK(gonio::row_at(functions, at)[0] == doctest::Approx(1.0));
  CHECK(gonio::offset_at(functions, at) == doctest::Approx(0.25));
}
