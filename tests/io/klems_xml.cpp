#include "scratch.hpp"
#include <gonio/io/measurements/klems_xml.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cstddef>
#include <initializer_list>
#include <string>

using gonio::degrees;
using gonio::io::read_klems_xml;
using scratch::check_refused;

namespace {

/// Patches: the normal, and four at 40 degrees. The number of row r and column c, from 0, is r + c / 10.
std::string numbers(const std::string& between) {
  std::string text;
  for (int r = 0; r < 5; ++r)
    for (int c = 0; c < 5; ++c) text += std::to_string(r) + "." + std::to_string(c) + between;
  return text;
}

std::string block(const std::string& direction, const std::string& data) {
  return "<WavelengthDataBlock>\n<WavelengthDataDirection>" + direction +
         "</WavelengthDataDirection><ColumnAngleBasis>small</ColumnAngleBasis>\n"
         "<RowAngleBasis>small</RowAngleBasis><ScatteringData>\n" +
         data + "</ScatteringData></WavelengthDataBlock>\n";
}

const std::string basis =
    "<AngleBasis><AngleBasisName>small</AngleBasisName>\n"
    "<AngleBasisBlock><Theta>0</Theta><nPhis>1</nPhis></AngleBasisBlock>\n"
    "<AngleBasisBlock><Theta>40</Theta><nPhis>4</nPhis></AngleBasisBlock></AngleBasis>";

std::string klems(const std::string& structure, const std::string& blocks, const std::string& wavelength = "Visible") {
  return "<?xml version=\"1.0\"?>\n<WindowElement xmlns=\"http://windows.lbl.gov\"><Optical><Layer>\n"
         "<!-- <DataDefinition> --><DataDefinition><IncidentDataStructure>" +
         structure + "</IncidentDataStructure>\n" + basis + "</DataDefinition>\n<WavelengthData>\n" +
         "<Wavelength unit=\"Integral\">" + wavelength + "</Wavelength>\n" + blocks +
         "</WavelengthData></Layer></Optical></WindowElement>\n";
}

const std::string front = block("Reflection Front", numbers(",\n"));

void check_klems_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_klems_xml(text, "blind.xml"); }, {"blind.xml"});
  check_refused([&] { return read_klems_xml(text, "blind.xml"); }, words);
}

std::string with(std::string text, const std::string& old, const std::string& fresh) {
  REQUIRE(text.find(old) != std::string::npos);
  return text.replace(text.find(old), old.size(), fresh);
}

}  // namespace

TEST_CASE("Klems: a value for each pair of patches: columns are the light's, rows the viewer's") {
  const auto samples = read_klems_xml(klems("Columns", block("Transmission Front", "0") + front), "x");
  REQUIRE(samples.size() == 25);
  const auto& [wi, wo] = samples[5 * 2 + 3].directions.pair();  // row 2, column 3
  CHECK(samples[5 * 2 + 3].value.x() == doctest::Approx(2.3));
  CHECK(degrees(gonio::polar_angle(wi)) == doctest::Approx(40.0));
  CHECK(degrees(gonio::azimuth(wi)) == doctest::Approx(0.0));  // the light goes towards 180
  CHECK(degrees(gonio::azimuth(wo)) == doctest::Approx(90.0));
  CHECK(samples[0].directions.pair().wo.z() == 1.0);
  // The mirror direction is on the diagonal.
  for (std::size_t i = 0; i < 25; i += 6) CHECK(samples[i].angles().theta_h < 1e-6);
  const auto rows = read_klems_xml(klems("Rows", front), "x");
  CHECK(degrees(gonio::azimuth(rows[5 * 2 + 3].directions.pair().wo)) == doctest::Approx(180.0));
  CHECK(degrees(gonio::azimuth(rows[5 * 2 + 3].directions.pair().wi)) == doctest::Approx(-90.0));
}

TEST_CASE("Klems: the front is read in visible light, the back if there is no front") {
  const std::string back = block("Reflection Back", with(numbers(" "), "0.0", "7.0"));
  CHECK(read_klems_xml(klems("Columns", back + front), "x")[0].value.x() == 0.0);
  CHECK(read_klems_xml(klems("Columns", back), "x")[0].value.x() == 7.0);
  check_klems_refused(klems("Columns", back, "Solar"), {"no 'Reflection Front'", "'Reflection Back' of 'Solar'"});
  check_klems_refused(klems("Columns", block("Transmission Front", "0")), {"'Transmission Front' of 'Visible'"});
  check_klems_refused(klems("Columns", ""), {"no matrix"});
}

TEST_CASE("Klems: the requested block is read") {
  using gonio::io::window_block;
  const std::string back = block("Reflection Back", "7 7 7 7 7 7 7 7 7 7 7 7 7 7 7 7 7 7 7 7 7 7 7 7 7");
  const std::string both = klems("Columns", front + back);
  const auto read = [](const std::string& text, const window_block& wanted) {
    return read_klems_xml(text, "x", wanted)[0].value.x();
  };
  CHECK(read(both, {}) == 0.0);
  CHECK(read(both, {.of = window_block::side::back}) == 7.0);
  CHECK(read(klems("Columns", back, "Solar"), {.wavelength = "solar"}) == 7.0);
  check_refused([&] { return read(klems("Columns", back), {.of = window_block::side::front}); },
                {"has no 'Reflection Front' of 'Visible', it has 'Reflection Back' of 'Visible'"});
  check_refused([&] { return read(both, {.of = window_block::side::back, .wavelength = "Solar"}); },
                {"has no 'Reflection Back' of 'Solar'", "'Reflection Front' of 'Visible'"});
}

TEST_CASE("Klems: a file is recognised by its root element") {
  CHECK(gonio::io::looks_like_klems_xml(klems("Columns", front)));
  CHECK_FALSE(gonio::io::looks_like_klems_xml("<opencv_storage>"));
}

TEST_CASE("Klems: bad files are refused") {
  const std::string good = klems("Columns", front);
  check_klems_refused("<WindowElement>\n", {"line 1", "no element <DataDefinition>"});
  check_klems_refused("<WindowElement>\n<DataDefinition>", {"line 2", "<DataDefinition> is not closed"});
  check_klems_refused("<WindowElement>\n<DataDefinition", {"no element <DataDefinition>"});
  check_klems_refused("<WindowElement>\n<DataDefinition a", {"line 2", "<DataDefinition> is not closed"});
  check_klems_refused(klems("TensorTree3", front), {"line 3", "'TensorTree3' is not supported", "Columns or Rows"});
  check_klems_refused(with(good, "<ColumnAngleBasis>small", "<ColumnAngleBasis>large"),
                      {"line 9", "no <AngleBasis>", "'large'"});
  check_klems_refused(with(good, "<nPhis>4", "<nPhis>4.5"), {"line 6", "nPhis", "4.5", "whole numbers"});
  check_klems_refused(with(good, "<nPhis>4", "<nPhis>1e9"), {"line 6", "nPhis", "1e+09", "from 1 to 4096"});
  check_klems_refused(with(good, "<nPhis>4", "<nPhis>4096"), {"line 6", "at most 4096"});
  check_klems_refused(with(good, "<Theta>40", "<Theta>140"), {"line 6", "Theta", "140", "from 0 to 90"});
  check_klems_refused(with(good, "<Theta>40</Theta>", ""), {"line 6", "no element <Theta>"});
  check_klems_refused(with(good, "2.2,", "two,"), {"line 24", "ScatteringData", "'two'"});
  check_klems_refused(with(good, "2.2,", "nan,"), {"'nan' is not finite"});
  check_klems_refused(with(good, "2.2,", "1e39,"), {"range of float"});
  check_klems_refused(with(good, "2.2,", ""), {"has 24 numbers, expected 25"});
  check_klems_refused(with(good, "2.2,", "2.2,2.2,"), {"has more than 25 numbers"});
  scratch::check_refuses_non_files([](const auto& path) { return read_klems_xml(path); });
}

TEST_CASE("Klems: any text is read or refused") {
  const std::string good = klems("Columns", front);
  CHECK(rc::check([&] {
    std::string text = good;
    const auto begin = *rc::gen::inRange<std::size_t>(0, text.size());
    text.replace(begin, *rc::gen::inRange<std::size_t>(0, 200), *rc::gen::string<std::string>());
    try {
      for (const gonio::sample& s : read_klems_xml(text, "x")) RC_ASSERT(s.value.isFinite().all());
    } catch (const gonio::error&) {
    }
  }));
}
