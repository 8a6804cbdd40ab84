/// gonio-papers spectra, on spectra that are made up.

#include "../io/scratch.hpp"
#include "papers_tool.hpp"
#include <gonio/io/measurements/samples.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>

TEST_CASE("spectra are fitted by wavelengths and by colours, and judged by what was not fitted") {
  gonio::sample_set samples{gonio::channels({420, 480, 540, 600, 660})};
  for (Eigen::Index i = 0; i < 30; ++i) {
    const double theta_h = 0.04 * static_cast<double>(i % 10), theta_d = 0.3 + 0.3 * static_cast<double>(i / 10);
    samples.add({theta_h, theta_d, 1.0},
                Eigen::ArrayXd(Eigen::ArrayXd::LinSpaced(5, 0.05, 0.25) + std::exp(-30.0 * theta_h)));
  }
  const scratch::folder here;
  const auto file = here / "paint.csv";
  gonio::io::write_samples(file, samples);
  const auto result = gonio_papers("spectra --samples " + file.string() + " --counts 20 --repetitions 2");
  REQUIRE_MESSAGE(result.exit_code == 0, result.output);
  CHECK(result.output.find("| paint | 20 | wavelengths | 0.") != std::string::npos);
  CHECK(result.output.find("| paint | 20 | XYZ | 0.") != std::string::npos);
  CHECK(result.output.find("nan") == std::string::npos);
  CHECK(result.output == gonio_papers("spectra --samples " + file.string() + " --counts 20 --repetitions 2").output);

  check_refusal(gonio_papers("spectra --samples " + file.string() + " --counts 30"),
                {"paint.csv", "no sample is left for the comparison", "30"});
  scratch::put(here / "grey.csv", std::string("theta_h,theta_d,phi_d,r,g,b\n1,2,3,1,1,1\n"));
  check_refusal(gonio_papers("spectra --samples " + (here / "grey.csv").string()),
                {"grey.csv", "names no wavelengths"});
}
