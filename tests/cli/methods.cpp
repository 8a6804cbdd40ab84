/// gonio reconstruct with fewer samples than a method needs, and its warnings.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "tool.hpp"

#include <doctest/doctest.h>

#include <string>

namespace {

/// Samples of red paint, and a folder for tables.
class sampled_paint {
 public:
  explicit sampled_paint(int count) {
    REQUIRE(gonio_tool("expand --formula red-paint -o " + at("truth.binary")).exit_code == 0);
    REQUIRE(gonio_tool("sample " + at("truth.binary") + " --count " + std::to_string(count) + " --seed 3 -o " +
                       at("samples.csv"))
                .exit_code == 0);
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  /// Returns the output, including errors.
  [[nodiscard]] std::string reconstruct(const std::string& options, const char* table = "out.binary") const {
    const auto result = gonio_tool("reconstruct " + at("samples.csv") + " " + options + " -o " + at(table));
    REQUIRE_MESSAGE(result.exit_code == 0, options, ": ", result.output);
    return result.output;
  }

 private:
  scratch::folder folder_;
};

bool contains(const std::string& text, const char* words) { return text.find(words) != std::string::npos; }

}  // namespace

TEST_CASE("few samples are not corrected: what pca does is done, with a warning") {
  const sampled_paint forty(40);
  CHECK(contains(forty.reconstruct("--method correction"),
                 "warning: --method correction needs at least 2000 samples, not 40: used --method pca instead"));
  CHECK_FALSE(contains(forty.reconstruct("--method pca", "pca.binary"), "warning"));
  CHECK(scratch::get(forty.at("out.binary")) == scratch::get(forty.at("pca.binary")));

  // If rounds are requested, they are run, with a warning.
  const std::string asked = forty.reconstruct("--method correction --iterations 1");
  CHECK(contains(asked, "1 round"));
  CHECK(
      contains(asked, "warning: --method correction with 40 samples usually has 1.9 times the error of --method pca"));
}

TEST_CASE("correction as the paper prints it") {
  const sampled_paint forty(40);
  const std::string printed = forty.reconstruct("--method correction --as-printed --iterations 2", "printed.binary");
  CHECK(contains(printed, "2 rounds"));
  CHECK_FALSE(contains(printed, "outliers"));  // the paper's method does not estimate their fraction
  // Gamma defaults to 3.
  CHECK(contains(forty.reconstruct("--method correction --as-printed --gamma 3 --iterations 2", "three.binary"),
                 "2 rounds"));
  CHECK(scratch::get(forty.at("three.binary")) == scratch::get(forty.at("printed.binary")));
  CHECK(contains(forty.reconstruct("--method correction --gamma 3 --iterations 2", "ours.binary"), "2 rounds"));
  CHECK(scratch::get(forty.at("ours.binary")) != scratch::get(forty.at("printed.binary")));
  const auto refused =
      gonio_tool("reconstruct " + forty.at("samples.csv") + " --as-printed -o " + forty.at("refused.binary"));
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.output, "--as-printed"));
}

TEST_CASE("methods that lose on measured materials say so on standard error") {
  const sampled_paint forty(40);
  for (const char* method : {"rbf", "pull-push"})
    CHECK(contains(forty.reconstruct(std::string("--json --method ") + method),
                   "times the error of --method pca, more than twice for"));
  CHECK(contains(sampled_paint(1).reconstruct("--method pca"),
                 "has a larger error than the median material for 3 of 20"));
}

TEST_CASE("the nearest samples need no prior, and take none") {
  const sampled_paint forty(40);
  const std::string start =
      "reconstruct " + forty.at("samples.csv") + " --method scattered -o " + forty.at("out.binary");
  const auto first = gonio_tool(start + " --json");
  if (first.exit_code == 2) {
    MESSAGE("skipped: no nanoflann");
    return;
  }
  CHECK(read_json(first.output.substr(first.output.find('{')))["neighbours"] == 16);
  const auto mean = scratch::get(forty.at("out.binary"));
  CHECK(contains(forty.reconstruct("--method scattered"), "usually has 2.1 times the error of --method pca"));
  CHECK(
      contains(forty.reconstruct("--method scattered --neighbours 1"), "40 samples, nearest sample in each direction"));
  CHECK(scratch::get(forty.at("out.binary")) != mean);
  // Sampling the result returns the measurements.
  REQUIRE(
      gonio_tool("sample " + forty.at("out.binary") + " --count 40 --seed 3 -o " + forty.at("again.csv")).exit_code ==
      0);
  CHECK(scratch::get(forty.at("again.csv")) == scratch::get(forty.at("samples.csv")));
  for (const char* wrong : {" --prior x.prior", " --metric log", " --noise 0.1", " --uncertainty u.binary", " --seed 1",
                            " --solver nnls", " --neighbours 0", " --neighbours 65"}) {
    CAPTURE(wrong);
    const auto refused = gonio_tool(start + wrong);
    CHECK(refused.exit_code == 2);
    CHECK(contains(refused.output, std::string(wrong).substr(1, std::string(wrong).find(' ', 1) - 1).c_str()));
  }
}

TEST_CASE("of many samples outliers count less, unless all are to be kept") {
  const sampled_paint paint(400);
  REQUIRE(gonio_tool("sample " + paint.at("truth.binary") + " --count 400 --outliers 0.3 --seed 3 -o " +
                     paint.at("samples.csv"))
              .exit_code == 0);
  const auto error = [&](const std::string& options) {
    static_cast<void>(paint.reconstruct(options));
    return read_json(gonio_tool("compare --json " + paint.at("out.binary") + ' ' + paint.at("truth.binary"))
                         .output)["mapped_rms"]
        .get<double>();
  };
  CHECK(error("") < 0.3 * error("--no-reject"));
  const std::string told = paint.reconstruct("--json");
  CHECK(contains(told, "more samples disagree and have less than a tenth of their weight"));
  CHECK(contains(told, " of 400 samples disagree with the others. If they have something in common"));
  const auto fit = read_json(told);
  CHECK(fit["outliers"].get<double>() > 0.1);
  CHECK(fit["outliers"].get<double>() < 0.35);
  CHECK(fit["down_weighted"].get<double>() > 0.1);
}
