/// 20 measurements, one of them wrong: finds the wrong one, predicts other directions, and gives the uncertainty.

#include <gonio/estimate/reconstruction.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <cstdio>

int main() {
  const gonio::log_relative_pca prior = gonio::io::read_prior("materials.prior");
  gonio::sample_set samples = gonio::io::read_samples("measurements.csv");
  samples[5].value *= 8.0;

  // The measurements have 2 % noise. Samples that contradict all others are rejected.
  const auto paint = gonio::reconstruction{prior, {.noise = 0.02}}.fit(samples);
  for (const gonio::outlying_sample& out : paint.contradicted())
    std::printf("sample %td is wrong with a probability of %.1f %%: measured %.3f, the others say %.3f\n",
                out.number + 1, 100.0 * out.probability, out.measured.y(), out.predicted.y());

  // Ask for the uncertainty in other directions.
  const auto show = [&](const char* name, double theta_h, double theta_d) {
    const auto [wi, wo] =
        gonio::to_directions({gonio::radians(theta_h), gonio::radians(theta_d), gonio::radians(90.0)});
    const auto [low, high] = paint.interval(wi, wo, gonio::confidence_level::ninety_five_percent);
    std::printf("%-22s %.3f sr^-1 (green), with 95 %% from %.3f to %.3f\n", name, paint(wi, wo).y(), low.y(), high.y());
  };
  show("in the highlight:", 1.0, 30.0);
  show("on its flank:", 12.0, 30.0);
  show("far from it:", 40.0, 20.0);
  show("grazing:", 20.0, 80.0);
  std::printf("the highlight is known to a factor of %.2f\n", paint.certainty().highlight_factor);
}
