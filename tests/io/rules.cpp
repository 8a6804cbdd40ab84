#include <gonio/io/text/rules.hpp>

#include <doctest/doctest.h>

using gonio::io::text_place;
using gonio::io::detail::read_rule;
using gonio::io::detail::require_numbers;

namespace {

const text_place place{"arm.txt", 7};

}  // namespace

TEST_CASE("a rule is a name and its numbers, however they are spaced, up to a comment") {
  const auto rule = read_rule("  forbid 1\t-2.5  +3e1 # and 4", place);
  CHECK(rule.name == "forbid");
  CHECK(rule.numbers == std::vector{1.0, -2.5, 30.0});
  CHECK(read_rule("mirrored", place).numbers.empty());
  CHECK(read_rule("block 3#4", place).numbers == std::vector{3.0});
}

TEST_CASE("other counts of numbers, and what is no number, are refused where they are") {
  const auto refused = [](auto&& act, const char* why) {
    CHECK_THROWS_WITH_AS(act(), doctest::Contains(why), gonio::error);
  };
  const auto rule = read_rule("disc 1 2", place);
  CHECK_NOTHROW(require_numbers(rule, {2}, place));
  CHECK_NOTHROW(require_numbers(rule, {1, 2, 5}, place));
  refused([&] { require_numbers(rule, {1}, place); }, "arm.txt, line 7: 'disc' takes 1 number, not 2");
  refused([&] { require_numbers(rule, {1, 3}, place); }, "'disc' takes 1 or 3 numbers, not 2");
  refused([&] { static_cast<void>(read_rule("disc 1 wide", place)); }, "number of 'disc': 'wide' is not a number");
  refused([&] { static_cast<void>(read_rule("disc inf", place)); }, "not finite");
}
