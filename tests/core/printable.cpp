#include <gonio/core/error.hpp>
#include <gonio/core/printable.hpp>

#include <doctest/doctest.h>

#include <string>

using gonio::printable;

TEST_CASE("plain text and whole UTF-8 characters are shown as they are") {
  for (const char* text :
       {"", "red paint ~ 'x' \\x1b", "Köhler, 反射, \U0001F600", "\xC2\xA0\xED\x9F\xBF\xEE\x80\x80\xF4\x8F\xBF\xBF"})
    CHECK(printable(text) == text);
}

TEST_CASE("control characters are written as their codes") {
  CHECK(printable("a\x1b[2Jb\x07") == "a\\x1b[2Jb\\x07");
  CHECK(printable(std::string("\0\t\n\r\x7F", 5)) == "\\x00\\x09\\x0a\\x0d\\x7f");
  CHECK(printable("\xC2\x9B"
                  "31m") == "\\xc2\\x9b31m");  // the C1 control that begins a sequence like ESC [
}

TEST_CASE("bytes that are no UTF-8 are written as their codes") {
  CHECK(printable("\x9B"
                  "31m") == "\\x9b31m");
  CHECK(printable("\xC3") == "\\xc3");
  CHECK(printable("\xC3x") == "\\xc3x");
  CHECK(printable("\xE2\x82") == "\\xe2\\x82");
  CHECK(printable("\xC0\x9B\xC1\xBF") == "\\xc0\\x9b\\xc1\\xbf");  // overlong encodings
  CHECK(printable("\xE0\x82\x9B") == "\\xe0\\x82\\x9b");
  CHECK(printable("\xF0\x80\x82\x9B") == "\\xf0\\x80\\x82\\x9b");
  CHECK(printable("\xED\xA0\x80") == "\\xed\\xa0\\x80");                    // a surrogate
  CHECK(printable("\xF4\x90\x80\x80\xFF") == "\\xf4\\x90\\x80\\x80\\xff");  // above U+10FFFF
}

TEST_CASE("text quoted by a message in parts cannot control a terminal") {
  const std::string name = "evil\x1b]0;title\x07.npy";
  const gonio::error refusal(gonio::message_of({name, ": holds elements of type '", "\x1b[31m", "'"}));
  CHECK(refusal.what() == std::string("evil\\x1b]0;title\\x07.npy: holds elements of type '\\x1b[31m'"));
}
