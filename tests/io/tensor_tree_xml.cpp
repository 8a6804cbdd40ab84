#include "scratch.hpp"
#include <gonio/io/measurements/tensor_tree_xml.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

#include <cmath>
#include <initializer_list>
#include <string>

using gonio::degrees;
using gonio::io::read_tensor_tree_xml;
using scratch::check_refused;

namespace {

std::string file_of(const std::string& rank, const std::string& blocks) {
  return "<?xml version=\"1.0\"?>\n<WindowElement><Optical><Layer>\n<DataDefinition><IncidentDataStructure>TensorTree" +
         rank + "</IncidentDataStructure></DataDefinition>\n<WavelengthData><Wavelength>Visible</Wavelength>\n" +
         blocks + "</WavelengthData></Layer></Optical></WindowElement>\n";
}

std::string block(const std::string& direction, const std::string& tree) {
  return "<WavelengthDataBlock>\n<WavelengthDataDirection>" + direction +
         "</WavelengthDataDirection><AngleBasis>LBNL/Shirley-Chiu</AngleBasis>\n<ScatteringData>\n" + tree +
         "\n</ScatteringData></WavelengthDataBlock>\n";
}

std::string tree_file(const std::string& rank, const std::string& tree) {
  return file_of(rank, block("Reflection Front", tree));
}

/// A node whose first child is `first` and whose other children have one value.
std::string node(const std::string& first, int children) {
  std::string text = "{ " + first;
  for (int i = 1; i < children; ++i) text += "\n{ " + std::to_string(i) + " }";
  return text + " }";
}

std::string numbers(int count) {
  std::string text = "{";
  for (int i = 0; i < count; ++i) text += (i % 2 == 0 ? " " : ", ") + std::to_string(i);
  return text + " }";
}

/// Returns the value of the sample with the nearest directions.
double value_near(const gonio::sample_set& samples, const gonio::direction& wi, const gonio::direction& wo) {
  double least = 1e9, value = 0.0;
  for (const gonio::sample& each : samples) {
    const auto& pair = each.directions.pair();
    const double distance = (pair.wi - wi).squaredNorm() + (pair.wo - wo).squaredNorm();
    if (distance < least) value = each.value.x();
    least = std::min(least, distance);
  }
  return value;
}

void check_tree_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_tensor_tree_xml(text, "blind.xml"); }, {"blind.xml"});
  check_refused([&] { return read_tensor_tree_xml(text, "blind.xml"); }, words);
}

}  // namespace

TEST_CASE("tensor tree: wide cells are divided, and the light of rank 3 is at azimuth 180") {
  const auto samples = read_tensor_tree_xml(tree_file("3", "{ 0.25 }"), "x");
  REQUIRE(samples.size() == 4 * 8 * 8);
  for (const gonio::sample& each : samples) {
    CHECK(each.value.x() == 0.25);
    CHECK(each.directions.pair().wi.norm() == doctest::Approx(1.0));
    CHECK(each.directions.pair().wo.norm() == doctest::Approx(1.0));
    CHECK(degrees(gonio::azimuth(each.directions.pair().wi)) == doctest::Approx(180.0));
  }
  CHECK(samples[0].directions.pair().wi.x() == doctest::Approx(-0.875));
  CHECK(read_tensor_tree_xml(tree_file("4", "{ 0.25 }"), "x").size() == 8 * 8 * 8 * 8);
}

TEST_CASE("tensor tree: the first axis is fastest among a node's children, the last among a grid's values") {
  const gonio::direction wi(-0.625, 0.0, std::sqrt(1.0 - 0.625 * 0.625));
  const auto towards = [](double x, double y) { return gonio::direction(x, y, std::sqrt(1.0 - x * x - y * y)); };
  // Children 0, 2, 4, 6 are below .5 on the first axis; 2 and 6 above it on the second, x; 4 and 6 on the third, y.
  const auto children = read_tensor_tree_xml(tree_file("3", node("{ 0 }", 8)), "x");
  CHECK(value_near(children, wi, towards(-0.5, -0.5)) == 0.0);
  CHECK(value_near(children, wi, towards(0.5, -0.5)) == 2.0);
  CHECK(value_near(children, wi, towards(-0.5, 0.5)) == 4.0);
  CHECK(value_near(children, wi, towards(0.5, 0.5)) == 6.0);
  const auto grid = read_tensor_tree_xml(tree_file("3", numbers(8)), "x");
  CHECK(value_near(grid, wi, towards(-0.5, 0.5)) == 1.0);
  CHECK(value_near(grid, wi, towards(0.5, -0.5)) == 2.0);
  CHECK(value_near(grid, wi, towards(0.5, 0.5)) == 3.0);
}

TEST_CASE("tensor tree: rank 4 has two squares; the light's is turned by 180 degrees") {
  const auto towards = [](double x, double y) { return gonio::direction(x, y, std::sqrt(1.0 - x * x - y * y)); };
  const auto samples = read_tensor_tree_xml(tree_file("4", node(numbers(16), 16)), "x");
  CHECK(samples.size() == 4096);
  CHECK(value_near(samples, towards(-0.5, 0.5), towards(-0.5, -0.5)) == 1.0);
  CHECK(value_near(samples, towards(0.5, -0.5), towards(-0.5, -0.5)) == 2.0);
  CHECK(value_near(samples, towards(0.5, 0.5), towards(0.5, -0.5)) == 4.0);
  CHECK(value_near(samples, towards(0.5, 0.5), towards(-0.5, 0.5)) == 8.0);
  // The first child's grid: its last axis is the fastest.
  CHECK(value_near(samples, towards(0.6, 0.6), towards(-0.6, -0.1)) == 1.0);
  CHECK(value_near(samples, towards(0.3, 0.3), towards(-0.6, -0.1)) == 13.0);
}

TEST_CASE("tensor tree: the map of the square preserves areas") {
  const auto samples = read_tensor_tree_xml(tree_file("3", numbers(4096)), "x");
  REQUIRE(samples.size() == 8 * 16 * 16);
  double mean = 0.0;
  for (int i = 0; i < 256; ++i) {
    const auto& wo = samples[i].directions.pair().wo;
    CHECK(samples[i].value.x() == i);
    mean += (1.0 - wo.z() * wo.z()) / 256.0;
  }
  CHECK(mean == doctest::Approx(0.5).epsilon(0.01));  // the mean squared radius in a disk
  CHECK(degrees(gonio::azimuth(samples[0].directions.pair().wo)) == doctest::Approx(-135.0));
  CHECK(samples[0].directions.pair().wo.z() == doctest::Approx(std::sqrt(1.0 - 0.9375 * 0.9375)));
}

TEST_CASE("tensor tree: the front is read, the back if there is no front; a file is recognised") {
  const std::string back = block("Reflection Back", "{ 7 }"), front = block("Reflection Front", "{ 3 }"),
                    through = block("Transmission Front", "{ 5 }");
  CHECK(read_tensor_tree_xml(file_of("3", through + back + front), "x")[0].value.x() == 3.0);
  CHECK(read_tensor_tree_xml(file_of("3", through + back), "x")[0].value.x() == 7.0);
  check_tree_refused(file_of("3", through), {"no 'Reflection Front'", "'Transmission Front' of 'Visible'"});
  CHECK(gonio::io::looks_like_tensor_tree_xml(file_of("4", front)));
  CHECK_FALSE(gonio::io::looks_like_tensor_tree_xml("<WindowElement><IncidentDataStructure>Columns"));
}

TEST_CASE("tensor tree: bad files are refused") {
  check_tree_refused("<WindowElement>\n", {"line 1", "no element <DataDefinition>"});
  check_tree_refused(file_of("5", block("Reflection Front", "{ 1 }")), {"line 3", "'TensorTree5'", "TensorTree4"});
  std::string klems = tree_file("3", "{ 1 }");
  klems.replace(klems.find("LBNL/Shirley-Chiu"), 17, "LBNL/Klems Full");
  check_tree_refused(klems, {"<AngleBasis> 'LBNL/Klems Full'", "LBNL/Shirley-Chiu"});
  check_tree_refused(tree_file("3", ""), {"the tree ends, expected {"});
  check_tree_refused(tree_file("3", "1"), {"line 8", "'1', expected {"});
  check_tree_refused(tree_file("3", "{ 1"), {"<ScatteringData>: ''"});
  check_tree_refused(tree_file("3", "{ one }"), {"line 8", "'one' is not a number"});
  check_tree_refused(tree_file("3", "{ 1\n1e39 }"), {"line 9", "range of float"});
  check_tree_refused(tree_file("3", "{ nan }"), {"'nan' is not finite"});
  check_tree_refused(tree_file("3", "{ }"), {"a node has 0 values"});
  check_tree_refused(tree_file("3", numbers(16)), {"a node has 16 values", "expected 1, 8, 64"});
  check_tree_refused(tree_file("4", numbers(8)), {"a node has 8 values", "expected 1, 16, 256"});
  check_tree_refused(tree_file("3", node("{ 0 }", 7)), {"'}', expected {"});
  check_tree_refused(tree_file("3", node("{ 0 }", 9)), {"'{', expected }"});
  check_tree_refused(tree_file("3", "{ 1 } { 2 }"), {"line 8", "'{' follows the tree"});
  check_tree_refused(tree_file("3", std::string(100'000, '{')), {"more than 16 levels"});
  scratch::check_refuses_non_files([](const auto& path) { return read_tensor_tree_xml(path); });
}

TEST_CASE("tensor tree: any text is read or refused") {
  CHECK(rc::check([] {
    std::string tree = node(node(numbers(8), 8), 8);
    const auto where = *rc::gen::inRange<std::size_t>(0, tree.size());
    const auto fresh = *rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789.-{} \ne")));
    tree.replace(where, *rc::gen::inRange<std::size_t>(0, 10), fresh);
    try {
      for (const gonio::sample& s : read_tensor_tree_xml(tree_file("3", tree), "x"))
        RC_ASSERT(s.value.isFinite().all());
    } catch (const gonio::error&) {
    }
  }));
}
