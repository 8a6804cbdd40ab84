#pragma once
/// Bodies of io/materials/networks.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/materials/networks.hpp>
#include <gonio/model/network_brdf.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

GONIO_INLINE std::vector<std::string> read_names(const std::filesystem::path& path) {
  const auto bytes = read_bytes(path);
  std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::vector<std::string> names;
  std::set<std::string_view> seen;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view name = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    name.remove_prefix(std::min(name.find_first_not_of(" \t\r"), name.size()));
    name = name.substr(0, name.find_last_not_of(" \t\r") + 1);
    const std::string line_name = path.string() + ", line " + std::to_string(names.size() + 1) + ": ";
    if (name.empty()) gonio::refuse({line_name, "the name is empty"});
    if (!seen.insert(name).second) gonio::refuse({line_name, "the name '", std::string(name), "' appears twice"});
    names.emplace_back(name);
  }
  return names;
}

GONIO_INLINE model::named_networks read_networks(const std::filesystem::path& path,
                                                 const std::filesystem::path& names_path) {
  const xt::xtensor<float, 2> rows = read_npy<float, 2>(path);
  constexpr std::size_t columns = model::network_brdf::parameter_count;
  if (rows.shape(1) != columns) gonio::refuse({path.string(), ": has ", rows.shape(1), " columns, expected ", columns});
  if (rows.shape(0) == 0) gonio::refuse({path.string(), ": holds no network, expected at least one"});
  model::named_networks materials{read_names(names_path), {}};
  if (materials.names.size() != rows.shape(0))
    gonio::refuse({names_path.string(), ": has ", materials.names.size(), " names, expected ", rows.shape(0),
                   ", one for each network in ", path.string()});

  materials.networks.reserve(rows.shape(0));
  for (std::size_t i = 0; i < rows.shape(0); ++i) {
    const std::span<const float, columns> parameters(rows.data() + i * columns, columns);
    const auto bad = std::ranges::find_if(parameters, [](float value) { return !std::isfinite(value); });
    if (bad != parameters.end())
      gonio::refuse({path.string(), ": column ", bad - parameters.begin(), " of row ", i, " (", materials.names[i],
                     ") is ", *bad, ", expected a finite number"});
    materials.networks.emplace_back(parameters);
  }
  return materials;
}

}  // namespace gonio::io
