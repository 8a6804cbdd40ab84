#pragma once
/// A goniometer that replays frames recorded in a real laboratory: a folder of PNG files and a manifest that lists the
/// directions of each frame (JSON; docs/reference/formats.md). Recorded measurements run through the same code as live
/// ones.

#include "tool/files/json.hpp"
#include <gonio/capture/device.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/text/text.hpp>

#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace lab {

class recorded_frames {
 public:
  /// Reads the manifest; frames are read when they are measured. Throws gonio::error naming manifest and invalid frame.
  explicit recorded_frames(const std::filesystem::path& manifest)
      : folder_(manifest.parent_path()), name_(manifest.string()) {
    const auto bytes = gonio::io::read_bytes(manifest);
    const auto text = cli::json::read(std::string(gonio::io::as_text(bytes)));
    if (!text.is_object())
      gonio::refuse({name_, ": is not a JSON object, of at most ", cli::json::most_values,
                     " values and nested at most ", cli::json::deepest, " deep"});
    largest_count_ = static_cast<std::uint16_t>(whole(text, "largest_count", 65535));
    if (largest_count_ == 0) gonio::refuse(name_ + ": 'largest_count' must be positive");
    if (text.contains("window")) window_ = read_window(text["window"]);
    if (!text.contains("frames") || !text["frames"].is_array() || text["frames"].empty())
      gonio::refuse(name_ + ": 'frames' must be a list of at least one frame");
    for (const auto& each : text["frames"].elements()) add(each);
  }

  /// Returns all recorded pairs of directions, in the manifest's order.
  [[nodiscard]] std::vector<gonio::direction_pair> poses() const {
    std::vector<gonio::direction_pair> all;
    for (const recorded_pose& each : recorded_) all.push_back(each.at);
    return all;
  }

  [[nodiscard]] gonio::capture::placement place(const gonio::direction_pair& pair) const {
    return {pair, find(pair) ? "" : "no frame was recorded for this pair of directions"};
  }
  [[nodiscard]] double travel(const gonio::direction_pair&, const gonio::direction_pair&) const { return 0.0; }
  [[nodiscard]] std::uint16_t largest_count() const { return largest_count_; }

  [[nodiscard]] gonio::capture::reading measure(const gonio::direction_pair& pair) {
    const recorded_pose* found = find(pair);
    if (found == nullptr) throw gonio::capture::device_failure("no frame was recorded for this pair of directions");
    gonio::capture::reading taken;
    for (const auto& [seconds, file] : found->frames) {
      taken.times.push_back(seconds);
      taken.frames.push_back(read_frame(folder_ / file));
    }
    return taken;
  }

 private:
  struct recorded_pose {
    gonio::direction_pair at;
    std::vector<std::pair<double, std::string>> frames;  ///< exposure time in seconds, and the file
  };
  struct window {
    std::size_t column, row, columns, rows;
  };

  [[nodiscard]] double number(const cli::json& object, const std::string& key) const {
    if (!object.contains(key) || !object[key].is_number())
      gonio::refuse(name_ + ": '" + key + "' is missing or not a number in " + shown(object));
    return object[key].number();
  }
  [[nodiscard]] std::size_t whole(const cli::json& object, const std::string& key, double most) const {
    const double value = number(object, key);
    if (!(value >= 0.0 && value <= most && value == std::floor(value)))
      gonio::refuse(name_ + ": '" + key + "' must be a whole number up to " + std::to_string(most));
    return static_cast<std::size_t>(value);
  }
  /// Returns the beginning of an invalid entry.
  [[nodiscard]] static std::string shown(const cli::json& object) {
    return gonio::printable(object.dump().substr(0, 120));
  }

  [[nodiscard]] window read_window(const cli::json& given) const {
    if (!given.is_object()) gonio::refuse(name_ + ": 'window' must have column, row, columns and rows");
    const window parsed{whole(given, "column", 1e6), whole(given, "row", 1e6), whole(given, "columns", 1e6),
                        whole(given, "rows", 1e6)};
    if (parsed.columns == 0 || parsed.rows == 0) gonio::refuse(name_ + ": 'window' has no pixels");
    return parsed;
  }

  [[nodiscard]] gonio::direction towards(const cli::json& frame, const std::string& theta,
                                         const std::string& phi) const {
    const double polar = number(frame, theta), azimuth = number(frame, phi);
    if (!(polar >= 0.0 && polar < 90.0 && std::abs(azimuth) <= 360.0))
      gonio::refuse(name_ + ": '" + theta + "' and '" + phi + "' must be degrees above the horizon in " + shown(frame));
    return gonio::spherical_direction(gonio::radians(polar), gonio::radians(azimuth));
  }

  void add(const cli::json& frame) {
    if (!frame.is_object()) gonio::refuse(name_ + ": " + shown(frame) + " is not a frame");
    const gonio::direction_pair at{towards(frame, "theta_i", "phi_i"), towards(frame, "theta_o", "phi_o")};
    const double seconds = number(frame, "seconds");
    if (!(seconds > 0.0)) gonio::refuse(name_ + ": 'seconds' must be positive in " + shown(frame));
    if (!frame.contains("file") || !frame["file"].is_string())
      gonio::refuse(name_ + ": 'file' is missing or not a string in " + shown(frame));
    recorded_pose* known = find(at);
    if (known == nullptr) {
      by_key_.emplace(key_of(at), recorded_.size());
      known = &recorded_.emplace_back(recorded_pose{at, {}});
    }
    known->frames.emplace_back(seconds, frame["file"].text());
  }

  /// Returns a search key. The keys of two pairs differ by less than twice the larger difference of their directions.
  [[nodiscard]] static double key_of(const gonio::direction_pair& pair) {
    return pair.wi.dot(gonio::direction(0.61, 0.53, 0.59)) + pair.wo.dot(gonio::direction(0.37, 0.71, 0.43));
  }

  [[nodiscard]] const recorded_pose* find(const gonio::direction_pair& pair) const {
    constexpr double tolerance = 1e-9;
    const double key = key_of(pair);
    for (auto near = by_key_.lower_bound(key - 2.0 * tolerance);
         near != by_key_.end() && near->first <= key + 2.0 * tolerance; ++near) {
      const recorded_pose& each = recorded_[near->second];
      if (each.at.wi.isApprox(pair.wi, tolerance) && each.at.wo.isApprox(pair.wo, tolerance)) return &each;
    }
    return nullptr;
  }
  [[nodiscard]] recorded_pose* find(const gonio::direction_pair& pair) {
    return const_cast<recorded_pose*>(std::as_const(*this).find(pair));
  }

  /// A missing or damaged file counts as a frame that did not arrive.
  [[nodiscard]] gonio::capture::camera_frame read_frame(const std::filesystem::path& file) const try {
    const gonio::stored_codes codes = gonio::io::read_png_codes(file);
    const window seen = window_.value_or(window{0, 0, codes.columns, codes.rows});
    if (seen.column + seen.columns > codes.columns || seen.row + seen.rows > codes.rows)
      throw gonio::capture::device_failure(file.string() + ": the window ends outside the image of " +
                                           std::to_string(codes.columns) + " x " + std::to_string(codes.rows) +
                                           " pixels");
    gonio::capture::camera_frame counts(seen.rows * seen.columns, 3);
    for (std::size_t row = 0; row < seen.rows; ++row)
      for (std::size_t column = 0; column < seen.columns; ++column)
        for (std::size_t channel = 0; channel < 3; ++channel)
          counts(row * seen.columns + column, channel) = codes.at(seen.row + row, seen.column + column, channel);
    return counts;
  } catch (const gonio::error& refusal) {
    throw gonio::capture::device_failure(refusal.what());
  }

  std::filesystem::path folder_;
  std::string name_;
  std::uint16_t largest_count_ = 0;
  std::optional<window> window_;
  std::vector<recorded_pose> recorded_;
  std::multimap<double, std::size_t> by_key_;  ///< indices of the poses
};
static_assert(gonio::capture::goniometer<recorded_frames>);

}  // namespace lab
