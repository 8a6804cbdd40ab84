#include <gonio/io/text/rules.hpp>

#include <doctest/doctest.h>

using gonio::io::text_position;
using gonio::io::detail::read_rule;
using gonio::io::detail::require_numbers;

namespace {

const text_position position{"arm.txt", 7};

}  // namespace

TEST_CASE("a rule is a name and its numbers, separated by any blanks, up to a comment") {
  const auto rule = read_rule("  forbid 1\t-2.5  +3e1 # and 4", position);
  CHECK(rule.name == "forbid");
  CHECK(rule.numbers == std::vector{1.0, -2.5, 30.0});
  CHECK(read_rule("mirrored", position).numbers.empty());
  CHECK(read_rule("block 3#4", position).numbers == std::vector{3.0});
}

TEST_CASE("wrong counts and faulty numbers are refused; the error names the line") {
  const auto refused = [](auto&& act, const char* why) {
    CHECK_THROWS_WITH_AS(act(), doctest::Contains(why), gonio::error);
  };
  const auto rule = read_rule("disc 1 2", position);
  CHECK_NOTHROW(require_numbers(rule, {2}, position));
  CHECK_NOTHROW(require_numbers(rule, {1, 2, 5}, position));
  refused([&] { require_numbers(rule, {1}, position); }, "arm.txt, line 7: 'disc' takes 1 number, not 2");
  refused([&] { require_numbers(rule, {1, 3}, position); }, "'disc' takes 1 or 3 numbers, not 2");
  refused([&] { static_cast<void>(read_rule("disc 1 wide", position)); }, "number of 'disc': 'wide' is not a number");
  refused([&] { static_cast<void>(read_rule("disc inf", position)); }, "not finite");
}
