/// Compares several solvers with the same prior and the same 20 samples against the truth.

#include <gonio/estimate/decomposition.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/measurements/samples.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/solve/choose_eta.hpp>
#include <gonio/solve/lasso.hpp>
#include <gonio/solve/least_squares.hpp>
#include <gonio/solve/tikhonov.hpp>
#include <gonio/solve/truncated_svd.hpp>

#include <cstdio>

int main() {
  const auto prior = gonio::io::read_prior("materials.prior");
  const gonio::sample_set samples = gonio::io::read_samples("measurements.csv");
  const gonio::valid_cells cells(gonio::grid({90, 30, 36}));
  const gonio::brdf_table truth = gonio::tabulate(gonio::model::formula_material("red-paint"), cells);
  const gonio::appearance_metric appearance(cells);

  std::printf("%-26s %9s %9s %11s %8s\n", "", "residual", "weights", "mapped rms", "Delta E");
  const auto show = [&](const char* name, const auto& solver) {
    const auto paint = gonio::decomposition{prior, solver}.fit(samples);
    const gonio::comparison off = gonio::compare(paint.tabulate(cells), truth, prior.metric(), appearance);
    const Eigen::MatrixXd& weights = paint.weights();
    const long used = (weights.col(0).array().abs() > 1e-12).count();
    std::printf("%-26s %9.4f %9ld %11.3f %8.2f\n", name, paint.report()->residual[0], used, off.mapped_rms.mean(),
                off.delta_e_env);
  };
  show("least squares", gonio::least_squares{});
  show("truncated SVD, 90 %", gonio::truncated_svd{0.90});
  show("Lasso, lambda 1", gonio::lasso{1.0});
  show("Tikhonov, eta 40", gonio::tikhonov{40.0});
  show("Tikhonov, automatic eta", gonio::automatic_tikhonov{});
}
