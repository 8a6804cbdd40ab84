#pragma once
/// Bodies of io/measurements/lighttools_bsdf.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/direction.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/lighttools_bsdf.hpp>
#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/io/text/words.hpp>
#include <gonio/table/sample_set.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// A table of one angle of incidence and one channel: a value for each polar angle, azimuth by azimuth.
struct lighttools_block {
  double incidence = 0.0, wavelength = 0.0;  ///< degrees and nanometres; 0 if the file has none
  int tristimulus = -1;                      ///< 0, 1, 2: X, Y, Z
  bool is_front = true, is_reflection = true;
  std::vector<double> values = {};
  std::size_t line = 0;
};

/// Reads a file word by word.
class lighttools_reader {
 public:
  lighttools_reader(std::string_view text, text_position& position) : words_(text, position) {}

  [[nodiscard]] sample_set read();

 private:
  using channel_blocks = std::map<double, const lighttools_block*>;  ///< by channel number

  void read_header();
  void read_blocks();
  [[nodiscard]] lighttools_block read_block();
  void read_keyword(std::string_view keyword, lighttools_block& block);
  void read_values(lighttools_block& block);
  [[nodiscard]] double channel_of(const lighttools_block& block) const;
  [[nodiscard]] std::map<double, channel_blocks> sorted_blocks() const;
  [[nodiscard]] sample_collector collector_of(const channel_blocks& blocks) const;
  [[nodiscard]] sample_set samples() const;
  void add(sample_collector& to, double incidence, const channel_blocks& blocks) const;
  void require_plane_of_incidence(double degrees) const;
  [[noreturn]] void refuse(const lighttools_block& block, std::initializer_list<message_part> what) const;

  word_reader words_;
  bool is_tristimulus_ = false;
  std::vector<double> azimuths_, polar_angles_;  ///< of the viewer, degrees
  std::vector<lighttools_block> blocks_;         ///< of reflection
};

GONIO_INLINE sample_set lighttools_reader::read() {
  read_header();
  read_blocks();
  return samples();
}

GONIO_INLINE void lighttools_reader::read_header() {
  while (!words_.read_if("DataBegin")) {
    const std::string_view key = words_.read("DataBegin");
    if (key == "Source" || key == "Symmetry")
      static_cast<void>(words_.read(key));  // ignored: the list of azimuths shows the measured directions
    else if (key == "SpectralContent")
      is_tristimulus_ = words_.read_one_of({"Monochrome", "XYZ"}) == 1;
    else if (key == "ScatterAzimuth")
      azimuths_ = words_.read_list("ScatterAzimuth", -360.0, 360.0);
    else if (key == "ScatterRadial")
      polar_angles_ = words_.read_list("ScatterRadial", 0.0, 180.0);
    else
      words_.position().refuse({in_quotes(key), " is not a keyword of a LightTools BSDF file above DataBegin"});
  }
  if (azimuths_.empty()) words_.position().refuse("ScatterAzimuth is missing above DataBegin");
  if (polar_angles_.empty()) words_.position().refuse("ScatterRadial is missing above DataBegin");
}

/// Reads the blocks of reflection: those of the front, or if there are none, those of the back.
GONIO_INLINE void lighttools_reader::read_blocks() {
  while (!words_.peek().empty() && !words_.read_if("DataEnd")) {
    lighttools_block block = read_block();
    if (block.is_reflection) blocks_.push_back(std::move(block));
  }
  if (const std::string_view more = words_.peek(); !more.empty())
    words_.position().refuse({in_quotes(more), " follows DataEnd, expected the end of the file"});
  if (blocks_.empty()) gonio::refuse({words_.position().name, ": has no block of ScatterType BRDF"});
  if (std::ranges::any_of(blocks_, &lighttools_block::is_front))
    std::erase_if(blocks_, [](const lighttools_block& block) { return !block.is_front; });
}

/// Reads a block: its keywords in any order, TIS last, then its values.
GONIO_INLINE lighttools_block lighttools_reader::read_block() {
  lighttools_block block;
  for (std::string_view key = words_.read("TIS"); key != "TIS"; key = words_.read("TIS")) read_keyword(key, block);
  static_cast<void>(words_.read_number("TIS"));
  block.line = words_.position().line;
  read_values(block);
  return block;
}

GONIO_INLINE void lighttools_reader::read_keyword(std::string_view keyword, lighttools_block& block) {
  if (keyword == "AOI")
    block.incidence = words_.read_number(keyword, 0.0, 90.0);
  else if (keyword == "POI")
    require_plane_of_incidence(words_.read_number(keyword, -360.0, 360.0));
  else if (keyword == "Side")
    block.is_front = words_.read_one_of({"Front", "Back"}) == 0;
  else if (keyword == "Wavelength")
    block.wavelength = words_.read_number(keyword, 0.0, 1e6);
  else if (keyword == "ScatterType")
    block.is_reflection = words_.read_one_of({"BRDF", "BTDF"}) == 0;
  else if (keyword == "TristimulusValue")
    block.tristimulus = static_cast<int>(words_.read_one_of({"TrisX", "TrisY", "TrisZ"}));
  else
    words_.position().refuse({in_quotes(keyword), " is not a keyword of a block, expected AOI, POI, Side, Wavelength, ",
                              "ScatterType, TristimulusValue, TIS or DataEnd"});
}

GONIO_INLINE void lighttools_reader::require_plane_of_incidence(double degrees) const {
  if (degrees != 0.0)
    words_.position().refuse({"POI: ", shortest(degrees), ", expected a plane of incidence of 0 degrees"});
}

GONIO_INLINE void lighttools_reader::read_values(lighttools_block& block) {
  for (std::size_t i = 0; i < azimuths_.size() * polar_angles_.size(); ++i) {
    block.values.push_back(words_.read_number("a value"));
    require_float_range(block.values.back(), words_.position());
  }
}

/// Returns the channel number of a block: its wavelength, or 0, 1, 2 for X, Y, Z.
GONIO_INLINE double lighttools_reader::channel_of(const lighttools_block& block) const {
  if (!is_tristimulus_) return block.wavelength;
  if (block.tristimulus < 0) refuse(block, {"a block of XYZ has no TristimulusValue above its TIS"});
  return block.tristimulus;
}

GONIO_INLINE void lighttools_reader::refuse(const lighttools_block& block,
                                            std::initializer_list<message_part> what) const {
  text_position{words_.position().name, block.line}.refuse(what);
}

/// Returns the blocks by angle of incidence; all angles must have the same channels.
GONIO_INLINE std::map<double, lighttools_reader::channel_blocks> lighttools_reader::sorted_blocks() const {
  std::map<double, channel_blocks> sorted;
  for (const lighttools_block& block : blocks_)
    if (!sorted[block.incidence].emplace(channel_of(block), &block).second)
      refuse(block, {"a second block of reflection has AOI ", shortest(block.incidence), " and the same channel"});
  const channel_blocks& first = sorted.begin()->second;
  const auto is_same = [](const auto& one, const auto& other) { return one.first == other.first; };
  for (const auto& [incidence, blocks] : sorted)
    if (!std::ranges::equal(blocks, first, is_same) || (is_tristimulus_ && blocks.size() != 3))
      refuse(*blocks.begin()->second,
             {"AOI ", shortest(incidence), " has ", blocks.size(), blocks.size() == 1 ? " block" : " blocks",
              is_tristimulus_ ? ", expected TrisX, TrisY and TrisZ"
                              : ", expected one for each wavelength of the smallest AOI"});
  return sorted;
}

GONIO_INLINE sample_collector lighttools_reader::collector_of(const channel_blocks& blocks) const {
  if (is_tristimulus_) return sample_collector::of_xyz();
  std::vector<double> wavelengths;
  for (const auto& [wavelength, block] : blocks) wavelengths.push_back(wavelength);
  if (wavelengths.front() > 0.0) return sample_collector(channels(wavelengths));
  if (wavelengths.size() > 1)
    refuse(*blocks.begin()->second,
           {"the block has no Wavelength but other blocks have, expected one in all blocks or in none"});
  return sample_collector();
}

GONIO_INLINE sample_set lighttools_reader::samples() const {
  const std::map<double, channel_blocks> sorted = sorted_blocks();
  sample_collector collector = collector_of(sorted.begin()->second);
  for (const auto& [incidence, blocks] : sorted) add(collector, incidence, blocks);
  return std::move(collector).samples(words_.position().name);
}

GONIO_INLINE void lighttools_reader::add(sample_collector& to, double incidence, const channel_blocks& blocks) const {
  const std::vector<bool> are_new = are_new_azimuths(azimuths_);
  const direction wi = spherical_direction(radians(incidence), std::numbers::pi / 2.0);
  std::vector<double> values;
  for (std::size_t row = 0; row < azimuths_.size(); ++row)
    for (std::size_t column = 0; column < polar_angles_.size(); ++column) {
      if (!are_new[row] || (polar_angles_[column] == 0.0 && row > 0)) continue;  // every row contains the normal
      values.clear();
      for (const auto& [channel, block] : blocks) values.push_back(block->values[row * polar_angles_.size() + column]);
      to.add({wi, spherical_direction(radians(polar_angles_[column]), radians(azimuths_[row]))}, values);
    }
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE bool looks_like_lighttools_bsdf(std::string_view text) {
  constexpr std::array<std::string_view, 6> first_words{"Source",      "Symmetry",       "SpectralContent",
                                                        "ScatterType", "ScatterAzimuth", "ScatterRadial"},
      of_blocks{"AOI", "POI", "Side", "Wavelength", "ScatterType", "TristimulusValue"};
  text_position position;
  detail::word_reader words(text, position);
  if (std::ranges::find(first_words, words.peek()) == first_words.end()) return false;
  while (!words.peek().empty())
    if (words.read("DataBegin") == "DataBegin") return std::ranges::find(of_blocks, words.peek()) != of_blocks.end();
  return false;
}

GONIO_INLINE sample_set read_lighttools_bsdf(std::string_view text, const std::string& name) {
  text_position position{name, 0};
  return detail::lighttools_reader(text, position).read();
}

GONIO_INLINE sample_set read_lighttools_bsdf(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_bytes(path);
  return read_lighttools_bsdf(as_text(bytes), path.string());
}

}  // namespace gonio::io
