/// gonio lab photograph and gonio lab merge: photographs at several exposure times, merged to radiance.

#include "../io/scratch.hpp"
#include "../io/tiff_bytes.hpp"
#include "lab/photographs.hpp"
#include "tool.hpp"
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/images/pnm.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>

namespace {

std::string run_merge(const std::string& arguments) {
  const auto result = gonio_tool("lab " + arguments);
  REQUIRE_MESSAGE(result.exit_code == 0, arguments, ": ", result.output);
  return result.output;
}

void merge_refuses(const std::string& arguments, const std::string& words) {
  const auto result = gonio_tool("lab merge " + arguments);
  CAPTURE(arguments);
  CAPTURE(result.output);
  CHECK(result.exit_code == 2);
  CHECK(result.output.find(words) != std::string::npos);
}

/// A folder with a scene whose left half is grey and whose right half is a thousand times brighter.
struct photographed_scene {
  photographed_scene() {
    gonio::image scene = gonio::uniform_image(20, 40, gonio::rgb(0.02, 0.01, 0.03));
    for (std::size_t row = 0; row < 20; ++row)
      for (std::size_t column = 20; column < 40; ++column) gonio::set_pixel(scene, row, column, gonio::rgb(20, 10, 30));
    gonio::io::write_hdr(at("scene.hdr"), scene);
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder / name).string(); }

  scratch::folder folder;
};

/// Writes a photograph in which all pixels have this count.
void put_frame(const std::filesystem::path& path, std::uint16_t count, std::size_t rows = 2,
               std::uint16_t largest = 4095) {
  gonio::io::write_pnm(path, {rows, 2, largest, std::vector<std::uint16_t>(6 * rows, count)});
}

}  // namespace

TEST_CASE("lab merge: what was photographed comes back, in its deviations") {
  const photographed_scene room;
  const std::string printed = run_merge("photograph " + room.at("scene.hdr") + " -o " + room.at("photos"));
  const std::string noise =
      printed.substr(printed.find("--read-noise"), printed.find('\n') - printed.find("--read-noise"));
  const std::string report = run_merge("merge " + room.at("photos/light") + " --dark " + room.at("photos/dark") +
                                       " --gamma 1 " + noise + " --deviation " + room.at("deviation.npy") + " --mask " +
                                       room.at("mask.png") + " -o " + room.at("radiance.npy"));
  CHECK(report.find("800 pixels: ") == 0);
  CHECK(report.find(" 0 saturated") != std::string::npos);
  const auto truth = gonio::io::read_npy<float, 3>(room.at("photos/truth.npy"));
  const auto found = gonio::io::read_npy<float, 3>(room.at("radiance.npy"));
  const auto deviation = gonio::io::read_npy<float, 3>(room.at("deviation.npy"));
  int within = 0;
  for (std::size_t i = 0; i < truth.size(); ++i)
    if (std::abs(found.data()[i] - truth.data()[i]) < 3.0f * deviation.data()[i]) ++within;
  CHECK(within > 2350);  // of 2400
  CHECK(gonio::io::read_png(room.at("mask.png")).shape(1) == 40);
  // The same without dark frames, as an image.
  run_merge("merge " + room.at("photos/light") + " --dark-level 64 --gamma 1 -o " + room.at("radiance.hdr"));
  const gonio::image seen = gonio::io::read_hdr(room.at("radiance.hdr"));
  CHECK(seen(10, 30, 0) / truth(10, 30, 0) == doctest::Approx(1.0).epsilon(0.03));
}

TEST_CASE("lab merge: cameras that are not linear are estimated") {
  const photographed_scene room;
  for (const std::string camera : {"gamma", "s-shaped"}) {
    run_merge("photograph " + room.at("scene.hdr") + " --camera " + camera + " -o " + room.at(camera));
    CHECK(!std::filesystem::exists(room.at(camera + "/dark")));
    run_merge("merge " + room.at(camera + "/light") + " -o " + room.at("radiance.npy"));
    const auto found = gonio::io::read_npy<float, 3>(room.at("radiance.npy"));
    const auto truth = gonio::io::read_npy<float, 3>(room.at(camera + "/truth.npy"));
    // The common factor is unknown; the contrast is not.
    const double contrast = double{found(10, 30, 1)} / found(10, 10, 1),
                 known = double{truth(10, 30, 1)} / truth(10, 10, 1);
    CHECK(contrast / known == doctest::Approx(1.0).epsilon(0.25));
  }
}

#if defined(GONIO_HAS_TIFF) && defined(GONIO_HAS_EXIF)
TEST_CASE("lab merge: TIFF frames are merged by the exposure times of their EXIF data") {
  const scratch::folder here;
  const auto put = [&](const std::string& name, const std::vector<std::byte>& bytes) {
    scratch::put(here / name, std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  };
  tiff_bytes::image frame{.columns = 2, .rows = 2, .bits = 16, .channels = 3};
  frame.samples.assign(12, 1000);
  frame.exposure = {1, 100};
  put("one.tif", tiff_bytes::of(frame));
  frame.samples.assign(12, 4000);
  frame.exposure = {};
  put("two.TIFF", tiff_bytes::of(frame));
  const std::string merge = here.path().string() + " --gamma 1 -o " + (here / "out.npy").string();
  merge_refuses(merge, "two.TIFF: has no exposure time");
  put("two.jpg", tiff_bytes::jpeg_of({{4, 100}}));  // a JPEG that the camera wrote as well
  run_merge("merge " + merge);
  const auto radiance = gonio::io::read_npy<float, 3>(here / "out.npy");
  // A radiance of 1 gives the middle count in one second; 1000 of 65535 in a hundredth of a second is 3.05.
  CHECK(radiance(0, 0, 0) == doctest::Approx(100.0 * 1000.0 / 32767.5).epsilon(0.001));
  put("two.jpg", tiff_bytes::jpeg_of({{0, 1}}));
  merge_refuses(merge, "two.jpg: an exposure time of 0 s");
  frame.bits = 1;
  frame.exposure = {1, 25};
  put("two.TIFF", tiff_bytes::of(frame));
  merge_refuses(merge, "has 1 bits a sample");
}
#endif

TEST_CASE("lab merge: bad input is refused") {
  const scratch::folder here;
  const auto folder = [&](const std::string& name) {
    std::filesystem::create_directory(here / name);
    return here / name;
  };
  const std::string to = " --gamma 1 -o " + (here / "radiance.npy").string();
  const auto refuses = [&](const std::filesystem::path& frames, const std::string& options, const std::string& words) {
    merge_refuses(frames.string() + options + to, words);
  };
  refuses(folder("empty"), "", "holds no photograph (.png or .tif or .tiff or .ppm or .pgm)");
  put_frame(folder("nameless") / "frame.ppm", 7);
  refuses(here / "nameless", "", "frame.ppm: has no exposure time");
  put_frame(folder("ambiguous") / "frame_2_250s.ppm", 7);
  refuses(here / "ambiguous", "", "ends in two numbers");
  scratch::put(here / "times.csv", std::string("file,seconds\nother.ppm,1\n"));
  refuses(here / "nameless", " --times " + (here / "times.csv").string(), "no exposure time of 'frame.ppm'");
  put_frame(folder("sizes") / "a_1s.ppm", 7);
  put_frame(here / "sizes" / "b_2s.ppm", 14, 3);
  refuses(here / "sizes", "", "b_2s.ppm: has 2 x 3 pixels and counts up to 4095, but a_1s.ppm has 2 x 2");
  put_frame(folder("bright") / "a_1s.ppm", 4095);
  refuses(here / "bright", "", "shorter exposures are needed");
  put_frame(folder("good") / "a_1s.ppm", 700);
  put_frame(here / "good" / "b_2s.ppm", 1400);
  refuses(here / "good", " --dark " + (here / "sizes").string(), "b_2s.ppm");
  put_frame(folder("short") / "dark_0.1s.ppm", 10);
  refuses(here / "good", " --dark " + (here / "short").string(), "dark frames of two exposure times are needed");
  refuses(here / "good", " --dark-level 4090", "the saturation count is");
  merge_refuses((here / "good").string() + " --dark " + (here / "short").string() + " -o " + (here / "a.npy").string(),
                "--dark needs --gamma 1");
  scratch::put(folder("broken") / "a_1s.png", std::string("no PNG"));
  refuses(here / "broken", "", "a_1s.png: is not a PNG file");
  CHECK(!std::filesystem::exists(here / "radiance.npy"));
  // With a table, file names need no times.
  scratch::put(here / "times.csv", std::string("file,seconds\na_1s.ppm,1/250\nb_2s.ppm,1/125\n"));
  CHECK(gonio_tool("lab merge " + (here / "good").string() + " --times " + (here / "times.csv").string() + to)
            .exit_code == 0);
}
