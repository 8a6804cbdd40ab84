#include "image_stack.hpp"

#include <gonio/core/error.hpp>
#include <gonio/core/finite.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/table/stored_codes.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>

namespace cli {

namespace {

/// Opens a file without a name, which vanishes with the process.
gonio::io::descriptor unnamed_file(const std::filesystem::path& folder) {
  gonio::io::descriptor file;
#if defined(O_TMPFILE)
  file = gonio::io::descriptor(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
#endif
  if (!file.is_open()) {
    std::string name = (folder / ".gonio-images-XXXXXX").string();
    file = gonio::io::descriptor(::mkstemp(name.data()));
    if (file.is_open()) ::unlink(name.c_str());
  }
  if (!file.is_open()) gonio::io::refuse_file(folder, {"cannot be written: ", gonio::io::system_reason(errno)});
  return file;
}

void keep_decoded(const gonio::io::descriptor& file, std::span<const std::byte> bytes, const std::string& name,
                  const std::filesystem::path& folder) {
  if (!gonio::io::write_all(file, bytes))
    gonio::io::refuse_file(
        folder, {"the decoded ", name, " cannot be written into this folder: ", gonio::io::system_reason(errno)});
}

/// Reads all bytes; throws gonio::error if the file is shorter.
void read_exactly(const gonio::io::descriptor& file, std::uint64_t offset, std::span<std::byte> bytes,
                  const std::string& name) {
  if (gonio::io::read_at(file, offset, bytes, name) != bytes.size()) gonio::refuse({name, ": is truncated"});
}

}  // namespace

image_stack::image_stack(const image_list& list, const std::filesystem::path& folder)
    : skips_invalid_(list.skips_invalid) {
  for (const listed_image& image : list.images) {
    sources_.push_back({image.file.string(), open_image(image.file),
                        static_cast<float>(gonio::io::brdf_factor(list.quantity, image.at.wo))});
    const image_rows& opened = *sources_.back().image;
    if (sources_.size() == 1) {
      rows_ = opened.rows();
      columns_ = opened.columns();
    }
    require_size(image.file.string(), opened.rows(), opened.columns());
  }
  if (!list.mask.empty()) mask_ = read_mask(list.mask, folder);
}

void image_stack::require_size(const std::string& name, Eigen::Index rows, Eigen::Index columns) const {
  if (rows < 1 || columns < 1) gonio::refuse({name, ": has no texels"});
  if (rows != rows_ || columns != columns_)
    gonio::refuse({name, ": has ", columns, " x ", rows, " pixels, but ", sources_.front().name, " has ", columns_,
                   " x ", rows_});
}

image_stack::decoded_mask image_stack::read_mask(const std::filesystem::path& path,
                                                 const std::filesystem::path& folder) const {
  const gonio::stored_codes pixels = gonio::io::read_png_codes(path);
  decoded_mask mask{path.string(), unnamed_file(folder)};
  require_size(mask.name, static_cast<Eigen::Index>(pixels.rows), static_cast<Eigen::Index>(pixels.columns));
  std::vector<std::uint8_t> outside;
  for (auto pixel = pixels.values.begin(); pixel != pixels.values.end(); pixel += 3)
    outside.push_back(std::all_of(pixel, pixel + 3, [](std::uint16_t code) { return code == 0; }) ? 1 : 0);
  keep_decoded(mask.file, std::as_bytes(std::span(outside)), mask.name, folder);
  return mask;
}

std::vector<std::uint8_t> image_stack::masked(gonio::block rows) const {
  std::vector<std::uint8_t> outside(static_cast<std::size_t>(columns_ * rows.size()));
  if (mask_)
    read_exactly(mask_->file, static_cast<std::uint64_t>(columns_ * rows.begin),
                 std::as_writable_bytes(std::span(outside)), mask_->name);
  return outside;
}

void image_stack::mark_invalid(const source& image, const Eigen::Ref<const Eigen::VectorXf>& values,
                               Eigen::Index first_row, std::vector<std::uint8_t>& outside) const {
  if (gonio::all_finite(std::span(values.data(), static_cast<std::size_t>(values.size())))) return;
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    std::uint8_t& is_outside = outside[static_cast<std::size_t>(i / 3)];
    if (is_outside != 0 || std::isfinite(values[i])) continue;
    if (!skips_invalid_)
      gonio::refuse({image.name, ": pixel (row ", first_row + i / 3 / columns_, ", column ", i / 3 % columns_,
                     ") is not a finite number: mask it, or skip such texels with \"invalid\": \"skip\" in the list"});
    is_outside = 1;
  }
}

void image_stack::will_read(gonio::block rows) const noexcept {
  for (const source& each : sources_) each.image->will_read(rows);
}

texel_values image_stack::read(gonio::block rows, gonio::thread_count threads) const {
  texel_values all{Eigen::MatrixXf(3 * columns_ * rows.size(), std::ssize(sources_)), {}};
  gonio::for_each_index(
      std::ssize(sources_), 1,
      [&](Eigen::Index i) {
        const source& from = sources_[static_cast<std::size_t>(i)];
        auto values = all.reflectance.col(i);
        from.image->read(rows, {values.data(), static_cast<std::size_t>(values.size())});
        if (from.factor != 1.0f) values *= from.factor;
      },
      threads);
  std::vector<std::uint8_t> outside = masked(rows);
  for (Eigen::Index i = 0; i < std::ssize(sources_); ++i)
    mark_invalid(sources_[static_cast<std::size_t>(i)], all.reflectance.col(i), rows.begin, outside);
  for (Eigen::Index texel = 0; texel < std::ssize(outside); ++texel) {
    if (outside[static_cast<std::size_t>(texel)] == 0) continue;
    all.outside.push_back(texel);
    all.reflectance.middleRows(3 * texel, 3).setZero();
  }
  return all;
}

}  // namespace cli
