#include "image_list.hpp"

#include "json.hpp"
#include <gonio/core/error.hpp>
#include <gonio/core/printable.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/text/text.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>

namespace cli {

namespace {

std::string shown(const json& value) { return gonio::printable(value.dump().substr(0, 120)); }

/// Refuses unknown keys: a misspelt entry would be silently lost.
void require_known(const json& object, std::initializer_list<std::string_view> known, const std::string& name) {
  for (const auto& [key, value] : object.items()) {
    if (std::ranges::find(known, key) == known.end())
      gonio::refuse({name, ": '", gonio::printable(key), "' is unknown in ", shown(object), ", expected one of ",
                     gonio::io::listed({known.begin(), known.size()}, ", ")});
  }
}

/// Reads the angles of some keys, in degrees, and returns them in radians; returns nothing if all keys are absent.
template <std::size_t Count>
std::optional<std::array<double, Count>> radians_of(const json& image, const std::array<const char*, Count>& keys,
                                                    const std::string& name) {
  std::array<double, Count> found{};
  if (std::ranges::none_of(keys, [&](const char* key) { return image.contains(key); })) return {};
  for (std::size_t i = 0; i < Count; ++i) {
    if (!image.contains(keys[i]) || !image[keys[i]].is_number() || !(std::abs(image[keys[i]].number()) <= 360.0))
      gonio::refuse({name, ": '", keys[i], "' must be an angle in degrees in ", shown(image)});
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

/// Reads the entries on texels outside the sample.
void read_outside(const json& text, const std::filesystem::path& path, image_list& list) {
  if (text.contains("mask")) {
    if (!text["mask"].is_string())
      gonio::refuse({path.string(), ": 'mask' must be the name of a PNG, black outside the sample"});
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
  const json text = json::read(std::string(gonio::io::as_text(bytes)));
  if (!text.is_object() || !text.contains("images") || !text["images"].is_array() || text["images"].empty())
    gonio::refuse({name, ": must be a JSON object whose 'images' is a list of at least one image"});
  require_known(text, {"quantity", "mask", "invalid", "images"}, name);
  image_list list;
  if (!text.contains("quantity") || !text["quantity"].is_string())
    gonio::refuse({name, ": 'quantity' must be brdf, brdf-cosine, reflectance-factor or percent"});
  const auto quantity = gonio::io::quantity_named(text["quantity"].text());
  if (!quantity)
    gonio::refuse({name, ": 'quantity' is '", gonio::printable(text["quantity"].text()),
                   "', expected brdf, brdf-cosine, reflectance-factor or percent"});
  list.quantity = *quantity;
  read_outside(text, path, list);
  for (const json& image : text["images"].elements()) {
    if (!image.is_object() || !image.contains("image") || !image["image"].is_string())
      gonio::refuse({name, ": 'image' is missing or not a string in ", shown(image)});
    require_known(image, {"image", "theta_i", "phi_i", "theta_o", "phi_o", "theta_h", "theta_d", "phi_d"}, name);
    list.images.push_back({path.parent_path() / image["image"].text(), directions_of(image, name)});
  }
  return list;
}

}  // namespace cli
