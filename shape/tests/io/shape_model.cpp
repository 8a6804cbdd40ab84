#include "../synthetic_shapes.hpp"
#include "io/scratch.hpp"
#include <gonio/shape/io/shape_model.hpp>

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

namespace io = gonio::io;

namespace {

/// Returns triangles around vertex 0.
gonio::shape::triangle_columns fan_of(int vertices) {
  gonio::shape::triangle_columns triangles(3, vertices - 2);
  for (int t = 0; t < vertices - 2; ++t) triangles.col(t) << 0, t + 1, t + 2;
  return triangles;
}

constexpr int fan_vertices = 5, fan_shapes = 4;

gonio::shape::shape_model learned_fan() {
  return gonio::shape::learn_shape_model(synthetic_shapes(fan_vertices, fan_shapes, 2, 7), synthetic_names(fan_shapes),
                                         fan_of(fan_vertices));
}

/// Returns a model with a source and fewer components than shapes.
gonio::shape::shape_model fan_model() {
  return {learned_fan().basis().truncated(2).with_source("four synthetic fans"), fan_of(fan_vertices)};
}

void check_equal(const gonio::shape::shape_model& back, const gonio::shape::shape_model& model) {
  CHECK(back.triangles() == model.triangles());
  CHECK(back.shapes() == model.shapes());
  const gonio::shape::shape_basis &one = back.basis(), &other = model.basis();
  CHECK(one.cells() == other.cells());
  CHECK(one.names() == other.names());
  CHECK(one.source() == other.source());
  CHECK(one.explained_variance() == other.explained_variance());
  CHECK(one.mean() == other.mean());
  CHECK(one.components() == other.components());
  CHECK(one.singular_values() == other.singular_values());
  CHECK(one.coefficients() == other.coefficients());
}

void check_fan_refused(std::span<const std::byte> bytes, const std::string& words) {
  scratch::check_refused([&] { return io::read_shape_model(bytes, "fan.shapes"); }, {"fan.shapes: ", words});
}

/// The header of a payload.
struct fan_header {
  std::uint32_t vertices = fan_vertices, triangles = fan_vertices - 2, components = 2, shapes = fan_shapes;
  double explained_variance = 1.0;
  std::size_t padding = 0;  ///< bytes after the last component
};

/// Returns a file with a correct checksum, as from a buggy writer. It holds the same number of values for all counts.
std::vector<std::byte> fan_file(const fan_header& header, const gonio::shape::triangle_columns& triangles,
                                float number = 1) {
  io::byte_writer payload;
  for (const std::uint32_t count : {header.vertices, header.triangles, header.components, header.shapes})
    payload.write(count);
  payload.write(header.explained_variance);
  payload.write_text("");
  for (const std::string& name : synthetic_names(fan_shapes)) payload.write_text(name);
  payload.write_all(std::span<const int>(triangles.data(), triangles.size()));
  for (int k = 0; k < 2; ++k) payload.write(1.0);
  const int floats = fan_shapes * 2 + 3 * fan_vertices + 3 * fan_vertices * 2;
  for (int i = 0; i < floats; ++i) payload.write(i + 1 == floats ? number : 1.0f);
  for (std::size_t i = 0; i < header.padding; ++i) payload.write(std::byte{0});
  return io::write_checked(io::detail::shape_model_kind, payload.bytes());
}

}  // namespace

TEST_CASE("shape model: a written model is read back exactly") {
  const gonio::shape::shape_model all = learned_fan(), few = fan_model();
  check_equal(io::read_shape_model(io::write_shape_model(all), "x"), all);
  check_equal(io::read_shape_model(io::write_shape_model(few), "x"), few);
  CHECK(few.basis().size() == 2);
  CHECK(few.basis().source() == "four synthetic fans");
  CHECK(few.basis().explained_variance() < 1.0);
  const Eigen::VectorXd weights = Eigen::Vector2d(0.5, -2.0);
  CHECK(io::read_shape_model(io::write_shape_model(few), "x").shape(weights).vertices == few.shape(weights).vertices);
}

TEST_CASE("shape model: a model that was read is written with the same bytes") {
  const auto once = io::write_shape_model(fan_model());
  CHECK(io::write_shape_model(io::read_shape_model(once, "x")) == once);
}

TEST_CASE("shape model: a file cut short at any byte, or longer, is refused") {
  const auto whole = io::write_shape_model(fan_model());
  for (std::size_t length = 0; length < whole.size(); ++length) {
    CAPTURE(length);
    check_fan_refused(std::span(whole).first(length), "");
  }
  auto longer = whole;
  longer.push_back(std::byte{0});
  check_fan_refused(longer, "1 bytes follow");
}

TEST_CASE("shape model: a flipped bit is refused, but for those that deflate does not use") {
  const auto whole = io::write_shape_model(fan_model());
  constexpr std::size_t header = io::detail::shape_model_kind.magic.size() + 4 + 8 + 4;
  std::size_t unused = 0;
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    auto damaged = whole;
    damaged[bit / 8] ^= static_cast<std::byte>(1u << bit % 8);
    CAPTURE(bit);
    try {
      const gonio::shape::shape_model back = io::read_shape_model(damaged, "fan.shapes");
      CHECK(io::write_shape_model(back) == whole);
      CHECK(bit / 8 >= header);
      ++unused;
    } catch (const gonio::error& refusal) {
      CHECK(std::string(refusal.what()).starts_with("fan.shapes: "));
    }
  }
  CHECK(unused < 16);  // the unused bits of the last block's byte, and a code without a value
}

TEST_CASE("shape model: other kinds of file and other versions are named") {
  const std::string other = "not a gonio shape model (it does not start with 'gonio-shapes')";
  check_fan_refused({}, other);
  check_fan_refused(scratch::bytes_of("gonio-prior and more"), other);
  auto version = io::write_shape_model(fan_model());
  version[io::detail::shape_model_kind.magic.size()] = std::byte{77};
  check_fan_refused(version, "shape model format version 77, this program reads version 1");
}

TEST_CASE("shape model: impossible counts are refused, with a right checksum too") {
  const gonio::shape::triangle_columns fan = fan_of(fan_vertices);
  // The unmodified file is read.
  CHECK(io::read_shape_model(fan_file({}, fan), "x").vertices() == fan_vertices);
  const auto refused = [&](const fan_header& header, const std::string& words) {
    check_fan_refused(fan_file(header, fan), words);
  };
  constexpr std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
  refused({.components = 0}, "0 components of 4 shapes, expected 1 to 4");
  refused({.components = 5}, "5 components of 4 shapes, expected 1 to 4");
  refused({.components = 0, .shapes = 0}, "0 components of 0 shapes");
  refused({.shapes = most}, "truncated or its counts are wrong");
  refused({.components = most, .shapes = most}, "truncated or its counts are wrong");
  refused({.vertices = most}, "truncated or its counts are wrong");
  refused({.triangles = most}, "truncated or its counts are wrong");
  refused({.vertices = 0}, "");
  refused({.vertices = fan_vertices + 1}, "");
  refused({.vertices = fan_vertices - 1}, "bytes follow the last component");
  refused({.triangles = fan_vertices - 1}, "");
  refused({.components = 3}, "");
  refused({.shapes = 5}, "");
  refused({.padding = 3}, "3 bytes follow the last component");
}

TEST_CASE("shape model: values that are not finite are refused") {
  const gonio::shape::triangle_columns fan = fan_of(fan_vertices);
  constexpr float infinity = std::numeric_limits<float>::infinity();
  check_fan_refused(fan_file({}, fan, infinity), "not finite");
  check_fan_refused(fan_file({}, fan, std::numeric_limits<float>::quiet_NaN()), "not finite");
  check_fan_refused(fan_file({.explained_variance = std::numeric_limits<double>::quiet_NaN()}, fan), "not finite");
}

TEST_CASE("shape model: triangles that are no surface are refused") {
  const auto refused = [](int triangle, const Eigen::Vector3i& corners, const std::string& words) {
    gonio::shape::triangle_columns triangles = fan_of(fan_vertices);
    triangles.col(triangle) = corners;
    check_fan_refused(fan_file({}, triangles), words);
  };
  refused(2, {0, 3, 5}, "triangle 2 names vertex 5");
  refused(1, {0, -1, 3}, "triangle 1 names vertex -1");
  refused(0, {0, 1, 1}, "triangle 0 of a mesh has one vertex twice");
  refused(2, {0, 1, 4}, "not a surface");                             // two triangles use an edge in one direction
  refused(1, {0, 3, 2}, "not a surface");                             // turned over
  check_fan_refused(fan_file({.triangles = 0}, {}), "no triangles");  // no surface at all
}

TEST_CASE("shape model: files are written whole, read back, and refused where they are no file") {
  const scratch::folder here;
  const gonio::shape::shape_model model = fan_model();
  io::write_shape_model(here / "fan.shapes", model);
  CHECK(here.entries() == 1);
  CHECK(io::is_of_kind(io::detail::shape_model_kind, here / "fan.shapes"));
  check_equal(io::read_shape_model(here / "fan.shapes"), model);
  scratch::check_refuses_non_files([](const auto& path) { return io::read_shape_model(path); });
  CHECK_THROWS_AS(io::write_shape_model(here / "no-such-folder" / "x.shapes", model), gonio::error);
}
