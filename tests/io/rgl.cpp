#include "scratch.hpp"
#include <gonio/io/merl_gzip.hpp>
#include <gonio/io/rgl.hpp>

#include <cmath>
#include <map>
#include <set>

using gonio::io::parse_rgl;
using gonio::io::read_rgl;
using scratch::check_refused;

namespace {

struct field {
  std::uint8_t type;
  std::vector<std::uint64_t> shape;
  std::string bytes;
};

using fields = std::map<std::string, field>;

template <class Number>
std::string bytes_of_numbers(const std::vector<Number>& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

/// An array in which number i is a function of i.
template <class Value>
field floats(std::vector<std::uint64_t> shape, const Value& value) {
  std::uint64_t count = 1;
  for (const std::uint64_t extent : shape) count *= extent;
  std::vector<float> numbers;
  for (std::uint64_t i = 0; i < count; ++i) numbers.push_back(static_cast<float>(value(i)));
  return {10, std::move(shape), bytes_of_numbers(numbers)};
}

fields small_material() {
  const auto one = [](std::uint64_t) { return 1.0; };
  return {{"description", {1, {5}, "paint"}},
          {"phi_i", floats({1}, [](std::uint64_t) { return 0.0; })},
          {"theta_i", floats({3}, [](std::uint64_t i) { return 0.785398185 * static_cast<double>(i); })},
          {"ndf", floats({2, 3}, one)},
          {"sigma", floats({2, 3}, one)},
          {"vndf", floats({1, 3, 4, 5}, one)},
          {"luminance", floats({1, 3, 2, 2}, one)},
          {"rgb", floats({1, 3, 3, 2, 2}, [](std::uint64_t i) { return static_cast<double>(i / 4 % 3); })}};
}

/// A container as the database writes it.
std::string container(const fields& arrays) {
  std::uint64_t position = 18;
  for (const auto& [name, array] : arrays) position += 13 + name.size() + 8 * array.shape.size();
  std::string head("tensor_file\0\1\0", 14), body;
  const auto put = [&](auto number) { head.append(reinterpret_cast<const char*>(&number), sizeof number); };
  put(static_cast<std::uint32_t>(arrays.size()));
  for (const auto& [name, array] : arrays) {
    put(static_cast<std::uint16_t>(name.size()));
    head += name;
    put(static_cast<std::uint16_t>(array.shape.size()));
    put(array.type);
    put(position + body.size());
    for (const std::uint64_t extent : array.shape) put(extent);
    body += array.bytes;
  }
  return head + body;
}

gonio::io::rgl_material parsed(const std::string& text) { return parse_rgl(scratch::bytes_of(text), "file"); }

}  // namespace

TEST_CASE("a material of the RGL database is read") {
  const scratch::folder here;
  scratch::put(here / "paint.bsdf", container(small_material()));
  const auto [material, description] = read_rgl(here / "paint.bsdf");
  CHECK(description == "paint");
  CHECK(material.parts().theta_i.size() == 3);
  CHECK(material.parts().visible_normals.rows == 4);
  CHECK(material.parts().visible_normals.columns == 5);
  const gonio::direction up(0, 0, 1);
  CHECK((material(up, up) - gonio::rgb(0.0, 0.25, 0.5)).abs().maxCoeff() < 1e-7);
}

TEST_CASE("of two azimuths of the light, the first is read") {
  fields arrays = small_material();
  arrays["phi_i"] = floats({2}, [](std::uint64_t i) { return static_cast<double>(i); });
  arrays["vndf"] = floats({2, 3, 4, 5}, [](std::uint64_t) { return 1.0; });
  arrays["rgb"] = floats({2, 3, 3, 2, 2}, [](std::uint64_t i) { return i < 36 ? 2.0 : 7.0; });
  const gonio::direction up(0, 0, 1);
  CHECK(parsed(container(arrays)).material(up, up).x() == doctest::Approx(0.5));
}

TEST_CASE("bad files of the RGL database are refused") {
  scratch::check_refuses_non_files([](const auto& path) { return read_rgl(path); });
  const auto refused = [](auto&& change, std::initializer_list<std::string> words) {
    fields arrays = small_material();
    change(arrays);
    check_refused([&] { return parsed(container(arrays)); }, words);
  };
  check_refused([] { return parsed("tensor"); }, {"file: ", "does not start with 'tensor_file'"});
  check_refused([] { return parsed(std::string("tensor_file\0\2\0\0\0\0\0", 18)); }, {"version 2.0", "expected 1.0"});
  refused([](fields& all) { all.erase("rgb"); }, {"file: ", "no array 'rgb'"});
  refused(
      [](fields& all) {
        all["spectra"] = all["rgb"];
        all.erase("rgb");
      },
      {"holds spectra", "'rgb'"});
  refused([](fields& all) { all["phi_i"] = all["theta_i"]; }, {"anisotropic", "3 azimuths"});
  refused([](fields& all) { all["vndf"].shape = {3, 4, 5}; }, {"'vndf'", "3 dimensions", "expected 4"});
  refused([](fields& all) { all["vndf"].type = 11; }, {"'vndf'", "does not lie within"});
  refused([](fields& all) { all["theta_i"].type = 5; }, {"'theta_i'", "float32"});
  refused([](fields& all) { all["ndf"].type = 12; }, {"'ndf'", "unknown type 12"});
  refused(
      [](fields& all) {
        all["sigma"].shape = {std::uint64_t{1} << 33, std::uint64_t{1} << 33};
      },
      {"'sigma'", "does not lie within"});
  refused([](fields& all) { all["rgb"].shape = {1, 3, 3, 4, 1}; }, {"file: ", "reflectance", "4 x 1"});
  refused([](fields& all) { all["rgb"].shape = {1, 3, 4, 3, 1}; }, {"file: ", "reflectance"});
  refused([](fields& all) { all["rgb"].shape = {0, 3, 3, 2, 2}; }, {"'rgb'", "is empty"});
  refused([](fields& all) { all["sigma"] = floats({2, 3}, [](auto) { return -1.0; }); }, {"projected area", "-1"});
}

TEST_CASE("damaged files of the RGL database are read or refused") {
  const std::string text = container(small_material());
  scratch::check_survives_damage(scratch::bytes_of(text), 3000,
                                 [](std::span<const std::byte> bytes) { return parse_rgl(bytes, "file"); });
}

TEST_CASE("what is read equals the same materials as others resampled them to MERL's format") {
  const std::filesystem::path shared(GONIO_SHARED_DATA);
  if (!std::filesystem::exists(shared / "rgl-bsdf") || !std::filesystem::exists(shared / "rgl-measured")) {
    MESSAGE("skipped: " << shared.string() << " has no rgl-bsdf and rgl-measured");
    return;
  }
  std::size_t compared = 0;
  for (const auto& entry : std::filesystem::directory_iterator(shared / "rgl-bsdf")) {
    const auto material = read_rgl(entry.path()).material;
    const auto table_path = shared / "rgl-measured" / (entry.path().stem().string() + ".binary.gz");
    if (!std::filesystem::exists(table_path)) continue;
    ++compared;
    CAPTURE(entry.path().filename().string());
    const gonio::brdf_table table = gonio::io::read_merl_any(table_path);
    // Their file has 12 bits of each value, and its angles are those of the cells' lower corners.
    double largest = 0.0;
    for (Eigen::Index cell = 7; cell < table.cells().size(); cell += 997) {
      const auto [wi, wo] = gonio::to_directions(table.cells().angles(cell));
      if (std::min(wi.z(), wo.z()) < 0.1) continue;
      const gonio::rgb ours = material.as_measured(wi, wo), theirs = table.at(cell);
      largest = std::max(largest, ((ours - theirs).abs() / (theirs.abs() + 1e-3)).maxCoeff());
    }
    CHECK(largest < 1e-3);
  }
  CHECK(compared == 10);
}
