#include "image_rows.hpp"

#include "exr_files.hpp"
#include "radiance_image.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/hdr_rows.hpp>

#include <fcntl.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cli {

namespace {

/// An array of numbers, read from its file on demand.
class npy_rows : public image_rows {
 public:
  explicit npy_rows(const std::filesystem::path& path) : name_(path.string()), file_(gonio::io::open_to_read(path)) {
    const std::uint64_t size = gonio::io::size_of_regular(file_, path);
    std::vector<std::byte> start(std::min<std::uint64_t>(size, 1u << 16));
    read_exactly(0, start);
    std::span<const std::byte> rest(start);
    layout_ = gonio::io::read_npy_header(rest, name_);
    if (layout_.shape.size() != 3 || layout_.shape[2] != 3)
      gonio::refuse({name_, ": has shape ", gonio::io::npy_shape_text(layout_.shape), ", expected (rows, columns, 3)"});
    offset_ = start.size() - rest.size();
    if (size - offset_ != std::uint64_t{layout_.count} * layout_.word_size)
      gonio::refuse({name_, ": has ", size - offset_, " bytes of elements, expected ",
                     layout_.count * layout_.word_size, " for its shape"});
  }

  [[nodiscard]] Eigen::Index rows() const override { return static_cast<Eigen::Index>(layout_.shape[0]); }
  [[nodiscard]] Eigen::Index columns() const override { return static_cast<Eigen::Index>(layout_.shape[1]); }

  void will_read(gonio::block rows) const noexcept override {
#if defined(POSIX_FADV_WILLNEED)
    static_cast<void>(::posix_fadvise(file_.get(), static_cast<off_t>(place_of(rows.begin)),
                                      static_cast<off_t>(bytes_of_row()) * rows.size(), POSIX_FADV_WILLNEED));
#else
    static_cast<void>(rows);
#endif
  }

  void read(gonio::block rows, std::span<float> out) const override {
    if (layout_.word_size == sizeof(float)) {
      read_exactly(place_of(rows.begin), std::as_writable_bytes(out));
      return;
    }
    std::vector<std::byte> bytes(out.size() * layout_.word_size);
    read_exactly(place_of(rows.begin), bytes);
    if (layout_.word_size == sizeof(double))
      gonio::io::copy_elements<double>(bytes, out, name_);
    else
      gonio::io::copy_halves(bytes, out);
  }

 private:
  [[nodiscard]] std::uint64_t bytes_of_row() const noexcept { return layout_.shape[1] * 3 * layout_.word_size; }
  [[nodiscard]] std::uint64_t place_of(Eigen::Index row) const noexcept {
    return offset_ + static_cast<std::uint64_t>(row) * bytes_of_row();
  }
  void read_exactly(std::uint64_t offset, std::span<std::byte> bytes) const {
    if (gonio::io::read_at(file_, offset, bytes, name_) != bytes.size()) gonio::refuse({name_, ": is truncated"});
  }

  std::string name_;
  gonio::io::descriptor file_;
  gonio::io::npy_layout layout_;
  std::uint64_t offset_ = 0;  ///< position of the first number
};

}  // namespace

std::unique_ptr<image_rows> open_image(const std::filesystem::path& path) {
  const std::string format = radiance_format(path);
  if (format == ".npy") return std::make_unique<npy_rows>(path);
  if (format == ".exr") return open_exr(path);
  return std::make_unique<image_rows_of<gonio::io::hdr_rows>>(path);
}

}  // namespace cli
