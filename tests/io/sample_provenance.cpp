#include <gonio/io/measurements/sample_provenance.hpp>

#include <doctest/doctest.h>

using gonio::io::comment_lines;
using gonio::io::sample_provenance;
namespace detail = gonio::io::detail;

TEST_CASE("comments are split into keys and values") {
  const detail::comment_entry entry = detail::entry_of(" Instrument : GON 360: arm 2 \r");
  CHECK(entry.key == "instrument");
  CHECK(entry.value == "GON 360: arm 2");
  CHECK(detail::entry_of("measured on a Thursday").key.empty());
}

TEST_CASE("a provenance is read back from its comment lines") {
  const sample_provenance written{"GON 360; arm 2", "2026-11-25", ""};
  const std::string text = comment_lines(written);
  CHECK(text == "# instrument: GON 360; arm 2\n# date: 2026-11-25\n");
  sample_provenance read;
  for (const std::string_view line : {"instrument: GON 360", "instrument: arm 2", "date: 2026-11-25", "other: x"})
    detail::keep(read, detail::entry_of(line));
  CHECK(read == written);
  CHECK(sample_provenance{}.empty());
  CHECK(comment_lines({}).empty());
  // An entry cannot begin a new line.
  CHECK(comment_lines({"a\n1,2,3", "", ""}) == "# instrument: a\\x0a1,2,3\n");
}
