#pragma once
/// Bodies of io/measurements/ssdd.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/measurements/ssdd.hpp>
#include <gonio/io/measurements/zemax_bsdf.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/io/text/words.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

GONIO_INLINE sample_collector ssdd_reader::read() {
  read_header();
  while (!words_.peek().empty()) read_block();
  if (!samples_) gonio::refuse({words_.position().name, ": has no block of DATA_TYPE brdf"});
  return *std::move(samples_);
}

GONIO_INLINE void ssdd_reader::read_header() {
  static_cast<void>(words_.read_one_of({"VERSION"}));
  const std::string_view version = words_.read_rest_of_line();
  if (!version.starts_with("0."))
    words_.position().refuse({"SSDD of version ", in_quotes(version), ", expected one that begins with 0."});
  while (words_.peek() != "DATA_TYPE") {
    static_cast<void>(words_.read_one_of({"SOFTWARE", "API", "DATE", "DATA_TYPE"}));
    static_cast<void>(words_.read_rest_of_line());
  }
}

GONIO_INLINE ssdd_reader::block_header ssdd_reader::read_block_header() {
  block_header block;
  static_cast<void>(words_.read_one_of({"DATA_TYPE"}));
  constexpr std::array types{"brdf", "btdf", "specular_reflectance", "specular_transmittance"};
  block.type = types[words_.read_one_of({types[0], types[1], types[2], types[3]})];
  while (words_.peek() != "DATA") read_entry(block, words_.read("DATA"));
  return block;
}

GONIO_INLINE void ssdd_reader::read_entry(block_header& block, std::string_view key) {
  constexpr std::array angle_lists{"PARAM0_LIST", "PARAM1_LIST", "PARAM2_LIST", "PARAM3_LIST"};
  constexpr std::array texts{"REDUCTION_TYPE", "NAME", "SOURCE_TYPE", "DEVICE", "CREATION_DATE", "MEASUREMENT_DATE"};
  const auto* const list = std::ranges::find(angle_lists, key);
  if (list != angle_lists.end()) {
    block.angles[list - angle_lists.begin()] = words_.read_line(*list, 0.0, 360.0);
  } else if (std::ranges::find(texts, key) != texts.end()) {
    static_cast<void>(words_.read_rest_of_line());
  } else if (key == "COLOR_MODEL") {
    constexpr std::array models{"monochrome", "rgb", "xyz", "spectrum"};
    block.colour_model = models[words_.read_one_of({models[0], models[1], models[2], models[3]})];
  } else if (key == "WAVELENGTH_LIST") {
    block.wavelengths = words_.read_line(key, 1.0, 1e6);
  } else if (key == "PARAM_TYPE") {
    block.parameters = static_cast<coordinates>(
        words_.read_one_of({"spherical_coordinate_system", "specular_coordinate_system",
                            "half_difference_coordinate_system", "distorted_spherical_coordinate_system"}));
  } else if (key == "PARAM4_LIST") {
    for (const double offset : words_.read_line(key, -90.0, 90.0))
      if (offset != 0.0) words_.position().refuse("PARAM4_LIST: offsets from the specular direction are not supported");
  } else {
    words_.position().refuse({in_quotes(key), " is not an entry of an SSDD file"});
  }
}

GONIO_INLINE std::size_t ssdd_reader::channel_count(const block_header& block) const {
  if (block.colour_model.empty()) words_.position().refuse("COLOR_MODEL is missing before DATA");
  if (block.colour_model == "monochrome") return 1;
  if (block.colour_model != "spectrum") return 3;
  if (block.wavelengths.empty()) words_.position().refuse("WAVELENGTH_LIST is missing before DATA");
  return block.wavelengths.size();
}

GONIO_INLINE void ssdd_reader::check_block(const block_header& block) const {
  if (!block.parameters) words_.position().refuse("PARAM_TYPE is missing before DATA");
  if (block.parameters == coordinates::distorted_spherical)
    words_.position().refuse("distorted spherical coordinates are not supported, expected another PARAM_TYPE");
  const bool is_half_difference = block.parameters == coordinates::half_difference;
  const double largest_second = is_half_difference || block.parameters == coordinates::spherical ? 90.0 : 180.0;
  for (const std::size_t list : {0, 2, 3})
    if (block.angles[list].empty()) words_.position().refuse({"PARAM", list, "_LIST is missing before DATA"});
  for (const auto& [list, largest] : {std::pair<std::size_t, double>{0, 90.0}, {2, largest_second}})
    if (std::ranges::max(block.angles[list]) > largest)
      words_.position().refuse({"PARAM", list, "_LIST: ", shortest(std::ranges::max(block.angles[list])),
                                " degrees, expected at most ", shortest(largest)});
}

GONIO_INLINE std::vector<double> ssdd_reader::read_numbers(std::size_t count) {
  std::vector<double> numbers;
  if (words_.read_one_of({"ascii", "binary"}) == 0) {
    while (numbers.size() < count) numbers.push_back(words_.read_number("a colour"));
    return numbers;
  }
  const std::string_view bytes = words_.read_bytes(count, sizeof(float));
  for (std::size_t i = 0; i < count; ++i) {
    float number = 0.0f;
    std::memcpy(&number, bytes.data() + i * sizeof number, sizeof number);
    if (!std::isfinite(number)) gonio::refuse({words_.position().name, ": a binary colour is not finite"});
    numbers.push_back(number);
  }
  return numbers;
}

GONIO_INLINE void ssdd_reader::read_block() {
  const block_header block = read_block_header();
  const bool is_brdf = block.type == "brdf";
  if (is_brdf && samples_) words_.position().refuse("a second block of DATA_TYPE brdf");
  if (is_brdf) check_block(block);
  std::size_t count = channel_count(block);
  for (const std::vector<double>& list : block.angles) {
    constexpr std::size_t most = 1'000'000'000;
    if (list.size() > most / count) words_.position().refuse("the lists need more than 1000000000 numbers");
    count *= std::max<std::size_t>(list.size(), 1);
  }
  static_cast<void>(words_.read_one_of({"DATA"}));
  const std::vector<double> numbers = read_numbers(count);
  if (is_brdf) samples_ = samples(block, numbers);
}

GONIO_INLINE direction_pair ssdd_reader::pair_of(coordinates parameters, const std::array<double, 4>& angles) {
  const auto& [theta, phi, second_theta, second_phi] = angles;
  if (parameters == coordinates::spherical)
    return {spherical_direction(theta, phi), spherical_direction(second_theta, second_phi)};
  if (parameters == coordinates::specular)
    return {spherical_direction(theta, phi), about_specular(theta, phi, second_theta, second_phi)};
  const direction_pair pair = to_directions({theta, second_theta, second_phi});
  return {turned_about_normal(pair.wi, phi), turned_about_normal(pair.wo, phi)};
}

GONIO_INLINE sample_collector ssdd_reader::collector_of(const block_header& block) const {
  if (block.colour_model == "rgb") return sample_collector(channels());
  if (block.colour_model == "xyz") return sample_collector::of_xyz();
  if (block.colour_model != "spectrum") return sample_collector();
  try {
    return sample_collector(channels(block.wavelengths));
  } catch (const error& reason) {
    words_.position().refuse({"WAVELENGTH_LIST: ", reason.what()});
  }
}

GONIO_INLINE sample_collector ssdd_reader::samples(const block_header& block,
                                                   const std::vector<double>& numbers) const {
  sample_collector collector = collector_of(block);
  const std::size_t count = collector.channel_count();
  const std::vector<bool> are_new = are_new_azimuths(block.angles[3]);
  std::array<std::size_t, 4> extents{};
  for (std::size_t k = 0; k < 4; ++k) extents[k] = std::max<std::size_t>(block.angles[k].size(), 1);
  std::array<std::size_t, 4> at{};
  for (std::size_t i = 0; i < numbers.size() / count; ++i) {
    // The first list varies fastest.
    for (std::size_t k = 0, left = i; k < 4; left /= extents[k++]) at[k] = left % extents[k];
    const bool is_at_pole = block.angles[2][at[2]] == 0.0;  // the same direction for every azimuth
    if (!are_new[at[3]] || (is_at_pole && at[3] > 0)) continue;
    std::array<double, 4> angles{};
    for (std::size_t k = 0; k < 4; ++k) angles[k] = block.angles[k].empty() ? 0.0 : radians(block.angles[k][at[k]]);
    const std::span colour(&numbers[i * count], count);
    for (const double number : colour) require_float_range(number, words_.position());
    collector.add(pair_of(*block.parameters, angles), colour);
  }
  return collector;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE bool looks_like_ssdd(std::string_view text) {
  text_position position;
  detail::word_reader words(text, position);
  return words.read_if("VERSION") && words.read_rest_of_line().starts_with("0.") &&
         text.find("DATA_TYPE") != std::string_view::npos;
}

GONIO_INLINE sample_set read_ssdd(std::string_view text, const std::string& name) {
  text_position position{name, 0};
  return detail::ssdd_reader(text, position).read().samples(name);
}

GONIO_INLINE sample_set read_ssdd(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_ssdd(as_text(bytes), path.string());
}

}  // namespace gonio::io
