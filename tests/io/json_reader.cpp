#include "scratch.hpp"
#include <gonio/io/text/json_reader.hpp>

#include <rapidcheck.h>

using gonio::io::text_position;
using gonio::io::detail::json_reader;
using scratch::check_refused;

namespace {

/// Returns the text of the only value.
std::string skipped(const std::string& text) {
  text_position position{"file.json", 0};
  json_reader json(text, position);
  const std::string value(json.skip());
  json.finish();
  return value;
}

void check_json_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return skipped(text); }, {"file.json"});
  check_refused([&] { return skipped(text); }, words);
}

}  // namespace

TEST_CASE("JSON: values are read in the file's order, others skipped") {
  const std::string text =
      "\xEF\xBB\xBF{ \"a\" : [1, -2.5e1,3],\n\"b\":{\"c\":[[],{}],\"d\":null},\"e\":\"x\\n\\u00b0\"}";
  text_position position{"file.json", 0};
  json_reader json(text, position);
  json.open_object("file");
  REQUIRE(json.next_key() == "a");
  json.open_array("a");
  std::vector<double> numbers;
  while (json.next_element()) numbers.push_back(json.read_number("a"));
  CHECK(numbers == std::vector<double>{1.0, -25.0, 3.0});
  REQUIRE(json.next_key() == "b");
  CHECK(json.skip() == "{\"c\":[[],{}],\"d\":null}");
  REQUIRE(json.next_key() == "e");
  CHECK(json.read_string("e") == "x\n\xC2\xB0");
  CHECK_FALSE(json.next_key());
  json.finish();
}

TEST_CASE("JSON: escapes become UTF-8") {
  const auto string_of = [](const std::string& text) {
    text_position position{"file.json", 0};
    return json_reader(text, position).read_string("text");
  };
  CHECK(string_of(R"("\"\\\/\b\f\r\t")") == "\"\\/\b\f\r\t");
  CHECK(string_of(R"("\u0041\u03bc\u20ac")") == "A\xCE\xBC\xE2\x82\xAC");
  CHECK(string_of(R"("\ud83d\ude00")") == "??");
}

TEST_CASE("JSON: every kind of value is read, other text is refused") {
  for (const std::string text : {"{}", "[]", "[1,[2],{\"a\":[]}]", "\"\"", "0", "-1.5E-3", "true", "false", "null"})
    CHECK(skipped(" " + text + "\n") == text);
  check_json_refused("", {"cut off"});
  check_json_refused("[1,2", {"cut off"});
  check_json_refused("{\"a\"", {"cut off"});
  check_json_refused("\"text", {"cut off"});
  check_json_refused("[1 2]", {"line 1", "','"});
  check_json_refused("[1,]", {"line 1", "not a number"});
  check_json_refused("{\"a\":1,}", {"line 1", "a key"});
  check_json_refused("{\"a\" 1}", {"line 1", "':'"});
  check_json_refused("{\n1:2}", {"line 2", "a key"});
  check_json_refused("[1}", {"line 1", "','"});
  check_json_refused("[nan]", {"'nan'"});
  check_json_refused("[inf]", {"'inf'", "not a number"});
  check_json_refused("[+1]", {"'+1'"});
  check_json_refused("[1e999]", {"'1e999'", "out of range"});
  check_json_refused("tru", {"'tru'"});
  check_json_refused("\"\x1b\"", {"control character"});
  check_json_refused(std::string("\"\0\"", 3), {"control character"});
  check_json_refused("\"\\x\"", {"after a backslash"});
  check_json_refused("\"\\u12\"", {"four hexadecimal digits"});
  check_json_refused("\"\\", {"after a backslash"});
  check_json_refused("1 2", {"'2' follows"});
  check_json_refused(std::string(200000, '['), {"100 levels"});
  CHECK(skipped(std::string(100, '[') + std::string(100, ']')).size() == 200);
}

TEST_CASE("JSON: any text is read or refused") {
  CHECK(rc::check([] {
    const auto text = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("{}[]\",:019.-etrufalsn\\ \n")));
    try {
      RC_ASSERT(skipped(text).size() <= text.size());
    } catch (const gonio::error&) {
    }
  }));
}
