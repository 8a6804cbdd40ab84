#include "sample_text.hpp"
#include "scratch.hpp"
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/text/text.hpp>

#include <rapidcheck.h>

#include <ranges>

using gonio::degrees;
using gonio::radians;
using gonio::io::read_directions;
using gonio::io::read_samples;
using gonio::io::write_samples;
using scratch::check_refused;
using scratch::check_text_refused;

namespace {

const std::string header = "theta_h,theta_d,phi_d,r,g,b\n";

}  // namespace

TEST_CASE("a file without a column of values has directions alone, in any dialect") {
  using gonio::io::has_directions_alone;
  CHECK(has_directions_alone("theta_i;phi_i;theta_o;phi_o\n10,5;0;20;180\n", "a.csv"));
  CHECK(!has_directions_alone("theta_i,phi_i,theta_o,phi_o,r,g,b\n10,0,20,180,1,1,1\n", "a.csv"));
}

TEST_CASE("half and difference angles are read in degrees") {
  const auto samples =
      read_samples("theta_h,theta_d,phi_d,r,g,b,weight\n10,20,30,0.1,-0.2,3e-1,2\n5,60,340,1,2,3,0\n", "x");
  REQUIRE(samples.size() == 2);
  CHECK(samples[0].angles().theta_h == radians(10));
  CHECK(samples[0].angles().theta_d == radians(20));
  CHECK(samples[0].angles().phi_d == radians(30));
  CHECK((samples[0].value == gonio::rgb(0.1, -0.2, 0.3)).all());
  CHECK(samples[0].weight == 2.0);
  CHECK(degrees(samples[1].angles().phi_d) == doctest::Approx(160));
  CHECK(samples[1].weight == 0.0);
}

TEST_CASE("a sample may have a weight for each channel") {
  const std::string columns = "weight_g,theta_h,theta_d,phi_d,r,g,b,weight_r,weight_b\n";
  const auto samples = read_samples(columns + "0.5,10,20,30,1,2,3,2,0\n", "x");
  CHECK(samples[0].weight == gonio::channel_weights(gonio::rgb(2.0, 0.5, 0.0)));
  check_text_refused(columns + "0.5,10,20,30,1,2,3,2,-1\n", {"line 2", "weight_b", "-1", "negative"});
  check_text_refused("theta_h,theta_d,phi_d,r,g,b,weight_r,weight_b\n1,2,3,1,1,1,1,1\n", {"weight_g", "missing"});
  check_text_refused("theta_h,theta_d,phi_d,r,g,b,weight,weight_r,weight_g,weight_b\n1,2,3,1,1,1,1,1,1,1\n",
                     {"line 1", "two ways", "weight_r,weight_g,weight_b"});
}

TEST_CASE("half angles are read from columns or from a comment") {
  const std::string at = "theta_h,theta_d,phi_d,r,g,b";
  const auto columns = read_samples(
      at + ",source_half_angle,Receiver Half Angle [rad]\n10,20,30,1,2,3,0.25,0.02\n10,20,30,1,2,3,0,0\n", "x");
  CHECK(columns[0].aperture.source == doctest::Approx(radians(0.25)));
  CHECK(columns[0].aperture.receiver == doctest::Approx(0.02));
  CHECK(columns[1].aperture.is_point());
  const auto above = read_samples("# receiver-half-angle: 1.5\n" + at + "\n10,20,30,1,2,3\n11,20,30,1,2,3\n", "x");
  for (const gonio::sample& each : above) CHECK(each.aperture == gonio::aperture{0.0, radians(1.5)});
  const scratch::folder here;
  write_samples(here / "a", columns);
  const auto again = read_samples(here / "a");
  for (std::size_t i = 0; i < 2; ++i) {
    CHECK(again[i].aperture.source == doctest::Approx(columns[i].aperture.source));
    CHECK(again[i].aperture.receiver == doctest::Approx(columns[i].aperture.receiver));
  }
  check_text_refused("# receiver-half-angle: wide\n" + at + "\n10,20,30,1,2,3\n",
                     {"line 1", "receiver-half-angle", "wide", "degrees"});
  for (const char* angle : {"-1", "46"})
    check_text_refused(at + ",receiver_half_angle\n10,20,30,1,2,3," + angle + "\n",
                       {"line 2", "receiver_half_angle", angle, "0 to 45"});
}

TEST_CASE("all three ways to give directions agree") {
  const gonio::direction wi = gonio::spherical_direction(radians(30), radians(40));
  const gonio::direction wo = gonio::spherical_direction(radians(50), radians(200));
  const gonio::half_difference expected = gonio::to_half_difference(wi, wo);
  const auto vector_text = [](const gonio::direction& w) {
    return gonio::io::shortest(w.x()) + "," + gonio::io::shortest(w.y()) + "," + gonio::io::shortest(w.z());
  };
  for (const std::string& text :
       {std::string("theta_i,phi_i,theta_o,phi_o,r,g,b\n30,40,50,200,1,1,1\n"),
        std::string("theta_i,phi_i,theta_o,phi_o,r,g,b\n-30,220,50,-160,1,1,1\n"),
        "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,r,g,b\n" + vector_text(wi) + "," + vector_text(wo) + ",1,1,1\n",
        // Rounded vectors of instruments are normalised.
        "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,r,g,b\n" + vector_text(1.0009 * wi) + "," + vector_text(0.9991 * wo) +
            ",1,1,1\n"}) {
    CAPTURE(text);
    const auto samples = read_samples(text, "x");
    REQUIRE(samples.size() == 1);
    CHECK(samples[0].angles().theta_h == doctest::Approx(expected.theta_h).epsilon(1e-12));
    CHECK(samples[0].angles().theta_d == doctest::Approx(expected.theta_d).epsilon(1e-12));
    CHECK(samples[0].angles().phi_d == doctest::Approx(expected.phi_d).epsilon(1e-12));
    CHECK(samples[0].weight == 1.0);
  }
}

TEST_CASE("columns may have any order, blanks, comments and either line end") {
  const auto samples = read_samples(
      "\xEF\xBB\xBF# measured on a Thursday\r\n\r\n b , weight,\tr, g ,phi_d, theta_d , theta_h\r\n"
      "  # another\r\n 3 ,4, +1 ,2,30,20,10\r\n   \r\n3,4,1,2,30,20,10",
      "x");
  REQUIRE(samples.size() == 2);
  for (const gonio::sample& s : samples) {
    CHECK((s.value == gonio::rgb(1, 2, 3)).all());
    CHECK(s.weight == 4.0);
    CHECK(s.angles().theta_h == radians(10));
    CHECK(s.angles().phi_d == radians(30));
  }
}

TEST_CASE("directions are read without values") {
  const scratch::folder here;
  scratch::put(here / "a", "theta_h,theta_d,phi_d\n9,12,69\n1,7,180\n");
  const auto directions = read_directions(here / "a");
  REQUIRE(directions.size() == 2);
  CHECK(directions[0].theta_h == radians(9));
  CHECK(directions[1].phi_d == 0.0);
  scratch::put(here / "b", "theta_h,theta_d,phi_d,r,g,b\n9,12,69,1,1,1\n");
  CHECK(read_directions(here / "b").size() == 1);
  check_refused([&] { return read_samples(here / "a"); }, {"line 1", "'r' is missing"});
  scratch::put(here / "c", "theta_h,theta_d,phi_d,r,b\n9,12,69,1,1\n");
  check_refused([&] { return read_directions(here / "c"); }, {"line 1", "'g' is missing"});
  scratch::put(here / "d", "theta_h,theta_d,phi_d\n9,12,69\n80,80,0\n");
  check_refused([&] { return read_directions(here / "d"); }, {"line 3", "horizon", "theta_h 80"});
  scratch::check_refuses_non_files([](const auto& path) { return read_directions(path); });
}

TEST_CASE("pairs of directions distinguish light and viewer and are read back") {
  const scratch::folder here;
  scratch::put(here / "a", "theta_i,phi_i,theta_o,phi_o\n40,0,-30,0\n");
  const auto read = gonio::io::read_direction_pairs(here / "a");
  REQUIRE(read.size() == 1);
  CHECK(read[0].wi.isApprox(gonio::spherical_direction(radians(40), 0.0)));
  CHECK(read[0].wo.isApprox(gonio::spherical_direction(radians(30), std::numbers::pi)));

  gonio::io::write_direction_pairs(here / "b", read);
  CHECK(scratch::get(here / "b") == "theta_i,phi_i,theta_o,phi_o\n40,0,30,180\n");
  const auto again = gonio::io::read_direction_pairs(here / "b");
  REQUIRE(again.size() == 1);
  CHECK(again[0].wo.isApprox(read[0].wo));

  // phi_d above pi exchanges light and viewer.
  scratch::put(here / "c", "theta_h,theta_d,phi_d\n20,10,30\n20,10,210\n");
  const auto folded = gonio::io::read_direction_pairs(here / "c");
  REQUIRE(folded.size() == 2);
  CHECK(folded[0].wi.isApprox(folded[1].wo));
  CHECK(folded[0].wo.isApprox(folded[1].wi));
  scratch::put(here / "d", "theta_i,phi_i,theta_o,phi_o\n40,0,30,0\n40,0,90,0\n");
  check_refused([&] { return gonio::io::read_direction_pairs(here / "d"); }, {"line 3", "theta_o", "horizon"});
}

TEST_CASE("bad headers are refused") {
  check_text_refused("", {"is empty", "expected a header line"});
  check_text_refused("\n# only a comment\n\n", {"is empty", "expected a header line"});
  check_text_refused(header, {"no samples", "at least one"});
  check_text_refused("# c\ntheta_h,theta_d,phi_d,r,g,azure\n",
                     {"line 2", "'b' is missing", "looks comma-separated", "unknown columns: 'azure'"});
  check_text_refused("theta_h,theta_d,phi_d,r,g,b,g\n", {"line 1", "'g' appears twice"});
  check_text_refused("theta_h,phi_d,r,g,b\n", {"line 1", "'theta_d' is missing"});
  check_text_refused("theta_i,phi_i,theta_o,r,g,b\n", {"line 1", "'phi_o' is missing"});
  check_text_refused("wi_x,wi_y,wi_z,wo_x,wo_y,r,g,b\n", {"line 1", "'wo_z' is missing"});
  check_text_refused("theta_h,theta_d,phi_d,r,g\n", {"line 1", "'b' is missing"});
  check_text_refused("r,g,b\n", {"line 1", "no columns of directions"});
  check_text_refused("theta_h,theta_d,phi_d,theta_i,r,g,b\n", {"line 1", "more than one way"});
  check_text_refused("10,20,30,1,1,1\n", {"line 1", "no header line", "looks comma-separated"});
  check_text_refused(std::string(1000, '\x01'),
                     {"line 1", "no columns of directions", "separated by blanks", "'????", "...'"});
}

TEST_CASE("bad lines are refused; the error names line, column and value") {
  const auto line_refused = [](const std::string& line, std::initializer_list<std::string> words) {
    check_text_refused(header + "1,2,3,4,5,6\n\n" + line + "\n1,2,3,4,5,6\n", words);
    check_text_refused(header + "1,2,3,4,5,6\n\n" + line, {"line 4"});
  };
  line_refused("1,2,3,4,5", {"5 fields", "expected 6"});
  line_refused("1,2,3,4,5,6,7", {"7 fields", "expected 6"});
  line_refused("1,2,3,4,five,6", {"column g", "'five' is not a number"});
  line_refused("1,2,3,4,5 5,6", {"column g", "'5 5' is not a number"});
  line_refused("1,2,3,4,0x10,6", {"column g", "'0x10' is not a number"});
  line_refused("1,2,3,4,+-5,6", {"column g", "'+-5' is not a number"});
  line_refused("1,2,3,4,+,6", {"column g", "'+' is not a number"});
  line_refused("1,2,3,4,5,1e999", {"column b", "'1e999' is out of range"});
  line_refused("1,2,3,4,5,1e39", {"column b", "1e+39 sr^-1 is outside the range of float"});
  line_refused("1,2,3,-1e300,5,6", {"column r", "-1e+300 sr^-1"});
  check_text_refused(header + "nan,2,3,4,5,6\n", {"line 2: column theta_h: 'nan' is not finite", "1 of 1 row"});
  line_refused("90,2,3,4,5,6", {"column theta_h", "90 degrees", "horizon"});
  line_refused("-1,2,3,4,5,6", {"column theta_h", "-1 degrees is negative", "expected at least 0"});
  line_refused("1,120,3,4,5,6", {"column theta_d", "120 degrees"});
  line_refused("1,2,720,4,5,6", {"column phi_d", "720 degrees", "from -360 to 360"});
  line_refused("50,60,10,4,5,6", {"horizon", "theta_h 50", "theta_d 60", "phi_d 10"});
  line_refused("1,2,3,4,5,\xFF\x02", {"column b", "'?\?' is not a number"});

  check_text_refused("theta_h,theta_d,phi_d,r,g,b,weight\n1,2,3,4,5,6,-0.5\n",
                     {"line 2", "column weight", "-0.5 is negative"});
  const std::string angles = "theta_i,phi_i,theta_o,phi_o,r,g,b\n";
  check_text_refused(angles + "95,0,10,0,1,1,1\n", {"line 2", "column theta_i", "95 degrees", "below the horizon"});
  check_text_refused(angles + "10,0,-91,0,1,1,1\n", {"line 2", "column theta_o", "-91 degrees", "below the horizon"});
  check_text_refused(angles + "10,0,-90,0,1,1,1\n", {"no sample above the horizon"});
  check_text_refused(angles + "10,999,0,0,1,1,1\n", {"line 2", "column phi_i", "999 degrees"});
  const std::string vectors = "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,r,g,b\n";
  check_text_refused(vectors + "0,0,1,0,0,1.2,1,1,1\n", {"line 2", "wo_x to wo_z", "length 1.2", "expected 1"});
  check_text_refused(vectors + "0,0,0,0,0,1,1,1,1\n", {"line 2", "wi_x to wi_z", "length 0"});
  check_text_refused(vectors + "0,0.6,-0.8,0,0,1,1,1,1\n", {"line 2", "wi_x to wi_z", "horizon", "-0.8"});
  check_text_refused(vectors + "1,0,0,0,0,1,1,1,1\n", {"line 2", "wi_x to wi_z", "horizon"});
  check_text_refused(vectors + "1e200,0,1,0,0,1,1,1,1\n", {"line 2", "wi_x to wi_z", "length"});
}

TEST_CASE("rows of measurements at 90 degrees are left out and counted") {
  std::vector<std::string> notes;
  gonio::io::sample_reading reading;
  reading.note = [&](const std::string& note) { notes.push_back(note); };
  const auto samples = gonio::io::read_samples(
      "theta_i,phi_i,theta_o,phi_o,r,g,b\n10,0,-90,0,1,1,1\n10,0,20,0,1,2,3\n90,0,20,0,7,7,7\n10,0,30,0,1,2,3\n",
      "arm.csv", reading);
  REQUIRE(samples.size() == 2);
  CHECK(samples[0].value.y() == 2.0);
  CHECK(notes == std::vector<std::string>{"arm.csv: 2 of 4 rows are left out: light or viewer is at 90 degrees"});
}

TEST_CASE("samples, directions and pairs accept the same grazing directions") {
  const scratch::folder here;
  const auto path = here / "grazing.csv";
  const auto accepts = [&](const auto& read) {
    try {
      return read(path).size() == 1;
    } catch (const gonio::error&) {
      return false;
    }
  };
  int accepted = 0, refused = 0;
  for (const char* row : {"89.9999999,0,-89.9999989,0", "-89.9999989,0,89.9999999,0", "89.9999999,10,89.9999999,190",
                          "89.99999999999999,0,0,0", "89.9,0,-89.9,0", "89.999,45,89.999,225"}) {
    CAPTURE(row);
    scratch::put(path, "theta_i,phi_i,theta_o,phi_o,r,g,b\n" + std::string(row) + ",1,1,1\n");
    const bool as_direction = accepts([](const auto& file) { return gonio::io::read_directions(file); });
    CHECK(accepts([](const auto& file) { return gonio::io::read_direction_pairs(file); }) == as_direction);
    CHECK(accepts([](const auto& file) { return read_samples(file); }) == as_direction);
    ++(as_direction ? accepted : refused);
  }
  CHECK(accepted >= 2);
  CHECK(refused >= 1);
}

TEST_CASE("unreadable files of samples are refused") {
  scratch::check_refuses_non_files([](const auto& path) { return read_samples(path); });
}

TEST_CASE("a written set is read back") {
  const scratch::folder here;
  CHECK(rc::check("samples round trip", [&] {
    const auto number = [](double low, double high) {
      return low + (high - low) * *rc::gen::inRange(0, 1 << 30) / (1 << 30);
    };
    gonio::sample_set samples(*rc::gen::inRange(1, 20));
    const bool apart = *rc::gen::arbitrary<bool>();
    for (gonio::sample& s : samples) {
      const auto polar = [&] { return radians(number(0.0, 89.9)); };
      const auto wi = gonio::spherical_direction(polar(), radians(number(0.0, 360.0)));
      const auto wo = gonio::spherical_direction(polar(), radians(number(0.0, 360.0)));
      s = {gonio::to_half_difference(wi, wo),
           {number(-1.0, 1.0), number(0.0, 1e-7), number(0.0, 1e9)},
           number(0.0, 5.0)};
      if (apart) s.weight = gonio::rgb(number(0.0, 5.0), number(0.0, 5.0), 1.0);
    }
    write_samples(here / "a", samples);
    const auto again = read_samples(here / "a");
    RC_ASSERT(again.size() == samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
      RC_ASSERT((again[i].value == samples[i].value).all());
      RC_ASSERT(again[i].weight == samples[i].weight);
      // The conversion to degrees and back rounds.
      RC_ASSERT(std::abs(again[i].angles().theta_h - samples[i].angles().theta_h) < 1e-15);
      RC_ASSERT(std::abs(again[i].angles().theta_d - samples[i].angles().theta_d) < 1e-15);
      RC_ASSERT(std::abs(std::sin(again[i].angles().phi_d - samples[i].angles().phi_d)) < 1e-15);
    }
  }));
}

TEST_CASE("numbers are written in the fewest digits, from any range of samples") {
  const scratch::folder here;
  const std::array<double, 2> readings{0.1, 0.25};
  write_samples(here / "a", readings | std::views::transform([](double r) {
                              return gonio::sample{{0.0, 0.0, 0.0}, gonio::rgb::Constant(r), 1.0};
                            }));
  CHECK(scratch::get(here / "a") ==
        "theta_h,theta_d,phi_d,r,g,b,weight\n0,0,0,0.1,0.1,0.1,1\n0,0,0,0.25,0.25,0.25,1\n");
}

TEST_CASE("unusable samples are not written") {
  const scratch::folder here;
  scratch::put(here / "a", "old");
  const auto write = [&](const gonio::sample_set& samples) {
    return [&here, samples] {
      write_samples(here / "a", samples);
      return 0;
    };
  };
  check_refused(write({}), {"a: ", "no samples"});
  check_refused(write({{{0.1, 0.1, 0.1}, gonio::rgb::Constant(std::nan("")), 1.0}}), {"a: ", "sample 1", "not finite"});
  check_refused(write({{{1.5, 1.5, 0.0}, gonio::rgb::Zero(), 1.0}}), {"a: ", "sample 1", "horizon"});
  CHECK(scratch::get(here / "a") == "old");
}

TEST_CASE("damaged CSV files are read or refused") {
  for (const std::string& text :
       {header + "1,2,3,4,5,6\n10,20,30,0.1,0.2,0.3\n",
        std::string(
            "# quantity: percent\n\"theta_i [deg]\";theta_o;value;quantity;x\n1,5;-2;\"3,5\";percent;\"a\"\"\"\n")})
    scratch::check_survives_damage(scratch::bytes_of(text), 5000, [](std::span<const std::byte> bytes) {
      return read_samples({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "x");
    });
}

TEST_CASE("samples written as pairs keep their azimuths") {
  const scratch::folder here;
  const gonio::direction_pair pair{gonio::spherical_direction(gonio::radians(30.0), gonio::radians(75.0)),
                                   gonio::spherical_direction(gonio::radians(50.0), gonio::radians(-160.0))};
  gonio::sample_set samples;
  samples.push_back({pair, {0.1, 0.2, 0.3}, 1.0});
  const std::string text = write_samples(samples, {}, gonio::io::direction_columns::pairs);
  CHECK(text == "theta_i,phi_i,theta_o,phi_o,r,g,b,weight\n30,75,50,-160,0.1,0.2,0.3,1\n");
  write_samples(here / "a", samples, {}, gonio::io::direction_columns::pairs);
  const auto again = gonio::io::read_samples(here / "a");
  CHECK((again[0].directions.pair().wi - pair.wi).norm() < 1e-10);
  CHECK((again[0].directions.pair().wo - pair.wo).norm() < 1e-10);
  samples[0].directions = gonio::sample_directions(gonio::direction_pair{{0, 0, 1}, {0, 0, 1}});
  CHECK(write_samples(samples, {}, gonio::io::direction_columns::pairs).find("\n0,0,0,0,") != std::string::npos);
}
