/// gonio report: a page that browsers show without a network, whatever text the measurements contain.

#include "../base64.hpp"
#include "../io/scratch.hpp"
#include "../json.hpp"
#include "report_pages.hpp"
#include "tool/pages/report_page.hpp"
#include <gonio/core/direction.hpp>
#include <gonio/io/bytes/gzip.hpp>
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/io/text/base64.hpp>
#include <gonio/model/formula_materials.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <random>
#include <span>
#include <string>
#include <vector>

TEST_CASE("gonio report: text is escaped") {
  CHECK(cli::escape_html("a<b> & \"c\" 'd'") == "a&lt;b&gt; &amp; &quot;c&quot; &#39;d&#39;");
  CHECK(cli::escape_script(R"(["</script>","<!--<script>"])") == R"(["\u003c/script>","\u003c!--\u003cscript>"])");
  const cli::json texts{"</script><!-- </ <\\/ <", "@STYLE@"};
  CHECK(cli::json::read(cli::escape_script(texts.dump())) == texts);
}

TEST_CASE("gonio report: bytes as a URL") {
  const auto url = [](std::vector<unsigned char> bytes) {
    return gonio::io::data_url("image/png", std::as_bytes(std::span(bytes)));
  };
  // RFC 4648, section 10.
  CHECK(url({}) == "data:image/png;base64,");
  CHECK(url({'f'}) == "data:image/png;base64,Zg==");
  CHECK(url({'f', 'o'}) == "data:image/png;base64,Zm8=");
  CHECK(url({'f', 'o', 'o', 'b', 'a', 'r'}) == "data:image/png;base64,Zm9vYmFy");
  CHECK(url({0xff, 0xef, 0xbe}) == "data:image/png;base64,/+++");
}

TEST_CASE("gonio report: an in-plane scan with a wrong sample") {
  const page_files files;
  const std::string page = files.page_of("scan.csv", in_plane_scan("# instrument: arm\n", true), "--noise 0.02");
  CHECK(page.size() < 4'000'000);
  const auto data = read_json(data_text(page));
  CHECK(data["name"] == "scan");
  CHECK(data["count"] == 15);
  CHECK(data["worst"] == read_json("[7]"));
  CHECK(data["details"]["left_out"][0]["sample"] == 7);
  REQUIRE(data["samples"].size() == 15);
  CHECK(data["samples"][6]["disagrees"] == true);
  CHECK(data["samples"][7]["disagrees"] == false);
  CHECK(data["samples"][6]["disagreement"].get<double>() > 9.0);
  CHECK(data["samples"][0]["in_plane"] == -70.0);
  CHECK(data["samples"][14]["in_plane"] == 70.0);  // on the side opposite to the light
  REQUIRE(data["scans"].size() == 1);
  CHECK(data["scans"][0]["theta_i"] == 45.0);
  CHECK(data["scans"][0]["samples"].size() == 15);
  // The fit is close to the correct samples, and brightest in the mirror direction.
  double brightest = 0.0, where = 0.0;
  for (const auto& each : data["scans"][0]["curve"])
    if (std::abs(each["angle"].get<double>()) < 60.0 && each["fit"][1].get<double>() > brightest) {
      brightest = each["fit"][1].get<double>();
      where = each["angle"].get<double>();
    }
  CHECK(where > 30.0);
  const auto& sample = data["samples"][2];
  CHECK(sample["fit"][0].get<double>() == doctest::Approx(sample["measured"][0].get<double>()).epsilon(0.1));
  CHECK(data["albedo"].size() == 19);
  CHECK(data["sphere"].get<std::string>().starts_with("data:image/png;base64,iVBORw0KGgo"));
  const std::string record = data["record"].dump();
  for (const char* word : {"gonio report ", "--noise 0.02", "2.00 % (stated)", "arm", "materials.prior"}) {
    CAPTURE(word);
    CHECK(record.find(word) != std::string::npos);
  }
}

TEST_CASE("gonio report: the viewer's table is that of gonio reconstruct, within a quarter of a percent") {
  const page_files files;
  const auto data = read_json(data_text(files.page_of("scan.csv", in_plane_scan("", true), "--noise 0.02")));
  run("reconstruct '" + files.path("scan.csv") + "' --noise 0.02 -o '" + files.path("scan.binary") + "'");
  const gonio::brdf_table table = gonio::io::read_merl(files.folder / "scan.binary");
  const auto& packed = data["viewer"]["table"];
  CHECK(packed["grid"] == read_json("[90,90,180]"));
  CHECK(packed["offset"] == 0.5);
  const Eigen::Index cells = packed["cells"].get<Eigen::Index>(), count = 3 * cells;
  REQUIRE(cells == table.cells().size());
  const double scale = packed["scale"].get<double>();
  CHECK(std::exp2(std::round(std::log2(scale))) == scale);
  const auto bytes = gonio::io::decompress_bytes(from_base64(packed["codes"].get<std::string>()), 2 * count, "codes");
  const auto byte = [&](Eigen::Index i) { return std::to_integer<int>(bytes[i]); };
  double worst = 0.0;
  for (Eigen::Index channel = 0, i = 0; channel < 3; ++channel)
    for (Eigen::Index cell = 0, code = 0; cell < cells; ++cell, ++i) {
      const int folded = byte(i) + 256 * byte(count + i);
      code += folded % 2 == 1 ? -(folded + 1) / 2 : folded / 2;
      const auto half = std::bit_cast<Eigen::half>(static_cast<std::uint16_t>(code << 2));
      const double value = scale * static_cast<float>(half), exact = std::max(table.at(cell)[channel], 0.0);
      worst = std::max(worst, std::abs(value - exact) / (exact + 1e-3 * scale));
    }
  CHECK(worst < 0.00245);
  CHECK(worst > 0.0015);
  const auto& known = data["viewer"]["uncertainty"];
  CHECK(known["grid"] == read_json("[45,45,90]"));
  const auto levels =
      gonio::io::decompress_bytes(from_base64(known["codes"].get<std::string>()), 45 * 45 * 90, "codes");
  // Next to the sample at 20 degrees, which fits, the uncertainty is the one given for the sample.
  const auto& sample = data["samples"][9];
  const auto near =
      gonio::grid({45, 45, 90})
          .nearest({gonio::radians(sample["theta_h"].get<double>()), gonio::radians(sample["theta_d"].get<double>()),
                    gonio::radians(sample["phi_d"].get<double>())});
  const double level = std::to_integer<int>(levels[gonio::grid({45, 45, 90}).linear(near)]) / 255.0;
  CHECK(0.001 * std::pow(10.0, 4.0 * level) == doctest::Approx(sample["known_to"].get<double>()).epsilon(0.2));
  CHECK(data["viewer"]["exposure"].get<double>() > 0.0);
  CHECK_FALSE(data["viewer"].contains("truth"));
  const auto with = read_json(data_text(
      files.page_of("scan.csv", in_plane_scan("", true), "--noise 0.02 --truth '" + files.path("scan.binary") + "'")));
  CHECK(with["viewer"]["truth"]["codes"] == packed["codes"]);
  CHECK(with["viewer"]["table"]["codes"] == packed["codes"]);
}

TEST_CASE("gonio report: the page asks no network") {
  const page_files files;
  const std::string page =
      files.page_of("scan.csv", in_plane_scan("# conditions: see http://example.org/\n", false), "--noise 0.02");
  CHECK(page.find("default-src 'none'") != std::string::npos);
  for (const char* word : {"src=\"http", "href=\"http", "src='http", "href='http", "url(http", "url(\"http", "@import",
                           "<link", "<iframe", "fetch(", "XMLHttpRequest", "importScripts", "src=\"//"}) {
    CAPTURE(word);
    CHECK(page.find(word) == std::string::npos);
  }
  // The remaining addresses are never loaded: XML namespaces, a licence, and text of the measurements.
  CHECK(occurrences(page, "http://") == occurrences(page, "http://www.w3.org/") +
                                            occurrences(page, "\nhttp://www.apache.org/licenses/LICENSE-2.0\n") +
                                            occurrences(page, "http://example.org/"));
  CHECK(page.find("Copyright 2020-2025 Observable, Inc.") != std::string::npos);
  CHECK(occurrences(page, "https://") == 0);
}

TEST_CASE("gonio report: text of files and of the command line is text in the page") {
  const page_files files;
  const std::string evil = "</script><script>alert(1)</script>";
  const std::string plain = files.page_of("scan.csv", in_plane_scan("", false));
  const std::string page = files.page_of("<b>&.csv", in_plane_scan("# instrument: " + evil + "<!--\n", false),
                                         "--title '" + evil + "@DATA@'");
  // The text adds or closes no script, and the title does not replace a placeholder of the page.
  CHECK(occurrences(page, "</script>") == occurrences(plain, "</script>"));
  CHECK(occurrences(page, "<script>alert") == occurrences(data_text(page), "<script>alert"));
  CHECK(page.find("<title>&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;@DATA@</title>") != std::string::npos);
  CHECK(data_text(page).find("\\u003c/script>") != std::string::npos);
  CHECK(data_text(page).find("<!--") == std::string::npos);
  const auto data = read_json(data_text(page));
  CHECK(data["name"] == evil + "@DATA@");
  CHECK(data["record"].dump().find("<b>&.csv") != std::string::npos);
}

TEST_CASE("gonio report: one sample") {
  const page_files files;
  const std::string page = files.page_of("one.csv", "theta_h,theta_d,phi_d,r,g,b\n9,12,69,0.2,0.1,0.1\n");
  const auto data = read_json(data_text(page));
  CHECK(data["count"] == 1);
  CHECK(data["worst"].empty());
  REQUIRE(data["scans"].size() == 3);  // of the fit alone
  CHECK(data["scans"][0]["samples"].empty());
}

TEST_CASE("gonio report: of many samples some are shown, the worst among them") {
  const page_files files;
  const gonio::model::formula_brdf paint = gonio::model::formula_material("red-paint");
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share;
  gonio::sample_set samples;
  for (int i = 0; i < 1100; ++i) {
    const gonio::half_difference angles{0.8 * share(random), 0.7 * share(random), 3.0 * share(random)};
    const auto [wi, wo] = gonio::to_directions(angles);
    samples.push_back({angles, paint(wi, wo) * (i % 50 == 0 ? 20.0 : 1.0), 1.0});
  }
  gonio::io::write_samples(files.folder / "many.csv", samples);
  run("report '" + files.path("many.csv") + "' --noise 0.02 -o '" + files.path("page.html") + "'");
  const std::string page = scratch::get(files.folder / "page.html");
  CHECK(page.size() < 4'000'000);
  const auto data = read_json(data_text(page));
  CHECK(data["count"] == 1100);
  CHECK(data["worst"].size() == 12);
  CHECK(data["samples"].size() >= 1000);
  CHECK(data["samples"].size() < 1100);
  int disagreeing = 0;
  for (const auto& each : data["samples"]) {
    CHECK_FALSE(each.contains("others"));
    if (each["disagrees"] == true) ++disagreeing;
    if (each["sample"].get<int>() % 50 == 1) CHECK(each["disagrees"] == true);
  }
  CHECK(disagreeing >= 22);
}

TEST_CASE("gonio report: what is wrong is refused, and nothing is written") {
  const page_files files;
  scratch::put(files.folder / "bad.csv", std::string("theta_h,theta_d,phi_d,r,g,b\n9,12,69,nan,.3,.3\n"));
  scratch::put(files.folder / "good.csv", in_plane_scan("", false));
  const std::string bad = "'" + files.path("bad.csv") + "'", good = "'" + files.path("good.csv") + "'";
  refuses("report " + bad + " -o '" + files.path("bad.html") + "'", {"bad.csv", "line 2", "not finite"});
  CHECK_FALSE(std::filesystem::exists(files.folder / "bad.html"));
  refuses("report " + good + " -o '" + files.path("page.txt") + "'", {"page.txt", ".html", ".pdf"});
  refuses("report " + good, {"--output"});
  refuses("report absent.csv -o '" + files.path("page.html") + "'", {"absent.csv"});
  refuses("report " + good + " --truth " + good + " -o '" + files.path("page.html") + "'", {"good.csv"});
  const std::string page = " -o '" + files.path("page.html") + "'";
  refuses("report " + good + " " + good + " --truth " + good + page, {"--truth", "one file", "2"});
  refuses("report " + good + " " + bad + page, {"bad.csv", "line 2"});
  std::string seven;
  for (int i = 0; i < 7; ++i) seven += " " + good;
  refuses("report" + seven + page, {"at most 6", "7"});
  refuses("report " + good + " --noise 2 -o '" + files.path("page.html") + "'", {"--noise"});
  CHECK_FALSE(std::filesystem::exists(files.folder / "page.html"));
}

TEST_CASE("--report: pages of reconstruct, check, design and fit") {
  const page_files files;
  scratch::put(files.folder / "ref.csv", in_plane_scan("# instrument: </script><script>alert(1)</script>\n", false));
  scratch::put(files.folder / "part.csv", in_plane_scan("", true));
  const auto data_of = [&](const std::string& arguments) {
    run(arguments + " --report '" + files.path("page.html") + "'");
    const std::string page = scratch::get(files.folder / "page.html");
    return read_json(data_text(page));
  };
  const std::string ref = files.path("ref.csv"), part = files.path("part.csv"), out = " -o " + files.path("out");

  // The pages of reconstruct and report differ only in the command.
  auto fit = data_of("reconstruct " + part + " --noise 0.02" + out + ".binary");
  auto report = read_json(data_text(files.page_of("part.csv", in_plane_scan("", true), "--noise 0.02")));
  CHECK(fit["kind"] == "reconstruct");
  CHECK(fit["record"][0][1].get<std::string>().find("gonio reconstruct ") == 0);
  fit.erase("record");
  report.erase("record");
  CHECK(fit == report);

  const auto told = gonio_tool("check " + part + " --reference " + ref + " --noise 0.02 --json --report '" +
                               files.path("check.html") + "'");
  CHECK(told.exit_code == 1);  // the part differs
  auto check = read_json(data_text(scratch::get(files.folder / "check.html")));
  CHECK(check["kind"] == "check");
  CHECK(check["name"] == "part beside ref");
  CHECK(check["check"]["worst_sample"] == 7);
  REQUIRE(check["check"]["directions"].size() == 15);
  CHECK(check["check"]["directions"][0]["theta_i"] == 45.0);
  CHECK(check["check"]["directions"][0]["theta_o"] == 70.0);
  CHECK(check["check"]["reference"]["instrument"] == "</script><script>alert(1)</script>");

  const auto of_samples = data_of("fit " + ref + " --model ggx");
  CHECK(of_samples["kind"] == "fit");
  CHECK(of_samples["name"] == "ref");
  CHECK(of_samples["details"]["lobes"][1]["lobe"] == "ggx");
  CHECK(of_samples["of_table"] == false);
  REQUIRE(of_samples["samples"].size() == 15);
  CHECK_FALSE(of_samples["samples"][0].contains("known_to"));
  CHECK(of_samples["scans"][0]["samples"].size() == 15);
  CHECK(of_samples["albedo"][0]["known_to"].is_null());
  CHECK(of_samples["readings"]["gloss"]["60"].get<double>() > 0.0);
  CHECK_FALSE(of_samples["readings"].contains("known_to"));
  const auto of_table = data_of("fit " + files.path("out.binary") + " --model ggx");
  CHECK(of_table["of_table"] == true);
  CHECK(of_table["scans"].size() == 3);
  CHECK(of_table["samples"].size() == 3 * 35);

  const auto design = data_of("design -n 3" + out + ".csv");
  CHECK(design["kind"] == "design");
  CHECK(design["name"] == "out");
  REQUIRE(design["design"]["directions"].size() == 3);
  CHECK(design["design"]["directions"][2]["number"] == 3);
  CHECK(design["design"]["sentence"].get<std::string>().find("3 measurements: expected Delta E of spheres ") == 0);
  CHECK_FALSE(design.contains("map"));
  const auto next = data_of("design -n 2 --given " + ref + " --noise 0.02" + out + ".csv");
  CHECK(next["samples"].size() == 15);
  CHECK(next["map"].size() > 100);
  CHECK(next["design"]["directions"].size() == 2);
}

TEST_CASE("--report: what knows of no uncertainty has no page") {
  const page_files files;
  scratch::put(files.folder / "scan.csv", in_plane_scan("", false));
  const std::string given = "reconstruct " + files.path("scan.csv") + " -o " + files.path("t.binary");
  refuses(given + " --method linear --report " + files.path("p.html"), {"--report", "--method pca"});
  refuses(given + " --eta 40 --report " + files.path("p.html"), {"--report", "discrepancy"});
  refuses(given + " --report " + files.path("p.pdf"), {"--report", ".html"});
  CHECK(files.folder.entries() == 1);
}
