#include "scratch.hpp"
#include <gonio/io/text/words.hpp>

using gonio::io::text_position;
using gonio::io::detail::word_reader;
using scratch::check_refused;

namespace {

/// A reader of a text, and its position.
struct text_of_words {
  explicit text_of_words(std::string given) : text(std::move(given)) {}
  text_of_words(const text_of_words&) = delete;

  std::string text;
  text_position position{"table.txt", 0};
  word_reader words{text, position};
};

}  // namespace

TEST_CASE("words: line breaks and comments are ignored") {
  text_of_words given("\xEF\xBB\xBF# made up\r\none\ttwo # not three\n\n  # nor this\nfour#4 5e-1\n#");
  CHECK(given.words.peek() == "one");
  CHECK(given.words.read("a word") == "one");
  CHECK_FALSE(given.words.read_if("one"));
  CHECK(given.words.read_one_of({"one", "two"}) == 1);
  CHECK(given.position.line == 2);
  CHECK(given.words.read("a word") == "four#4");
  CHECK(given.words.read_number("a number") == 0.5);
  CHECK(given.words.peek().empty());
  check_refused([&] { return given.words.read("the end"); }, {"table.txt", "ends before the end"});
}

TEST_CASE("words: lists by count or by line, and the rest of a line, are read") {
  text_of_words given("3 1 2\n3\n4 5 # degrees\nname of a thing\n\nnext");
  CHECK(given.words.read_list("angles", 0.0, 9.0) == std::vector<double>{1.0, 2.0, 3.0});
  CHECK(given.words.read_line("angles", 0.0, 9.0) == std::vector<double>{4.0, 5.0});
  CHECK(given.words.read_if("name"));
  CHECK(given.words.read_rest_of_line() == "of a thing");
  CHECK(given.words.read_rest_of_line().empty());
  CHECK(given.words.peek() == "next");
}

TEST_CASE("words: bytes follow the line of the last word") {
  text_of_words given(std::string("binary \r\n\n# \0after", 18));
  CHECK(given.words.read_if("binary"));
  CHECK(given.words.read_bytes(2, 2) == std::string_view("\n# \0", 4));
  check_refused([&] { return given.words.read_bytes(3, 2); }, {"table.txt", "has 5 bytes", "3 times 2"});
  CHECK(given.words.peek() == "after");
}

TEST_CASE("words: numbers out of range and bad counts are refused") {
  const auto refuses = [](const std::string& text, std::initializer_list<std::string> why) {
    check_refused([&] { return text_of_words(text).words.read_list("angles", 0.0, 9.0); }, why);
  };
  refuses("", {"ends before angles"});
  refuses("two", {"line 1", "angles", "'two'"});
  refuses("0", {"angles: 0 is not a count"});
  refuses("-1", {"-1 is not a count"});
  refuses("1.5", {"1.5 is not a count"});
  refuses("1e7 1", {"not a count from 1 to 1000000"});
  refuses("3 1\n2", {"ends before angles"});
  refuses("2 1\n10", {"line 2", "'10'", "from 0 to 9"});
  refuses("1 nan", {"'nan'", "not finite"});
  check_refused(
      [] {
        return text_of_words("three").words.read_one_of({"one", "two"});
      },
      {"line 1", "'three'", "one or two"});
}
