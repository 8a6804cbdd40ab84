/// gonio lab: from directions to samples, and from a light probe to an environment map.

#include "../json.hpp"
#include "laboratory.hpp"
#include <gonio/capture/trajectory.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/measurements/reference_reflectance.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/measurements/scan_journal.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>
#include <stb/stb_image_write.h>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

TEST_CASE("lab: without defects both machines' samples are the table's values") {
  const laboratory room;
  const gonio::brdf_table truth = gonio::io::read_merl(room.at("truth.binary"));
  for (const std::string machine : {" --machine gantry ", " --machine robot --lamp-tolerance 4 "}) {
    const std::string plan = room.at("plan.csv"), white = room.at("white.scan"), paint = room.at("paint.scan");
    for (const std::string& journal : {white, paint}) std::filesystem::remove(journal);
    CHECK(run("lab plan " + directions + machine + "-o " + plan).find("20 poses, 0 cannot be reached") !=
          std::string::npos);
    CHECK(run("lab scan " + plan + machine + "--ideal --white -o " + white) ==
          "20 poses measured, 0 were already there\n");
    run("lab scan " + plan + machine + "--ideal" + room.material + "-o " + paint);
    run("lab calibrate " + paint + " --reference " + white +
        " --gamma 1 --read-noise 0 --shot-noise 0 --flicker 0 -o " + room.at("samples.csv"));
    const auto samples = gonio::io::read_samples(room.at("samples.csv"));
    REQUIRE(samples.size() == 20);
    for (const gonio::sample& each : samples) {
      const auto [wi, wo] = each.directions.pair();
      const gonio::rgb expected = truth(wi, wo);
      CHECK(((each.value - expected).abs() < 1e-3 * expected).all());
    }
  }
}

TEST_CASE("lab: a scan with all defects is calibrated by itself, and goes on where it was stopped") {
  const laboratory room;
  const std::string plan = room.at("plan.csv"), white = room.at("white.scan"), paint = room.at("paint.scan");
  run("lab plan " + directions + " -o " + plan);
  run("lab scan " + plan + " --camera gamma --white -o " + white);
  run("lab scan " + plan + " --camera gamma" + room.material + "-o " + paint);
  const std::string whole = scratch::get(paint);
  // Truncated, as if the process had been killed.
  scratch::put(paint, whole.substr(0, whole.size() - 5000));
  const std::string resumed = run("lab scan " + plan + " --camera gamma" + room.material + "-o " + paint);
  CHECK(resumed.find(" were already there") != std::string::npos);
  CHECK(resumed.find("20 poses measured") == std::string::npos);
  CHECK(scratch::get(paint) == whole);

  const std::string told = run("lab calibrate " + paint + " --reference " + white + " --response " +
                               room.at("response.csv") + " -o " + room.at("samples.csv"));
  CHECK(told.find("20 samples, each known to ") == 0);
  CHECK(scratch::get(room.at("response.csv")).starts_with("count,log_exposure_r,log_exposure_g,log_exposure_b\n"));
  const gonio::brdf_table truth = gonio::io::read_merl(room.at("truth.binary"));
  double worst = 0.0;
  for (const gonio::sample& each : gonio::io::read_samples(room.at("samples.csv"))) {
    const auto [wi, wo] = each.directions.pair();
    worst = std::max(worst, std::abs(each.value.sum() / truth(wi, wo).sum() - 1.0));
    CHECK((each.weight.of_each() > 0.1).all());
  }
  CHECK(worst > 0.001);  // from half a degree at grazing angles, and noise
  CHECK(worst < 0.5);

  // The whole chain: the reconstruction is near the material in the machine.
  run("reconstruct " + room.at("samples.csv") + " -o " + room.at("estimate.binary"));
  const auto errors = read_json(run("compare --json " + room.at("estimate.binary") + " " + room.at("truth.binary")));
  CHECK(errors["delta_e_env"].get<double>() < 10.0);
}

TEST_CASE("lab: a reference whose reflectance depends on the angle needs its table") {
  const laboratory room;
  const std::string table = std::string(GONIO_SOURCE_DIR) + "/examples/data/white-by-formula.csv";
  const std::string plan = room.at("plan.csv"), white = room.at("white.scan"), paint = room.at("paint.scan");
  run("lab plan " + directions + " -o " + plan);
  run("lab scan " + plan + " --ideal --white --reflectance " + table + " -o " + white);
  run("lab scan " + plan + " --ideal" + room.material + "-o " + paint);
  const std::string calibrate = "lab calibrate " + paint + " --reference " + white +
                                " --gamma 1 --read-noise 0 --shot-noise 0 --flicker 0 -o " + room.at("samples.csv");
  const gonio::brdf_table truth = gonio::io::read_merl(room.at("truth.binary"));
  const auto known = gonio::io::read_reference_reflectance(table);
  const auto check_samples = [&](const std::string& options, auto&& share_of_truth) {
    run(calibrate + options);
    double most_off = 0.0;
    const auto samples = gonio::io::read_samples(room.at("samples.csv"));
    // In a sample's phi_d, light and viewer may be exchanged; in the plan they are not.
    const auto pairs = gonio::io::read_direction_pairs(plan);
    REQUIRE(samples.size() == pairs.size());
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      const gonio::rgb& found = samples[i].value;
      const gonio::rgb expected = share_of_truth(pairs[i]) * truth(pairs[i].wi, pairs[i].wo);
      CHECK(((found - expected).abs() < 1e-3 * expected).all());
      most_off = std::max(most_off, found.sum() / truth(pairs[i].wi, pairs[i].wo).sum() - 1.0);
    }
    return most_off;
  };
  CHECK(check_samples(" --reflectance " + table, [](const auto&) { return 1.0; }) < 1e-3);
  // Without the table, samples deviate by its factors: by a tenth or more for grazing light.
  const auto constant_beside = [&](const auto& pair) -> gonio::rgb { return 0.99 / known.at(pair); };
  CHECK(check_samples("", constant_beside) > 0.1);
  CHECK(check_samples(" --nearest-reference --reflectance " + table, [](const auto&) { return 1.0; }) < 1e-3);

  // The journal stores the table. Refuses a truncated table and other files, and writes nothing.
  refuses("lab scan " + plan + " --ideal --white -o " + white, "reflectance of white-by-formula.csv");
  std::filesystem::remove(room.at("samples.csv"));
  scratch::put(room.at("short.csv"), "theta_i,factor\n0,0.99\n40,0.95\n");
  refuses(calibrate + " --reflectance " + room.at("short.csv"), "covers theta_i from 0.000000 to 40.000000 degrees");
  refuses(calibrate + " --reflectance " + plan, "plan.csv, line 1: column 'phi_i' is unknown");
  refuses(calibrate + " --reflectance 1.1",
          "--reflectance 1.1: expected a number from 0.01 to 1, or the file of a table");
  refuses(calibrate + " --reflectance none.csv", "none.csv");
  refuses("lab scan " + plan + " --white --reflectance 0 -o " + room.at("b.scan"), "--reflectance 0: expected");
  CHECK(!std::filesystem::exists(room.at("samples.csv")));
  CHECK(!std::filesystem::exists(room.at("b.scan")));
}

TEST_CASE("lab: an adaptive scan chooses its poses, and is the same however often it was stopped") {
  const laboratory room;
  const std::string white = room.at("white.scan"), plan = room.at("plan.csv"), paint = room.at("paint.scan");
  run("lab plan " + directions + " -o " + room.at("white.csv"));
  run("lab scan " + room.at("white.csv") + " --white -o " + white);
  run("lab plan " + directions + " -o " + plan);
  const std::string scan = "lab scan " + plan + room.material + "--adaptive --reference " + white + " -o " + paint;
  const std::string told = run(scan + " --most 22 --until 0.001");
  CHECK(told.find("20 samples: half of all directions are known to ") == 0);
  CHECK(told.find("\nnext: light at ") != std::string::npos);
  CHECK(told.find("stopped at --most 22 poses") != std::string::npos);
  CHECK(told.ends_with("22 poses measured, 22 in total\n"));
  const std::string whole = scratch::get(paint);
  scratch::put(paint, whole.substr(0, whole.rfind("added_pose") + 20));  // truncated, as if the process had been killed
  CHECK(run(scan + " --most 22 --until 0.001").ends_with("1 poses measured, 22 in total\n"));
  CHECK(scratch::get(paint) == whole);
  CHECK(run(scan + " --until 1").ends_with("0 poses measured, 22 in total\n"));

  // The reference was measured at other poses.
  refuses("lab calibrate " + paint + " --reference " + white + " -o " + room.at("s.csv"), "--nearest-reference");
  CHECK(run("lab calibrate " + paint + " --reference " + white + " --nearest-reference -o " + room.at("s.csv"))
            .find("22 samples") == 0);
  refuses("lab scan " + plan + room.material + "--adaptive -o " + room.at("b.scan"), "--adaptive needs --reference");
  refuses("lab scan " + plan + room.material + "--reference " + white + " -o " + room.at("b.scan"),
          "--reference needs --adaptive");
  refuses("lab scan " + plan + " --white --adaptive --reference " + white + " -o " + room.at("b.scan"),
          "--adaptive needs --material");
  refuses("lab scan " + plan + room.material + "-o " + paint, "adaptive");  // not the same kind of scan
}

TEST_CASE("lab: a scan goes on only with what lay in the machine, and by the same options") {
  const laboratory room;
  const std::string plan = room.at("plan.csv"), white = room.at("white.scan"), paint = room.at("paint.scan");
  run("expand --formula blue-rubber -o " + room.at("rubber.binary"));
  run("lab plan " + directions + " -o " + plan);
  run("lab scan " + plan + " --white -o " + white);
  run("lab scan " + plan + room.material + "-o " + paint);
  const auto refuses_to_go_on = [&](const std::string& arguments, const std::string& scan, const std::string& words) {
    const std::string before = scratch::get(scan);
    refuses("lab scan " + plan + " " + arguments + " -o " + scan, words);
    CHECK(scratch::get(scan) == before);
  };
  refuses_to_go_on(room.material, white, "is a scan of 'white reference, reflectance 0.99', not of 'truth.binary'");
  refuses_to_go_on("--white", paint, "is a scan of 'truth.binary', not of 'white reference");
  refuses_to_go_on("--white --reflectance 0.5", white, "not of 'white reference, reflectance 0.5'");
  refuses_to_go_on("--white --camera gamma", white, "camera linear");
  refuses_to_go_on("--white --outliers 0.1", white, "outliers 0.1");
  refuses_to_go_on("--white --room-seed 2", white, "room seed 2");
  refuses_to_go_on("--white --seed 2", white, "with the seed 1, not 2");
  refuses_to_go_on("--white --label tile", white, "not of 'tile'");
  // An unfinished scan is refused for another material, even one of the same name.
  const std::string half = scratch::get(paint).substr(0, scratch::get(paint).size() / 2);
  scratch::put(paint, half);
  refuses_to_go_on("--material " + room.at("rubber.binary"), paint, "not of 'rubber.binary'");
  std::filesystem::rename(room.at("rubber.binary"), room.at("truth.binary"));
  refuses_to_go_on(room.material, paint, "is a scan of another 'truth.binary'");
}

TEST_CASE("lab: a reference that is darker than the material is refused") {
  const laboratory room;
  const std::string plan = room.at("plan.csv"), white = room.at("white.scan"), paint = room.at("paint.scan");
  run("lab plan " + directions + " -o " + plan);
  run("lab scan " + plan + " --white -o " + white);
  run("lab scan " + plan + room.material + "-o " + paint);
  const std::string exchanged = "lab calibrate " + white + " --reference " + paint + " -o " + room.at("s.csv");
  refuses(exchanged, "paint.scan: the reference is darker than the material in ");
  CHECK(!std::filesystem::exists(room.at("s.csv")));
  CHECK(run(exchanged + " --brighter").find("of 'white reference, reflectance 0.99' beside 'truth.binary'") !=
        std::string::npos);
}

TEST_CASE("lab: a plan names what cannot be reached") {
  const scratch::folder folder;
  scratch::put(folder / "two.csv", "theta_i,phi_i,theta_o,phi_o\n30,0,30,2\n20,0,50,100\n");
  const std::string out = " -o " + (folder / "plan.csv").string();
  const std::string told = run("lab plan " + (folder / "two.csv").string() + out);
  CHECK(told.find("not measured: 1, light at 30.0, 0.0, viewer at 30.0, 2.0: the camera hides the lamp") == 0);
  CHECK(told.find("1 poses, 1 cannot be reached") != std::string::npos);
  CHECK(run("lab plan --whole --machine robot" + out).find("160.5 minutes") != std::string::npos);
  refuses("lab plan --whole --machine gantry" + out, "--machine robot");
  scratch::put(folder / "two.csv", "theta_i,phi_i,theta_o,phi_o\n30,0,30,2\n");
  refuses("lab plan " + (folder / "two.csv").string() + out, "cannot reach any");
}

TEST_CASE("lab: a plan's poses lead back to its directions, for both machines") {
  const scratch::folder folder;
  const std::string plan = (folder / "plan.csv").string(), poses = (folder / "poses.csv").string();
  for (const bool is_robot : {false, true}) {
    run("lab plan " + directions + (is_robot ? " --machine robot --lamp-tolerance 4" : "") + " --poses " + poses +
        " -o " + plan);
    const auto pairs = gonio::io::read_direction_pairs(plan);
    std::istringstream lines(scratch::get(poses));
    std::string line;
    std::getline(lines, line);
    const std::string camera = "pose,camera_x,camera_y,camera_z,camera_qw,camera_qx,camera_qy,camera_qz,";
    CHECK(line == camera + (is_robot ? "lamp" : "lamp_x,lamp_y,lamp_z,lamp_qw,lamp_qx,lamp_qy,lamp_qz"));
    Eigen::Vector4d before = Eigen::Vector4d::Zero();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      REQUIRE(std::getline(lines, line));
      std::vector<double> numbers;
      std::istringstream fields(line);
      for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::stod(field));
      REQUIRE(numbers.size() == (is_robot ? 9 : 15));
      CHECK(numbers[0] == static_cast<double>(i + 1));
      const auto check_tool = [&](std::size_t first, const gonio::direction& expected, double radius) {
        const Eigen::Vector3d position(numbers[first], numbers[first + 1], numbers[first + 2]);
        const gonio::capture::tool_pose pose{position, Eigen::Vector4d(&numbers[first + 3])};
        CHECK(position.norm() == doctest::Approx(radius));
        CHECK(std::abs(pose.quaternion.norm() - 1.0) < 1e-8);
        for (const gonio::direction& back :
             {gonio::direction(position / radius), gonio::direction(-pose.looks_along())})
          CHECK(gonio::angle_between(gonio::turned_about_normal(back, is_robot ? -std::numbers::pi / 2.0 : 0.0),
                                     expected) < 1e-7);
        return pose.quaternion;
      };
      const Eigen::Vector4d quaternion = check_tool(1, pairs[i].wo, is_robot ? 350.0 : 600.0);
      CHECK(quaternion.dot(before) >= 0.0);
      before = quaternion;
      if (is_robot)
        CHECK(gonio::angle_between(gonio::capture::arc_lamps()[static_cast<std::size_t>(numbers[8]) - 1], pairs[i].wi) <
              1e-7);
      else
        check_tool(8, pairs[i].wi, 1000.0);
    }
    CHECK(!std::getline(lines, line));
  }
  refuses("lab plan " + directions + " --poses " + plan + " -o " + plan, "is also written by ");
}

TEST_CASE("lab: frames of a real laboratory go the same way, and those that are missing are named") {
  const scratch::folder folder;
  nlohmann::json manifest{{"largest_count", 255}, {"frames", nlohmann::json::array()}};
  for (const double theta : {10.0, 40.0})
    for (const double seconds : {0.1, 0.2}) {
      const std::string file = std::to_string(manifest["frames"].size()) + ".png";
      const std::vector<unsigned char> codes(12, static_cast<unsigned char>(seconds * 1000.0 * std::cos(theta / 57.3)));
      REQUIRE(stbi_write_png((folder / file).c_str(), 2, 2, 3, codes.data(), 6) != 0);
      manifest["frames"].push_back(
          {{"theta_i", theta}, {"phi_i", 0}, {"theta_o", 20}, {"phi_o", 180}, {"seconds", seconds}, {"file", file}});
    }
  scratch::put(folder / "manifest.json", manifest.dump());
  const std::string replay =
      "lab replay " + (folder / "manifest.json").string() + " -o " + (folder / "a.scan").string();
  std::filesystem::rename(folder / "3.png", folder / "lost.png");
  refuses(replay, "1 of 2 poses are missing", 1);
  CHECK(gonio::io::read_scan(folder / "a.scan").measured() == 1u);
  std::filesystem::rename(folder / "lost.png", folder / "3.png");
  CHECK(run(replay) == "1 poses measured, 1 were already there\n");
  run("lab calibrate " + (folder / "a.scan").string() + " --reference " + (folder / "a.scan").string() +
      " --gamma 1 -o " + (folder / "samples.csv").string());
  const auto samples = gonio::io::read_samples(folder / "samples.csv");
  REQUIRE(samples.size() == 2u);
  CHECK(samples[0].value.x() == doctest::Approx(0.99 / std::numbers::pi));
}

TEST_CASE("lab: a light probe is photographed and unwrapped") {
  const scratch::folder folder;
  gonio::image sky = gonio::uniform_image(64, 128);
  for (std::size_t row = 0; row < 64; ++row)
    for (std::size_t column = 0; column < 128; ++column)
      gonio::set_pixel(sky, row, column,
                       gonio::rgb(1.0, 2.0, 3.0) * (1.5 + std::sin(0.05 * static_cast<double>(row + column))));
  const auto at = [&](const char* name) { return (folder / name).string(); };
  gonio::io::write_hdr(folder / "sky.hdr", sky);
  run("lab probe " + at("sky.hdr") + " --size 256 --distance 5 -o " + at("probe.hdr"));
  const std::string told = run("lab unwrap " + at("probe.hdr") + " --distance 5 --rows 16 --truth " + at("sky.hdr") +
                               " --image " + at("look.png") + " -o " + at("map.hdr"));
  CHECK(told.find("mean relative error 0.") == 0);
  CHECK(gonio::io::read_png(folder / "look.png").shape(1) == 16u + 32u + 3u * 4u);  // with margins
  const gonio::image map = gonio::io::read_hdr(folder / "map.hdr");
  CHECK(map.shape(0) == 16u);
  CHECK(map.shape(1) == 32u);
  // An array as written by gonio lab merge.
  gonio::io::write_npy(folder / "probe.NPY", gonio::io::read_hdr(folder / "probe.hdr"));
  run("lab unwrap " + at("probe.NPY") + " --distance 5 --rows 16 -o " + at("again.hdr"));
  CHECK(scratch::get(folder / "again.hdr") == scratch::get(folder / "map.hdr"));
  run("lab unwrap " + at("probe.NPY") + " --distance 5 --rows 16 -o " + at("map.NPY"));
  const auto array = gonio::io::read_npy<float, 3>(folder / "map.NPY");
  CHECK(std::abs(array(8, 16, 2) - map(8, 16, 2)) <= 0.01f * map(8, 16, 2));  // an .hdr has 8 bits
  refuses("lab unwrap " + at("sky.hdr") + " -o " + at("map.hdr"),
          "sky.hdr: an image that a mirror sphere fills must be square, not 64 x 128; --outline find");
  refuses("lab unwrap " + at("probe.hdr") + " --rows 5 --truth " + at("sky.hdr") + " -o " + at("map.hdr"),
          "averaged to one of 5 rows");
}

TEST_CASE("lab: bad input is refused") {
  const laboratory room;
  const std::string plan = room.at("plan.csv"), scan = room.at("a.scan");
  run("lab plan " + directions + " -o " + plan);
  refuses("lab", "");
  refuses("lab scan " + plan + " -o " + scan, "");
  refuses("lab scan " + plan + " --white" + room.material + "-o " + scan, "");
  refuses("lab scan " + room.at("none.csv") + " --white -o " + scan, "cannot be read");
  CHECK(!std::filesystem::exists(scan));
  run("lab scan " + plan + " --ideal --white -o " + scan);
  refuses("lab scan " + plan + " --white -o " + scan, "counts up to 65535, not up to 4095");
  refuses("lab scan " + directions + " --ideal --white -o " + scan, "other poses");
  run("lab scan " + directions + " --ideal --white -o " + room.at("b.scan"));
  refuses("lab calibrate " + scan + " --reference " + room.at("b.scan") + " -o " + room.at("s.csv"), "the same poses");
  refuses("lab calibrate " + plan + " --reference " + scan + " -o " + room.at("s.csv"), "plan.csv, line 1");
  refuses("lab replay " + plan + " -o " + room.at("c.scan"), "is not a JSON object");
  CHECK(!std::filesystem::exists(room.at("s.csv")));
}
