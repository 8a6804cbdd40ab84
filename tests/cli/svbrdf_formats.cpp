/// gonio svbrdf: reads images of all formats in bands.

#include "svbrdf_images.hpp"
#include "tool.hpp"
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/svbrdf_map.hpp>
#include <gonio/table/image.hpp>

#include <doctest/doctest.h>

#include <limits>
#include <string>

#if defined(GONIO_HAS_EXR)
#include "../io/exr_of_others.hpp"
#include <gonio/io/images/exr.hpp>
#endif

namespace {

/// Writes a list of the images with this extension.
void write_list(const images_folder& given, const std::string& extension, const std::string& more = "") {
  std::string list = "{\"quantity\": \"brdf\", " + more + "\"images\": [";
  for (std::size_t i = 0; i < given.angles.size(); ++i)
    list += (i > 0 ? "," : "") + given.entry("image-" + std::to_string(i) + extension, i);
  scratch::put(given.folder / ("images" + extension + ".json"), list + "]}");
}

scratch::fs::path file_of(const images_folder& given, std::size_t i, const std::string& extension) {
  return given.folder / ("image-" + std::to_string(i) + extension);
}

}  // namespace

TEST_CASE("svbrdf: images of Radiance HDR make the same map as their values in arrays") {
  const images_folder given;
  for (std::size_t i = 0; i < given.images.size(); ++i) {
    gonio::io::write_hdr(file_of(given, i, ".hdr"), given.images[i]);
    given.replace(i, gonio::io::read_hdr(file_of(given, i, ".hdr")));
  }
  write_list(given, ".hdr");
  run(given.command("expected.gsv"));
  run(given.command("map.gsv", "images.hdr.json") + " --threads 2");
  CHECK(scratch::get(given.folder / "map.gsv") == scratch::get(given.folder / "expected.gsv"));
  // Resumes after the first band.
  const std::string whole = scratch::get(given.folder / "map.gsv");
  scratch::put(given.folder / "next.gsv.part", whole.substr(0, whole.size() - 1000));
  CHECK(run(given.command("next.gsv", "images.hdr.json")).find("resumed after band 1 of 2") != std::string::npos);
  CHECK(scratch::get(given.folder / "next.gsv") == whole);
  // Refuses a truncated file, and a header that states more rows than the file has.
  const std::string image = scratch::get(file_of(given, 2, ".hdr"));
  scratch::put(file_of(given, 2, ".hdr"), image.substr(0, image.size() - 9));
  refuses(given.command("cut.gsv", "images.hdr.json"), {"image-2.hdr: the HDR file is truncated"});
  std::string lying = image;
  lying.replace(lying.find("-Y 70"), 5, "-Y 71");
  scratch::put(file_of(given, 2, ".hdr"), lying);
  refuses(given.command("cut.gsv", "images.hdr.json"), {"image-2.hdr: the HDR file is truncated"});
  CHECK(!scratch::fs::exists(given.folder / "cut.gsv.part"));
}

#if defined(GONIO_HAS_EXR)
TEST_CASE("svbrdf: images of OpenEXR make the same map as their values in arrays, cut ones are refused") {
  const images_folder given;
  for (std::size_t i = 0; i < given.images.size(); ++i)
    gonio::io::write_exr(file_of(given, i, ".exr"), given.images[i]);
  write_list(given, ".exr");
  run(given.command("expected.gsv"));
  run(given.command("map.gsv", "images.exr.json") + " --threads 2");
  CHECK(scratch::get(given.folder / "map.gsv") == scratch::get(given.folder / "expected.gsv"));
  const std::string image = scratch::get(file_of(given, 2, ".exr"));
  scratch::put(file_of(given, 2, ".exr"), image.substr(0, image.size() - 9));
  refuses(given.command("cut.gsv", "images.exr.json"), {"image-2.exr: cannot be decoded as OpenEXR"});
  // A damaged block is found when it is decoded. The bands before it are kept, as for any job that stops.
  std::string damaged = image;
  damaged[image.size() - 2000] = static_cast<char>(~damaged[image.size() - 2000]);
  scratch::put(file_of(given, 2, ".exr"), damaged);
  refuses(given.command("damaged.gsv", "images.exr.json"), {"image-2.exr: cannot be decoded as OpenEXR"});
  CHECK(!scratch::fs::exists(given.folder / "damaged.gsv"));
  // With the file repaired, the job resumes.
  scratch::put(file_of(given, 2, ".exr"), image);
  run(given.command("damaged.gsv", "images.exr.json"));
  CHECK(scratch::get(given.folder / "damaged.gsv") == scratch::get(given.folder / "expected.gsv"));
}

TEST_CASE("svbrdf: texels of OpenEXR images that are not numbers are refused or skipped") {
  const images_folder given;
  for (std::size_t i = 0; i < given.images.size(); ++i) {
    auto image = given.images[i];
    const auto file = file_of(given, i, ".exr");
    if (i == 1) image(50, 7, 2) = std::numeric_limits<float>::quiet_NaN();
    put_lines(file, image, Imf::PIZ_COMPRESSION);
    given.replace(i, image);
  }
  write_list(given, ".exr");
  refuses(given.command("map.gsv", "images.exr.json"), {"image-1.exr", "row 50, column 7", "not a finite number"});
  write_list(given, ".exr", "\"invalid\": \"skip\", ");
  write_list(given, ".npy", "\"invalid\": \"skip\", ");
  run(given.command("map.gsv", "images.exr.json"));
  run(given.command("expected.gsv", "images.npy.json"));
  CHECK(scratch::get(given.folder / "map.gsv") == scratch::get(given.folder / "expected.gsv"));
  CHECK(!gonio::io::svbrdf_map(given.folder / "map.gsv").read_band(1).has_material(7 * 375 + 7));
}
#endif
