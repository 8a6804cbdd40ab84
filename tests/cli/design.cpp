/// `gonio design` and `gonio plan`, with a prior of a few synthetic materials.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "../synthetic_materials.hpp"
#include "tool.hpp"
#include <gonio/design/apparatus.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/setups/apparatus.hpp>
#include <gonio/solve/default_eta.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace {

/// A folder that holds a prior and the designs made with it.
class drawing_board {
 public:
  drawing_board() { gonio::io::write_prior(folder_ / "p.prior", learn(synthetic_materials(small_cells(), 12), 10)); }

  [[nodiscard]] std::string at(const char* name) const { return (folder_ / name).string(); }
  void put(const char* name, const std::string& text) const { scratch::put(folder_ / name, text); }
  [[nodiscard]] std::size_t files() const { return folder_.entries(); }

  [[nodiscard]] tool_result design(const std::string& arguments, const char* output) const {
    return gonio_tool("design --prior " + at("p.prior") + " " + arguments + " -o " + at(output));
  }

  /// Returns the fraction of the materials' variation that a design leaves unknown.
  [[nodiscard]] double unknown_after(const std::string& arguments, const char* output = "d.csv") const {
    const auto result = design(arguments + " --json", output);
    REQUIRE_MESSAGE(result.exit_code == 0, arguments, ": ", result.output);
    return read_json(result.output)["unknown_share"];
  }

  [[nodiscard]] std::vector<gonio::direction_pair> poses(const char* name) const {
    return gonio::io::read_direction_pairs(at(name));
  }

  /// Checks for exit code 2 and one line with these words, and that no file is written.
  void refuses(const std::string& arguments, std::initializer_list<const char*> words) const {
    CAPTURE(arguments);
    const auto result = design(arguments, "refused.csv");
    CAPTURE(result.output);
    CHECK(result.exit_code == 2);
    CHECK(std::ranges::count(result.output, '\n') == 1);
    for (const char* word : words) CHECK(result.output.find(word) != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(at("refused.csv")));
  }

 private:
  scratch::folder folder_;
};

}  // namespace

TEST_CASE("directions that may not be met are others, and leave more unknown") {
  const drawing_board board;
  const std::string how = "-n 4 --criterion expected-error --search exchange";
  const double met = board.unknown_after(how, "met.csv"), off = board.unknown_after(how + " --misplaced 10", "off.csv");
  CHECK(met < off);
}

TEST_CASE("designs are for materials that the prior has not seen, unless --in-sample says otherwise") {
  const drawing_board board;
  const std::string how = "-n 4 --criterion expected-error";
  const double out_of_sample = board.unknown_after(how), in_sample = board.unknown_after(how + " --in-sample");
  CHECK(in_sample < out_of_sample);
  const auto said = read_json(board.design("-n 4 --json", "d.csv").output);
  CHECK(said["eta"].get<double>() == gonio::default_eta);
  CHECK(said["in_sample"] == false);
}

TEST_CASE("noise of each measurement, and a shift of all, leave more unknown, and not the same") {
  const drawing_board board;
  const std::string how = "-n 4 --criterion expected-error --noise ";
  const double none = board.unknown_after(how + "0"), noise = board.unknown_after(how + "0.3"),
               shift = board.unknown_after(how + "0 --common-shift 0.3");
  CHECK(none < noise);
  CHECK(none < shift);
  CHECK(std::abs(noise - shift) > 1e-3 * noise);
}

TEST_CASE("more measurements leave less unknown, in every geometry and by every search") {
  const drawing_board board;
  for (const char* how : {"", "--search exchange", "--search descent", "--geometry sphere --eta 0.1",
                          "--geometry near-field --step 20", "--geometry fixed-camera --step 20 --fov 35",
                          "--geometry fixed-light --step 20", "--criterion expected-error --eta 0.1"}) {
    CAPTURE(how);
    const double one = board.unknown_after(std::string(how) + " -n 1"),
                 three = board.unknown_after(std::string(how) + " -n 3", "three.csv");
    CHECK(three < one);
    CHECK(three > 0.0);
    CHECK(board.poses("three.csv").size() == 3);
  }
  for (const char* criterion : {"condition", "a-optimal", "d-optimal"}) {
    CHECK(board.unknown_after(std::string("-n 3 --eta 0.1 --criterion ") + criterion) < 1.0);
    CHECK(board.poses("d.csv").size() == 3);
  }
}

TEST_CASE("the exhaustive search is at least as good as the descent, and the same seed gives the same file") {
  const drawing_board board;
  const std::string how = "-n 4 --criterion expected-error --eta 0.1 --search ";
  CHECK(board.unknown_after(how + "exchange") <= board.unknown_after(how + "greedy") * 1.000001);
  static_cast<void>(board.unknown_after(how + "descent --seed 3", "a.csv"));
  static_cast<void>(board.unknown_after(how + "descent --seed 3 --threads 3", "b.csv"));
  CHECK(scratch::get(board.at("a.csv")) == scratch::get(board.at("b.csv")));
}

TEST_CASE("a design may go on from what is measured anyway") {
  const drawing_board board;
  static_cast<void>(board.unknown_after("-n 2", "two.csv"));
  const double four = board.unknown_after("-n 4 --start " + board.at("two.csv"), "four.csv");
  CHECK(four < board.unknown_after("-n 2", "two.csv"));
  const auto two = board.poses("two.csv"), all = board.poses("four.csv");
  REQUIRE(all.size() == 4);
  for (std::size_t i = 0; i < 2; ++i) CHECK(all[i].wi.isApprox(two[i].wi, 1e-9));
  // Directions between two candidates are accepted as well.
  board.put("own.csv", "theta_i,phi_i,theta_o,phi_o\n31.5,10,47.25,200\n");
  for (const char* criterion : {"perceived", "expected-error"}) {
    CAPTURE(criterion);
    REQUIRE(board.design(std::string("-n 2 --criterion ") + criterion + " --start " + board.at("own.csv"), "kept.csv")
                .exit_code == 0);
    CHECK(board.poses("kept.csv")[0].wi.isApprox(board.poses("own.csv")[0].wi, 1e-9));
    CHECK(board.poses("kept.csv")[0].wo.isApprox(board.poses("own.csv")[0].wo, 1e-9));
  }
}

TEST_CASE(
    "by default light and viewer stay below 80 degrees and 5 degrees apart, and long plans begin with short ones") {
  const drawing_board board;
  static_cast<void>(board.unknown_after("-n 3", "three.csv"));
  static_cast<void>(board.unknown_after("-n 7", "seven.csv"));
  static_cast<void>(board.unknown_after("-n 7 --threads 1", "again.csv"));
  CHECK(scratch::get(board.at("seven.csv")) == scratch::get(board.at("again.csv")));
  for (const char* name : {"three.csv", "seven.csv"})
    for (const auto& [wi, wo] : board.poses(name)) {
      CHECK(gonio::degrees(std::max(gonio::polar_angle(wi), gonio::polar_angle(wo))) < 80.001);
      CHECK(gonio::degrees(gonio::angle_between(wi, wo)) > 4.999);
    }
  const auto said = read_json(board.design("-n 7 --json", "d.csv").output);
  CHECK(said["expected_delta_e"].get<double>() > 0.0);
  static_cast<void>(board.unknown_after("-n 5", "five.csv"));
  const auto five = board.poses("five.csv"), seven = board.poses("seven.csv");
  for (std::size_t i = 0; i < 5; ++i) CHECK(five[i].wi.isApprox(seven[i].wi));
  static_cast<void>(board.unknown_after("-n 7 --largest-polar-angle 50 --separation 20", "narrow.csv"));
  for (const auto& [wi, wo] : board.poses("narrow.csv")) {
    CHECK(gonio::degrees(std::max(gonio::polar_angle(wi), gonio::polar_angle(wo))) < 50.001);
    CHECK(gonio::degrees(gonio::angle_between(wi, wo)) > 19.999);
  }
}

TEST_CASE("an apparatus is named, and what is designed for it is what it can measure") {
  const drawing_board board;
  const std::string shipped = std::string(GONIO_SOURCE_DIR) + "/examples/data/apparatus/";
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(shipped)) {
    const std::string name = entry.path().stem().string();
    CAPTURE(name);
    ++files;
    const auto with = gonio::io::read_apparatus(entry.path());
    const std::string images = name == "near-field-tablet" ? " --geometry near-field --step 10" : "";
    const auto result = board.design("-n 2 --apparatus " + name + images, "two.csv");
    REQUIRE_MESSAGE(result.exit_code == 0, result.output);
    for (const auto& [wi, wo] : board.poses("two.csv")) CHECK((with.constraint({wi, wo}) || with.constraint({wo, wi})));
  }
  CHECK(files == 8);
  board.refuses("-n 2 --apparatus telescope", {"--apparatus", "telescope", "in-plane-arm"});
  board.put("own.txt", "light 0 40\n");
  board.refuses("-n 2 --apparatus robot --constraint " + board.at("own.txt"), {"--constraint and --apparatus"});
  board.refuses("-n 9 --apparatus multi-angle-5", {"9 of"});
}

TEST_CASE("what the apparatus cannot do is not asked of it") {
  const drawing_board board;
  board.put("arc.txt", "light 0 40\nviewer 10 80\nseparation 30\n");
  for (const char* geometry : {"point", "near-field --step 10"}) {
    static_cast<void>(board.unknown_after("-n 3 --constraint " + board.at("arc.txt") + " --geometry " + geometry));
    for (const auto& [wi, wo] : board.poses("d.csv")) {
      CHECK(gonio::degrees(gonio::polar_angle(wi)) < 40.001);
      CHECK(gonio::degrees(gonio::polar_angle(wo)) > 9.999);
      CHECK(gonio::degrees(std::acos(wi.dot(wo))) > 29.999);
    }
  }
}

TEST_CASE("one angle of the light is met to a tolerance, and all lies in the plane that is asked for") {
  const drawing_board board;
  board.put("plane.txt", "light 45 45 10\nin_plane\n");
  static_cast<void>(board.unknown_after("-n 3 --constraint " + board.at("plane.txt")));
  for (const auto& [wi, wo] : board.poses("d.csv")) {
    CHECK(std::abs(gonio::degrees(gonio::polar_angle(wi)) - 45.0) < 10.001);
    CHECK(std::abs(wi.x() * wo.y() - wi.y() * wo.x()) < 1e-9);
  }
}

TEST_CASE("the next measurements by what the given ones read") {
  const drawing_board board;
  board.put(
      "given.csv",
      "theta_i,phi_i,theta_o,phi_o,r,g,b\n45,0,0,0,0.1,0.1,0.1\n30,0,30,180,1.5,1.5,1.5\n60,0,20,90,0.1,0.1,0.1\n");
  const auto result = board.design("-n 2 --json --given " + board.at("given.csv"), "next.csv");
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  const auto said = read_json(result.output);
  CHECK(said["given"] == 3);
  CHECK(said["measurements"] == 2);
  const auto reconstructed = gonio_tool("reconstruct --prior " + board.at("p.prior") + " --json -o " +
                                        board.at("given.binary") + " " + board.at("given.csv"));
  REQUIRE_MESSAGE(reconstructed.exit_code == 0, reconstructed.output);
  CHECK(said["known_to"] == read_json(reconstructed.output)["known_to"]);
  CHECK(said["expected_delta_e"].get<double>() > 0.0);
  CHECK(board.poses("next.csv").size() == 2);
  const auto enough = board.design("-n 2 --json --until 0.99 --given " + board.at("given.csv"), "unwritten.csv");
  REQUIRE_MESSAGE(enough.exit_code == 0, enough.output);
  CHECK(read_json(enough.output)["enough"] == true);
  CHECK_FALSE(std::filesystem::exists(board.at("unwritten.csv")));
  board.refuses("-n 2 --geometry sphere --given " + board.at("given.csv"), {"--given", "--geometry point"});
  board.refuses("-n 2 --criterion condition --given " + board.at("given.csv"), {"--given", "--criterion"});
  board.refuses("-n 2 --start " + board.at("given.csv") + " --given " + board.at("given.csv"), {"--given", "--start"});
}

TEST_CASE("the literature's sets are written as they are printed") {
  const drawing_board board;
  CHECK(board.unknown_after("--published 5") < 1.0);
  const auto five = board.poses("d.csv");
  REQUIRE(five.size() == 5);
  const gonio::half_difference third = gonio::to_half_difference(five[2].wi, five[2].wo);
  CHECK(gonio::degrees(third.theta_h) == doctest::Approx(8.0));
  CHECK(gonio::degrees(third.theta_d) == doctest::Approx(79.0));
  CHECK(gonio::degrees(third.phi_d) == doctest::Approx(85.0));
  CHECK(board.unknown_after("--industry") < 1.0);
  CHECK(board.poses("d.csv").size() == 5);
  CHECK(board.unknown_after("--published 2 --geometry sphere") <
        board.unknown_after("--published 1 --geometry sphere"));

  REQUIRE(board.design("--published 2 --geometry sphere", "images.csv").exit_code == 0);
  const auto images = board.poses("images.csv");
  REQUIRE(images.size() == 2);
  CHECK(gonio::degrees(gonio::to_half_difference(images[0].wi, images[0].wo).theta_d) == doctest::Approx(4.0));
  CHECK(gonio::degrees(gonio::to_half_difference(images[1].wi, images[1].wo).theta_d) == doctest::Approx(70.0));

  board.refuses("--published 3", {"there is no published set of 3", "1, 2, 5, 10 or 20"});
  board.refuses("--published 10 --geometry sphere", {"images of a sphere", "1, 2 or 5"});
  board.refuses("--published 1 --geometry near-field", {"--published needs --geometry point or sphere"});
  board.refuses("--industry --geometry sphere", {"--industry needs --geometry point"});
  board.refuses("--industry --published 5", {"exclude each other"});
  board.refuses("--published 5 --criterion condition", {"--published needs no search", "--criterion"});
}

TEST_CASE("the literature's sets that ship are what the tool writes, and can be read as they are") {
  const drawing_board board;
  const std::string shipped = std::string(GONIO_SOURCE_DIR) + "/examples/data/directions/";
  const auto ships = [&](const std::string& name, const std::string& arguments, std::size_t count) {
    CAPTURE(name);
    const auto result = board.design(arguments, "d.csv");
    REQUIRE_MESSAGE(result.exit_code == 0, result.output);
    CHECK(scratch::get(shipped + name) == scratch::get(board.at("d.csv")));
    CHECK(gonio::io::read_directions(shipped + name).size() == count);
  };
  for (const std::size_t n : {1, 2, 5, 10, 20})
    ships("point-" + std::to_string(n) + "-published.csv", "--published " + std::to_string(n), n);
  for (const std::size_t n : {1, 2, 5})
    ships("sphere-" + std::to_string(n) + "-published.csv", "--geometry sphere --published " + std::to_string(n), n);
  ships("point-5-industry.csv", "--industry", 5);

  const std::string table = board.at("grey.binary"), samples = board.at("samples.csv");
  REQUIRE(gonio_tool("expand --formula grey-lambertian -o " + table).exit_code == 0);
  const auto measured =
      gonio_tool("sample " + table + " --directions " + shipped + "point-10-published.csv -o " + samples);
  REQUIRE_MESSAGE(measured.exit_code == 0, measured.output);
  CHECK(gonio::io::read_samples(samples).size() == 10);
}

TEST_CASE("designed directions that ship are within the usual apparatus, and can be read of every measured table") {
  const gonio::design::apparatus usual = gonio::design::usual_apparatus();
  std::vector<gonio::direction_pair> points;
  Eigen::Index sets = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(GONIO_SOURCE_DIR) + "/examples/data/directions")) {
    const std::string name = entry.path().filename().string();
    CAPTURE(name);
    if (name.ends_with("published.csv") || name.ends_with("industry.csv") || entry.path().extension() != ".csv")
      continue;
    ++sets;
    for (const gonio::direction_pair& pair : gonio::io::read_direction_pairs(entry.path())) {
      CHECK(gonio::angle_between(pair.wi, pair.wo) > gonio::radians(4.999));
      if (name.starts_with("sphere")) continue;  // it covers all directions
      CHECK(std::max(gonio::polar_angle(pair.wi), gonio::polar_angle(pair.wo)) < gonio::radians(80.001));
      if (name.starts_with("point")) points.push_back(pair);
    }
  }
  CHECK(sets >= 30);
  CHECK(usual.constraint.light.largest == doctest::Approx(gonio::radians(80)));

  const std::filesystem::path tables(std::string(GONIO_SHARED_DATA) + "/rgl-measured");
  if (!std::filesystem::exists(tables)) {
    MESSAGE("skipped: there is no " << tables.string());
    return;
  }
  const drawing_board board;
  gonio::io::write_direction_pairs(board.at("all.csv"), points);
  for (const auto& entry : std::filesystem::directory_iterator(tables)) {
    if (entry.path().extension() != ".gz") continue;
    const auto measured = gonio_tool("sample " + entry.path().string() + " --directions " + board.at("all.csv") +
                                     " -o " + board.at("samples.csv"));
    CHECK_MESSAGE(measured.exit_code == 0, entry.path().string(), ": ", measured.output);
  }
}

TEST_CASE("designs that cannot be made") {
  const drawing_board board;
  board.refuses("-n 0", {"0 of"});
  board.refuses("-n 9 --geometry sphere", {"9 of 7"});
  board.refuses("-n 2 --criterion expected-error --eta 0", {"eta"});
  board.refuses("-n 2 --eta 10", {"--eta needs --criterion expected-error"});
  board.refuses("-n 2 --until 0.1", {"--until needs --given"});
  board.refuses("-n 2 --noise -1", {"noise"});
  board.refuses("-n 2 --criterion expected-error --common-shift -1", {"common shift", "not -1"});
  board.refuses("-n 2 --common-shift 0.1", {"--common-shift", "need --criterion expected-error"});
  board.refuses("-n 2 --common-shift 0.1 --criterion d-optimal", {"--common-shift", "expected-error", "d-optimal"});
  board.refuses("-n 2 --in-sample --criterion condition", {"--in-sample", "condition"});
  board.refuses("-n 2 --noise 0.1 --criterion condition", {"--noise", "condition"});
  board.refuses("-n 2 --misplaced -1", {"--misplaced needs an angle from 0 to 45 degrees, not -1"});
  board.refuses("-n 2 --misplaced 1 --geometry sphere",
                {"--misplaced needs --geometry point and --criterion expected-error or perceived"});
  board.refuses("-n 2 --misplaced 1 --criterion condition", {"--criterion expected-error or perceived"});
  board.refuses("-n 2 --geometry near-field --fov 0", {"field of view"});
  board.refuses("-n 2 --geometry near-field --fov 95", {"field of view", "95"});
  board.refuses("-n 2 --geometry cube", {"cube"});
  board.refuses("-n 2 --criterion beauty", {"beauty"});
  board.put("low.csv", "theta_i,phi_i,theta_o,phi_o\n40,0,95,0\n");
  board.refuses("-n 2 --start " + board.at("low.csv"), {"low.csv", "line 2", "horizon"});
  board.put("none.txt", "light 0 10\nviewer 0 10\nseparation 60\n");
  board.refuses("-n 1 --constraint " + board.at("none.txt"), {"the rule 'separation'", "relax this rule"});
  board.refuses("-n 1 --geometry near-field --constraint " + board.at("none.txt"),
                {"limits of the apparatus", "--constraint"});
  board.put("odd.txt", "lamp 3\n");
  board.refuses("-n 1 --constraint " + board.at("odd.txt"), {"odd.txt", "line 1", "lamp"});
}

TEST_CASE("a plan says where light and viewer go, and draws them") {
  const drawing_board board;
  board.put("d.csv", "theta_i,phi_i,theta_o,phi_o\n40,10,30,190\n0,0,50,90\n");
  const auto printed = gonio_tool("plan " + board.at("d.csv") + " --image " + board.at("d.png"));
  REQUIRE(printed.exit_code == 0);
  CHECK(printed.output.find("| 1 | 40.00 | 30.00 | 180.00 | 0.6428 0.0000 0.7660 | -0.5000 0.0000 0.8660 |") !=
        std::string::npos);
  CHECK(std::filesystem::file_size(board.at("d.png")) > 1000);
  // The number of the first pose is drawn left of its viewer, 30 degrees left of the middle at (450, 450), away from
  // the light. The number of the second is above its viewer, 50 degrees up. 90 degrees have 400 pixels.
  const gonio::image drawn = gonio::io::read_png(board.at("d.png"));
  const auto is_drawn = [&](std::size_t from_row, std::size_t from_column) {
    for (std::size_t row = from_row; row < from_row + 9; ++row)
      for (std::size_t column = from_column; column < from_column + 9; ++column)
        if (gonio::pixel(drawn, row, column).minCoeff() < 0.5f) return true;
    return false;
  };
  CHECK(is_drawn(444, 450 - 133 - 23));
  CHECK_FALSE(is_drawn(424, 450 - 133 - 23));
  CHECK(is_drawn(450 - 222 - 28, 444));

  const auto json = gonio_tool("plan " + board.at("d.csv") + " --json");
  const auto poses = read_json(json.output);
  REQUIRE(poses.size() == 2);
  CHECK(poses[1]["theta_i"] == 0.0);
  CHECK(poses[1]["phi_o"].get<double>() == doctest::Approx(90));
  CHECK(gonio_tool("plan /no/such.csv").exit_code == 2);
}
