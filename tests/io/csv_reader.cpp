#include "scratch.hpp"
#include <gonio/io/text/csv_reader.hpp>

#include <doctest/doctest.h>

#include <string>
#include <string_view>
#include <vector>

using gonio::io::csv_reader;
using scratch::check_refused;

TEST_CASE("lines of a CSV file: comments, the header line, numbers in its dialect") {
  csv_reader csv("\xEF\xBB\xBF\"# of Monday\";;\r\n\r\nname;x;\n;;\n# below\n\"a;b\";1,5;\nc;2\n", "a.csv");
  std::vector<std::string> comments;
  const auto next = [&] { return csv.next([&](std::string_view text) { comments.emplace_back(text); }); };
  using fields = std::vector<std::string_view>;
  double x = 0.0;
  CHECK(next());
  CHECK(csv.fields() == fields{"name", "x"});
  CHECK(next());
  CHECK(csv.fields() == fields{"a;b", "1,5"});
  CHECK(csv.read_number(csv.fields()[1], x) == nullptr);
  CHECK(x == 1.5);
  CHECK(csv.dialect() == gonio::io::csv_dialect{';', ','});
  CHECK(csv.position().line == 6);
  CHECK(next());
  CHECK(!next());
  CHECK(comments == std::vector<std::string>{" of Monday", " below"});
}

TEST_CASE("lines of a CSV file: bad lines are refused") {
  const auto refuses = [](std::string_view text, const std::string& words) {
    check_refused(
        [&] {
          csv_reader csv(text, "a.csv");
          while (csv.next()) continue;
          return 0;
        },
        {"a.csv", words});
  };
  refuses("a,b\n1\n", "line 2: 1 field, expected 2");
  refuses("a,b\n1,2\n1,2,3\n", "line 3: 3 fields, expected 2");
  refuses("a;b\n1,2\n", "the header line looks semicolon-separated, this one comma-separated");
  refuses("a,b\n\"1,2\n", "line 2: a double quote is not closed");
  refuses("PK\x03\x04", "workbook");
  CHECK(!csv_reader("# a comment\n,,\n", "a.csv").next());
}
