#include "scratch.hpp"
#include <gonio/io/materials/networks.hpp>

using gonio::io::read_networks;
using scratch::check_refused;

namespace {

xt::xtensor<float, 2> weights(std::size_t rows, std::size_t columns = 675) {
  xt::xtensor<float, 2> array(std::array<std::size_t, 2>{rows, columns});
  for (std::size_t i = 0; i < array.size(); ++i) array.data()[i] = 0.001f * static_cast<float>(i % 1000);
  return array;
}

}  // namespace

TEST_CASE("networks and names are read from files side by side") {
  const scratch::folder here;
  const auto array = weights(2);
  gonio::io::write_npy(here / "n.npy", array);
  scratch::put(here / "merl_names.txt", "red paint\r\n blue-cloth \n");
  scratch::put(here / "other.txt", "a\nb");
  const auto materials = read_networks(here / "n.npy");
  CHECK(materials.names == std::vector<std::string>{"red paint", "blue-cloth"});
  REQUIRE(materials.networks.size() == 2);
  CHECK(std::equal(array.data(), array.data() + 675, materials.networks[0].parameters().begin()));
  CHECK(std::equal(array.data() + 675, array.data() + 1350, materials.networks[1].parameters().begin()));
  CHECK(read_networks(here / "n.npy", here / "other.txt").names == std::vector<std::string>{"a", "b"});
}

TEST_CASE("bad network files are refused") {
  const scratch::folder here;
  scratch::put(here / "merl_names.txt", "a\nb\n");
  scratch::check_refuses_non_files([&](const auto& path) { return read_networks(path, here / "merl_names.txt"); });
  const auto refused = [&](const auto& array, std::initializer_list<std::string> words) {
    gonio::io::write_npy(here / "n.npy", array);
    check_refused([&] { return read_networks(here / "n.npy"); }, words);
  };
  refused(weights(2, 674), {"n.npy: ", "674 columns", "expected 675"});
  refused(weights(2, 676), {"n.npy: ", "676 columns", "expected 675"});
  refused(xt::xtensor<float, 1>(std::array<std::size_t, 1>{675}), {"n.npy: ", "(675,)", "expected 2 dimensions"});
  refused(weights(0), {"n.npy: ", "no network"});
  refused(weights(3), {"merl_names.txt: ", "2 names", "expected 3"});
  auto bad = weights(2);
  bad(1, 600) = std::numeric_limits<float>::quiet_NaN();
  refused(bad, {"n.npy: ", "column 600", "row 1", "(b)", "nan"});
  bad(1, 600) = -std::numeric_limits<float>::infinity();
  refused(bad, {"n.npy: ", "column 600", "row 1", "(b)", "inf"});
}

TEST_CASE("bad name files are refused") {
  const scratch::folder here;
  gonio::io::write_npy(here / "n.npy", weights(2));
  check_refused([&] { return read_networks(here / "n.npy"); }, {"merl_names.txt", "No such file"});
  scratch::check_refuses_non_files([&](const auto& path) { return read_networks(here / "n.npy", path); });
  const auto refused = [&](const std::string& names, std::initializer_list<std::string> words) {
    scratch::put(here / "merl_names.txt", names);
    check_refused([&] { return read_networks(here / "n.npy"); }, words);
  };
  refused("a\n\nb\n", {"merl_names.txt, line 2", "empty"});
  refused("a\na \n", {"merl_names.txt, line 2", "'a' appears twice"});
  refused("a\n", {"1 names", "expected 2"});
  refused("", {"0 names", "expected 2"});
}

TEST_CASE("damaged network files are read or refused") {
  const scratch::folder here;
  gonio::io::write_npy(here / "n.npy", weights(1));
  scratch::put(here / "merl_names.txt", "a\n");
  const auto valid = gonio::io::read_bytes(here / "n.npy");
  scratch::check_survives_damage(valid, 500, [&](auto bytes) {
    scratch::put(here / "n.npy", bytes);
    return read_networks(here / "n.npy");
  });
}

TEST_CASE("the networks of the MERL materials are read") {
  const scratch::fs::path path = GONIO_SHARED_DATA "/measured-materials/merl_networks.npy";
  if (!scratch::fs::exists(path)) {
    MESSAGE("skipped: " << path.string() << " is not here");
    return;
  }
  const auto materials = read_networks(path);
  CHECK(materials.networks.size() == 100);
  CHECK(materials.names.front() == "alum-bronze");
}
