/// gonio lab probe and unwrap: a camera in any direction, a sphere with a margin, and two images merged.

#include "laboratory.hpp"
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/render/environment_map.hpp>
#include <gonio/table/image.hpp>

#include <cmath>
#include <string>

namespace {

/// A sky with stripes and its images in a sphere from two directions, with a margin and the photographer.
struct two_images {
  two_images() {
    const auto sky = gonio::render::environment_map::of(
        [](const gonio::direction& d) -> gonio::rgb {
          return gonio::rgb(1.0, 2.0, 3.0) * (2.0 + d.y() + std::sin(8.0 * d.x()) * std::cos(5.0 * d.z()));
        },
        64);
    gonio::io::write_npy(folder / "sky.npy", sky.image());
    const std::string probe = "lab probe " + at("sky.npy") + " --size 256 --margin 0.25 --photographer 10 --towards ";
    run(probe + "0,0 -o " + at("a.npy"));
    run(probe + "-90,20,5 -o " + at("b.npy"));
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder / name).string(); }

  /// Returns the error in percent that `lab unwrap` prints with these images and options.
  [[nodiscard]] double error(const std::string& arguments) const {
    const std::string told =
        run("lab unwrap " + arguments + " --rows 32 --truth " + at("sky.npy") + " -o " + at("map.npy"));
    const std::size_t start = told.find("mean relative error ");
    REQUIRE(start != std::string::npos);
    return std::stod(told.substr(start + 20));
  }

  scratch::folder folder;
};

const std::string both_directions = " --towards 0,0 --towards -90,20,5 ";

}  // namespace

TEST_CASE("lab unwrap: two images are merged, and neither the photographer nor the seam remains") {
  const two_images here;
  const std::string circle = " --outline 128,128,102.4 ", both = here.at("a.npy") + ' ' + here.at("b.npy");
  const double one = here.error(here.at("a.npy") + circle), two = here.error(both + both_directions + circle);
  MESSAGE("one image " << one << " %, both " << two << " %");
  CHECK(two < 2.0);
  CHECK(two < 0.7 * one);
  // The sphere is found as well, and the direction matters.
  CHECK(here.error(both + both_directions + "--outline find") < two + 0.3);
  CHECK(here.error(both + both_directions + "--outline find --outline 128,128,102.4") < two + 0.3);
  CHECK(here.error(here.at("b.npy") + " --towards -90,20,5" + circle) < 1.5 * one);
  CHECK(here.error(here.at("b.npy") + circle) > 5.0 * one);
  CHECK(run("lab unwrap " + here.at("a.npy") + " --outline find --rows 16 -o " + here.at("map.npy"))
            .find("a.npy: the sphere is at column 12") != std::string::npos);
  run("lab unwrap " + both + both_directions + circle + "--rows 32 --image " + here.at("look.png") + " -o " +
      here.at("map.npy"));
  CHECK(gonio::io::read_png(here.folder / "look.png").shape(1) == 2u * 32u + 64u + 4u * 4u);  // with margins
}

TEST_CASE("lab unwrap: bad options are refused") {
  const two_images here;
  const std::string to = " -o " + here.at("map.npy"), a = "lab unwrap " + here.at("a.npy"), b = ' ' + here.at("b.npy");
  refuses(a + b + to, "several images need one --towards each: expected 2, not 0");
  refuses(a + b + " --towards 0,0" + to, "expected 2, not 1");
  refuses(a + " --towards 10" + to, "--towards 10: expected AZIMUTH,ELEVATION");
  refuses(a + " --towards 10,up" + to, "--towards: number 2 of a list, 'up'");
  refuses(a + " --outline 128,128" + to, "a.npy: --outline 128,128: expected COLUMN,ROW,RADIUS or find");
  refuses(a + " --outline 200,128,100" + to, "a.npy: an image of a mirror sphere must show all of it");
  refuses(a + b + both_directions + " --outline find --outline find --outline find" + to,
          "--outline needs one value for each of 2 images, not 3");
  refuses(a + " --photographer 100" + to, "--photographer");
  gonio::io::write_npy(here.folder / "grey.npy", gonio::uniform_image(32, 48, gonio::rgb::Constant(0.5)));
  refuses("lab unwrap " + here.at("grey.npy") + " --outline find" + to, "grey.npy: no sphere is found");
  refuses("lab unwrap " + here.at("grey.npy") + to, "must be square, not 32 x 48; --outline find");
  CHECK(!std::filesystem::exists(here.folder / "map.npy"));
}
