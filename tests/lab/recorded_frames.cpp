#include "../io/scratch.hpp"
#include "synthetic_scan.hpp"

#include <doctest/doctest.h>
#include <lab/gantry.hpp>
#include <lab/recorded_frames.hpp>
#include <nlohmann/json.hpp>
#include <stb/stb_image_write.h>

#include <fstream>

using doctest::Contains;

namespace {

/// Writes counts of 8 bits as a PNG of some pixels a side.
void write_counts(const std::filesystem::path& path, const gonio::capture::camera_frame& counts, int side) {
  std::vector<unsigned char> codes;
  for (Eigen::Index pixel = 0; pixel < counts.rows(); ++pixel)
    for (Eigen::Index channel = 0; channel < 3; ++channel)
      codes.push_back(static_cast<unsigned char>(counts(pixel, channel)));
  REQUIRE(stbi_write_png(path.c_str(), side, side, 3, codes.data(), 3 * side) != 0);
}

void write_text(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

}  // namespace

TEST_CASE("lab: frames that were recorded are read as they were taken") {
  const scratch::folder folder;
  lab::dark_room room(glossy, {.largest_count = 255, .side = 4}, {});
  lab::gantry machine(room);
  const auto poses = gonio::capture::plan_scan(machine, scattered_pairs(6, 2)).poses;
  const auto taken = lab::measure_all(machine, poses);
  nlohmann::json manifest{{"largest_count", 255}, {"frames", nlohmann::json::array()}};
  for (std::size_t i = 0; i < poses.size(); ++i)
    for (std::size_t j = 0; j < taken[i].times.size(); ++j) {
      const std::string file = std::to_string(i) + "-" + std::to_string(j) + ".png";
      write_counts(folder.path() / file, taken[i].frames[j], 4);
      const auto& [wi, wo] = poses[i];
      manifest["frames"].push_back({{"theta_i", gonio::degrees(gonio::polar_angle(wi))},
                                    {"phi_i", gonio::degrees(gonio::azimuth(wi))},
                                    {"theta_o", gonio::degrees(gonio::polar_angle(wo))},
                                    {"phi_o", gonio::degrees(gonio::azimuth(wo))},
                                    {"seconds", taken[i].times[j]},
                                    {"file", file}});
    }
  const auto manifest_path = folder.path() / "manifest.json";
  write_text(manifest_path, manifest.dump());

  lab::recorded_frames recorded(manifest_path);
  CHECK(recorded.largest_count() == 255);
  REQUIRE(recorded.poses().size() == poses.size());
  lab::scan_in_memory record;
  CHECK(gonio::capture::scan(recorded, poses, record).is_complete());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    CHECK(record.readings[i].times == taken[i].times);
    for (std::size_t j = 0; j < taken[i].times.size(); ++j)
      CHECK((record.readings[i].frames[j] == taken[i].frames[j]).all());
  }

  // The window's pixels alone.
  manifest["window"] = {{"column", 1}, {"row", 2}, {"columns", 3}, {"rows", 2}};
  write_text(manifest_path, manifest.dump());
  const auto part = lab::recorded_frames(manifest_path).measure(poses[0]);
  CHECK(part.frames[0].rows() == 6);
  CHECK((part.frames[0].row(0) == taken[0].frames[0].row(2 * 4 + 1)).all());
  CHECK((part.frames[0].row(5) == taken[0].frames[0].row(3 * 4 + 3)).all());

  SUBCASE("a frame that is missing is a pose that is missing, and the others are measured") {
    std::filesystem::remove(folder.path() / "2-1.png");
    write_text(folder.path() / "4-0.png", "no image");
    lab::scan_in_memory fresh;
    lab::recorded_frames incomplete(manifest_path);
    const auto outcome = gonio::capture::scan(incomplete, poses, fresh);
    CHECK(outcome.measured == poses.size() - 2);
    REQUIRE(outcome.missing.size() == 2u);
    CHECK(outcome.missing[0].number == 2u);
    CHECK(outcome.missing[0].reason.find("2-1.png: cannot be read") != std::string::npos);
    CHECK(outcome.missing[1].reason.find("4-0.png: is not a PNG file") != std::string::npos);
  }
  SUBCASE("a window beside the image is a device that fails") {
    manifest["window"]["row"] = 3;
    write_text(manifest_path, manifest.dump());
    CHECK_THROWS_WITH_AS((void)lab::recorded_frames(manifest_path).measure(poses[0]), Contains("ends outside"),
                         gonio::capture::device_failure);
  }
  SUBCASE("a pose that was not recorded has an obstacle") {
    CHECK(!recorded.place({poses[0].wo, poses[0].wi}).is_reachable());
    CHECK_THROWS_AS((void)recorded.measure({poses[0].wo, poses[0].wi}), gonio::capture::device_failure);
  }
}

TEST_CASE("lab: a manifest that is none says what is wrong") {
  const scratch::folder folder;
  const auto path = folder.path() / "manifest.json";
  const auto refuses = [&](const std::string& text, const char* message) {
    write_text(path, text);
    CHECK_THROWS_WITH_AS(lab::recorded_frames{path}, Contains(message), gonio::error);
  };
  const auto with_frame = [](const std::string& frame) {
    return R"({"largest_count": 255, "frames": [)" + frame + "]}";
  };
  refuses("{", "is not a JSON object");
  refuses("{}", "'largest_count' is missing");
  refuses(R"({"largest_count": 0, "frames": []})", "must be positive");
  refuses(R"({"largest_count": 1.5, "frames": []})", "whole number");
  refuses(R"({"largest_count": 255, "frames": []})", "at least one frame");
  refuses(R"({"largest_count": 255, "window": {"column": 0, "row": 0, "columns": 0, "rows": 1}, "frames": [1]})",
          "no pixel");
  refuses(with_frame("7"), "7 is not a frame");
  refuses(with_frame(R"({"theta_i": 95, "phi_i": 0})"), "above the horizon");
  const std::string angles = R"("theta_i": 30, "phi_i": 0, "theta_o": 40, "phi_o": 180)";
  refuses(with_frame("{" + angles + R"(, "seconds": 0, "file": "a.png"})"), "'seconds' must be positive");
  refuses(with_frame("{" + angles + R"(, "seconds": 0.1})"), "'file' is missing");
  CHECK_THROWS_WITH_AS(lab::recorded_frames{folder.path() / "none.json"}, Contains("cannot be read"), gonio::error);
}
