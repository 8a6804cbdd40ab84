#include "chosen_networks.hpp"

#include <gonio/core/error.hpp>

#include <algorithm>

namespace cli {

namespace {

gonio::model::named_networks select(const gonio::model::named_networks& all, const std::vector<std::string>& names,
                                    const std::filesystem::path& file, bool wanted) {
  for (const std::string& name : names)
    if (std::ranges::find(all.names, name) == all.names.end())
      gonio::refuse({file.native(), ": there is no material named '", name, "'"});
  gonio::model::named_networks chosen;
  for (std::size_t i = 0; i < all.names.size(); ++i) {
    const bool listed = std::ranges::find(names, all.names[i]) != names.end();
    if (listed != wanted) continue;
    chosen.names.push_back(all.names[i]);
    chosen.networks.push_back(all.networks[i]);
  }
  return chosen;
}

}  // namespace

gonio::model::named_networks networks_in(const gonio::model::named_networks& all, const std::vector<std::string>& names,
                                         const std::filesystem::path& file) {
  return select(all, names, file, true);
}

gonio::model::named_networks networks_except(const gonio::model::named_networks& all,
                                             const std::vector<std::string>& names, const std::filesystem::path& file) {
  return select(all, names, file, false);
}

}  // namespace cli
