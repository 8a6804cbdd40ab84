/// Files as instruments and spreadsheets write them, and common mistakes in them.

#include "../io/scratch.hpp"
#include "tool.hpp"
#include <gonio/io/measurements/samples.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace {

/// A file on which each command is run.
struct one_file {
  scratch::folder folder;
  std::string path = (folder / "scan.csv").string();

  void put(const std::string& text) const { scratch::put(path, text); }

  void refuses(const std::string& text, std::initializer_list<const char*> words,
               const std::string& options = "") const {
    put(text);
    CAPTURE(text);
    ::refuses("reconstruct " + path + options + " -o " + (folder / "out.binary").string(), words);
    CHECK(folder.entries() == 1);
  }

  /// Runs `gonio info` on the file, which must accept it, and returns the output.
  std::string info(const std::string& text, const std::string& options = "") const {
    put(text);
    return run("info " + path + options);
  }

  void warns(const std::string& text, const std::string& words, const std::string& options = "") const {
    const std::string output = info(text, options);
    CAPTURE(output);
    CHECK(output.find("gonio: warning: " + path + ": " + words) != std::string::npos);
  }

  void is_silent_on(const std::string& text, const std::string& options = "") const {
    CHECK(info(text, options).find("warning") == std::string::npos);
  }
};

const std::string angles = "theta_i,phi_i,theta_o,phi_o,";

/// A scan over the hemisphere away from the mirror direction. Each value is a function of the viewer's angle.
template <class Value>
std::string dull_scan(const std::string& columns, const Value& value) {
  std::string text = angles + columns + "\n";
  for (int theta_o = 10; theta_o <= 80; theta_o += 5)
    text +=
        "70,0," + std::to_string(theta_o) + ",30," + std::to_string(value(theta_o * std::numbers::pi / 180.0)) + "\n";
  return text;
}

}  // namespace

TEST_CASE("the likely mistakes get the right sentences") {
  const one_file file;
  // A misspelt column.
  file.refuses(
      "theta_i;phi_i;tetha_o;phi_o;r;g;b\n10;0;20;0;1;1;1\n",
      {"line 1: column 'theta_o' is missing: perhaps it is 'tetha_o'; the header line looks semicolon-separated",
       "--columns"});
  // No header line, or a header line after #.
  file.refuses("# theta_i,phi_i,theta_o,phi_o,r,g,b\n10,0,20,0,1,1,1\n",
               {"line 2: there is no header line above the numbers", "after # is a comment"});
  // The file does not state the quantity.
  file.refuses(angles + "value\n10,0,20,0,0.3\n", {"line 2", "does not state the quantity of value", "--quantity"});
  // The file and the option state different quantities.
  file.refuses("# quantity: percent\n" + angles + "value\n10,0,20,0,30\n",
               {"line 1: the values are brdf according to the requested quantity (--quantity), but percent according "
                "to the comment in line 1"},
               " --quantity brdf");
  // Decimal commas in a comma-separated file.
  file.refuses(
      angles + "r,g,b\n10,5,0,20,5,0,1,5,1,5,1,5\n",
      {"line 2: 12 fields, expected 7", "comma-separated: separate fields by semicolons if numbers have decimal"});
  // Rows and the header line use different separators.
  file.refuses(angles + "r,g,b\n10;0;20;0;1;1;1\n", {"1 field, expected 7", "comma-separated, this one semicolon"});
  // Misplaced thousands separators.
  file.refuses(
      "theta_i;phi_i;theta_o;phi_o;r;g;b\n10;0;20;0;1,5;1.23,5;1\n",
      {"column g: '1.23,5' is not a number: it has a point and a comma", "semicolon-separated with decimal commas"});
  // A workbook.
  file.refuses("PK\x03\x04 xl/workbook.xml", {"looks like a workbook", "save its sheet as CSV"});
  // More than one wavelength.
  file.refuses(angles + "wavelength,brdf\n10,0,20,0,550,1\n10,0,20,0,560,1\n",
               {"line 3: column wavelength: 560 nm, but 550 nm above: more than one wavelength"});
  // In-plane angles without signs.
  file.refuses("theta_i,theta_o,r,g,b\n45,20,1,1,1\n",
               {"line 2: the viewer's side of the normal is unknown", "phi_i and phi_o"});
  // A column that does not exist, and a malformed list.
  file.refuses(angles + "r,g,b\n10,0,20,0,1,1,1\n", {"there is no column 'Winkel' for theta_o"},
               " --columns theta_o=Winkel");
  file.refuses(angles + "r,g,b\n10,0,20,0,1,1,1\n", {"--columns theta_o: 'theta_o' is not a pair of names"},
               " --columns theta_o");
  file.refuses(angles + "r,g,b\n10,0,20,0,1,1,1\n", {"--quantity", "luminance"}, " --quantity luminance");
}

TEST_CASE("a result that reflects far more than arrives is warned of") {
  const one_file file;
  const std::string sentence = " times the light that arrives at 8 degrees: are the values and --quantity right?\n";
  file.put("# quantity: percent\n" + dull_scan("value", [](double) { return 350.0; }));
  CHECK(run("reconstruct " + file.path + " -o " + file.path + ".binary").find(sentence) != std::string::npos);
  file.put("# quantity: percent\n" + dull_scan("value", [](double) { return 90.0; }));
  CHECK(run("reconstruct " + file.path + " -o " + file.path + ".binary").find(sentence) == std::string::npos);
}

TEST_CASE("a file from a spreadsheet is read as it is") {
  const one_file file;
  std::string scan =
      "\xEF\xBB\xBF# Instrument: GON 360\r\nEinfall;\"Winkel [deg]\";phi_i;phi_o;Messwert;Temperatur\r\n"
      "45;-45,5;0;0;31,4%;23,1\r\n45;20;0;0;12,5%;23,1\r\n";
  for (const char* row :
       {"45;0;0;0;12,9%;23,1", "45;-20;0;0;13,8%;23,1", "45;-35;0;0;22%;23,1", "45;60;0;0;13,1%;23,1"})
    scan += row + std::string("\r\n");
  const std::string columns = " --columns theta_i=Einfall,theta_o=Winkel --columns value=Messwert";
  const std::string output = file.info(scan, columns);
  CAPTURE(output);
  for (const char* words : {"samples: 6", "quantity: percent", "instrument: GON 360", "column 'Temperatur' is ignored"})
    CHECK(output.find(words) != std::string::npos);
  CHECK(output.find("maximum: [0.0999") != std::string::npos);  // 0.314 / pi
  // All commands that read samples agree, also in JSON.
  const std::string json = run("reconstruct " + file.path + columns + " --json");
  for (const char* words : {"\"quantity\": \"percent\"", "\"instrument\": \"GON 360\""})
    CHECK(json.find(words) != std::string::npos);
  run("properties " + file.path + columns);
  run("fit " + file.path + columns + " --model phong --json");
  run("check " + file.path + " --reference " + file.path + columns + " --noise 0.02");
}

TEST_CASE("where samples come from stands in what is found of them") {
  const one_file file;
  std::string scan = "# instrument: GON 360\n# date: 2026-11-25\n# conditions: 23 C\ntheta_h,theta_d,phi_d,r,g,b\n";
  for (const char* row : {"2,10,0", "10,20,30", "20,30,60", "30,40,90", "40,20,120", "15,50,150"})
    scan += row + std::string(",0.1,0.1,0.1\n");
  file.put(scan);
  const std::string residuals = (file.folder / "residuals.csv").string();
  run("reconstruct " + file.path + " --residuals " + residuals);
  CHECK(scratch::get(residuals).starts_with(
      "# instrument: GON 360\n# date: 2026-11-25\n# conditions: 23 C\nsample,r,g,b,"));
  CHECK(run("info " + residuals).find("residuals of gonio reconstruct") != std::string::npos);
  const std::string checked = run("check " + file.path + " --reference " + file.path + " --noise 0.02 --json");
  const std::string told = "\"instrument\": \"GON 360\"";
  for (const char* key : {"\"part\": {", "\"reference\": {"}) {
    const std::size_t at = checked.find(key);
    REQUIRE(at != std::string::npos);
    CHECK(checked.find(told, at) < checked.find('}', at));
  }
  const std::string designed =
      run("design -n 1 --json --given " + file.path + " -o " + (file.folder / "next.csv").string());
  for (const std::string& words :
       {told, std::string("\"date\": \"2026-11-25\""), std::string("\"conditions\": \"23 C\"")})
    CHECK(designed.find(words) != std::string::npos);
}

TEST_CASE("the quantity of any format can be stated") {
  const scratch::folder here;
  const std::string path = (here / "black.txt").string();
  scratch::put(path, "type bsdf_data\nformat angles=deg bsdf=value scale=1\n10\t0\n60\t0\t.25\n0\t0\t.25\n");
  const auto largest = [&](const std::string& options) {
    const std::string output = run("info " + path + options);
    const std::size_t begin = output.find("maximum: [");
    REQUIRE(begin != std::string::npos);
    return std::stod(output.substr(begin + 10));
  };
  CHECK(largest("") == doctest::Approx(0.25));
  CHECK(largest(" --quantity brdf") == doctest::Approx(0.25));
  CHECK(largest(" --quantity brdf-cosine") == doctest::Approx(0.5));
  CHECK(largest(" --quantity percent") == doctest::Approx(0.0025 / 3.14159265));
  CHECK(run("info " + path + " --quantity brdf-cosine").find("brdf-cosine") != std::string::npos);
}

TEST_CASE("options on samples need samples") {
  const one_file file;
  const std::string table = (file.folder / "paint.binary").string(), out = (file.folder / "out.csv").string();
  run("expand --formula red-paint -o " + table);
  for (const std::string command : {"fit ", "info ", "properties "})
    refuses(command + table + " --quantity percent",
            {"paint.binary: --quantity, --columns, --theta-o-sign, --side and --band need a file of samples"});
  refuses("design -n 1 --quantity percent -o " + out,
          {"--quantity, --columns, --theta-o-sign, --side and --band need --given"});
}

TEST_CASE("a highlight on the light's side is told of, and turned by an option in any format") {
  const one_file file;
  std::string rows;
  for (const char* theta : {"20", "40", "60"})
    for (const auto& [phi, value] : {std::pair("0", "9"), std::pair("180", "1")})
      rows += std::string(theta) + ",0," + theta + "," + phi + "," + value + "," + value + "," + value + "\n";
  const std::string scan = angles + "r,g,b\n" + rows;
  file.warns(
      scan,
      "where light and viewer have the same direction, the sample is 9.0 times as bright as in the mirror direction");
  for (const char* sign : {"light", "mirror"}) file.is_silent_on(scan, std::string(" --theta-o-sign ") + sign);
  file.is_silent_on("# theta-o-sign: light\n" + scan);
  const std::string bright_mirror = "theta_i,theta_o,brdf\n20,-20,9\n20,20,1\n40,-40,9\n40,40,1\n60,-60,9\n60,60,1\n";
  file.is_silent_on(bright_mirror, " --theta-o-sign light");
  file.warns(bright_mirror,
             "where light and viewer have the same direction, the sample is 9.0 times as bright as in the mirror "
             "direction: is a positive theta_o on the light's side (--theta-o-sign light)?",
             " --theta-o-sign mirror");
  const std::string foreign = (file.folder / "scan.json").string();
  const auto variable = [](const std::string& name, const std::string& unit, const std::string& values) {
    return "\"" + name + "\":{\"unit\":\"" + unit + "\",\"values\":[" + values + "]}";
  };
  scratch::put(foreign, "{\"metadata\":{},\"data\":{" + variable("theta_i", "deg", "30,30") + "," +
                            variable("phi_i", "deg", "0,0") + "," + variable("theta_r", "deg", "30,30") + "," +
                            variable("phi_r", "deg", "0,180") + "," + variable("BRDF", "sr^-1", "8,1") + "}}");
  CHECK(run("info " + foreign).find("the sample is 8.0 times as bright") != std::string::npos);
  const std::string converted = (file.folder / "samples.csv").string();
  run("convert " + foreign + " --theta-o-sign mirror " + converted);
  CHECK(gonio::io::read_samples(converted)[0].angles().theta_h < 1e-6);
  refuses("info " + foreign + " --columns value=x", {"--columns needs a .csv file, not "});
}

TEST_CASE("numbers that look like something else are accepted with a warning") {
  const one_file file;
  file.warns(angles + "r,g,b\n0.5,0,0.7,3.1,1,1,1\n0.6,0,0.9,3.1,1,1,1\n0.1,0,1.4,3.1,1,1,1\n",
             "light and viewer of all samples are within 3.2 degrees of the normal: are the angles in radians?");
  file.is_silent_on(
      "theta_i [rad],phi_i [rad],theta_o [rad],phi_o [rad],brdf\n"
      "0.5,0,0.7,3.1,1\n0.6,0,0.9,3.1,1\n0.1,0,1.4,3.1,1\n");
  const auto white = [](double theta_o) { return 0.3 + 0.01 * std::cos(5.0 * theta_o); };  // at most 0.318 is possible
  file.is_silent_on(dull_scan("brdf", white));
  file.warns(dull_scan("brdf", [&](double angle) { return std::numbers::pi * white(angle); }),
             "away from highlights, half of the samples reflect more than");
  file.warns(dull_scan("brdf", [&](double angle) { return 100.0 * std::numbers::pi * white(angle); }),
             "away from highlights, half of the samples reflect more than");
  file.warns(dull_scan("value", [&](double angle) { return 100.0 * std::numbers::pi * white(angle); }),
             "away from highlights, half of the samples reflect more than", " --quantity reflectance-factor");
  file.is_silent_on(dull_scan("value", [&](double angle) { return 100.0 * std::numbers::pi * white(angle); }),
                    " --quantity percent");
  const auto with_cosine = [&](double angle) { return white(angle) * std::cos(angle); };
  file.warns(dull_scan("brdf", with_cosine), "away from highlights, the values fall like the cosine");
  file.is_silent_on(dull_scan("value", with_cosine), " --quantity brdf-cosine");
}

TEST_CASE("a long comment hides no format") {
  const scratch::folder here;
  std::string text;
  for (int line = 0; line < 200; ++line) text += "# " + std::string(70, 'x') + "\n";
  text +=
      "Source Measured\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterType BRDF\nSampleRotation 1\n0\n"
      "AngleOfIncidence 1\n30\nScatterAzimuth 1\n0\nScatterRadial 3\n0 20 50\nMonochrome\nDataBegin\nTIS 0.5\n9 1 "
      "0.1\nDataEnd\n";
  const std::string path = (here / "long.bsdf").string();
  scratch::put(path, text);
  CHECK(run("info " + path).find("Zemax") != std::string::npos);
  CHECK(run("reconstruct " + path + " -o " + (here / "o.binary").string()).find("3 samples") != std::string::npos);
}

TEST_CASE("rotations of an anisotropic sample are not averaged") {
  const one_file scan;
  const auto brushed = [&](double strength) {
    std::string text = "# quantity: brdf\n" + angles + "value\n";
    for (const int rotation : {0, 90})
      for (int theta_o = 5; theta_o <= 75; theta_o += 10)
        for (const int beside : {0, 90})
          text += "30," + std::to_string(rotation) + "," + std::to_string(theta_o) + "," +
                  std::to_string(rotation + beside) + "," +
                  std::to_string(0.1 * (1.0 + strength * (rotation == 90 ? 1.0 : 0.0))) + "\n";
    return text;
  };
  scan.refuses(brushed(1.0), {"scan.csv", "16 pairs", "50 %", "anisotropic", "--rotation", "0, 90"});
  scan.refuses(brushed(1.0), {"--rotation 45", "0, 90"}, " --rotation 45");
  CHECK(scan.info(brushed(1.0)).find("samples: 32") != std::string::npos);  // info accepts any material
  CHECK(scan.info(brushed(1.0), " --rotation 90").find("samples: 16") != std::string::npos);
  const std::string output = " -o " + (scan.folder / "out.binary").string();
  scan.put(brushed(0.2));
  CHECK(run("reconstruct " + scan.path + output).find("treated as isotropic") != std::string::npos);
  scan.put(brushed(0.05));
  CHECK(run("reconstruct " + scan.path + output).find("isotropic") == std::string::npos);
  scan.put(brushed(1.0));
  refuses("check " + scan.path + " --reference " + scan.path + " --noise 0.02", {"--rotation"});
  CHECK(run("check " + scan.path + " --reference " + scan.path + " --noise 0.02 --rotation 90")
            .find("no difference found") != std::string::npos);
}

TEST_CASE("half angles of readings are given once, and to whom uses them") {
  const one_file scan;
  const std::string output = " -o " + (scan.folder / "out.binary").string(),
                    rows = "10,0,10,180,8,8,8\n10,0,20,180,0.2,0.2,0.2\n40,0,40,180,7,7,7\n40,0,0,0,0.1,0.1,0.1\n";
  const auto bytes = [&](const std::string& text, const std::string& options) {
    scan.put(text);
    run("reconstruct " + scan.path + options + output);
    return scratch::get(scan.folder / "out.binary");
  };
  const std::string file = angles + "r,g,b\n" + rows, stated = "# receiver-half-angle: 2\n" + file;
  CHECK(bytes(stated, "") == bytes(file, " --receiver-half-angle 2"));
  CHECK(bytes(stated, "") != bytes(file, ""));
  std::filesystem::remove(scan.folder / "out.binary");
  scan.refuses(stated, {"scan.csv", "half angles", "--receiver-half-angle"}, " --receiver-half-angle 2");
  scan.refuses(file, {"--receiver-half-angle", "45"}, " --receiver-half-angle 46");
  scan.refuses(file, {"--source-half-angle needs --method pca"}, " --source-half-angle 1 --method scattered");
  scan.put(stated);
  CHECK(run("reconstruct " + scan.path + " --method scattered" + output).find("half angles are ignored") !=
        std::string::npos);
}
