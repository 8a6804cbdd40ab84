#include "cli/image_stack.hpp"

#include "command_line/json.hpp"
#include <gonio/core/error.hpp>
#include <gonio/core/finite.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/image.hpp>
#include <gonio/io/text.hpp>
#include <gonio/table/stored_codes.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <span>

namespace cli {

namespace {

// ---- the list ----------------------------------------------------------------------------------

std::string shown(const json& value) { return gonio::printable(value.dump().substr(0, 120)); }

/// The degrees of some keys in radians, or nothing if the image has none of them.
template <std::size_t Count>
std::optional<std::array<double, Count>> radians_of(const json& image, const std::array<const char*, Count>& keys,
                                                    const std::string& name) {
  std::array<double, Count> found{};
  if (std::ranges::none_of(keys, [&](const char* key) { return image.contains(key); })) return {};
  for (std::size_t i = 0; i < Count; ++i) {
    if (!image.contains(keys[i]) || !image[keys[i]].is_number() || !(std::abs(image[keys[i]].number()) <= 360.0))
      gonio::refuse({name, ": '", keys[i], "' must be degrees in ", shown(image)});
    found[i] = gonio::radians(image[keys[i]].number());
  }
  return found;
}

gonio::direction_pair directions_of(const json& image, const std::string& name) {
  const auto apart = radians_of<4>(image, {"theta_i", "phi_i", "theta_o", "phi_o"}, name);
  const auto half = radians_of<3>(image, {"theta_h", "theta_d", "phi_d"}, name);
  if (apart.has_value() == half.has_value())
    gonio::refuse(
        {name, ": an image needs theta_i, phi_i, theta_o and phi_o, or theta_h, theta_d and phi_d, in ", shown(image)});
  const gonio::direction_pair pair = half ? gonio::to_directions({(*half)[0], (*half)[1], (*half)[2]})
                                          : gonio::direction_pair{gonio::spherical_direction((*apart)[0], (*apart)[1]),
                                                                  gonio::spherical_direction((*apart)[2], (*apart)[3])};
  if (!(pair.wi.z() > 1e-6 && pair.wo.z() > 1e-6))
    gonio::refuse({name, ": a direction is not above the horizon in ", shown(image)});
  return pair;
}

/// What a list says of texels that are not of the sample.
void read_outside(const json& text, const std::filesystem::path& path, image_list& list) {
  if (text.contains("mask")) {
    if (!text["mask"].is_string())
      gonio::refuse({path.string(), ": 'mask' must be the name of a PNG, black where texels are not of the sample"});
    list.mask = path.parent_path() / text["mask"].text();
  }
  if (!text.contains("invalid")) return;
  if (!text["invalid"].is_string() || (text["invalid"].text() != "skip" && text["invalid"].text() != "refuse"))
    gonio::refuse({path.string(), ": 'invalid' must be \"refuse\" or \"skip\", not ", shown(text["invalid"])});
  list.skips_invalid = text["invalid"].text() == "skip";
}

}  // namespace

image_list read_image_list(const std::filesystem::path& path) {
  const std::string name = path.string();
  const auto bytes = gonio::io::read_bytes(path);
  const json text = json::parse(std::string(gonio::io::detail::as_text(bytes)));
  if (!text.is_object() || !text.contains("images") || !text["images"].is_array() || text["images"].empty())
    gonio::refuse({name, ": must be a JSON object whose 'images' is a list with an image at least"});
  image_list list;
  if (!text.contains("quantity") || !text["quantity"].is_string())
    gonio::refuse(
        {name, ": 'quantity' must say what the numbers are: brdf, brdf-cosine, reflectance-factor or percent"});
  const auto quantity = gonio::io::quantity_named(text["quantity"].text());
  if (!quantity)
    gonio::refuse({name, ": 'quantity' is '", gonio::printable(text["quantity"].text()),
                   "', expected brdf, brdf-cosine, reflectance-factor or percent"});
  list.quantity = *quantity;
  read_outside(text, path, list);
  for (const json& image : text["images"].elements()) {
    if (!image.is_object() || !image.contains("image") || !image["image"].is_string())
      gonio::refuse({name, ": 'image' is missing or no text in ", shown(image)});
    list.images.push_back({path.parent_path() / image["image"].text(), directions_of(image, name)});
  }
  return list;
}

// ---- the images --------------------------------------------------------------------------------

namespace {

/// A file that vanishes with its process.
gonio::io::detail::descriptor unnamed_file(const std::filesystem::path& folder) {
  gonio::io::detail::descriptor file;
#if defined(O_TMPFILE)
  file = gonio::io::detail::descriptor(::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600));
#endif
  if (!file.is_open()) {
    std::string name = (folder / ".gonio-images-XXXXXX").string();
    file = gonio::io::detail::descriptor(::mkstemp(name.data()));
    if (file.is_open()) ::unlink(name.c_str());
  }
  if (!file.is_open())
    gonio::io::detail::refuse_file(folder, {"cannot be written: ", gonio::io::detail::system_reason(errno)});
  return file;
}

void keep_decoded(const gonio::io::detail::descriptor& file, std::span<const std::byte> bytes, const std::string& name,
                  const std::filesystem::path& folder) {
  if (!gonio::io::detail::write_all(file, bytes))
    gonio::io::detail::refuse_file(
        folder,
        {"the decoded ", name, " cannot be written into this folder: ", gonio::io::detail::system_reason(errno)});
}

/// All of the bytes, or a refusal.
void read_exactly(const gonio::io::detail::descriptor& file, std::uint64_t offset, std::span<std::byte> bytes,
                  const std::string& name) {
  if (gonio::io::detail::read_at(file, offset, bytes, name) != bytes.size()) gonio::refuse({name, ": is truncated"});
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
  if (!list.mask.empty()) mask_ = decode_mask(list.mask, folder);
}

void image_stack::require_size(const std::string& name, Eigen::Index rows, Eigen::Index columns) const {
  if (rows < 1 || columns < 1) gonio::refuse({name, ": has no texel"});
  if (rows != rows_ || columns != columns_)
    gonio::refuse({name, ": has ", columns, " x ", rows, " pixels, but ", sources_.front().name, " has ", columns_,
                   " x ", rows_});
}

image_stack::decoded_mask image_stack::decode_mask(const std::filesystem::path& path,
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
