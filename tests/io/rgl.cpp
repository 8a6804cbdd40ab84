#include "scratch.hpp"
#include <gonio/core/interpolated_colour.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lambert.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <random>
#include <set>
#include <utility>

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

/// An array of the numbers value(0), value(1), ...
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

gonio::io::rgl_material read_text(const std::string& text) { return read_rgl(scratch::bytes_of(text), "file"); }

}  // namespace

TEST_CASE("a material of the RGL database is read") {
  const scratch::folder here;
  scratch::put(here / "paint.bsdf", container(small_material()));
  const auto [material, description, spectra] = read_rgl(here / "paint.bsdf");
  CHECK(description == "paint");
  CHECK(!spectra);
  CHECK(material.parts().theta_i.size() == 3);
  CHECK(material.parts().visible_normals.rows == 4);
  CHECK(material.parts().visible_normals.columns == 5);
  const gonio::direction up(0, 0, 1);
  CHECK((material(up, up) - gonio::rgb(0.0, 0.25, 0.5)).abs().maxCoeff() < 1e-7);
  // Arrays of other types are skipped; the last one ends at the file's end.
  for (const auto& [type, size] :
       {std::pair{1, 1}, {2, 1}, {3, 2}, {4, 2}, {5, 4}, {6, 4}, {7, 8}, {8, 8}, {9, 2}, {10, 4}, {11, 8}}) {
    CAPTURE(type);
    fields more = small_material();
    more["zones"] = {static_cast<std::uint8_t>(type), {3}, std::string(static_cast<std::size_t>(3 * size), 'z')};
    CHECK(read_text(container(more)).description == "paint");
    more["zones"].bytes.pop_back();
    check_refused([&] { return read_text(container(more)); }, {"'zones'", "does not lie within"});
  }
}

TEST_CASE("a spectral material is read as colours, and its spectra are kept") {
  // A constant spectrum is grey; a linear one has the colour of linear interpolation.
  fields arrays = small_material();
  arrays.erase("rgb");
  arrays["wavelengths"] = floats({4}, [](std::uint64_t i) { return 400.0 + 100.0 * static_cast<double>(i); });
  arrays["spectra"] =
      floats({1, 3, 4, 2, 2}, [](std::uint64_t i) { return i < 16 ? 1.0 : 0.1 * static_cast<double>(i / 4 % 4); });
  const auto [material, description, spectra] = read_text(container(arrays));
  const gonio::model::unit_square_tables& colours = material.parts().reflectance;
  CHECK(colours.tables == 9);
  for (std::size_t i = 0; i < 12; ++i) CHECK(colours.values[i] == doctest::Approx(1.0).epsilon(1e-6));
  const std::vector<double> wavelengths{400.0, 500.0, 600.0, 700.0};
  const gonio::rgb expected = gonio::interpolated_colour(wavelengths) * Eigen::Vector4d(0.0, 0.1, 0.2, 0.3);
  for (std::size_t c = 0; c < 3; ++c)
    CHECK(colours.values[12 + 4 * c] == doctest::Approx(expected[static_cast<Eigen::Index>(c)]).epsilon(1e-5));
  REQUIRE(spectra);
  CHECK(spectra->wavelengths == wavelengths);
  CHECK(spectra->values.tables == 12);
}

TEST_CASE("a written material is read back number for number") {
  fields arrays = small_material();
  arrays.erase("rgb");
  arrays["wavelengths"] = floats({3}, [](std::uint64_t i) { return 450.0 + 50.0 * static_cast<double>(i); });
  arrays["spectra"] = floats({1, 3, 3, 2, 2}, [](std::uint64_t i) { return 0.01 * static_cast<double>(i); });
  for (const std::string& text : {container(small_material()), container(arrays)}) {
    const gonio::io::rgl_material before = read_text(text);
    const std::vector<std::byte> bytes = gonio::io::write_rgl(before);
    const gonio::io::rgl_material after = read_rgl(bytes, "again");
    CHECK(after.description == before.description);
    CHECK(after.spectra.has_value() == before.spectra.has_value());
    if (before.spectra) CHECK(after.spectra->values.values == before.spectra->values.values);
    CHECK(after.material.parts().reflectance.values == before.material.parts().reflectance.values);
    CHECK(after.material.parts().normals.values == before.material.parts().normals.values);
    CHECK(after.material.parts().projected_area.values == before.material.parts().projected_area.values);
    CHECK(gonio::io::write_rgl(after) == bytes);
  }
}

TEST_CASE("a written file has the arrays that Mitsuba and pbrt need, with their types and shapes") {
  const std::vector<std::byte> bytes = gonio::io::write_rgl(read_text(container(small_material())));
  const auto found = gonio::io::detail::tensor_fields(bytes, "written");
  const std::map<std::string, std::pair<int, std::vector<std::uint64_t>>> expected{
      {"description", {1, {5}}},      {"phi_i", {10, {1}}},
      {"theta_i", {10, {3}}},         {"ndf", {10, {2, 3}}},
      {"sigma", {10, {2, 3}}},        {"vndf", {10, {1, 3, 4, 5}}},
      {"rgb", {10, {1, 3, 3, 2, 2}}}, {"luminance", {10, {1, 3, 2, 2}}},
      {"jacobian", {1, {1}}}};
  REQUIRE(found.size() == expected.size());
  for (const auto& [name, array] : expected) {
    CAPTURE(name);
    REQUIRE(found.contains(name));
    CHECK(found.at(name).type == array.first);
    CHECK(found.at(name).shape == array.second);
  }
  CHECK(found.at("jacobian").elements[0] == std::byte{1});
  // The luminance of red 0, green 1 and blue 2.
  float bright = 0.0f;
  std::memcpy(&bright, found.at("luminance").elements.data(), sizeof bright);
  CHECK(bright == doctest::Approx(0.7152 + 2.0 * 0.0722));
}

TEST_CASE("a BRDF is read back with a mean error below 0.5 % of its peak") {
  const scratch::folder here;
  const gonio::model::ggx f{.alpha = 0.2, .f0 = gonio::rgb(0.9, 0.6, 0.3)};
  gonio::io::write_rgl(here / "metal.bsdf", f, "a metal");
  const auto [material, description, spectra] = read_rgl(here / "metal.bsdf");
  CHECK(description == "a metal");
  CHECK(!spectra);
  double sum = 0.0, peak = 0.0;
  int count = 0;
  for (double theta = 0.0; theta < 75.0; theta += 7.0)
    for (double other = 1.0; other < 75.0; other += 3.0)
      for (double turn = 0.0; turn < 360.0; turn += 15.0) {
        const gonio::direction wi = gonio::spherical_direction(gonio::radians(theta), 0.0);
        const gonio::direction wo = gonio::spherical_direction(gonio::radians(other), gonio::radians(turn));
        peak = std::max(peak, f(wi, wo).maxCoeff());
        sum += (material.as_measured(wi, wo) - f(wi, wo)).abs().maxCoeff();
        ++count;
      }
  CHECK(sum / count < 0.005 * peak);
  // Golden: the value of Mitsuba 3.9.1 for this file (eval of its "measured", divided by the cosine).
  const gonio::rgb golden =
      material.as_measured(gonio::spherical_direction(0.5, 0.0), gonio::spherical_direction(0.6, 3.0));
  CHECK((golden - gonio::rgb(2.01104543, 1.34074924, 0.67045305)).abs().maxCoeff() < 1e-4);
}

TEST_CASE("a material in RGB is written as spectra of the same colours") {
  gonio::io::rgl_material material = read_text(container(small_material()));
  material.spectra = gonio::io::upsampled_spectra(material.material);
  const gonio::io::rgl_material again = read_rgl(gonio::io::write_rgl(material), "again");
  REQUIRE(again.spectra);
  CHECK(again.spectra->wavelengths.size() == 20);
  CHECK(*std::ranges::min_element(again.spectra->values.values) > -1e-6f);
  const std::vector<float>& before = material.material.parts().reflectance.values;
  const std::vector<float>& after = again.material.parts().reflectance.values;
  REQUIRE(before.size() == after.size());
  for (std::size_t i = 0; i < before.size(); ++i) CHECK(std::abs(before[i] - after[i]) < 1e-5f);
}

TEST_CASE("materials that no renderer reads are not written") {
  gonio::io::rgl_material material = read_text(container(small_material()));
  material.spectra = gonio::io::rgl_spectra{{400.0, 500.0}, {5, 2, 2, std::vector<float>(20)}};
  check_refused([&] { return gonio::io::write_rgl(material); }, {"spectra need 6 tables", "not 5"});
  fields arrays = small_material();
  arrays["rgb"] = floats({1, 3, 3, 2, 3}, [](std::uint64_t) { return 1.0; });
  check_refused([&] { return gonio::io::write_rgl(read_text(container(arrays))); }, {"square", "2 x 3"});
}

TEST_CASE("if there are two azimuths of the light, the first is read") {
  fields arrays = small_material();
  arrays["phi_i"] = floats({2}, [](std::uint64_t i) { return static_cast<double>(i); });
  arrays["vndf"] = floats({2, 3, 4, 5}, [](std::uint64_t) { return 1.0; });
  arrays["rgb"] = floats({2, 3, 3, 2, 2}, [](std::uint64_t i) { return i < 36 ? 2.0 : 7.0; });
  const gonio::direction up(0, 0, 1);
  CHECK(read_text(container(arrays)).material(up, up).x() == doctest::Approx(0.5));
}

TEST_CASE("bad files of the RGL database are refused") {
  scratch::check_refuses_non_files([](const auto& path) { return read_rgl(path); });
  const auto refused = [](auto&& change, std::initializer_list<std::string> words) {
    fields arrays = small_material();
    change(arrays);
    check_refused([&] { return read_text(container(arrays)); }, words);
  };
  check_refused([] { return read_text("tensor"); }, {"file: ", "does not start with 'tensor_file'"});
  check_refused([] { return read_text(std::string("tensor_file\0\2\0\0\0\0\0", 18)); },
                {"version 2.0", "expected 1.0"});
  refused([](fields& all) { all.erase("rgb"); }, {"file: ", "no array 'rgb'"});
  const auto spectral = [](fields& all, std::vector<std::uint64_t> shape, double first) {
    all.erase("rgb");
    all["wavelengths"] = floats({2}, [&](std::uint64_t i) { return first + 100.0 * static_cast<double>(i); });
    all["spectra"] = floats(std::move(shape), [](std::uint64_t) { return 1.0; });
  };
  refused([&](fields& all) { spectral(all, {1, 3, 3, 2, 2}, 500.0); }, {"file: ", "need 6 tables", "not 9"});
  refused([&](fields& all) { spectral(all, {1, 3, 2, 0, 0}, 500.0); }, {"file: ", "at least 2 x 2", "0 x 0"});
  refused([&](fields& all) { spectral(all, {1, 3, 2, 2, 2}, 500.0), all.erase("wavelengths"); }, {"'wavelengths'"});
  refused([](fields& all) { all["jacobian"] = {1, {1}, std::string("\0", 1)}; }, {"'jacobian' is not 1"});
  refused([](fields& all) { all["phi_i"] = all["theta_i"]; }, {"'rgb' has 1 azimuths of the light", "phi_i has 3"});
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
  fields spectral = small_material();
  spectral["spectra"] = spectral["rgb"];
  spectral["wavelengths"] = floats({3}, [](std::uint64_t i) { return 450.0 + 50.0 * static_cast<double>(i); });
  spectral.erase("rgb");
  for (const std::string& text : {container(small_material()), container(spectral)})
    scratch::check_survives_damage(scratch::bytes_of(text), 3000,
                                   [](std::span<const std::byte> bytes) { return read_rgl(bytes, "file"); });
}

namespace {

/// Evaluates the arrays of a file by the paper's equations, without the library's model.
class plain_evaluation {
 public:
  explicit plain_evaluation(const std::vector<std::byte>& bytes) {
    for (const auto& [name, array] : gonio::io::detail::tensor_fields(bytes, "file"))
      if (array.type == 10) {
        numbers_[name].resize(array.elements.size() / 4);
        std::memcpy(numbers_[name].data(), array.elements.data(), array.elements.size());
        shapes_[name] = array.shape;
      }
  }

  gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const {
    const gonio::direction m = (wi + wo).normalized();
    const double phi = std::atan2(m.y(), m.x()) - std::atan2(wi.y(), wi.x());
    const double v = phi / (2.0 * pi) + 0.5 - std::floor(phi / (2.0 * pi) + 0.5), u = elevation(m);
    // The two angles around the light's, and the fraction of the way to the second.
    const std::vector<float>& angles = numbers_.at("theta_i");
    std::size_t first = 0;
    while (first + 2 < angles.size() && angles[first + 1] <= std::acos(wi.z())) ++first;
    const double share = (std::acos(wi.z()) - angles[first]) / (double{angles[first + 1]} - angles[first]);
    const std::vector<double> density = blend("vndf", first, 1, 0, share, true);
    const auto [across, along] = position(density, shapes_.at("vndf")[3], v, u);
    gonio::rgb value;
    for (std::size_t c = 0; c < 3; ++c)
      value[static_cast<Eigen::Index>(c)] =
          at(blend("rgb", first, 3, c, share, false), shapes_.at("rgb")[4], across, along);
    return value * at(plain("ndf"), shapes_.at("ndf")[1], v, u) /
           (4.0 * wo.z() * at(plain("sigma"), shapes_.at("sigma")[1], 0.5, elevation(wi)));
  }

 private:
  static constexpr double pi = std::numbers::pi;

  static double elevation(const gonio::direction& w) { return std::sqrt(std::acos(std::min(w.z(), 1.0)) * 2.0 / pi); }

  std::vector<double> plain(const std::string& name) const {
    return {numbers_.at(name).begin(), numbers_.at(name).end()};
  }

  /// Mixes table `channel` of `channels` of an angle and of the next one; if `normalised`, each has the integral 1.
  std::vector<double> blend(const std::string& name, std::size_t angle, std::size_t channels, std::size_t channel,
                            double share, bool normalised) const {
    const std::vector<std::uint64_t>& shape = shapes_.at(name);
    const std::size_t columns = shape.back(), size = columns * shape[shape.size() - 2];
    std::vector<double> mixed(size);
    for (const std::size_t which : {std::size_t{0}, std::size_t{1}}) {
      const float* table = numbers_.at(name).data() + ((angle + which) * channels + channel) * size;
      std::vector<double> values(table, table + size);
      const double whole = normalised ? integral(values, columns, static_cast<double>(size / columns - 1)) : 1.0;
      for (std::size_t i = 0; i < size; ++i) mixed[i] += (which == 0 ? 1.0 - share : share) * values[i] / whole;
    }
    return mixed;
  }

  /// Interpolates bilinearly.
  static double at(const std::vector<double>& values, std::size_t columns, double across, double along) {
    const double row = across * static_cast<double>(values.size() / columns - 1),
                 column = along * static_cast<double>(columns - 1);
    const std::size_t r = std::min(static_cast<std::size_t>(row), values.size() / columns - 2);
    const std::size_t c = std::min(static_cast<std::size_t>(column), columns - 2);
    const double y = row - static_cast<double>(r), x = column - static_cast<double>(c);
    const double* corner = values.data() + r * columns + c;
    return (1 - y) * ((1 - x) * corner[0] + x * corner[1]) + y * ((1 - x) * corner[columns] + x * corner[columns + 1]);
  }

  /// Integrates a row at any height up to a fractional column. Simpson's rule is exact for bilinear functions.
  static double row_integral(const std::vector<double>& values, std::size_t columns, double row, double end) {
    const double rows = static_cast<double>(values.size() / columns - 1), scale = static_cast<double>(columns - 1);
    double sum = 0.0;
    for (double from = 0.0; from < end; from += 1.0) {
      const double to = std::min(from + 1.0, end);
      const auto value = [&](double column) { return at(values, columns, row / rows, column / scale); };
      sum += (to - from) / 6.0 * (value(from) + 4.0 * value(0.5 * (from + to)) + value(to));
    }
    return sum;
  }

  /// Integrates all rows up to a fractional one.
  static double integral(const std::vector<double>& values, std::size_t columns, double end) {
    double sum = 0.0;
    for (double from = 0.0; from < end; from += 1.0) {
      const double to = std::min(from + 1.0, end);
      const auto row = [&](double r) { return row_integral(values, columns, r, static_cast<double>(columns - 1)); };
      sum += (to - from) / 6.0 * (row(from) + 4.0 * row(0.5 * (from + to)) + row(to));
    }
    return sum;
  }

  static std::pair<double, double> position(const std::vector<double>& density, std::size_t columns, double v,
                                            double u) {
    const double rows = static_cast<double>(density.size() / columns - 1), last = static_cast<double>(columns - 1);
    const double whole = row_integral(density, columns, v * rows, last);
    return {integral(density, columns, v * rows) / integral(density, columns, rows),
            row_integral(density, columns, v * rows, u * last) / whole};
  }

  std::map<std::string, std::vector<float>> numbers_;
  std::map<std::string, std::vector<std::uint64_t>> shapes_;
};

}  // namespace

TEST_CASE("the database's files agree with an independent evaluation of their arrays") {
  const std::filesystem::path folder = std::filesystem::path(GONIO_SHARED_DATA) / "rgl-bsdf";
  if (!std::filesystem::exists(folder)) {
    MESSAGE("skipped: there is no " << folder.string());
    return;
  }
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.05, 1.0);
  std::size_t files = 0;
  for (const auto& [name, path] : gonio::io::list_rgl_directory(folder)) {
    const auto material = read_rgl(path).material;
    const plain_evaluation plain(gonio::io::read_bytes(path));
    CAPTURE(name);
    for (int i = 0; i < 5; ++i) {
      const auto draw = [&] { return gonio::spherical_direction(std::acos(uniform(random)), 6.0 * uniform(random)); };
      const gonio::direction wi = draw(), wo = draw();
      const gonio::rgb expected = plain(wi, wo);
      CHECK(((material.as_measured(wi, wo) - expected).abs() < 1e-4 * (expected.abs() + 0.01)).all());
    }
    // A written material is read back unchanged.
    const gonio::io::rgl_material whole = read_rgl(path);
    const auto again = read_rgl(gonio::io::write_rgl(whole), "again").material;
    CHECK(again.parts().reflectance.values == whole.material.parts().reflectance.values);
    const gonio::direction up(0, 0, 1), side(0.6, 0, 0.8);
    CHECK((again(up, side) / whole.material(up, side) - 1.0).abs().maxCoeff() < 1e-6);
    ++files;
  }
  CHECK(files == 20);
}

TEST_CASE("materials agree with others' conversions to MERL's format") {
  const std::filesystem::path shared(GONIO_SHARED_DATA);
  if (!std::filesystem::exists(shared / "rgl-bsdf") || !std::filesystem::exists(shared / "rgl-measured")) {
    MESSAGE("skipped: " << shared.string() << " has no rgl-bsdf and rgl-measured");
    return;
  }
  std::size_t compared = 0;
  for (const auto& [name, path] : gonio::io::list_rgl_directory(shared / "rgl-bsdf")) {
    const auto material = read_rgl(path).material;
    const auto table_path = shared / "rgl-measured" / (name + ".binary.gz");
    if (!std::filesystem::exists(table_path)) continue;
    ++compared;
    CAPTURE(name);
    const gonio::brdf_table table = gonio::io::read_merl_any(table_path);
    // Their file has 12 bits of each value, and values at the cells' lower corners.
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
