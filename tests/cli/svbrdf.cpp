/// gonio svbrdf: from registered images to a map of BRDFs.

#include "svbrdf_images.hpp"
#include "tool.hpp"
#include <gonio/core/half.hpp>
#include <gonio/estimate/decomposition.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/table/image.hpp>

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

TEST_CASE("svbrdf: each texel is what a decomposition of its samples finds") {
  const images_folder given;
  const std::string output = run(given.command("map.gsv") + " --threads 3");
  CHECK(output.find("375 x 70 texels, 4 images, 6 components, eta 2.5") != std::string::npos);
  const gonio::io::svbrdf_map map(given.folder / "map.gsv");
  map.require_prior(given.prior);
  REQUIRE(map.header().bands() == 2);
  REQUIRE(map.header().directions.size() == 4);
  const gonio::decomposition one_by_one{given.prior, gonio::tikhonov{2.5}};
  for (const Eigen::Index row : {0, 42, 43, 69}) {
    const auto band = map.read_band(row / map.header().band_rows);
    for (const Eigen::Index column : {0, 211, 374}) {
      gonio::sample_set samples;
      for (std::size_t i = 0; i < given.angles.size(); ++i)
        samples.push_back(
            {map.header().directions[i],
             {given.images[i](row, column, 0), given.images[i](row, column, 1), given.images[i](row, column, 2)},
             1.0});
      const Eigen::MatrixXd expected = one_by_one.fit(samples).weights();
      const Eigen::MatrixXd found =
          gonio::io::weights_of_texel(map.header(), band, row % map.header().band_rows * 375 + column);
      CHECK((found - expected).cwiseAbs().maxCoeff() < 1e-3 * expected.cwiseAbs().maxCoeff());  // half floats
    }
  }
  run(given.command("one.gsv") + " --threads 1");
  CHECK(scratch::get(given.folder / "one.gsv") == scratch::get(given.folder / "map.gsv"));
  const std::string facts = run("info " + (given.folder / "map.gsv").string());
  CHECK(facts.find("disagreement") != std::string::npos);
}

TEST_CASE("svbrdf: an unfinished map is gone on with, unless it is of other images or another job") {
  const images_folder given;
  run(given.command("map.gsv"));
  const std::string whole = scratch::get(given.folder / "map.gsv");
  const auto part = given.folder / "next.gsv.part";
  scratch::put(part, whole.substr(0, whole.size() - 1000));
  CHECK(run(given.command("next.gsv")).find("resumed after band 1 of 2") != std::string::npos);
  CHECK(scratch::get(given.folder / "next.gsv") == whole);
  CHECK(!scratch::fs::exists(part));
  // Refuses to resume with other images of the same size.
  scratch::put(part, whole.substr(0, whole.size() - 1000));
  auto changed = given.images[1];
  changed(20, 3, 1) = 9.0f;
  given.replace(1, changed);
  refuses(given.command("next.gsv"), {"next.gsv.part", "other images"});
  given.replace(1, given.images[1]);
  // Refuses to resume with another penalty.
  refuses(given.command("next.gsv", "images.json", "3"), {"next.gsv.part", "another job"});
  // The finished bands are still there.
  CHECK(whole.starts_with(scratch::get(part)));
  CHECK(scratch::fs::file_size(part) > whole.size() / 2);
}

TEST_CASE("killed: gonio svbrdf, given again, ends with the same bytes") {
  const images_folder given;
  run(given.command("map.gsv"));
  std::mt19937 generator(8);
  std::uniform_int_distribution<int> moment(1, 60);
  const char* wanted = std::getenv("GONIO_KILLS");
  for (int kill = wanted == nullptr ? 4 : std::stoi(wanted); kill > 0; --kill) {
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      const std::string line = "exec '" GONIO_TOOL "' " + given.command("again.gsv") + " > /dev/null 2>&1";
      ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
      ::_exit(127);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(moment(generator)));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
  }
  run(given.command("again.gsv"));
  CHECK(scratch::get(given.folder / "again.gsv") == scratch::get(given.folder / "map.gsv"));
}

TEST_CASE("svbrdf: images that do not fit, that are missing or hold no numbers, and bad lists are refused") {
  const images_folder given;
  auto image = given.images[2];
  image(50, 7, 1) = std::nanf("");
  given.replace(2, image);
  refuses(given.command("map.gsv"), {"image-2.npy", "row 50, column 7", "not a finite number"});
  given.replace(2, xt::xtensor<float, 3>(std::array<std::size_t, 3>{70, 374, 3}, 0.1f));
  refuses(given.command("other.gsv"), {"image-2.npy: has 374 x 70 pixels", "375 x 70"});
  scratch::fs::remove(given.folder / "image-2.npy");
  refuses(given.command("other.gsv"), {"image-2.npy", "No such file"});
  const auto list = [&](const std::string& text) { scratch::put(given.folder / "list.json", text); };
  const std::string command = given.command("other.gsv", "list.json");
  list("{\"quantity\": \"brdf\", \"images\": []}");
  refuses(command, {"list.json", "'images'"});
  list("{\"images\": [" + given.entry("image-0.npy", 0) + "]}");
  refuses(command, {"list.json", "'quantity'"});
  list("{\"quantity\": \"light\", \"images\": [" + given.entry("image-0.npy", 0) + "]}");
  refuses(command, {"list.json", "'light'"});
  list(
      "{\"quantity\": \"brdf\", \"images\": [{\"image\": \"image-0.npy\", \"theta_i\": 30, \"phi_i\": 0, "
      "\"theta_o\": 95, \"phi_o\": 0}]}");
  refuses(command, {"list.json", "above the horizon"});
  list("{\"quantity\": \"brdf\", \"images\": [{\"image\": \"image-0.npy\", \"theta_i\": 30}]}");
  refuses(command, {"list.json", "'phi_i'"});
  list("{\"quantity\": \"brdf\", \"masks\": \"m.png\", \"images\": [" + given.entry("image-0.npy", 0) + "]}");
  refuses(command, {"list.json", "'masks' is unknown", "expected one of quantity, mask, invalid, images"});
  list(
      "{\"quantity\": \"brdf\", \"images\": [{\"image\": \"image-0.npy\", \"theta_h\": 30, \"theta_d\": 0, "
      "\"phi_d\": 0, \"exposure\": 2}]}");
  refuses(command, {"list.json", "'exposure' is unknown", "image-0.npy"});
  gonio::io::write_png(given.folder / "photograph.png", gonio::uniform_image(70, 375, gonio::rgb::Ones()));
  list("{\"quantity\": \"brdf\", \"images\": [" + given.entry("photograph.png", 0) + "]}");
  refuses(command, {"photograph.png: is not an image of linear radiance", ".hdr, .npy or .exr"});
  CHECK(!scratch::fs::exists(given.folder / "other.gsv"));
  CHECK(!scratch::fs::exists(given.folder / "other.gsv.part"));
}

TEST_CASE("svbrdf: two jobs on one output, the second is refused") {
  const images_folder given;
  run(given.command("map.gsv"));
  scratch::put(given.folder / "busy.gsv.part", scratch::get(given.folder / "map.gsv").substr(0, 100));
  const gonio::io::svbrdf_map map(given.folder / "map.gsv");
  const gonio::io::svbrdf_writer first(given.folder / "busy.gsv", map.header());
  refuses(given.command("busy.gsv"), {"busy.gsv", "another process is writing"});
}

TEST_CASE("svbrdf: of two commands at once one writes the map, and the other does so later or is refused") {
  const images_folder given;
  run(given.command("map.gsv"));
  std::array<tool_result, 2> both;
  {
    std::jthread other([&] { both[1] = gonio_tool(given.command("both.gsv")); });
    both[0] = gonio_tool(given.command("both.gsv"));
  }
  for (const tool_result& each : both)
    if (each.exit_code != 0) check_refusal(each, {"both.gsv", "another process is writing"});
  CHECK(std::min(both[0].exit_code, both[1].exit_code) == 0);
  CHECK(scratch::get(given.folder / "both.gsv") == scratch::get(given.folder / "map.gsv"));
  CHECK(!scratch::fs::exists(given.folder / "both.gsv.part"));
}

TEST_CASE("svbrdf: on a full disk it says so, and the command given again goes on with what is written") {
  const images_folder given;
  run(given.command("map.gsv"));
  const auto size = scratch::fs::file_size(given.folder / "map.gsv");
  // A limit on file size, in blocks of 512 bytes, stands in for a full disk.
  const auto limited = [&](std::uintmax_t bytes, const std::string& arguments) {
    return run_program("sh",
                       "-c \"ulimit -f " + std::to_string(bytes / 512) + "; exec '" GONIO_TOOL "' " + arguments + "\"");
  };
  check_refusal(limited(size / 2, given.command("full.gsv")), {"full.gsv.part: cannot be written: File too large"});
  check_refusal(limited(size - 4096, given.command("full.gsv")),
                {"full.gsv.part", "File too large", "the first 1 of 2 bands are kept"});
  CHECK(!scratch::fs::exists(given.folder / "full.gsv"));
  CHECK(run(given.command("full.gsv")).find("resumed after band 1 of 2") != std::string::npos);
  CHECK(scratch::get(given.folder / "full.gsv") == scratch::get(given.folder / "map.gsv"));
  // The same while a mask is decoded.
  gonio::io::write_png(given.folder / "mask.png", gonio::uniform_image(70, 375, gonio::rgb::Ones()));
  scratch::put(given.folder / "masked.json",
               "{\"quantity\": \"brdf\", \"mask\": \"mask.png\", \"images\": [" + given.entry("image-0.npy", 0) + "]}");
  check_refusal(limited(16384, given.command("masked.gsv", "masked.json")),
                {"the decoded", "mask.png", "File too large"});
  CHECK(!scratch::fs::exists(given.folder / "masked.gsv.part"));
}

TEST_CASE("svbrdf: quantities are made BRDFs") {
  const images_folder given;
  gonio::image flat = gonio::uniform_image(3, 4, gonio::rgb::Constant(0.5));
  gonio::io::write_npy(given.folder / "flat.npy", flat);
  scratch::put(given.folder / "flat.json",
               "{\"quantity\": \"brdf\", \"images\": [" + given.entry("flat.npy", 0) + "]}");
  for (float& each : flat) each *= 100.0f * 3.14159265f;
  gonio::io::write_npy(given.folder / "percent.npy", flat);
  scratch::put(given.folder / "percent.json",
               "{\"quantity\": \"percent\", \"images\": [" + given.entry("percent.npy", 0) + "]}");
  run(given.command("flat.gsv", "flat.json"));
  run(given.command("percent.gsv", "percent.json"));
  const auto weights = [&](const char* file) {
    const gonio::io::svbrdf_map map(given.folder / file);
    return gonio::io::weights_of_texel(map.header(), map.read_band(0), 5);
  };
  const Eigen::MatrixXd expected = weights("flat.gsv");
  CHECK((weights("percent.gsv") - expected).cwiseAbs().maxCoeff() < 1e-3 * expected.cwiseAbs().maxCoeff());
}

TEST_CASE("svbrdf: weights, functions, uncertainty and disagreement as arrays") {
  const images_folder given;
  const auto file = [&](const char* name) { return (given.folder / name).string(); };
  run(given.command("map.gsv") + " --weights " + file("w.npy") + " --functions " + file("f.npy") + " --uncertainty " +
      file("u.npy") + " --disagreement " + file("d.npy"));
  const auto weights = gonio::io::read_npy<float, 4>(file("w.npy"));
  const auto functions = gonio::io::read_npy<float, 2>(file("f.npy"));
  const auto disagreement = gonio::io::read_npy<float, 2>(file("d.npy"));
  CHECK(gonio::io::read_npy<float, 2>(file("u.npy")).shape(1) == 375);
  REQUIRE(weights.shape(3) == 4);
  REQUIRE(functions.shape(0) == 6);
  const gonio::io::svbrdf_map map(given.folder / "map.gsv");
  const auto band = map.read_band(1);
  const Eigen::MatrixXd expected = gonio::io::weights_of_texel(map.header(), band, 2 * 375 + 9);
  for (Eigen::Index c = 0; c < 3; ++c)
    for (Eigen::Index k = 0; k < 6; ++k) {
      double sum = 0.0;
      for (std::size_t r = 0; r < 4; ++r) sum += double{functions(k, r)} * double{weights(45, 9, c, r)};
      CHECK(sum == doctest::Approx(expected(k, c)).epsilon(1e-4));
    }
  CHECK(disagreement(45, 9) == gonio::from_half(band.disagreement[2 * 375 + 9]));
}

TEST_CASE("svbrdf: a map is drawn as a flat sample, and with its own prior only") {
  const images_folder given;
  run(given.command("map.gsv"));
  const std::string map = (given.folder / "map.gsv").string(), image = (given.folder / "map.png").string();
  const std::string prior = " --prior " + (given.folder / "small.prior").string();
  run("render " + map + prior + " --light 20,10 --exposure 0.5 -o " + image);
  const gonio::image drawn = gonio::io::read_png(image);
  REQUIRE(drawn.shape(0) == 70);
  REQUIRE(drawn.shape(1) == 375);
  const gonio::io::svbrdf_map read(map);
  const double right = gonio::radians(20.0), up = gonio::radians(10.0);
  const gonio::direction light{std::sin(right) * std::cos(up), std::sin(up), std::cos(right) * std::cos(up)};
  const auto band = read.read_band(1);
  for (const Eigen::Index column : {0, 200, 374}) {
    const gonio::fitted_brdf fit(given.prior, gonio::io::weights_of_texel(read.header(), band, 2 * 375 + column));
    const gonio::rgb radiance = fit(light, gonio::direction(0, 0, 1)) * light.z() * 3.14159265 * 0.5;
    for (Eigen::Index c = 0; c < 3; ++c)
      CHECK(drawn(45, column, c) == doctest::Approx(std::clamp(radiance[c], 0.0, 1.0)).epsilon(0.03));
  }
  refuses("render " + map + " -o " + image, {"map.gsv", "another prior"});
  refuses("render " + map + prior + " --slices -o " + image, {"map.gsv", "needs to be the only input"});
}
