/// gonio report: simulated instrument readings, several files in one page, and printed pages.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "report_pages.hpp"
#include <gonio/core/rgb.hpp>

#include <doctest/doctest.h>

#include <filesystem>
#include <string>

TEST_CASE("gonio report: readings are those of gonio properties, as well known as their receptors' centres") {
  const page_files files;
  const auto data = read_json(data_text(files.page_of("scan.csv", in_plane_scan("", false), "--noise 0.02")));
  run("reconstruct '" + files.path("scan.csv") + "' --noise 0.02 -o '" + files.path("scan.binary") + "'");
  const auto table = read_json(gonio_tool("properties '" + files.path("scan.binary") + "' --json").output)["readings"];
  const auto& readings = data["readings"];
  const auto near = [](const auto& value) { return doctest::Approx(value.template get<double>()).epsilon(1e-3); };
  for (const char* angle : {"20", "60", "85"})
    CHECK(readings["gloss"][angle].get<double>() == near(table["gloss"][angle]));
  CHECK(readings["haze_20"].get<double>() == near(table["haze_20"]));
  CHECK(readings["luminous_reflectance_8"].get<double>() == near(table["luminous_reflectance_8"]));
  REQUIRE(readings["colours"].size() == 5);
  CHECK(readings["colours"][4]["L"].get<double>() == near(table["colours"][4]["L"]));

  // For light at 45 degrees, aspecular angles of 15 and 45 degrees are viewers at 30 degrees on the far side, and at 0.
  const auto& known = readings["known_to"];
  REQUIRE(known["colours"].size() == 5);
  CHECK(known["colours"][0].get<double>() == near(data["samples"][10]["known_to"]));
  CHECK(known["colours"][2].get<double>() == near(data["samples"][7]["known_to"]));
  for (const char* angle : {"20", "60", "85"}) CHECK(known["gloss"][angle].get<double>() > 0.0);
  CHECK(known["haze_20"].get<double>() > 0.0);
  // The reflectance of light at 8 degrees into all directions is an albedo, with and without the specular cone of four
  // degrees.
  const auto& albedo = data["albedo"][2];  // at 10 degrees
  CHECK(albedo["theta_i"] == 10.0);
  for (const char* key : {"reflectance_8", "reflectance_8_specular_excluded"})
    CHECK(known[key].get<double>() == doctest::Approx(albedo["known_to"].get<double>()).epsilon(0.2));
}

TEST_CASE("gonio report: several files, of which the first has the page") {
  const page_files files;
  const std::string alone = files.page_of("b.csv", in_plane_scan("", true), "--noise 0.02");
  scratch::put(files.folder / "a.csv", in_plane_scan("", false));
  const std::string a = "'" + files.path("a.csv") + "'", b = "'" + files.path("b.csv") + "'";
  const std::string to = " --noise 0.02 -o '" + files.path("page.html") + "'";
  const auto told = gonio_tool("report " + a + " " + b + to);
  CHECK(told.exit_code == 0);
  CHECK(told.output.find("a: 15 samples, ") != std::string::npos);
  CHECK(told.output.find("b: 15 samples, ") != std::string::npos);
  const std::string page = scratch::get(files.folder / "page.html");
  const auto data = read_json(data_text(page)), other = read_json(data_text(alone));
  CHECK(data["name"] == "a beside b");
  CHECK(data["subject"] == "a");
  CHECK(data["worst"].empty());
  REQUIRE(data["others"].size() == 1);
  const auto& beside = data["others"][0];
  CHECK(beside["name"] == "b");
  CHECK(beside["count"] == 15);
  CHECK(beside["readings"] == other["readings"]);
  CHECK(beside["albedo"] == other["albedo"]);
  CHECK(beside["details"]["known_to"] == other["details"]["known_to"]);
  REQUIRE(beside["scans"].size() == 1);
  const auto& curve = other["scans"][0]["curve"];
  REQUIRE(beside["scans"][0]["curve"].size() == curve.size());
  const auto& fit = curve[200]["fit"];
  const gonio::rgb value(fit[0].get<double>(), fit[1].get<double>(), fit[2].get<double>());
  CHECK(beside["scans"][0]["curve"][200].get<double>() == doctest::Approx(gonio::luminance(value)).epsilon(1e-3));
  REQUIRE(beside["scans"][0]["samples"].size() == 15);
  CHECK(beside["scans"][0]["samples"][6]["in_plane"] == -10.0);
  CHECK(data["record"].dump().find("b.csv: 15, of which 15 count") != std::string::npos);
  // The second file adds about 10 KB to the page of one.
  CHECK(page.size() < alone.size() + 50'000);
  CHECK_FALSE(other.contains("others"));
  CHECK_FALSE(other.contains("subject"));

  // Files with the same stem are listed by their paths.
  std::filesystem::create_directory(files.folder / "again");
  scratch::put(files.folder / "again" / "a.csv", in_plane_scan("", true));
  run("report " + a + " '" + files.path("again/a.csv") + "' --title both" + to);
  const auto both = read_json(data_text(scratch::get(files.folder / "page.html")));
  CHECK(both["name"] == "both");
  CHECK(both["others"][0]["name"] == files.path("again/a.csv"));
}

TEST_CASE("gonio report: chromium prints a page, if it is there") {
  const page_files files;
  scratch::put(files.folder / "scan.csv", in_plane_scan("", false));
  const std::string chromium = files.path("chromium"), pdf = files.path("page.pdf");
  const auto report = [&](const std::string& path) {
    return run_program("/usr/bin/env", "PATH='" + path + "' '" + GONIO_TOOL + "' report '" + files.path("scan.csv") +
                                           "' --noise 0.02 -o '" + pdf + "'");
  };
  const auto put_chromium = [&](const std::string& script) {
    scratch::put(chromium, "#!/bin/sh\n" + script);
    std::filesystem::permissions(chromium, std::filesystem::perms::owner_all);
  };
  check_refusal(report("/absent"), {"page.pdf", "chromium", "PATH", ".html"});  // before the reconstruction
  put_chromium("exit 1\n");
  const auto failed = report("/absent:" + files.path(""));
  CHECK(failed.exit_code == 2);
  CHECK(failed.output.find("page.pdf: chromium does not print the page") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(pdf));
  // Prints the first line of its page, which is the last argument.
  put_chromium(R"(for word; do case "$word" in --print-to-pdf=*) to="${word#*=}";; esac; done
read -r line < "$word"; echo "printed: $line" > "$to"
)");
  CHECK(report(files.path("")).exit_code == 0);
  CHECK(scratch::get(pdf) == "printed: <!DOCTYPE html>\n");
  CHECK(files.folder.entries() == 3);  // the samples, chromium and the page
}
