#pragma once
/// What is expected of a reader that reads a crafted file.

#include "limited_child.hpp"
#include "made_files.hpp"

#include <doctest/doctest.h>

#include <string>

namespace crafted {

inline void refuses(const std::string& reader, const byte_vector& file, const std::string& words) {
  const report result = read_in_child(reader_named(reader), file);
  INFO(reader << ": " << result.message);
  CHECK(result.how == outcome::refused);
  CHECK(result.message.find(words) != std::string::npos);
}

inline void refuses(const std::string& reader, const std::string& text, const std::string& words) {
  refuses(reader, bytes_of(text), words);
}

inline void reads(const std::string& reader, const byte_vector& file) {
  const report result = read_in_child(reader_named(reader), file);
  INFO(reader << ": " << result.message);
  CHECK(result.how == outcome::read);
}

}  // namespace crafted
