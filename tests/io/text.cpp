#include "scratch.hpp"
#include <gonio/io/text/text.hpp>

#include <rapidcheck.h>

#include <charconv>
#include <cmath>

using gonio::io::for_each_line;
using gonio::io::in_quotes;
using gonio::io::read_by_strtod;
using gonio::io::read_number;
using gonio::io::shortest;
using gonio::io::text_position;
using scratch::check_refused;

TEST_CASE("lines are trimmed and counted; comments and a byte order mark are skipped") {
  text_position position{"a file"};
  std::vector<std::pair<Eigen::Index, std::string>> lines;
  for_each_line("\xEF\xBB\xBFone\r\n\n# no\n  \t\n two  2 \n#\nlast", position,
                [&](std::string_view line) { lines.emplace_back(position.line, line); });
  const decltype(lines) expected{{1, "one"}, {5, "two  2"}, {7, "last"}};
  CHECK(lines == expected);
  check_refused([&]() -> int { position.refuse("is wrong"); }, {"a file, line 7: is wrong"});
  // Lone carriage returns, also among other line ends.
  const auto split = [](std::string_view text) {
    std::vector<std::pair<Eigen::Index, std::string>> found;
    text_position at{"a file"};
    for_each_line(text, at, [&](std::string_view line) { found.emplace_back(at.line, line); });
    return found;
  };
  CHECK(split("one\r\rtwo\rlast") == decltype(lines){{1, "one"}, {3, "two"}, {4, "last"}});
  CHECK(split("one\rtwo\r\nthree\nlast\r") == decltype(lines){{1, "one"}, {2, "two"}, {3, "three"}, {4, "last"}});
}

TEST_CASE("numbers read back as they were written") {
  const text_position position{"a file", 3};
  const auto read = [&](std::string_view field) {
    return read_number(field, position, [] { return std::string("depth"); });
  };
  CHECK(read("+1.5") == 1.5);
  CHECK(read("-2e3") == -2000.0);
  CHECK(rc::check([&](double value) { RC_ASSERT(read(shortest(value)) == value); }));
  for (const char* wrong : {"", "+", "+-1", "1,5", "1 2", "x", "0x10", "nan", "inf", "1e999"})
    check_refused([&] { return read(wrong); }, {"a file, line 3: depth", in_quotes(wrong)});
}

TEST_CASE("strtod gives the same numbers as from_chars for any field") {
  const auto same = [](const std::string& field) {
    double expected = -7.0, value = -7.0;
    const auto [end, status] = std::from_chars(field.data(), field.data() + field.size(), expected);
    const std::errc failed = end == field.data() + field.size() ? status : std::errc::invalid_argument;
    CHECK_MESSAGE(read_by_strtod(field, value) == failed, in_quotes(field));
    if (failed == std::errc() && !std::isnan(expected)) CHECK_MESSAGE(value == expected, in_quotes(field));
  };
  for (const char* field :
       {"0",    "-0.0", "1.",       ".5",  "-.5e-3", "1e5", "1E+05", "1e999", "-1e999", "1e-999", "4.9e-324",
        "inf",  "-INF", "Infinity", "nan", "-nan",   "",    " 1",    "1 ",    "+1",     "-+1",    "--1",
        "0x10", "1p3",  "1e",       "e1",  ".",      "-",   "1,5",   "infin", "1.5.2"})
    same(field);
  same(std::string("1\0", 2));
  CHECK(rc::check([&](double value) { same(shortest(value)); }));
  const auto any_field = rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.eE+-infax ")));
  CHECK(rc::check([&] { same(*any_field); }));
}

TEST_CASE("fields in quotes are short and printable") {
  CHECK(in_quotes("plain") == "'plain'");
  CHECK(in_quotes("a\x01\xff z") == "'a?? z'");
  CHECK(in_quotes(std::string(40, 'x')) == "'" + std::string(40, 'x') + "'");
  CHECK(in_quotes(std::string(100, 'x')) == "'" + std::string(40, 'x') + "...'");
}
