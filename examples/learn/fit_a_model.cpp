/// Fits a Lambertian lobe and a GGX lobe to 20 samples.

#include <gonio/io/measurements/samples.hpp>
#include <gonio/metric/log.hpp>
#include <gonio/model/fit_model.hpp>

#include <cstdio>
#include <numbers>
#include <vector>

int main() {
  const gonio::sample_set samples = gonio::io::read_samples("measurements.csv");
  const std::vector kinds{&gonio::model::lobe_kind_named("lambert"), &gonio::model::lobe_kind_named("ggx")};
  const gonio::model::model_fit fit =
      gonio::model::fit_model(kinds, gonio::model::fit_observations(samples), gonio::log{});
  std::printf("loss %.2e, %s\n", fit.loss, fit.converged ? "converged" : "not converged");

  for (const gonio::model::analytic_lobe& lobe : fit.model.lobes()) {
    std::printf("%s of colour %.4f %.4f %.4f", std::string(lobe.kind().name()).c_str(), lobe.colour().x(),
                lobe.colour().y(), lobe.colour().z());
    for (std::size_t i = 0; i < lobe.kind().parameters().size(); ++i)
      std::printf(", %s %.4f", std::string(lobe.kind().parameters()[i].name).c_str(), lobe.parameters()[i]);
    std::printf("\n");
  }
  // The fitted parameters by name.
  const gonio::model::lobe<gonio::model::ggx_shape> gloss = fit.model.lobes()[1].as<gonio::model::ggx_shape>();
  std::printf("alpha of the gloss: %.3f\n", gloss.shape().alpha);
  // The model is a BRDF, like a table.
  const auto [wi, wo] = gonio::to_directions({gonio::radians(2.0), gonio::radians(20.0), gonio::radians(90.0)});
  std::printf("red near the highlight: %.4f sr^-1\n", fit.model(wi, wo).x());
}
