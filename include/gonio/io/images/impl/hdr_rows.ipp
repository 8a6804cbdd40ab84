#pragma once
/// Bodies of io/images/hdr_rows.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/rgb.hpp>
#include <gonio/io/bytes/believable.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/images/hdr_rows.hpp>
#include <gonio/io/text/text.hpp>

#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace gonio::io::detail {

/// The content of an HDR file's header.
struct hdr_header {
  std::size_t rows = 0, columns = 0;
  std::size_t size = 0;                                   ///< bytes before the first row
  bool from_bottom = false;                               ///< the first row is the lowest
  Eigen::Matrix3d colours = Eigen::Matrix3d::Identity();  ///< converts stored numbers to linear Rec. 709
};

/// Returns the numbers of a line "EXPOSURE= 2.5". Throws gonio::error unless there are `count` finite numbers.
[[nodiscard]] GONIO_INLINE Eigen::VectorXd hdr_numbers(std::string_view line, Eigen::Index count,
                                                       const std::string& name) {
  const auto equals = line.find('=');
  std::vector<std::string_view> words;
  split_at_blanks(line.substr(equals + 1), words);
  Eigen::VectorXd numbers(count);
  for (Eigen::Index i = 0; i < count; ++i)
    if (i >= std::ssize(words) || read_number(words[i], numbers[i]) != nullptr)
      gonio::refuse({name, ": the line ", in_quotes(line.substr(0, equals)), " of the HDR file must hold ", count,
                     count == 1 ? " number" : " numbers"});
  return numbers;
}

/// Returns the matrix that converts to Rec. 709 and keeps white white, from x and y of red, green, blue and white.
[[nodiscard]] GONIO_INLINE Eigen::Matrix3d from_primaries(const Eigen::VectorXd& xy, const std::string& name) {
  Eigen::Matrix<double, 3, 4> xyz;
  for (Eigen::Index i = 0; i < 4; ++i)
    xyz.col(i) = Eigen::Vector3d(xy[2 * i], xy[2 * i + 1], 1.0 - xy[2 * i] - xy[2 * i + 1]) / xy[2 * i + 1];
  const Eigen::Matrix3d primaries = xyz.leftCols(3);
  const Eigen::Vector3d amounts = primaries.inverse() * xyz.col(3);
  Eigen::Matrix3d found;
  for (Eigen::Index i = 0; i < 3; ++i) found.col(i) = from_xyz((amounts[i] * primaries.col(i)).array()).matrix();
  const Eigen::Vector3d of_white = found.rowwise().sum();
  for (Eigen::Index row = 0; row < 3; ++row) found.row(row) /= of_white[row];
  if (!found.allFinite()) gonio::refuse({name, ": the PRIMARIES of the HDR file are not three colours and a white"});
  return found;
}

/// Returns the matrix to Rec. 709 from X, Y and Z in candela per square metre, at Radiance's 179 lumens per watt.
[[nodiscard]] GONIO_INLINE Eigen::Matrix3d from_radiance_xyz() {
  Eigen::Matrix3d found;
  for (Eigen::Index i = 0; i < 3; ++i) found.col(i) = from_xyz(rgb(Eigen::Vector3d::Unit(i).array())).matrix() / 179.0;
  return found;
}

/// Returns the smallest number of bytes for the pixels, reached if all rows are runs of 127 pixels.
[[nodiscard]] constexpr std::size_t least_hdr_size(std::size_t rows, std::size_t columns) noexcept {
  const std::size_t flat = 4 * columns;
  return rows * (columns < 8 ? flat : std::min(flat, 4 + 8 * ((columns + 126) / 127)));
}

/// Takes the letters and a number, as in "-Y 12", from the front of a line. Sets `extent` to the number, 0 if it is
/// negative. Returns false if either is missing.
[[nodiscard]] GONIO_INLINE bool read_hdr_extent(std::string_view& line, std::string_view letters, std::size_t& extent) {
  if (!line.starts_with(letters)) return false;
  line.remove_prefix(letters.size());
  std::int64_t number = 0;
  const auto [end, failure] = std::from_chars(line.data(), line.data() + line.size(), number);
  if (failure == std::errc::invalid_argument) return false;
  if (failure == std::errc::result_out_of_range) number = std::numeric_limits<std::int32_t>::max();
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
  extent = static_cast<std::size_t>(std::clamp<std::int64_t>(number, 0, std::numeric_limits<std::int32_t>::max()));
  return true;
}

/// Collects the colour conversion from the lines of a header.
class hdr_colours {
 public:
  explicit hdr_colours(const std::string& name) : name_(name) {}

  void read(std::string_view line) {
    if (line.starts_with("EXPOSURE=")) divisor_ *= hdr_numbers(line, 1, name_)[0];
    if (line.starts_with("COLORCORR=")) divisor_ = divisor_.cwiseProduct(hdr_numbers(line, 3, name_));
    if (line.starts_with("PRIMARIES=")) read_primaries(hdr_numbers(line, 8, name_));
    if (line == "FORMAT=32-bit_rle_xyze") primaries_ = from_radiance_xyz();
    is_known_ = is_known_ || line == "FORMAT=32-bit_rle_rgbe" || line == "FORMAT=32-bit_rle_xyze";
  }
  [[nodiscard]] bool is_known() const noexcept { return is_known_; }
  [[nodiscard]] Eigen::Matrix3d matrix() const {
    if (!(divisor_.array() > 0.0).all())
      gonio::refuse({name_, ": EXPOSURE and COLORCORR of the HDR file must be positive"});
    return primaries_ * divisor_.cwiseInverse().asDiagonal();
  }

 private:
  /// Reads PRIMARIES. Eight zeros, which Photoshop writes, mean the default primaries.
  void read_primaries(const Eigen::VectorXd& xy) {
    if ((xy.array() != 0.0).any()) primaries_ = from_primaries(xy, name_);
  }

  const std::string& name_;
  bool is_known_ = false;
  Eigen::Vector3d divisor_ = Eigen::Vector3d::Ones();
  Eigen::Matrix3d primaries_ = Eigen::Matrix3d::Identity();
};

/// Reads a header: lines of text, an empty line, and a line with the size.
[[nodiscard]] GONIO_INLINE hdr_header read_hdr_header(std::string_view text, const std::string& name) {
  if (!text.starts_with("#?RADIANCE\n") && !text.starts_with("#?RGBE\n"))
    gonio::refuse({name, ": is not a Radiance HDR file"});
  hdr_header header;
  hdr_colours colours(name);
  bool is_sized = false;
  for (bool before_empty = true; !is_sized;) {
    const auto end = text.find('\n', header.size);
    if (end == std::string_view::npos) break;
    std::string_view line = text.substr(header.size, end - header.size);
    header.size = end + 1;
    if (!before_empty) {
      header.from_bottom = line.starts_with('+');
      is_sized = read_hdr_extent(line, header.from_bottom ? "+Y " : "-Y ", header.rows) &&
                 read_hdr_extent(line, "+X ", header.columns);
      break;
    }
    before_empty = !line.empty();
    colours.read(line);
  }
  if (!colours.is_known() || !is_sized)
    gonio::refuse({name,
                   ": the header of the HDR file is truncated or of an unknown kind (expected 32-bit_rle_rgbe or "
                   "32-bit_rle_xyze, -Y or +Y, and +X)"});
  check_image_size(header.rows, header.columns, name);
  header.colours = colours.matrix();
  return header;
}

/// Returns the factor of the mantissas for each exponent.
[[nodiscard]] GONIO_INLINE std::array<float, 256> rgbe_factors() {
  std::array<float, 256> factors{};
  for (int exponent = 1; exponent < 256; ++exponent)
    factors[static_cast<std::size_t>(exponent)] = std::ldexp(1.0f, exponent - 136);
  return factors;
}

}  // namespace gonio::io::detail

namespace gonio::io {

/// Reads rows one after the other, through a buffer.
class hdr_rows::row_reader {
 public:
  row_reader(const hdr_rows& file, std::uint64_t offset)
      : file_(file), buffer_(std::size_t{1} << 16), end_(offset), codes_(static_cast<std::size_t>(4 * file.columns_)) {}

  /// Returns the next byte's position in the file.
  [[nodiscard]] std::uint64_t offset() const noexcept { return end_ - left_.size(); }
  [[nodiscard]] bool ended() { return left_.empty() && !refill(); }

  /// Returns the codes of the next row. A run-length encoded row has all mantissas of red, of green, of blue, then all
  /// exponents; a flat row goes pixel by pixel.
  [[nodiscard]] std::span<const std::uint8_t> next() {
    if (!file_.has_runs_) {
      read(codes_);
      return codes_;
    }
    std::array<std::uint8_t, 4> start{};
    read(start);
    if (start[0] != 2 || start[1] != 2 || start[2] * 256 + start[3] != file_.columns_)
      fail("a row does not begin with a run-length header");
    const auto columns = static_cast<std::size_t>(file_.columns_);
    for (std::size_t channel = 0; channel < 4; ++channel)
      read_channel(std::span(codes_).subspan(channel * columns, columns));
    return codes_;
  }

 private:
  void read_channel(std::span<std::uint8_t> out) {
    while (!out.empty()) {
      std::array<std::uint8_t, 1> count{};
      read(count);
      const bool is_run = count[0] > 128;
      const std::size_t length = is_run ? count[0] - 128u : count[0];
      if (length == 0 || length > out.size()) fail("a run is empty or longer than its row");
      if (is_run) {
        std::array<std::uint8_t, 1> value{};
        read(value);
        std::ranges::fill(out.first(length), value[0]);
      } else {
        read(out.first(length));
      }
      out = out.subspan(length);
    }
  }

  void read(std::span<std::uint8_t> out) {
    while (!out.empty()) {
      if (ended()) gonio::refuse({file_.name_, ": the HDR file is truncated"});
      const std::size_t count = std::min(out.size(), left_.size());
      std::ranges::copy(left_.first(count), out.begin());
      left_ = left_.subspan(count);
      out = out.subspan(count);
    }
  }

  [[nodiscard]] bool refill() {
    const std::size_t count = read_at(file_.file_, end_, std::as_writable_bytes(std::span(buffer_)), file_.name_);
    end_ += count;
    left_ = std::span(buffer_).first(count);
    return count > 0;
  }

  [[noreturn]] void fail(std::string_view reason) const {
    gonio::refuse({file_.name_, ": the HDR file cannot be decoded (", reason, ")"});
  }

  const hdr_rows& file_;
  std::vector<std::uint8_t> buffer_;
  std::uint64_t end_;  ///< position in the file of the buffer's end
  std::span<const std::uint8_t> left_;
  std::vector<std::uint8_t> codes_;
};

GONIO_INLINE hdr_rows::hdr_rows(const std::filesystem::path& path) : name_(path.string()), file_(open_to_read(path)) {
  const std::uint64_t size = size_of_regular(file_, path);
  std::string text(static_cast<std::size_t>(std::min<std::uint64_t>(size, 1u << 16)), ' ');
  text.resize(read_at(file_, 0, std::as_writable_bytes(std::span(text)), path));
  const detail::hdr_header header = detail::read_hdr_header(text, name_);
  if (size < detail::least_hdr_size(header.rows, header.columns)) gonio::refuse({name_, ": the HDR file is truncated"});
  detail::check_believable_pixels(detail::hdr_claims, header.rows, header.columns, size, name_);
  columns_ = static_cast<Eigen::Index>(header.columns);
  has_colours_ = !header.colours.isIdentity(0.0);
  colours_ = header.colours.cast<float>();
  from_bottom_ = header.from_bottom;
  // An encoded row begins with 2, 2 and its number of columns. A flat row may begin with 2, 2, too (a dark pixel), but
  // rarely goes on with that number.
  const std::string_view first = std::string_view(text).substr(header.size).substr(0, 4);
  has_runs_ = header.columns >= 8 && first.size() == 4 && first.starts_with("\x02\x02") &&
              256u * static_cast<unsigned char>(first[2]) + static_cast<unsigned char>(first[3]) == header.columns;
  // Find the position of each row.
  row_reader reader(*this, header.size);
  begins_.push_back(header.size);
  for (std::size_t row = 0; row < header.rows; ++row) {
    static_cast<void>(reader.next());
    begins_.push_back(reader.offset());
  }
  if (!reader.ended()) gonio::refuse({name_, ": ", size - reader.offset(), " bytes follow the end of the HDR file"});
}

GONIO_INLINE void hdr_rows::read(block rows, std::span<float> out) const {
  static const std::array<float, 256> factors = detail::rgbe_factors();
  const auto columns = static_cast<std::size_t>(columns_);
  const std::size_t across = has_runs_ ? 1 : 4,
                    along = has_runs_ ? columns : 1;  // `across`: to the next pixel; `along`: to the next channel
  // The rows in file order; if `from_bottom_`, the file's last row is the highest.
  const block stored = from_bottom_ ? block{this->rows() - rows.end, this->rows() - rows.begin} : rows;
  row_reader reader(*this, begins_.at(static_cast<std::size_t>(stored.begin)));
  for (Eigen::Index row = 0; row < stored.size(); ++row) {
    const std::span<const std::uint8_t> codes = reader.next();
    float* pixel = out.data() + 3 * columns_ * (from_bottom_ ? stored.size() - 1 - row : row);
    for (std::size_t i = 0; i < columns; ++i, pixel += 3) {
      const float factor = factors[codes[i * across + 3 * along]];
      for (std::size_t channel = 0; channel < 3; ++channel)
        pixel[channel] = static_cast<float>(codes[i * across + channel * along]) * factor;
      if (has_colours_) Eigen::Map<Eigen::Vector3f>{pixel} = (colours_ * Eigen::Map<Eigen::Vector3f>(pixel)).eval();
    }
  }
}

}  // namespace gonio::io
