#include "../golden_noell.hpp"
#include "../synthetic_materials.hpp"
#include <gonio/metric/log.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/metric/root.hpp>
#include <gonio/robust/correction.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::correction;
using gonio::correction_factor;
using gonio::correction_rule;

static_assert(gonio::channelwise_basis<correction> && !gonio::has_arbitrary_sign<correction>);

namespace {

/// The approximation of a material by the others at a cell, in sr^-1, computed from the basis' products.
template <class Metric>
class approximations {
 public:
  explicit approximations(const gonio::measured<Metric>& basis) : basis_(basis) {
    for (std::size_t c = 0; c < 3; ++c) products_[c] = basis.channel(c).products();
  }

  /// Values of one channel at all cells.
  [[nodiscard]] std::vector<double> of(Eigen::Index target, std::size_t channel) const {
    std::vector<Eigen::Index> others(basis_.columns().begin(), basis_.columns().end());
    std::erase(others, target);
    const auto x = gonio::nnls().solve(gonio::leave_one_out(products_[channel], target, others)).weights;
    const auto functions = basis_.channel(channel);
    std::vector<double> values;
    for (Eigen::Index cell = 0; cell < basis_.cells().size(); ++cell) {
      double sum = 0.0;
      for (std::size_t i = 0; i < others.size(); ++i) sum += x(i, 0) * double{functions.row(cell)[others[i]]};
      values.push_back(std::max(basis_.metric().inverse(sum, gonio::locate_cell(basis_.cells(), cell)), 0.0));
    }
    return values;
  }

 private:
  gonio::measured<Metric> basis_;
  std::array<Eigen::MatrixXd, 3> products_;
};

/// Checks that the corrections of materials under a metric turn the approximations into the materials.
template <class Metric>
void check_that_materials_come_back(const gonio::material_set& set, const Metric& metric, const correction_rule& rule) {
  const gonio::measured basis{set, metric};
  const correction corrections{basis, rule};
  const approximations<Metric> approximation{basis};
  double largest = 0.0;
  for (Eigen::Index i = 0; i < std::ssize(set.names); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      const auto estimates = approximation.of(i, c);
      for (Eigen::Index cell = 0; cell < std::ssize(estimates); ++cell) {
        const float sigma = corrections.channel(c).row(cell)[i];
        const double shifted = std::max(estimates[cell] + double{rule.factor.offset}, double{rule.factor.smallest});
        const double material = double{set.values(cell, 3 * i + c)};
        const double back = double{sigma} * shifted - double{rule.factor.offset};
        largest = std::max(largest, std::abs(back - material) / (material + 1e-3));
      }
    }
  // The approximation is a float sum of at most nine products of values below 5, followed by exp.
  CHECK(largest < 2e-5);
  CHECK(largest > 0.0);
}

std::vector<float> function_values(const correction& corrections, std::size_t function) {
  std::vector<float> values;
  for (std::size_t c = 0; c < 3; ++c)
    for (Eigen::Index cell = 0; cell < corrections.cells().size(); ++cell)
      values.push_back(corrections.channel(c).row(cell)[function]);
  return values;
}

}  // namespace

TEST_CASE("golden: the corrections of eleven measured materials as printed") {
  const golden_noell& golden = small_golden_noell();
  const gonio::measured basis{golden.materials, gonio::log{}};
  const correction corrections{basis.without({golden.truth_name()}), correction_rule::as_printed()};
  REQUIRE(corrections.columns().size() == 11);
  double largest = 0.0;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < 11; ++i)
      for (std::size_t cell = 0; cell < 5; ++cell) {
        const double expected = golden.expected["channels"][c]["C_first5cols"][i][cell].get<double>();
        const std::size_t column = corrections.columns()[i];
        largest = std::max(largest, std::abs(double{corrections.channel(c).row(cell)[column]} / expected - 1.0));
      }
  // Tables and their logarithms are float here and double in the reference.
  CHECK(largest < 1e-6);
}

TEST_CASE("a correction times the approximation by the others is the material, with any metric and both rules") {
  const auto set = synthetic_materials(small_cells(), 7);
  for (const correction_rule& rule : {correction_rule{}, correction_rule::as_printed()}) {
    check_that_materials_come_back(set, gonio::log{}, rule);
    check_that_materials_come_back(set, gonio::lin{}, rule);
    check_that_materials_come_back(set, gonio::root{}, rule);
    check_that_materials_come_back(set, gonio::root{3.0}, rule);
    check_that_materials_come_back(set, gonio::log_relative::to_median_of(set), rule);
  }
}

TEST_CASE("the constant function is the last one of each channel, if the rule has it") {
  const gonio::measured basis{synthetic_materials(small_cells(), 4), gonio::log{}};
  const correction with{basis}, printed{basis, correction_rule::as_printed()};
  REQUIRE(with.size() == 5);
  CHECK(with.names().size() == 4);
  CHECK(with.columns().size() == 5);
  CHECK(std::ranges::all_of(function_values(with, 4), [](float value) { return value == 1.0f; }));
  CHECK(with.rule().has_constant);
  CHECK(printed.size() == 4);
  CHECK(printed.columns().size() == 4);
  CHECK_FALSE(printed.rule().has_constant);
  CHECK(printed.rule().factor.offset == 0.0f);
  CHECK(std::ranges::any_of(function_values(printed, 3), [](float value) { return value != 1.0f; }));
}

TEST_CASE("a material that the basis leaves out is in no approximation") {
  auto set = synthetic_materials(small_cells(), 5);
  const gonio::measured basis{set, gonio::log{}};
  const correction fewer{basis.without({"material-1"})}, all{basis};
  // The same basis, made without that material.
  gonio::material_set rest{set.cells, {}, gonio::cell_matrix(set.values.rows(), 12)};
  for (Eigen::Index i = 0, to = 0; i < 5; ++i)
    if (i != 1) {
      rest.names.push_back(set.names[i]);
      rest.values.middleCols(3 * to++, 3) = set.values.middleCols(3 * i, 3);
    }
  const correction direct{gonio::measured{rest, gonio::log{}}};
  const correction later = all.without({"material-1"});
  for (const correction& without_it : {fewer, later}) {
    REQUIRE(without_it.size() == 6);
    CHECK(without_it.excluded() == std::vector<std::string>{"material-1"});
    REQUIRE(std::ranges::equal(without_it.columns(), std::vector<Eigen::Index>{0, 2, 3, 4, 5}));
    for (std::size_t f = 0; f < 5; ++f) {
      const auto one = function_values(without_it, without_it.columns()[f]), other = function_values(direct, f);
      // Sums over Gram matrices of other sizes have another order, in double. The float product of rows and weights
      // includes the zero weight of the material that was left out.
      for (std::size_t i = 0; i < one.size(); ++i) REQUIRE(one[i] == doctest::Approx(double{other[i]}).epsilon(2e-6));
    }
  }
  // It would have contributed to some approximation.
  CHECK(function_values(all, 0) != function_values(fewer, 0));
}

TEST_CASE("leaving materials out one by one, all at once or before is the same") {
  const gonio::measured basis{synthetic_materials(small_cells(), 9), gonio::log{}};
  const correction all{basis};
  CHECK(rc::check([&] {
    std::vector<std::string> out;
    correction one_by_one = all;
    for (const std::string& name : basis.names())
      if (out.size() < 7 && *rc::gen::inRange(0, 3) == 0) {
        out.push_back(name);
        one_by_one = one_by_one.without({name});
      }
    const correction at_once = all.without(out), before{basis.without(out)};
    RC_ASSERT(one_by_one.excluded() == out);
    RC_ASSERT(at_once.excluded() == out);
    RC_ASSERT(before.excluded() == out);
    for (const Eigen::Index column : before.columns()) {
      const std::size_t f = column;
      const auto expected = function_values(before, f), one = function_values(one_by_one, f),
                 other = function_values(at_once, f);
      for (std::size_t i = 0; i < expected.size(); ++i) {
        RC_ASSERT(std::abs(one[i] - expected[i]) <= 2e-6f * expected[i]);
        RC_ASSERT(std::abs(other[i] - expected[i]) <= 2e-6f * expected[i]);
      }
    }
  }));
}

TEST_CASE("leaving out is refused for unknown names, and below two materials") {
  const gonio::measured basis{synthetic_materials(small_cells(), 4), gonio::log{}};
  const correction all{basis};
  const correction fewer = all.without({"material-2", "material-0"});
  CHECK(std::ranges::equal(fewer.columns(), std::vector<Eigen::Index>{1, 3, 4}));
  CHECK(fewer.size() == 5);
  CHECK(fewer.rule().has_constant);
  CHECK(all.columns().size() == 5);
  CHECK_THROWS_WITH_AS((void)fewer.without({"chrome"}), doctest::Contains("'chrome'"), gonio::error);
  CHECK_THROWS_WITH_AS((void)fewer.without({"material-1"}), doctest::Contains("at least two materials"), gonio::error);
  CHECK_THROWS_AS((void)fewer.without({"material-1", "material-3"}), gonio::error);
}

TEST_CASE("zeros stay finite: 0/0 needs no correction, and x/0 is bounded by the offset") {
  auto set = synthetic_materials(small_cells(), 4);
  set.values.row(3).setZero();  // all materials: 0/0
  set.values.row(5).setZero();  // all except one: x/0
  set.values.block(5, 0, 1, 3).setConstant(2);
  set.values.row(8).setConstant(-0.5f);  // negative measurements
  const gonio::measured basis{set, gonio::log{}};
  const correction corrections{basis}, printed{basis, correction_rule::as_printed()};
  for (std::size_t c = 0; c < 3; ++c) {
    CHECK(corrections.channel(c).values().allFinite());
    CHECK(printed.channel(c).values().allFinite());
    CHECK((corrections.channel(c).values().array() >= 0.0f).all());
    for (std::size_t i = 0; i < 4; ++i) {
      CHECK(corrections.channel(c).row(3)[i] == 1.0f);
      CHECK(corrections.channel(c).row(8)[i] == 1.0f);
      CHECK(printed.channel(c).row(3)[i] == 0.0f);
    }
    CHECK(corrections.channel(c).row(5)[0] == doctest::Approx(2.001 / 1e-3));
    CHECK(printed.channel(c).row(5)[0] == doctest::Approx(2.0 / 1e-6));
  }
}

TEST_CASE("correction factors: correcting an estimate by its quotient gives the measurement") {
  CHECK(rc::check([] {
    const auto reflectance = rc::gen::map(rc::gen::inRange(0, 100'001), [](int value) {
      return value == 0 ? 0.0f : static_cast<float>(1e-4 * std::pow(10.0, 6e-5 * value));
    });
    using values = Eigen::Array<float, 2, 1>;
    const float rho = *reflectance, estimate = *reflectance;
    const values measurement{rho, -rho}, estimates{estimate, estimate};
    for (const correction_factor& factor : {correction_factor{}, correction_factor::as_printed()}) {
      const values sigma = factor.quotient(measurement, estimates);
      const values back = factor.correct(estimates, sigma);
      RC_ASSERT((sigma >= 0.0f).all());
      // A few roundings of numbers of the size of measurement plus offset.
      RC_ASSERT(std::abs(back[0] - rho) <= 4e-7f * (rho + factor.offset));
      RC_ASSERT(back[1] <= 1e-9f);  // a negative measurement counts as zero
      // A sigma of 1 leaves an estimate unchanged, up to the rounding of the offset, even at the smallest denominator.
      const values ones = values::Ones(), same = factor.correct(estimates, ones);
      RC_ASSERT(std::abs(same[0] - std::max(estimate, factor.smallest - factor.offset)) <=
                2e-7f * (estimate + factor.offset));
    }
  }));
}

TEST_CASE("corrections are the same for any number of threads") {
  const auto set = synthetic_materials(gonio::valid_cells(gonio::grid({12, 10, 12})), 6);
  const gonio::measured basis{set, gonio::log{}};
  const correction one{basis, {}, gonio::nnls{}, {1}}, three{basis, {}, gonio::nnls{}, {3}};
  for (Eigen::Index f = 0; f < one.size(); ++f) CHECK(function_values(one, f) == function_values(three, f));
}

TEST_CASE("fewer than two materials have no corrections") {
  const gonio::measured alone{synthetic_materials(small_cells(), 1), gonio::log{}};
  CHECK_THROWS_WITH_AS(correction{alone}, doctest::Contains("at least two materials"), gonio::error);
  const gonio::measured pair{synthetic_materials(small_cells(), 2), gonio::log{}};
  CHECK(correction{pair}.size() == 3);
  CHECK_THROWS_AS(correction{pair.without({"material-0"})}, gonio::error);
}
