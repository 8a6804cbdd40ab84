/// What gonio reconstruct does with fewer samples than a method needs, and what it warns of.

#include "../io/scratch.hpp"
#include "../json.hpp"
#include "tool.hpp"

#include <doctest/doctest.h>

#include <string>

namespace {

/// Samples of red paint and a place for tables.
class sampled_paint {
 public:
  explicit sampled_paint(int count) {
    REQUIRE(gonio_tool("expand --formula red-paint -o " + at("truth.binary")).exit_code == 0);
    REQUIRE(gonio_tool("sample " + at("truth.binary") + " --count " + std::to_string(count) + " --seed 3 -o " +
                       at("samples.csv"))
                .exit_code == 0);
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }

  /// What is printed, errors too.
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

TEST_CASE("few samples are not corrected: robust, and of very few pca, are taken with a warning") {
  const sampled_paint five(5);
  const std::string corrected = five.reconstruct("--method correction");
  CHECK(contains(corrected, "warning: 5 samples are too few for --method correction, which needs 2000"));
  CHECK(contains(corrected, "warning: 5 samples are too few to tell outliers from highlights: --method pca was taken"));
  static_cast<void>(five.reconstruct("--method pca", "pca.binary"));
  CHECK(scratch::get(five.at("out.binary")) == scratch::get(five.at("pca.binary")));

  const sampled_paint forty(40);
  const std::string handed_over = forty.reconstruct("--method correction");
  CHECK(contains(handed_over, "--method robust was taken"));
  const std::string robust = forty.reconstruct("--method robust", "robust.binary");
  CHECK_FALSE(contains(robust, "warning"));
  CHECK(contains(robust, "% outliers (42 % at most from so few)"));
  CHECK(scratch::get(forty.at("out.binary")) == scratch::get(forty.at("robust.binary")));

  // Who asks for rounds gets them, and is warned.
  const std::string asked = forty.reconstruct("--method correction --iterations 1");
  CHECK(contains(asked, "1 round"));
  CHECK(
      contains(asked, "warning: --method correction from 40 samples is usually 2.0 times as far off as --method pca"));
}

TEST_CASE("methods that lose on measured materials say so on standard error") {
  const sampled_paint forty(40);
  for (const char* method : {"rbf", "pull-push"})
    CHECK(contains(forty.reconstruct(std::string("--json --method ") + method),
                   "times as far off as --method pca, more than twice for"));
  CHECK_FALSE(contains(forty.reconstruct("--method pca"), "warning"));
  const std::string printed = forty.reconstruct("--method robust --json");
  CHECK(parse_json(printed)["outliers"].get<double>() < 0.2);
  CHECK(parse_json(printed)["largest_outlier_share"].get<double>() == doctest::Approx(0.42));
  CHECK(contains(sampled_paint(1).reconstruct("--method pca"), "further off than the median material for 3 of 20"));
  const auto refused = gonio_tool("reconstruct " + forty.at("samples.csv") + " --method robust --gamma 3");
  CHECK(refused.exit_code == 2);
  CHECK(contains(refused.output, "--gamma needs --method correction"));
}
