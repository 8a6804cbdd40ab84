#include "io/scratch.hpp"
#include <gonio/shape/io/mesh.hpp>

#include <rapidcheck.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iostream>  // rapidcheck.h does not include what it uses
#include <limits>

using gonio::io::read_mesh;
using gonio::io::write_mesh;
using gonio::shape::triangle_mesh;
using scratch::check_refused;

namespace {

using numbers = std::vector<std::vector<double>>;
using faces = std::vector<std::vector<int>>;

numbers points_of(const triangle_mesh& mesh) {
  numbers points;
  for (const auto& point : mesh.vertices.colwise()) points.emplace_back(point.begin(), point.end());
  return points;
}

faces triangles_of(const triangle_mesh& mesh) {
  faces triangles;
  for (const auto& corners : mesh.triangles.colwise()) triangles.emplace_back(corners.begin(), corners.end());
  return triangles;
}

triangle_mesh mesh_in(const scratch::folder& here, const std::string& name, const std::string& content) {
  scratch::put(here / name, content);
  return read_mesh(here / name);
}

/// Returns the bytes of a number, in big-endian order if requested.
template <class Number>
std::string bytes_of_number(Number value, bool big_endian) {
  auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
  if (big_endian) std::ranges::reverse(bytes);
  return {bytes.begin(), bytes.end()};
}

/// Returns any finite number, including signed zeros and subnormals.
double any_finite() {
  const auto bits = *rc::gen::arbitrary<std::uint64_t>();
  const double some = *rc::gen::element(0.0, -0.0, 1.0 / 3.0, 5e-324, -1.7976931348623157e308, 12.5);
  const double value = std::bit_cast<double>(bits * 0x9E3779B97F4A7C15u);
  return std::isfinite(value) && bits % 4 != 0 ? value : some;
}

triangle_mesh any_mesh() {
  const int vertices = *rc::gen::inRange(1, 30), triangles = *rc::gen::inRange(1, 40);
  triangle_mesh mesh{gonio::shape::point_columns(3, vertices), gonio::shape::triangle_columns(3, triangles)};
  for (double& coordinate : mesh.vertices.reshaped()) coordinate = any_finite();
  for (int& corner : mesh.triangles.reshaped()) corner = *rc::gen::inRange(0, vertices);
  return mesh;
}

bool same_bits(const triangle_mesh& a, const triangle_mesh& b) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return a.triangles == b.triangles && a.vertices.cols() == b.vertices.cols() &&
         std::ranges::equal(a.vertices.reshaped(), b.vertices.reshaped(), {}, bits, bits);
}

triangle_mesh single_triangle() {
  triangle_mesh mesh{gonio::shape::point_columns(3, 3), gonio::shape::triangle_columns(3, 1)};
  mesh.vertices << 0.1, 1.0, 0.0, 0.0, -2.5, 1e-7, 0.0, 0.0, 1e300;
  mesh.triangles << 2, 0, 1;
  return mesh;
}

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string corner_list = "property list uchar int vertex_indices\n";

/// Returns an ascii PLY with these counts in its header.
std::string ascii_ply(const std::string& vertices, const std::string& face_count, const std::string& rows) {
  return "ply\nformat ascii 1.0\nelement vertex " + vertices + "\n" + xyz + "element face " + face_count + "\n" +
         corner_list + "end_header\n" + rows;
}

/// Returns a square of two triangles and a pentagon in binary. The last vertex repeats the first; the sixth is unused.
std::string binary_ply(bool big_endian) {
  std::string text = std::string("ply\nformat binary_") + (big_endian ? "big" : "little") +
                     "_endian 1.0\ncomment made by hand\nobj_info of no importance\nelement range_grid 2\n"
                     "property list short uchar vertex_indices\nelement vertex 7\nproperty uchar red\n"
                     "property float32 x\nproperty double y\nproperty int16 z\nproperty list int8 double x\n"
                     "element face 3\nproperty int flags\nproperty list uint uint16 vertex_index\n"
                     "property list uchar float weights\nelement edge 1\nproperty int vertex1\nend_header\n";
  const auto put = [&](auto value) { text += bytes_of_number(value, big_endian); };
  put(std::int16_t{3});
  text += "abc";
  put(std::int16_t{0});
  for (int v = 0; v < 7; ++v) {
    text += '\xFF';
    put(static_cast<float>(v % 6) + 0.25f);
    put(0.1 * (v % 6));
    put(static_cast<std::int16_t>(-300 * (v % 6)));
    text += '\1';
    put(std::numeric_limits<double>::quiet_NaN());
  }
  for (const auto& corners : faces{{0, 1, 2}, {0, 2, 3}, {6, 1, 2, 3, 4}}) {
    put(std::int32_t{-1});
    put(static_cast<std::uint32_t>(corners.size()));
    for (const int corner : corners) put(static_cast<std::uint16_t>(corner));
    text += '\2' + bytes_of_number(0.5f, big_endian) + bytes_of_number(0.25f, big_endian);
  }
  put(std::int32_t{7});
  return text;
}

}  // namespace

TEST_CASE("a mesh is read as it was written, to the last bit") {
  const scratch::folder here;
  CHECK(rc::check("mesh round trip", [&] {
    const triangle_mesh mesh = any_mesh();
    for (const char* name : {"a.ply", "a.obj"}) {
      write_mesh(here / name, mesh);
      RC_ASSERT(same_bits(read_mesh(here / name), mesh));
    }
  }));
  CHECK(here.entries() == 2);
}

TEST_CASE("written files have the bytes that other programs expect") {
  using namespace std::string_literals;
  const scratch::folder here;
  write_mesh(here / "a.obj", single_triangle());
  CHECK(scratch::get(here / "a.obj") == "v 0.1 0 0\nv 1 -2.5 0\nv 0 1e-07 1e+300\nf 3 1 2\n");
  write_mesh(here / "a.ply", single_triangle());
  std::string expected =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  for (const double value : {0.1, 0.0, 0.0, 1.0, -2.5, 0.0, 0.0, 1e-7, 1e300})
    expected += bytes_of_number(value, false);
  expected += "\3\2\0\0\0\0\0\0\0\1\0\0\0"s;
  CHECK(scratch::get(here / "a.ply") == expected);
}

TEST_CASE("colours are stored in sRGB and do not disturb the mesh") {
  using namespace std::string_literals;
  const scratch::folder here;
  const std::vector<gonio::rgb> colours{{0.0, 1.0, 0.5}, {-1.0, 7.0, 0.2140411}, {0.0031308, 0.001, 1.0}};
  write_mesh(here / "a.PLY", single_triangle(), colours);
  CHECK(same_bits(read_mesh(here / "a.PLY"), single_triangle()));
  const std::string content = scratch::get(here / "a.PLY");
  CHECK(
      content.find("property double z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face") !=
      std::string::npos);
  const std::size_t body = content.find("end_header\n") + 11;
  REQUIRE(content.size() == body + 3 * 27 + 13);
  CHECK(content.substr(body + 24, 3) == "\x00\xFF\xBC"s);
  CHECK(content.substr(body + 27 + 24, 3) == "\x00\xFF\x7F"s);
  CHECK(content.substr(body + 2 * 27 + 24, 3) == "\x0A\x03\xFF"s);
}

TEST_CASE("binary PLY of both byte orders and all kinds of properties") {
  const scratch::folder here;
  for (const bool big_endian : {false, true}) {
    const triangle_mesh mesh = mesh_in(here, "a.ply", binary_ply(big_endian));
    REQUIRE(mesh.vertices.cols() == 7);
    for (int v = 0; v < 7; ++v)
      CHECK(mesh.vertices.col(v) == Eigen::Vector3d(v % 6 + 0.25, 0.1 * (v % 6), -300.0 * (v % 6)));
    CHECK(triangles_of(mesh) == faces{{0, 1, 2}, {0, 2, 3}, {6, 1, 2}, {6, 2, 3}, {6, 3, 4}});
  }
}

TEST_CASE("big-endian PLY from its bytes") {
  using namespace std::string_literals;
  const scratch::folder here;
  const triangle_mesh mesh =
      mesh_in(here, "a.ply",
              "ply\r\nformat binary_big_endian 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty short y\r\n"
              "property uint z\r\nelement face 1\r\nproperty list ushort char vertex_indices\r\nend_header\r\n"
              "\x3F\x80\0\0\x01\x02\0\0\0\x05"
              "\xC0\x20\0\0\xFF\xFE\x80\0\0\0"
              "\0\0\0\0\0\0\0\0\0\0"
              "\0\3\2\1\0"s);
  CHECK(points_of(mesh) == numbers{{1.0, 258.0, 5.0}, {-2.5, -2.0, 2147483648.0}, {0.0, 0.0, 0.0}});
  CHECK(triangles_of(mesh) == faces{{2, 1, 0}});
}

TEST_CASE("ascii PLY: vertices in order, used or not, coincident or not, and polygons split into fans") {
  const scratch::folder here;
  const triangle_mesh mesh =
      mesh_in(here, "a.Ply",
              "ply\ncomment x\nformat ascii 1.0\nelement vertex 7\nproperty float32 nx\nproperty float32 z\n"
              "property double y\nproperty float64 x\nelement face 3\nproperty list uint8 int32 vertex_indices\n"
              "property list uchar float texcoord\nelement none 0\nend_header\n"
              "nan 3 2 1\n\n  0 6\t5 4 \n0 0 0 0\r\n0 0 0 0\n0 0 0 0\nx 1e-3 -.5 +7\n0 9 9 9\n"
              "3 0 1 2 6 0 0 0 0 nan 0\n4 3 2 1 0 0\n5 0 1 2 3 5 1 0.5\n\n \n");
  CHECK(points_of(mesh) == numbers{{1, 2, 3}, {4, 5, 6}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {7, -0.5, 0.001}, {9, 9, 9}});
  CHECK(triangles_of(mesh) == faces{{0, 1, 2}, {3, 2, 1}, {3, 1, 0}, {0, 1, 2}, {0, 2, 3}, {0, 3, 5}});
}

TEST_CASE("faces of a PLY may come before the vertices, and the last line may have no end") {
  const scratch::folder here;
  const triangle_mesh mesh = mesh_in(here, "a.ply",
                                     "ply\nformat ascii 1.0\nelement face 1\n" + corner_list + "element vertex 3\n" +
                                         xyz + "end_header\n3 2 1 0\n0 0 0\n1 0 0\n0 1 5");
  CHECK(triangles_of(mesh) == faces{{2, 1, 0}});
  CHECK(mesh.vertices(2, 2) == 5.0);
}

TEST_CASE("OBJ: all ways to name a corner") {
  const scratch::folder here;
  const triangle_mesh mesh =
      mesh_in(here, "a.OBJ",
              "\xEF\xBB\xBF# a comment\r\nmtllib some.mtl\r\no thing\ng a b\nusemtl red\ns off\n"
              "v 0 0 0\nv 1 0 0 1\nv 1 1 0 0.5 0.5 0.5 # grey\n\nvt 0 0\nvn 0 0 nan\n"
              "f 1 2 3\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1 # all\nf -3 -2/-1 -1//-1\n"
              "v\t0 +1 -0\nv 0 0 0\nv 8 8 8\nf -6 -5 -4 -3\nf 1 2 3 4 7\nl 1 2\np 1\nv 7e0 7 7");
  CHECK(points_of(mesh) == numbers{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}, {8, 8, 8}, {7, 7, 7}});
  const std::vector<int> first{0, 1, 2};
  CHECK(triangles_of(mesh) == faces{first, first, first, first, first, first, {0, 2, 3}, first, {0, 2, 3}, {0, 3, 6}});
}

TEST_CASE("files without a mesh are refused with their path first") {
  const scratch::folder here;
  for (const char* extension : {".ply", ".obj"}) {
    const auto path = [&](const std::string& name) { return here / (name + extension); };
    const auto begins_with = [&](const std::string& name) { return path(name).string() + ": "; };
    check_refused([&] { return read_mesh(path("absent")); }, {begins_with("absent"), "No such file"});
    scratch::fs::create_directory(path("folder"));
    check_refused([&] { return read_mesh(path("folder")); }, {begins_with("folder"), "is a directory"});
    REQUIRE(::mkfifo(path("pipe").c_str(), 0600) == 0);
    check_refused([&] { return read_mesh(path("pipe")); }, {begins_with("pipe"), "not a regular file"});
    scratch::put(path("empty"), std::string());
    check_refused([&] { return read_mesh(path("empty")); }, {begins_with("empty"), "is empty"});
    scratch::put(path("text"), "plain text");
    check_refused([&] { return read_mesh(path("text")); }, {path("text").string()});
  }
  for (const char* name : {"a.stl", "a", "a.ply.gz", "a.plyx", ".ply"})
    check_refused([&] { return read_mesh(here / name); }, {(here / name).string() + ": ", ".ply or .obj"});
}

TEST_CASE("bad PLY headers are refused") {
  const scratch::folder here;
  const auto refused = [&](const std::string& content, std::initializer_list<std::string> words) {
    check_refused([&] { return mesh_in(here, "a.ply", content); }, {(here / "a.ply").string()});
    check_refused([&] { return mesh_in(here, "a.ply", content); }, words);
  };
  const std::string start = "ply\nformat ascii 1.0\n", vertex = "element vertex 3\n", end = "end_header\n";
  const std::string face = "element face 1\n" + corner_list, rows = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  CHECK_NOTHROW(mesh_in(here, "a.ply", start + vertex + xyz + face + end + rows));
  refused("PLY\n" + start, {"is not a PLY file"});
  refused("ply", {"line 1", "truncated"});
  refused("plyx\n" + start, {"line 1", "'plyx'"});
  refused(start + vertex, {"line 4", "truncated", "end_header"});
  refused("ply\n" + vertex + xyz + face + end + rows, {"line 8", "without a format"});
  refused("ply\nformat binary_middle_endian 1.0\n", {"line 2", "'binary_middle_endian 1.0'", "expected ascii"});
  refused("ply\nformat ascii 2.0\n", {"line 2", "'ascii 2.0'"});
  refused("ply\nformat ascii\n", {"line 2", "'ascii'"});
  refused(start + "format ascii 1.0\n", {"line 3", "twice"});
  refused(start + "elephant 3\n", {"line 3", "'elephant 3'", "expected"});
  refused(start + "\n" + vertex, {"line 3", "''"});
  for (const char* count : {"", "-1", "3x", "1.5", "99999999999999999999", "3 3"})
    refused(start + "element vertex " + count + "\n", {"line 3", "expected a count"});
  refused(start + "element vertex 2147483648\n", {"line 3", "2147483648", "2^31"});
  refused(start + vertex + xyz + vertex, {"line 7", "'vertex' is given twice"});
  refused(start + xyz, {"line 3", "before the first element"});
  refused(start + vertex + "property half x\n", {"line 4", "'half'"});
  refused(start + vertex + "property list uchar\n", {"line 4", "not a PLY type"});
  refused(start + vertex + xyz + "property int x\n", {"line 7", "'x' is given twice"});
  refused(start + vertex + xyz + "element face 1\nproperty list float int vertex_index\n",
          {"line 8", "an integer type"});
  refused(start + vertex + xyz + "element face 1\nproperty list uchar float vertex_index\n",
          {"line 8", "an integer type"});
  refused(start + vertex + xyz + face + "property list uchar int vertex_index\n", {"line 9", "twice"});
  refused(start + vertex + "property float x\nproperty float y\n" + face + end + rows, {"lacks a property x, y or z"});
  refused(start + vertex + "property list int int x\nproperty float y\nproperty float z\n" + face + end,
          {"lacks a property x, y or z"});
  refused(start + vertex + xyz + "element face 1\nproperty int vertex_index\n" + end, {"lacks a list"});
  refused(start + vertex + xyz + face + "element nothing 18446744073709551615\n" + end + rows,
          {"'nothing' has no properties"});
  refused(start + "element vertex 3\n" + end, {"'vertex' has no properties"});
}

TEST_CASE("bad rows of an ascii PLY are refused") {
  const scratch::folder here;
  const auto refused = [&](const std::string& content, std::initializer_list<std::string> words) {
    check_refused([&] { return mesh_in(here, "a.ply", content); }, {(here / "a.ply").string()});
    check_refused([&] { return mesh_in(here, "a.ply", content); }, words);
  };
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  CHECK_NOTHROW(mesh_in(here, "a.ply", ascii_ply("3", "1", points + "3 0 1 2\n")));
  refused(ascii_ply("4", "1", points + "3 0 1 2\n"), {"line 13", "follows the values"});
  refused(ascii_ply("2", "1", points + "3 0 1 2\n"), {"line 12", "0 vertices", "at least 3"});
  refused(ascii_ply("3", "2", points + "3 0 1 2\n"), {"truncated or its counts are wrong"});
  refused(ascii_ply("3", "18446744073709551615", points + "3 0 1 2\n"), {"truncated or its counts are wrong"});
  refused(ascii_ply("2147483647", "1", points), {"truncated or its counts are wrong"});
  refused(ascii_ply("3", "1", points + "3 0 1 2\n3 2 1 0\n"),
          {"line 14", "'3 2 1 0' follows the data that the header counts"});
  refused(ascii_ply("3", "0", points), {"3 vertices has no triangles"});
  refused(ascii_ply("0", "0", ""), {"0 vertices has no triangles"});
  refused("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "end_header\n1 2 3\n", {"1 vertices has no triangles"});
  refused("ply\nformat ascii 1.0\nelement face 1\n" + corner_list + "end_header\n3 0 0 0\n",
          {"expected at least 0 and less than 0"});
  refused("ply\nformat ascii 1.0\nend_header\n", {"no triangles"});
  refused(ascii_ply("3", "1", "0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), {"line 10", "the line ends"});
  refused(ascii_ply("3", "1", "0 0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), {"line 10", "'0' follows"});
  refused(ascii_ply("3", "1", "0 0 zero\n1 0 0\n0 1 0\n3 0 1 2\n"), {"line 10", "'zero' is not a number"});
  refused(ascii_ply("3", "1", "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n"), {"line 11", "'nan' is not finite"});
  refused(ascii_ply("3", "1", "0 0 0\n1 0 -inf\n0 1 0\n3 0 1 2\n"), {"line 11", "'-inf' is not finite"});
  refused(ascii_ply("3", "1", "0 0 0\n1 0 1e999\n0 1 0\n3 0 1 2\n"), {"line 11", "'1e999' is out of range"});
  for (const char* corner : {"3", "-1", "1.5", "4294967296", "1e300"})
    refused(ascii_ply("3", "1", points + "3 0 1 " + corner + "\n"), {"line 13", "a face names vertex", "less than 3"});
  refused(ascii_ply("3", "1", points + "3 0 1\n"), {"line 13", "the line ends"});
  refused(ascii_ply("3", "1", points + "2 0 1\n"), {"line 13", "a face has 2 vertices, expected at least 3"});
  refused(ascii_ply("3", "1", points + "-3 0 1 2\n"), {"line 13", "'vertex_indices' has -3 values"});
  refused(ascii_ply("3", "1", points + "3.5 0 1 2\n"), {"line 13", "has 3.5 values"});
  refused(ascii_ply("3", "1", points + "1e19 0 1 2\n"), {"line 13", "1e+19 values"});
  refused(ascii_ply("3", "1", points + "4294967295 0 1 2\n"), {"line 13", "the line ends"});
}

TEST_CASE("binary PLY that is cut off anywhere, or goes on, is refused") {
  const scratch::folder here;
  for (const bool big_endian : {false, true}) {
    const std::string valid = binary_ply(big_endian);
    CHECK_NOTHROW(mesh_in(here, "a.ply", valid));
    const std::size_t body = valid.find("end_header\n") + 11;
    for (std::size_t size = 0; size < valid.size(); ++size)
      check_refused([&] { return mesh_in(here, "a.ply", valid.substr(0, size)); },
                    {"a.ply", size == 0     ? "is empty"
                              : size < 3    ? "is not a PLY"
                              : size < body ? "header"
                                            : "truncated"});
    check_refused([&] { return mesh_in(here, "a.ply", valid + "\n"); },
                  {"a.ply: 1 bytes follow the data that its header counts"});
  }
  write_mesh(here / "b.ply", single_triangle());
  const std::string written = scratch::get(here / "b.ply");
  for (std::size_t size = 0; size < written.size(); ++size)
    check_refused([&] { return mesh_in(here, "a.ply", written.substr(0, size)); }, {"a.ply"});
}

TEST_CASE("truncated text is refused if the truncation can be detected") {
  const scratch::folder here;
  const std::string ply = ascii_ply("3", "1", "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  for (std::size_t size = 0; size + 1 < ply.size(); ++size)
    check_refused([&] { return mesh_in(here, "a.ply", ply.substr(0, size)); }, {"a.ply"});
  // An OBJ does not state the number of its lines, but the lines that are read are correct.
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n";
  for (std::size_t size = 0; size < obj.size(); ++size) {
    if (size < 31 || (size > 32 && size < 39))
      check_refused([&] { return mesh_in(here, "a.obj", obj.substr(0, size)); }, {"a.obj"});
    else
      CHECK(triangles_of(mesh_in(here, "a.obj", obj.substr(0, size))).front() == std::vector<int>{0, 1, 2});
  }
}

TEST_CASE("bad bytes of a binary PLY are refused") {
  const scratch::folder here;
  write_mesh(here / "b.ply", single_triangle());
  const std::string valid = scratch::get(here / "b.ply");
  const std::size_t body = valid.find("end_header\n") + 11;
  const auto changed = [&](std::size_t at, const std::string& bytes) {
    return std::string(valid).replace(body + at, bytes.size(), bytes);
  };
  const auto recounted = [&](const std::string& from, const std::string& to) {
    return std::string(valid).replace(valid.find(from), from.size(), to);
  };
  const auto refused = [&](const std::string& content, std::initializer_list<std::string> words) {
    check_refused([&] { return mesh_in(here, "a.ply", content); }, {(here / "a.ply").string() + ": "});
    check_refused([&] { return mesh_in(here, "a.ply", content); }, words);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  refused(changed(24 + 8, bytes_of_number(nan, false)), {"vertex 1 is not finite"});
  refused(changed(48, bytes_of_number(infinite, false)), {"vertex 2 is not finite"});
  refused(changed(72, "\2"), {"a face has 2 vertices"});
  refused(changed(72, "\xFF"), {"truncated or its counts are wrong"});
  refused(changed(73, bytes_of_number(std::int32_t{3}, false)),
          {"a face names vertex 3, expected at least 0 and less than 3"});
  refused(changed(73, bytes_of_number(std::int32_t{-1}, false)),
          {"a face names vertex -1, expected at least 0 and less than 3"});
  refused(recounted("list uchar int", "list uchar char").substr(0, body + 1 + 72) + "\3\1\2\xFF",
          {"names vertex -1, expected"});
  refused(recounted("vertex 3", "vertex 2147483647"), {"truncated or its counts are wrong"});
  refused(recounted("face 1", "face 18446744073709551615"), {"truncated or its counts are wrong"});
  refused(recounted("face 1", "face 0"), {"13 bytes follow"});
  refused(recounted("vertex 3", "vertex 2"), {"a.ply: "});
  refused(recounted("list uchar", "list uint"), {"a face names vertex"});
}

TEST_CASE("bad OBJ files are refused") {
  using namespace std::string_literals;
  const scratch::folder here;
  const auto refused = [&](const std::string& content, std::initializer_list<std::string> words) {
    check_refused([&] { return mesh_in(here, "a.obj", content); }, {(here / "a.obj").string()});
    check_refused([&] { return mesh_in(here, "a.obj", content); }, words);
  };
  const std::string points = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  CHECK_NOTHROW(mesh_in(here, "a.obj", points + "f 1 2 3\n"));
  refused(points, {"3 vertices has no triangles"});
  refused("# nothing\n", {"0 vertices has no triangles"});
  refused(points + "f 1 2 4\n", {"line 4", "names vertex 4 of 3", "from 1"});
  refused(points + "f 1 5 9\nf 1 2 4\n", {"line 4", "names vertex 9 of 3"});
  refused(points + "f 0 1 2\n", {"line 4", "names vertex 0 of 3"});
  refused(points + "f -1 -2 -4\nv 1 1 1\n", {"line 4", "names vertex -4 of 3"});
  for (const char* vertex : {"2147483648", "4294967297", "9223372036854775807"})
    refused(points + "f 1 2 "s + vertex + "\n", {"line 4", vertex + " of 3"s});
  refused(points + "f 1 2 -9223372036854775808\n", {"line 4", "-9223372036854775808 of 3"});
  for (const char* corner : {"1x", "x", "/1", "1.5", "99999999999999999999", "1/a", "3\\", "--1"})
    refused(points + "f 1 2 " + corner + "\n", {"line 4", "'"s + corner + "'", "expected a vertex of a face"});
  refused(points + "f 1 2\n", {"line 4", "a face has 2 vertices"});
  refused(points + "f\n", {"line 4", "a face has 0 vertices"});
  refused("v 1 2\n" + points, {"line 1", "a coordinate: '' is not a number"});
  refused("v 1 2 3,5\n" + points, {"line 1", "'3,5' is not a number"});
  refused("v 1 2 nan\n" + points, {"line 1", "'nan' is not finite"});
  refused("v 1 2 1e999\n" + points, {"line 1", "'1e999' is out of range"});
  refused("w 1 2 3\n" + points, {"line 1", "'w' is not supported"});
  refused("curv 0 1 1 2\n" + points, {"line 1", "'curv' is not supported"});
  write_mesh(here / "b.ply", single_triangle());
  refused(scratch::get(here / "b.ply"), {"line 1", "'ply' is not supported"});
}

TEST_CASE("damaged mesh files are read or refused") {
  const scratch::folder here;
  const auto survives = [&](const std::string& name, const std::string& content) {
    scratch::check_survives_damage(scratch::bytes_of(content), 500, [&](auto bytes) {
      scratch::put(here / name, bytes);
      return read_mesh(here / name);
    });
  };
  survives("a.ply", binary_ply(false));
  survives("a.ply", binary_ply(true));
  survives("a.ply", ascii_ply("4", "2", "0 0 0\n1 0 0\n0 1 0\n1 1 1\n3 0 1 2\n4 0 1 2 3\n"));
  survives("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nvn 0 0 1\nf 1 2 3\nf 1//1 2//1 3//1\nf -1 -2 -3 -4\n");
}

TEST_CASE("a mesh that is refused leaves the old file") {
  const scratch::folder here;
  const auto refused = [&](const std::string& name, const triangle_mesh& mesh,
                           std::initializer_list<std::string> words) {
    scratch::put(here / name, "old");
    const auto write = [&] { return write_mesh(here / name, mesh), 0; };
    check_refused(write, {(here / name).string() + ": "});
    check_refused(write, words);
    CHECK(scratch::get(here / name) == "old");
  };
  for (const char* name : {"a.ply", "a.obj"}) {
    triangle_mesh mesh = single_triangle();
    mesh.vertices(1, 2) = std::numeric_limits<double>::quiet_NaN();
    refused(name, mesh, {"vertex 2 is not finite"});
    mesh = single_triangle();
    mesh.triangles(1, 0) = 3;
    refused(name, mesh, {"triangle 0 names vertex 3, expected at least 0 and less than 3"});
    mesh.triangles(1, 0) = -1;
    refused(name, mesh, {"triangle 0 names vertex -1, expected at least 0 and less than 3"});
    mesh.triangles.resize(3, 0);
    refused(name, mesh, {"no triangles"});
  }
  refused("a.off", single_triangle(), {".ply or .obj, not '.off'"});
  check_refused([&] { return write_mesh(here / "absent" / "a.ply", single_triangle()), 0; }, {"a.ply", "No such file"});
  CHECK(here.entries() == 3);
}

TEST_CASE("colours that a file cannot hold are refused") {
  const scratch::folder here;
  std::vector<gonio::rgb> colours(3, gonio::rgb(0.1, 0.2, 0.3));
  const auto refused = [&](const char* name, std::initializer_list<std::string> words) {
    check_refused([&] { return write_mesh(here / name, single_triangle(), colours), 0; }, words);
    CHECK(here.entries() == 0);
  };
  refused("a.obj", {"a.obj: an OBJ file holds no colours", "expected .ply"});
  refused("a.png", {"a.png: ", ".ply or .obj"});
  colours[1][2] = std::numeric_limits<double>::quiet_NaN();
  refused("a.ply", {"a.ply: the colour of vertex 1 is not a number"});
  colours.pop_back();
  refused("a.ply", {"a.ply: 2 colours were given for 3 vertices"});
  colours.clear();
  refused("a.ply", {"a.ply: 0 colours were given for 3 vertices"});
}
