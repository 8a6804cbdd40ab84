#pragma once
/// Bodies of io/setups/camera_calibration.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/setups/camera_calibration.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io::detail {

/// Finds entries of OpenCV's YAML and XML files by name. Understands only numbers, words and matrices of numbers.
class storage_text {
 public:
  storage_text(std::string_view text, const std::string& name)
      : text_(without_byte_order_mark(text)), name_(name), is_xml_(text_.find("<opencv_storage>") != text_.npos) {
    if (!is_xml_ && text_.find(':') == text_.npos)
      gonio::refuse({name_, ": is not a calibration file of OpenCV, neither YAML nor XML"});
  }

  struct matrix {
    std::size_t rows = 0, columns = 0;
    std::vector<double> values;
  };

  /// Returns the matrix under the first of these names that is present; nothing if none is.
  [[nodiscard]] std::optional<matrix> find_matrix(std::initializer_list<std::string_view> names) const {
    for (const std::string_view each : names)
      if (const auto value = find(text_, each)) return matrix_of(*value, each);
    return {};
  }

  /// Returns the word of an entry, without quotes; nothing if it is missing.
  [[nodiscard]] std::optional<std::string_view> find_word(std::string_view entry) const {
    const auto value = find(text_, entry);
    if (!value) return {};
    constexpr std::string_view blanks = " \t\r\n";
    std::string_view text = value->substr(std::min(value->find_first_not_of(blanks), value->size()));
    text = text.substr(0, text.find_first_of(blanks));
    if (text.size() >= 2 && (text.front() == '"' || text.front() == '\'') && text.back() == text.front())
      text = text.substr(1, text.size() - 2);
    return text;
  }

  /// Returns the number of pixels under the first of these names that is present.
  [[nodiscard]] std::size_t pixels(std::initializer_list<std::string_view> names) const {
    for (const std::string_view each : names)
      if (const auto value = find(text_, each)) return count_of(trimmed(*value), each);
    gonio::refuse({name_, ": ", in_quotes(*names.begin()), " is missing"});
  }

  [[noreturn]] void refuse(std::string_view entry, const std::string& what) const {
    gonio::refuse({name_, ": ", in_quotes(entry), " ", what});
  }

 private:
  [[nodiscard]] std::optional<std::string_view> find(std::string_view within, std::string_view entry) const {
    return is_xml_ ? find_element(within, entry) : find_key(within, entry);
  }

  /// Returns the text between <entry ...> and </entry>.
  [[nodiscard]] std::optional<std::string_view> find_element(std::string_view within, std::string_view entry) const {
    const std::string opening = "<" + std::string(entry), closing = "</" + std::string(entry) + ">";
    for (std::size_t at = within.find(opening); at != within.npos; at = within.find(opening, at + 1)) {
      const std::size_t after = at + opening.size();
      if (after >= within.size() || !(within[after] == '>' || within[after] == ' ')) continue;
      const std::size_t begin = within.find('>', after), end = within.find(closing, after);
      if (begin == within.npos || end == within.npos || end < begin) refuse(entry, "is not closed");
      return within.substr(begin + 1, end - begin - 1);
    }
    return {};
  }

  /// Returns the text after "entry:" at the start of a line, up to the next line that is not indented deeper and does
  /// not start with - or ].
  [[nodiscard]] std::optional<std::string_view> find_key(std::string_view within, std::string_view entry) const {
    for (std::size_t begin = 0; begin < within.size();) {
      const std::size_t end = std::min(within.find('\n', begin), within.size());
      const std::string_view line = within.substr(begin, end - begin);
      const std::size_t depth = std::min(line.find_first_not_of(' '), line.size());
      std::string_view rest = line.substr(depth);
      if (rest.starts_with(entry) && rest.substr(entry.size()).starts_with(':')) {
        const std::size_t value = begin + depth + entry.size() + 1;
        return within.substr(value, end_of_value(within, end, depth) - value);
      }
      begin = end + 1;
    }
    return {};
  }

  /// Returns the end of a value whose first line ends at `end`.
  [[nodiscard]] static std::size_t end_of_value(std::string_view within, std::size_t end, std::size_t depth) {
    while (end < within.size()) {
      const std::size_t next = std::min(within.find('\n', end + 1), within.size());
      const std::string_view line = within.substr(end + 1, next - end - 1);
      const std::size_t first = line.find_first_not_of(" \r");
      if (first != line.npos && first <= depth && line[first] != '-' && line[first] != ']') break;
      end = next;
    }
    return end;
  }

  [[nodiscard]] std::size_t count_of(std::string_view field, std::string_view entry) const {
    constexpr double most = 1e6;
    double value = 0.0;
    if (read_number(field, value) != nullptr || !(value >= 1.0 && value <= most && value == std::floor(value)))
      refuse(entry, "must be a whole number from 1 to 1000000, not " + in_quotes(field));
    return static_cast<std::size_t>(value);
  }

  [[nodiscard]] matrix matrix_of(std::string_view value, std::string_view entry) const {
    const auto rows = find(value, "rows"), columns = find(value, "cols"), data = find(value, "data");
    if (!rows || !columns || !data) refuse(entry, "must be a matrix with rows, cols and data");
    matrix read{count_of(trimmed(*rows), entry), count_of(trimmed(*columns), entry), {}};
    // The numbers are separated by blanks, commas and line feeds.
    constexpr std::string_view separators = " \t\r\n,[]";
    for (std::string_view rest = *data;;) {
      const std::size_t begin = rest.find_first_not_of(separators);
      if (begin == rest.npos) break;
      const std::size_t end = std::min(rest.find_first_of(separators, begin), rest.size());
      double number = 0.0;
      const std::string_view field = rest.substr(begin, end - begin);
      // OpenCV writes "1." for 1.
      if (const char* wrong = read_number(field.ends_with('.') ? field.substr(0, field.size() - 1) : field, number))
        refuse(entry, "holds " + in_quotes(field) + wrong);
      read.values.push_back(number);
      rest.remove_prefix(end);
    }
    if (read.rows > 100 || read.columns > 100 || read.values.size() != read.rows * read.columns)
      refuse(entry, "is declared as " + std::to_string(read.rows) + " x " + std::to_string(read.columns) +
                        " but holds " + std::to_string(read.values.size()) + " numbers");
    return read;
  }

  std::string_view text_;
  std::string name_;
  bool is_xml_;
};

GONIO_INLINE camera_intrinsics calibrated_intrinsics(const storage_text& text) {
  const auto matrix = text.find_matrix({"camera_matrix", "cameraMatrix", "Camera_Matrix", "CameraMatrix", "K"});
  if (!matrix) text.refuse("camera_matrix", "is missing");
  const std::vector<double>& k = matrix->values;
  if (matrix->rows != 3 || matrix->columns != 3) text.refuse("camera_matrix", "must be 3 x 3");
  if (k[1] != 0.0 || k[3] != 0.0 || k[6] != 0.0 || k[7] != 0.0 || k[8] != 1.0)
    text.refuse("camera_matrix", "must be fx 0 cx, 0 fy cy, 0 0 1");
  if (!(k[0] > 0.0 && k[4] > 0.0)) text.refuse("camera_matrix", "has focal lengths that are not positive");
  return {text.pixels({"image_height", "image_Height", "imageHeight"}),
          text.pixels({"image_width", "image_Width", "imageWidth"}),
          k[0],
          k[4],
          k[2] + 0.5,
          k[5] + 0.5};
}

/// Refuses lens models whose coefficients have another meaning.
GONIO_INLINE void require_radial_and_tangential(const storage_text& text) {
  constexpr std::string_view way_out = ": undistort the images first, for instance by cv::fisheye::undistortImage";
  if (const auto fisheye = text.find_word("fisheye_model"); fisheye && *fisheye != "0")
    text.refuse("fisheye_model", "is an unsupported lens model" + std::string(way_out));
  const auto model = text.find_word("distortion_model");
  if (model && *model != "plumb_bob" && *model != "radtan" && *model != "rational_polynomial")
    text.refuse("distortion_model", in_quotes(*model) + " is an unsupported lens model" + std::string(way_out));
}

GONIO_INLINE lens_distortion calibrated_distortion(const storage_text& text) {
  require_radial_and_tangential(text);
  const auto matrix = text.find_matrix({"distortion_coefficients", "distCoeffs", "dist_coeffs",
                                        "Distortion_Coefficients", "DistortionCoefficients", "D"});
  if (!matrix) return {};
  const std::vector<double>& all = matrix->values;
  if ((matrix->rows != 1 && matrix->columns != 1) || all.size() < 4)
    text.refuse("distortion_coefficients", "must be four or five numbers, k1 k2 p1 p2 k3");
  if (std::any_of(all.begin() + std::min<std::ptrdiff_t>(5, std::ssize(all)), all.end(),
                  [](double each) { return each != 0.0; }))
    text.refuse("distortion_coefficients", "has coefficients after k3 that are not 0, of an unsupported lens model");
  return {.k1 = all[0], .k2 = all[1], .p1 = all[2], .p2 = all[3], .k3 = all.size() > 4 ? all[4] : 0.0};
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE camera_calibration read_camera_calibration(std::string_view text, const std::string& name) {
  const detail::storage_text entries(text, name);
  return {detail::calibrated_intrinsics(entries), detail::calibrated_distortion(entries)};
}

GONIO_INLINE camera_calibration read_camera_calibration(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  return read_camera_calibration(as_text(bytes), path.string());
}

}  // namespace gonio::io
