#pragma once
/// Bodies of io/materials/svbrdf_map.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/half.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/bytes/checked_file.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/solve/float_product.hpp>

#include <Eigen/Core>
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::io::detail {

inline constexpr checked_file_kind svbrdf_kind{"gonio-svbrdf", 1, "map of a spatially varying BRDF"};

/// Limits for a header: sizes are computed from it before the file is read.
inline constexpr std::uint32_t most_svbrdf_texels = 1u << 17, most_svbrdf_components = 1u << 12,
                               most_svbrdf_directions = 1u << 16;
inline constexpr std::uint64_t most_svbrdf_band = std::uint64_t{1} << 30;  ///< bytes
/// The size in bytes of the fields before the header itself: magic word, version and size of the header.
inline constexpr std::size_t svbrdf_start = 12 + 2 * sizeof(std::uint32_t);

[[nodiscard]] GONIO_INLINE std::uint64_t bytes_of_band(const svbrdf_header& header, Eigen::Index band) {
  const auto numbers = static_cast<std::uint64_t>(3 * header.functions.cols() + 2);
  return numbers * sizeof(std::uint16_t) * static_cast<std::uint64_t>(header.texels_of_band(band)) +
         sizeof(std::uint32_t);
}

[[nodiscard]] GONIO_INLINE std::uint64_t bytes_before_band(const svbrdf_header& header, Eigen::Index band) {
  return band == 0 ? 0
                   : static_cast<std::uint64_t>(band - 1) * bytes_of_band(header, 0) + bytes_of_band(header, band - 1);
}

/// Throws gonio::error starting with `name` if the header is invalid.
GONIO_INLINE void require_possible(const svbrdf_header& header, const std::string& name) {
  const auto require = [&](const char* what, Eigen::Index value, Eigen::Index most) {
    if (value < 1 || value > most) gonio::refuse({name, ": has ", value, " ", what, ", expected from 1 to ", most});
  };
  require("rows", header.rows, most_svbrdf_texels);
  require("columns", header.columns, most_svbrdf_texels);
  require("components", header.functions.rows(), most_svbrdf_components);
  require("functions", header.functions.cols(), most_svbrdf_components);
  if (!header.functions.allFinite()) gonio::refuse({name, ": a function's weight of a component is not finite"});
  require("rows in a band", header.band_rows, header.rows);
  require("directions", std::ssize(header.directions), most_svbrdf_directions);
  if (bytes_of_band(header, 0) > most_svbrdf_band)
    gonio::refuse({name, ": a band of ", bytes_of_band(header, 0), " bytes, expected at most ", most_svbrdf_band});
  if (!(header.eta > 0.0 && std::isfinite(header.eta)))
    gonio::refuse({name, ": eta is ", header.eta, ", expected a positive number"});
  for (const direction_pair& pair : header.directions)
    for (const direction* w : {&pair.wi, &pair.wo})
      if (!(w->allFinite() && w->z() > 0.0)) gonio::refuse({name, ": a direction is not above the horizon"});
}

/// Returns all bytes before the first band. Their number is a multiple of 64; the last four are a checksum of the bytes
/// before them.
[[nodiscard]] GONIO_INLINE std::vector<std::byte> write_svbrdf_header(const svbrdf_header& header) {
  byte_writer own;
  for (const Eigen::Index each : {header.rows, header.columns, header.band_rows, std::ssize(header.directions),
                                  header.functions.rows(), header.functions.cols()})
    own.write(static_cast<std::uint32_t>(each));
  own.write(header.prior_checksum);
  own.write(header.eta);
  own.write_text(header.prior_source);
  for (const direction_pair& pair : header.directions)
    for (const direction* w : {&pair.wi, &pair.wo}) own.write_bytes(w->data(), 3 * sizeof(double));
  own.write_bytes(header.functions.data(), static_cast<std::size_t>(header.functions.size()) * sizeof(float));
  const std::size_t used = svbrdf_start + own.bytes().size() + sizeof(std::uint32_t);
  const std::vector<std::byte> padding((64 - used % 64) % 64);
  own.write_all(std::span<const std::byte>(padding));
  byte_writer all;
  all.write_bytes(svbrdf_kind.magic.data(), svbrdf_kind.magic.size());
  all.write(svbrdf_kind.version);
  all.write(static_cast<std::uint32_t>(own.bytes().size() + sizeof(std::uint32_t)));
  all.write_all(own.bytes());
  all.write(checksum(all.bytes()));
  return std::move(all).bytes();
}

[[nodiscard]] GONIO_INLINE svbrdf_header read_svbrdf_header(std::span<const std::byte> bytes, const std::string& name) {
  byte_reader in(bytes.first(bytes.size() - sizeof(std::uint32_t)), name);
  static_cast<void>(in.read_bytes(svbrdf_start));
  svbrdf_header header;
  header.rows = in.read<std::uint32_t>();
  header.columns = in.read<std::uint32_t>();
  header.band_rows = in.read<std::uint32_t>();
  const auto count = in.read<std::uint32_t>();
  const auto components = in.read<std::uint32_t>(), functions = in.read<std::uint32_t>();
  header.prior_checksum = in.read<std::uint32_t>();
  header.eta = in.read<double>();
  header.prior_source = in.read_text();
  const auto numbers = in.read_all<double>(6 * std::size_t{count});
  for (std::size_t i = 0; i < numbers.size(); i += 6)
    header.directions.push_back(
        {{numbers[i], numbers[i + 1], numbers[i + 2]}, {numbers[i + 3], numbers[i + 4], numbers[i + 5]}});
  if (components > most_svbrdf_components || functions > most_svbrdf_components)
    gonio::refuse({name, ": ", functions, " functions of ", components, " components, expected at most ",
                   most_svbrdf_components});
  const auto weights = in.read_all<float>(std::size_t{components} * functions);
  header.functions = Eigen::Map<const Eigen::MatrixXf>(weights.data(), components, functions);
  require_possible(header, name);
  return header;
}

/// Returns `count` bytes of a file from an offset on, fewer if the file ends first.
[[nodiscard]] GONIO_INLINE std::vector<std::byte> bytes_at(const descriptor& file, std::uint64_t offset,
                                                           std::size_t count, const std::filesystem::path& path) {
  std::vector<std::byte> bytes(count);
  bytes.resize(read_at(file, offset, bytes, path));
  return bytes;
}

/// Are the last four bytes of a band or header the checksum of the bytes before them?
[[nodiscard]] GONIO_INLINE bool is_whole_band(std::span<const std::byte> bytes) {
  std::uint32_t expected = 0;
  if (bytes.size() < sizeof expected) return false;
  const auto own = bytes.first(bytes.size() - sizeof expected);
  std::memcpy(&expected, bytes.data() + own.size(), sizeof expected);
  return checksum(own) == expected;
}

/// Rounds numbers to half floats. Throws gonio::error naming a number outside their range.
template <class Numbers>
void to_halves(const Numbers& numbers, std::vector<std::uint16_t>& halves, thread_count threads) {
  halves.resize(static_cast<std::size_t>(numbers.size()));
  for_each_block(
      numbers.size(), Eigen::Index{1} << 16,
      [&](block range) {
        for (Eigen::Index i = range.begin; i < range.end; ++i) {
          const float value = numbers.data()[i];
          if (!(std::abs(value) < 65504.0f))
            gonio::refuse(
                {"a number of the map is ", double{value}, ", outside the range of half floats, -65504 to 65504"});
          halves[static_cast<std::size_t>(i)] = to_half(value);
        }
      },
      threads);
}

/// Zeros mean that a texel is outside the sample. If a texel of the sample has an uncertainty or only weights that
/// round to zero, sets the uncertainty or the first weight to the smallest half float, 6e-8.
GONIO_INLINE void keep_materials(const texel_estimates& found, svbrdf_band& band) {
  const std::size_t own = band.weights.size() / std::max<std::size_t>(band.uncertainty.size(), 1);
  for (std::size_t i = 0; i < band.uncertainty.size(); ++i) {
    if (found.uncertainty[static_cast<Eigen::Index>(i)] == 0.0f) continue;
    band.uncertainty[i] = std::max<std::uint16_t>(band.uncertainty[i], 1);
    const std::span<std::uint16_t> weights(band.weights.data() + i * own, own);
    if (std::ranges::all_of(weights, [](std::uint16_t each) { return each == 0; })) weights.front() = 1;
  }
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE std::uint32_t checksum_of(const log_relative_pca& prior) {
  uLong sum = 0;
  const auto add = [&](std::span<const float> values) {
    sum = crc32_z(sum, reinterpret_cast<const unsigned char*>(values.data()), values.size_bytes());  // NOLINT
  };
  add({prior.components().data(), static_cast<std::size_t>(prior.components().size())});
  add(prior.mean());
  add(prior.metric().reference());
  return static_cast<std::uint32_t>(sum);
}

GONIO_INLINE std::uint32_t checksum_of(const svbrdf_header& header) {
  const auto bytes = detail::write_svbrdf_header(header);
  std::uint32_t sum = 0;
  std::memcpy(&sum, bytes.data() + bytes.size() - sizeof sum, sizeof sum);
  return sum;
}

GONIO_INLINE Eigen::Index rows_of_band(Eigen::Index columns) noexcept {
  return std::max<Eigen::Index>(1, 16384 / std::max<Eigen::Index>(columns, 1));
}

GONIO_INLINE svbrdf_band as_halves(const texel_estimates& found, thread_count threads) {
  svbrdf_band band;
  detail::to_halves(found.weights, band.weights, threads);
  detail::to_halves(found.uncertainty, band.uncertainty, threads);
  detail::to_halves(found.disagreement, band.disagreement, threads);
  detail::keep_materials(found, band);
  return band;
}

GONIO_INLINE std::vector<std::byte> write_band(const svbrdf_header& header, Eigen::Index band,
                                               const svbrdf_band& values) {
  const auto texels = static_cast<std::size_t>(header.texels_of_band(band));
  const auto functions = static_cast<std::size_t>(header.functions.cols());
  if (values.weights.size() != 3 * texels * functions || values.uncertainty.size() != texels ||
      values.disagreement.size() != texels)
    gonio::refuse({"band ", band, " of ", values.uncertainty.size(), " texels of a map has ", values.weights.size(),
                   " weights, expected ", texels, " texels of ", functions, " functions"});
  byte_writer out;
  for (const auto* numbers : {&values.weights, &values.uncertainty, &values.disagreement})
    out.write_all(std::span<const std::uint16_t>(*numbers));
  out.write(checksum(out.bytes()));
  return std::move(out).bytes();
}

GONIO_INLINE Eigen::MatrixXd weights_of_texel(const svbrdf_header& header, const svbrdf_band& band,
                                              Eigen::Index texel) {
  Eigen::MatrixXf own(header.functions.cols(), 3);
  for (Eigen::Index i = 0; i < own.size(); ++i) own.data()[i] = from_half(band.weights.at(texel * own.size() + i));
  return product(header.functions, own).cast<double>();
}

// ---- writing -----------------------------------------------------------------------------------

GONIO_INLINE svbrdf_writer::svbrdf_writer(const std::filesystem::path& path, const svbrdf_header& header)
    : path_(path), target_(follow_links(path)), part_(target_), header_(header) {
  part_ += ".part";
  detail::require_possible(header, path.string());
  if (std::filesystem::is_directory(target_)) refuse_file(path, "cannot be written: it is a directory");
  const std::vector<std::byte> head = detail::write_svbrdf_header(header);
  head_size_ = head.size();
  open();
  resume(head);
}

GONIO_INLINE void svbrdf_writer::open() {
  // Without O_NONBLOCK, opening a pipe without a reader would wait forever.
  file_ = descriptor(::open(part_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NONBLOCK, 0666));
  if (!file_.is_open()) fail();
  static_cast<void>(size_of_regular(file_, part_));
  const bool is_locked = ::flock(file_.get(), LOCK_EX | LOCK_NB) == 0;
  if (!is_locked && errno != EWOULDBLOCK) fail();
  // Another process may have finished and renamed the file since this one opened it.
  struct stat opened {
  }, named{};
  const bool is_ours = ::fstat(file_.get(), &opened) == 0 && ::stat(part_.c_str(), &named) == 0 &&
                       opened.st_ino == named.st_ino && opened.st_dev == named.st_dev;
  if (!is_locked || !is_ours) gonio::refuse({path_.string(), ": another process is writing it"});
}

GONIO_INLINE void svbrdf_writer::resume(std::span<const std::byte> head) {
  const auto begun = detail::bytes_at(file_, 0, head.size(), part_);
  if (!std::ranges::equal(begun, head.first(begun.size())))
    gonio::refuse({part_.string(),
                   ": belongs to another job (other image sizes, directions, prior or eta): remove it, "
                   "or write to another file"});
  std::uint64_t end = head.size();
  if (begun.size() < head.size()) {
    if (::lseek(file_.get(), static_cast<off_t>(begun.size()), SEEK_SET) < 0) fail();
    write(head.subspan(begun.size()));
  } else {
    for (; finished_ < header_.bands(); ++finished_) {
      const std::uint64_t size = detail::bytes_of_band(header_, finished_);
      const auto band = detail::bytes_at(file_, end, static_cast<std::size_t>(size), part_);
      if (band.size() != size || !detail::is_whole_band(band)) break;
      end += size;
    }
  }
  if (::ftruncate(file_.get(), static_cast<off_t>(end)) != 0) fail();
  if (::lseek(file_.get(), static_cast<off_t>(end), SEEK_SET) < 0) fail();
}

GONIO_INLINE bool svbrdf_writer::has_written(Eigen::Index band, std::span<const std::byte> bytes) const {
  const auto written =
      detail::bytes_at(file_, head_size_ + detail::bytes_before_band(header_, band), bytes.size(), part_);
  return std::ranges::equal(written, bytes);
}

GONIO_INLINE void svbrdf_writer::require_unfinished() const {
  if (finished_ == header_.bands()) gonio::refuse({path_.string(), ": all ", finished_, " bands are already written"});
}

GONIO_INLINE void svbrdf_writer::append(const svbrdf_band& values) {
  require_unfinished();
  append(write_band(header_, finished_, values));
}

GONIO_INLINE void svbrdf_writer::append(std::span<const std::byte> bytes) {
  require_unfinished();
  const std::uint64_t expected = detail::bytes_of_band(header_, finished_);
  if (bytes.size() != expected || !detail::is_whole_band(bytes))
    gonio::refuse({path_.string(), ": band ", finished_, " is damaged or does not have ", expected, " bytes"});
  write(bytes);
  ++finished_;
}

GONIO_INLINE void svbrdf_writer::write(std::span<const std::byte> bytes) {
  if (!write_all(file_, bytes)) fail();
}

GONIO_INLINE void svbrdf_writer::commit() {
  if (finished_ != header_.bands())
    gonio::refuse({path_.string(), ": has ", finished_, " of ", header_.bands(), " bands, it is not finished"});
  if (::fsync(file_.get()) != 0 && errno != EINVAL) fail();
  if (::rename(part_.c_str(), target_.c_str()) != 0) fail();
}

[[gnu::cold]] GONIO_INLINE void svbrdf_writer::fail() const {
  const std::string reason = system_reason(errno);
  if (finished_ == 0) refuse_file(part_, {"cannot be written: ", reason});
  refuse_file(part_, {"cannot be written: ", reason, "; the first ", finished_, " of ", header_.bands(),
                      " bands are kept, and the same job continues after them"});
}

// ---- reading -----------------------------------------------------------------------------------

GONIO_INLINE svbrdf_map::svbrdf_map(const std::filesystem::path& path) : path_(path), file_(open_to_read(path)) {
  const std::string name = path.string();
  const std::uint64_t size = size_of_regular(file_, path);
  const auto start = detail::bytes_at(file_, 0, detail::svbrdf_start, path);
  byte_reader in(start, name);
  detail::read_kind(detail::svbrdf_kind, in, name);
  head_size_ = detail::svbrdf_start + in.read<std::uint32_t>();
  if (head_size_ > size) gonio::refuse({name, ": its header is truncated"});
  const auto head = detail::bytes_at(file_, 0, static_cast<std::size_t>(head_size_), path);
  if (!detail::is_whole_band(head))
    gonio::refuse({name, ": the header's checksum does not match, the file is damaged"});
  header_ = detail::read_svbrdf_header(head, name);
  const std::uint64_t expected = head_size_ + detail::bytes_before_band(header_, header_.bands());
  if (size != expected)
    gonio::refuse({name, ": has ", size, " bytes, expected ", expected, " for ", header_.columns, " x ", header_.rows,
                   " texels of ", header_.functions.cols(), " functions"});
}

GONIO_INLINE svbrdf_band svbrdf_map::read_band(Eigen::Index band) const {
  const std::string name = path_.string();
  if (band < 0 || band >= header_.bands())
    gonio::refuse({name, ": has no band ", band, ", it has ", header_.bands(), " bands"});
  const auto size = static_cast<std::size_t>(detail::bytes_of_band(header_, band));
  const auto bytes = detail::bytes_at(file_, head_size_ + detail::bytes_before_band(header_, band), size, path_);
  if (bytes.size() != size || !detail::is_whole_band(bytes))
    gonio::refuse({name, ": the checksum of band ", band, " does not match, the file is damaged"});
  byte_reader in(bytes, name);
  const auto texels = static_cast<std::size_t>(header_.texels_of_band(band));
  svbrdf_band values;
  values.weights = in.read_all<std::uint16_t>(3 * texels * static_cast<std::size_t>(header_.functions.cols()));
  values.uncertainty = in.read_all<std::uint16_t>(texels);
  values.disagreement = in.read_all<std::uint16_t>(texels);
  return values;
}

GONIO_INLINE void svbrdf_map::require_prior(const log_relative_pca& prior) const {
  if (header_.functions.rows() != prior.size() || header_.prior_checksum != checksum_of(prior))
    gonio::refuse({path_.string(), ": was made with another prior, learned from '", header_.prior_source, "'"});
}

GONIO_INLINE bool is_svbrdf_map(const std::filesystem::path& path) { return is_of_kind(detail::svbrdf_kind, path); }

}  // namespace gonio::io
