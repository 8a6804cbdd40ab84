#include <gonio/io/text/csv_dialect.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <string>
#include <string_view>
#include <vector>

using gonio::io::csv_dialect;
using gonio::io::dialect_of;

TEST_CASE("the separator is the most frequent one in the header line outside quotes") {
  CHECK(dialect_of("a,b,c").separator == ',');
  CHECK(dialect_of("a;b;c").separator == ';');
  CHECK(dialect_of("a\tb\tc").separator == '\t');
  CHECK(dialect_of("a b   c").separator == ' ');
  CHECK(dialect_of("a").separator == ' ');
  CHECK(dialect_of("").separator == ' ');
  CHECK(dialect_of("a , b,\tc").separator == ',');
  CHECK(dialect_of("a;b, of c;d").separator == ';');
  CHECK(dialect_of("a;b,c").separator == ',');  // equally frequent: the first
  CHECK(dialect_of("a;\"b, c, d\"").separator == ';');
  CHECK(gonio::io::description({';', ','}) == "semicolon-separated with decimal commas");
  CHECK(gonio::io::description({' ', '?'}) == "separated by blanks");
}

TEST_CASE("fields of a line, with quotes and without") {
  const auto fields = [](std::string_view line, char separator) {
    std::vector<std::string_view> found;
    const char* wrong = csv_dialect{separator}.split(line, found);
    if (wrong != nullptr) return std::vector<std::string_view>{"wrong: ", wrong};
    return found;
  };
  using list = std::vector<std::string_view>;
  CHECK(fields("a, b ,,c", ',') == list{"a", "b", "", "c"});
  CHECK(fields("\"a\", \" b,c \" ,\"\",d\r", ',') == list{"a", "b,c", "", "d"});
  CHECK(fields("\"a\"\"b\";\"\"\"\"", ';') == list{"a\"\"b", "\"\""});
  CHECK(fields("a\t\tb\t", '\t') == list{"a", "", "b", ""});
  CHECK(fields("\t\"a\"\t \"b\"\t", '\t') == list{"", "a", "b", ""});
  CHECK(fields("  a \t b ", ' ') == list{"a", "b"});
  CHECK(fields(" \"a b\"  c \r", ' ') == list{"a b", "c"});
  CHECK(fields("5\" lens,b", ',') == list{"5\" lens", "b"});  // a quote inside is a character
  CHECK(fields("\"a", ',')[1] == "a double quote is not closed on its line");
  CHECK(fields("a,\"b\"\"", ',')[1] == "a double quote is not closed on its line");
  CHECK(fields("\"a\"b,c", ',')[1] == "a field continues after its closing double quote");
}

TEST_CASE("quoted fields are read back, trimmed") {
  CHECK(rc::check([] {
    const char separator = *rc::gen::element(',', ';', '\t', ' ');
    const auto texts = *rc::gen::nonEmpty(rc::gen::container<std::vector<std::string>>(
        rc::gen::container<std::string>(rc::gen::elementOf(std::string("ab,;\t #.")))));
    std::string line;
    for (const std::string& text : texts) line += (line.empty() ? "\"" : std::string(1, separator) + '"') + text + '"';
    std::vector<std::string_view> found;
    RC_ASSERT(csv_dialect{separator}.split(line, found) == nullptr);
    RC_ASSERT(found.size() == texts.size());
    for (std::size_t i = 0; i < texts.size(); ++i) {
      const std::size_t begin = texts[i].find_first_not_of(" \t");
      const std::string trimmed =
          begin == std::string::npos ? "" : texts[i].substr(begin, texts[i].find_last_not_of(" \t") - begin + 1);
      RC_ASSERT(found[i] == trimmed);
    }
  }));
}

TEST_CASE("the first decimal mark applies to all numbers") {
  double value = 0.0;
  csv_dialect german{';'};
  CHECK(german.read_number("12", value) == nullptr);
  CHECK(german.decimal_mark == '?');
  CHECK(german.read_number("-1,25e-1", value) == nullptr);
  CHECK(value == -0.125);
  CHECK(german == csv_dialect{';', ','});
  CHECK(german.read_number("+7", value) == nullptr);
  CHECK(value == 7.0);
  for (const char* wrong : {"1.5", "1,5,5", "1.23,5", "1,234.5", ",", "", "x", "nan", "1,5x"}) {
    CAPTURE(wrong);
    CHECK(german.read_number(wrong, value) != nullptr);
  }
  csv_dialect english{';'};
  CHECK(english.read_number("1.5", value) == nullptr);
  CHECK(english.decimal_mark == '.');
  for (const char* wrong : {"1,5", "1.5.5", "1.234,5", "1,23.5", "inf"}) {
    CAPTURE(wrong);
    CHECK(english.read_number(wrong, value) != nullptr);
  }
  CHECK(german.read_number("1.234,5", value) == nullptr);  // thousands
  CHECK(value == 1234.5);
  CHECK(english.read_number("1,234.5", value) == nullptr);
  CHECK(value == 1234.5);
  csv_dialect unknown{';'};
  CHECK(unknown.read_number("1,x", value) != nullptr);
  CHECK(unknown.decimal_mark == '?');  // a faulty number sets no mark
}
