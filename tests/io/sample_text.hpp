#pragma once
// Common parts of the tests of samples as text.

#include "scratch.hpp"
#include <gonio/io/measurements/samples.hpp>

#include <initializer_list>
#include <string>

namespace scratch {

/// Checks that `read_samples` refuses a text with a message that names it and has these words.
inline void check_text_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return gonio::io::read_samples(text, "paint.csv"); }, {"paint.csv"});
  check_refused([&] { return gonio::io::read_samples(text, "paint.csv"); }, words);
}

}  // namespace scratch
