/// JSON, as the files of --state hold it: what is read is written, and read again as the same.

#include "harness.hpp"

#include <tool/files/json.hpp>

#include <cstdlib>

namespace {

void read(fuzz::input bytes) {
  const cli::json value = cli::json::read(std::string(fuzz::text_of(bytes)));
  const std::string text = value.dump();
  if (cli::json::read(text).dump() != text) std::abort();
}

const fuzz::registered harness("json", &read);

}  // namespace
