#include "scratch.hpp"
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/merl_gzip.hpp>

#include <rapidcheck.h>
#include <zlib.h>

using gonio::cell_anchor;
using gonio::grid_extents;
using gonio::infer_convention;
using gonio::table_convention;
using gonio::io::merl_options;
using gonio::io::read_merl;
using gonio::io::read_merl_any;
using gonio::io::write_merl;
using scratch::check_refused;

namespace {

constexpr grid_extents small{5, 4, 6};

/// A table of distinct values, some of them negative.
gonio::brdf_table numbered_table(const gonio::valid_cells& cells, float scale = 0.01f) {
  gonio::brdf_table table(cells);
  for (std::size_t i = 0; i < table.values().size(); ++i) table.values()[i] = scale * (static_cast<float>(i) - 7.3f);
  return table;
}

std::vector<std::byte> merl_bytes(const std::vector<std::int32_t>& header, const std::vector<double>& values) {
  std::string text(reinterpret_cast<const char*>(header.data()), header.size() * sizeof(std::int32_t));
  text.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  return scratch::bytes_of(text);
}

std::vector<std::byte> small_bytes() { return merl_bytes({5, 4, 6}, std::vector<double>(3 * 5 * 4 * 6, 1500.0)); }

void compress_file(const scratch::fs::path& from, const scratch::fs::path& to) {
  const std::string content = scratch::get(from);
  const gzFile file = gzopen(to.c_str(), "wb1");
  REQUIRE(file != nullptr);
  REQUIRE(gzwrite(file, content.data(), static_cast<unsigned>(content.size())) == static_cast<int>(content.size()));
  REQUIRE(gzclose(file) == Z_OK);
}

}  // namespace

TEST_CASE("values, planes and scales are MERL's") {
  // A plane for each channel, phi_d fastest: each value is its index in the file.
  std::vector<double> values(3 * 5 * 4 * 6);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<double>(i);
  const auto table = read_merl(merl_bytes({5, 4, 6}, values), "x");
  const auto& cells = table.cells();
  CHECK(cells.grid().extents() == small);
  CHECK(cells.grid().anchor() == cell_anchor::centre);
  for (Eigen::Index cell = 0; cell < cells.size(); ++cell) {
    const auto linear = static_cast<double>(cells.linear(cell));
    CHECK(table.at(cell).x() == doctest::Approx(linear / 1500.0));
    CHECK(table.at(cell).y() == doctest::Approx((linear + 120.0) * 1.15 / 1500.0));
    CHECK(table.at(cell).z() == doctest::Approx((linear + 240.0) * 1.66 / 1500.0));
  }
}

TEST_CASE("a written table is read back equal and written again with the same bytes") {
  const scratch::folder here;
  CHECK(rc::check("merl round trip", [&] {
    const auto extent = [] { return *rc::gen::inRange(1, 9); };
    const grid_extents extents{extent(), extent(), extent()};
    const auto anchor = *rc::gen::element(cell_anchor::centre, cell_anchor::lower_corner);
    const double minimum = *rc::gen::element(0.0, 0.02, 0.1);
    const gonio::grid grid(extents, anchor);
    std::optional<gonio::valid_cells> cells;
    try {
      cells.emplace(grid, minimum);
    } catch (const gonio::error&) {
      RC_DISCARD("no cell is valid");
    }
    gonio::brdf_table table(*cells);
    for (float& value : table.values()) value = *rc::gen::arbitrary<float>();
    for (float& value : table.values()) value = std::isfinite(value) ? value : 0.0f;

    write_merl(here / "a", table);
    const auto again = read_merl(here / "a");
    write_merl(here / "b", again);
    RC_ASSERT(scratch::get(here / "a") == scratch::get(here / "b"));
    const auto forced = read_merl(here / "a", {table_convention{anchor, minimum}, {}});
    RC_ASSERT(forced.cells() == table.cells());
    RC_ASSERT(std::ranges::equal(forced.values(), table.values()));
  }));
}

TEST_CASE("cells below the horizon are written as -1 and ignored when read") {
  const scratch::folder here;
  const auto table = numbered_table(gonio::valid_cells(gonio::grid(small)));
  write_merl(here / "a", table);
  CHECK(scratch::fs::file_size(here / "a") == 12 + 24 * 5 * 4 * 6);
  std::string bytes = scratch::get(here / "a");
  std::vector<double> planes(3 * 120);
  std::memcpy(planes.data(), bytes.data() + 12, planes.size() * sizeof(double));
  std::size_t marked = 0;
  for (std::size_t linear = 0; linear < 120; ++linear) {
    const bool mark = planes[linear] == -1.0 && planes[120 + linear] == -1.0 && planes[240 + linear] == -1.0;
    CHECK(mark == !table.cells().contains(linear));
    if (!mark) continue;
    ++marked;
    planes[linear] = std::numeric_limits<double>::quiet_NaN();
  }
  CHECK(marked == 120 - table.cells().size());
  const auto again = read_merl(merl_bytes({5, 4, 6}, planes), "x");
  CHECK(again.cells() == table.cells());
  CHECK(std::ranges::equal(again.values(), table.values()));
}

TEST_CASE("any brdf can be written") {
  struct grey {
    gonio::rgb operator()(const gonio::direction& wi, const gonio::direction& wo) const noexcept {
      return gonio::rgb::Constant(wi.z() > 0.0 && wo.z() > 0.0 ? 0.25 : 0.0);
    }
  };
  struct fitted : grey {
    gonio::brdf_table tabulate(const gonio::valid_cells& cells) const {
      gonio::brdf_table table(cells);
      std::ranges::fill(table.values(), 0.5f);
      return table;
    }
  };
  const scratch::folder here;
  const gonio::valid_cells cells{gonio::grid(small)};
  write_merl(here / "a", grey(), cells);
  CHECK(std::ranges::all_of(read_merl(here / "a").values(), [](float v) { return v == 0.25f; }));
  write_merl(here / "a", fitted(), cells);
  CHECK(std::ranges::all_of(read_merl(here / "a").values(), [](float v) { return v == 0.5f; }));
}

TEST_CASE("the convention is inferred from the marks") {
  const auto marks_of = [](const gonio::valid_cells& cells) {
    return infer_convention(cells.grid().extents(), [&](std::size_t linear) { return !cells.contains(linear); });
  };
  const gonio::grid centre({30, 30, 60}), corner({30, 30, 60}, cell_anchor::lower_corner);
  CHECK(marks_of(gonio::valid_cells(centre)) == table_convention{cell_anchor::centre, 0.0});
  CHECK(marks_of(gonio::valid_cells(corner)) == table_convention{cell_anchor::lower_corner, 0.0});
  const auto raised = marks_of(gonio::valid_cells(corner, 0.05));
  CHECK(raised.anchor == cell_anchor::lower_corner);
  CHECK(raised.minimum_cosine == doctest::Approx(0.05).epsilon(0.02));
  const auto raised_centre = marks_of(gonio::valid_cells(centre, 0.05));
  CHECK(raised_centre.anchor == cell_anchor::centre);
  CHECK(raised_centre.minimum_cosine == doctest::Approx(0.05).epsilon(0.02));

  const table_convention fallback{cell_anchor::centre, 0.0};
  CHECK(infer_convention({30, 30, 60}, [](std::size_t) { return false; }) == fallback);
  CHECK(infer_convention({30, 30, 60}, [](std::size_t) { return true; }) == fallback);
  CHECK(infer_convention({30, 30, 60}, [](std::size_t linear) { return linear % 2 == 0; }) == fallback);
}

TEST_CASE("a mark on a cell at the horizon, up to rounding, does not hide the convention") {
  // theta_h = 22.5, theta_d = 67.5, phi_d = 0 degrees: wi is on the horizon, whichever way that rounds.
  const gonio::grid corner({10, 20, 20}, cell_anchor::lower_corner);
  const std::size_t linear = corner.linear({5, 15, 0});
  const gonio::cosine_pair cosine = gonio::cosines(corner.angles(corner.cell(linear)));
  REQUIRE(std::min(cosine.i, cosine.o) == doctest::Approx(0.0));
  const gonio::valid_cells cells(corner);
  for (const bool mark : {false, true}) {
    const auto found =
        infer_convention(corner.extents(), [&](std::size_t l) { return l == linear ? mark : !cells.contains(l); });
    CHECK(found.anchor == cell_anchor::lower_corner);
    CHECK(found.minimum_cosine >= 0.0);
    CHECK(found.minimum_cosine < 1e-8);
    if (mark) CHECK_FALSE(gonio::valid_cells(corner, found.minimum_cosine).contains(linear));
  }
}

TEST_CASE("a convention can be forced, and cells shared") {
  const auto bytes = small_bytes();
  const gonio::valid_cells corner(gonio::grid(small, cell_anchor::lower_corner), 0.1);
  const merl_options forced{table_convention{cell_anchor::lower_corner, 0.1}, {}};
  CHECK(read_merl(bytes, "x", forced).cells() == corner);
  CHECK(read_merl(bytes, "x").cells() == gonio::valid_cells(gonio::grid(small)));
  // Sharing only saves memory: cells of another convention are not used.
  CHECK(read_merl(bytes, "x", {{}, corner}).cells() == gonio::valid_cells(gonio::grid(small)));
  CHECK(read_merl(bytes, "x", {forced.convention, corner}).cells() == corner);
}

TEST_CASE("bad MERL files are refused") {
  scratch::check_refuses_non_files([](const auto& path) { return read_merl(path); });
  scratch::check_refuses_non_files([](const auto& path) { return read_merl_any(path); });
  const auto refused = [](const std::vector<std::byte>& bytes, std::initializer_list<std::string> words) {
    check_refused([&] { return read_merl(bytes, "a.binary"); }, words);
    check_refused([&] { return read_merl(bytes, "a.binary"); }, {"a.binary: "});
  };
  const auto valid = small_bytes();
  for (const std::size_t size : {0u, 1u, 11u})
    refused({valid.begin(), valid.begin() + static_cast<std::ptrdiff_t>(size)},
            {std::to_string(size) + " bytes", "at least 12"});
  for (const std::size_t size : {std::size_t{12}, std::size_t{13}, valid.size() / 2, valid.size() - 1})
    refused({valid.begin(), valid.begin() + static_cast<std::ptrdiff_t>(size)},
            {"has " + std::to_string(size) + " bytes", "expected 2892", "5 x 4 x 6"});
  auto longer = valid;
  longer.push_back(std::byte{0});
  refused(longer, {"has 2893 bytes", "expected 2892"});
  const std::vector<double> values(360, 1.0);
  refused(merl_bytes({5, 4, 7}, values), {"has 2892 bytes", "expected 3372", "5 x 4 x 7"});
  refused(merl_bytes({-5, 4, 6}, values), {"-5 x 4 x 6", "from 1 to 4096"});
  refused(merl_bytes({0, 4, 6}, values), {"0 x 4 x 6", "from 1 to 4096"});
  refused(merl_bytes({4096, 4096, 4096}, values), {"expected 1649267441676"});
  refused(merl_bytes({65536, 65536, 65536}, values), {"from 1 to 4096"});
  refused(merl_bytes({0x7fffffff, 0x7fffffff, 0x7fffffff}, values), {"from 1 to 4096"});
}

TEST_CASE("NaN and infinity in a valid cell are refused") {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
                           -std::numeric_limits<double>::infinity(), 1e300}) {
    std::vector<double> values(360, 1.0);
    values[120 + 6 * 4 + 6 + 2] = bad;
    check_refused(
        [&] {
          return read_merl(merl_bytes({5, 4, 6}, values), "a.binary");
        },
        {"a.binary: ", "green", "theta_h 1", "theta_d 1", "phi_d 2", "expected a finite number"});
  }
}

TEST_CASE("a table that is not finite is not written") {
  const scratch::folder here;
  auto table = numbered_table(gonio::valid_cells(gonio::grid(small)));
  write_merl(here / "a", table);
  const std::string old = scratch::get(here / "a");
  table.values()[4] = std::numeric_limits<float>::quiet_NaN();
  check_refused(
      [&] {
        write_merl(here / "a", table);
        return 0;
      },
      {"a: green", "expected a finite number"});
  CHECK(scratch::get(here / "a") == old);
  CHECK(here.entries() == 1);
}

TEST_CASE("damaged MERL files are read or refused") {
  const scratch::folder here;
  write_merl(here / "a", numbered_table(gonio::valid_cells(gonio::grid(small))));
  const auto plain = gonio::io::read_bytes(here / "a");
  scratch::check_survives_damage(plain, 2000, [](auto bytes) { return read_merl(bytes, "x"); });
  compress_file(here / "a", here / "b");
  scratch::check_survives_damage(gonio::io::read_bytes(here / "b"), 2000,
                                 [](auto bytes) { return gonio::io::read_merl_any(bytes, "x"); });
}

TEST_CASE("compressed and plain files are distinguished by their content") {
  const scratch::folder here;
  const auto table = numbered_table(gonio::valid_cells(gonio::grid(small)));
  write_merl(here / "plain.gz", table);
  compress_file(here / "plain.gz", here / "compressed.binary");
  for (const char* name : {"plain.gz", "compressed.binary"})
    CHECK(std::ranges::equal(read_merl_any(here / name).values(), table.values()));
  check_refused([&] { return read_merl(here / "compressed.binary"); }, {"compressed.binary"});

  // Compressed files of the wrong size.
  const std::string content = scratch::get(here / "plain.gz");
  const auto compressed = [&](const std::string& changed) {
    scratch::put(here / "changed", changed);
    compress_file(here / "changed", here / "changed.gz");
    return [&] { return read_merl_any(here / "changed.gz"); };
  };
  check_refused(compressed(content + "x"), {"changed.gz: ", "more than the expected 2892 bytes"});
  check_refused(compressed(content.substr(0, 2000)), {"changed.gz: ", "has 2000 bytes", "expected 2892"});
  check_refused(compressed(content.substr(0, 5)), {"changed.gz: ", "has 5 bytes", "at least 12"});
  check_refused(compressed(""), {"changed.gz: ", "has 0 bytes", "at least 12"});
}

TEST_CASE("a measured material has values at lower corners and cosines above 0.02") {
  const scratch::fs::path path = GONIO_SHARED_DATA "/rgl-measured/paper_blue.binary.gz";
  if (!scratch::fs::exists(path)) {
    MESSAGE("skipped: " << path.string() << " is not here");
    return;
  }
  const auto table = read_merl_any(path);
  CHECK(table.cells().grid().anchor() == cell_anchor::lower_corner);
  CHECK(table.cells().minimum_cosine() > 0.0199999);
  CHECK(table.cells().minimum_cosine() < 0.0200047);
  CHECK(table.cells().size() == 1'089'356);
  const scratch::folder here;
  write_merl(here / "a", table);
  const auto again = read_merl(here / "a", {{}, table.cells()});
  CHECK(again.cells() == table.cells());
  CHECK(std::ranges::equal(again.values(), table.values()));
}

TEST_CASE("MERL's own files have values at the cells' centres") {
  const scratch::fs::path path = GONIO_SHARED_DATA "/merl_valid_mask.npy";
  if (!scratch::fs::exists(path)) {
    MESSAGE("skipped: " << path.string() << " is not here");
    return;
  }
  const std::string bits = scratch::get(path).substr(128);
  const auto marked = [&](std::size_t linear) {
    return (static_cast<unsigned char>(bits[linear / 8]) >> (7 - linear % 8) & 1) == 0;
  };
  CHECK(infer_convention({}, marked) == table_convention{cell_anchor::centre, 0.0});
}
