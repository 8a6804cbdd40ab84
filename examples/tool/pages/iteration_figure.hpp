#pragma once
/// The correction iteration in images: Noell, Koehler and Stricker 2014, Fig. 4.

#include <gonio/render/image.hpp>
#include <gonio/robust/correction.hpp>
#include <gonio/table/sample_set.hpp>

#include <optional>
#include <utility>
#include <vector>

namespace cli {

struct iteration_image {
  gonio::image image;
  /// Mean CIELAB difference between the spheres of each drawn round and of the truth; empty without a truth.
  std::vector<std::pair<Eigen::Index, double>> differences;
};

/// Observes an iteration, and draws the start, rounds 1 and 2, and the last round. docs/reference/formats.md describes
/// the image.
class iteration_figure {
 public:
  iteration_figure(gonio::correction corrections, gonio::sample_set samples, std::optional<gonio::brdf_table> truth,
                   gonio::thread_count threads);

  /// Keeps the state of a run with `result()`. Must be called before the first round and after each.
  template <class Run>
  void look(const Run& run) {
    const auto result = run.result();
    keep({result.history().size(), result.tabulate(gonio::valid_cells(), threads_),
          result.weights().empty() ? Eigen::MatrixXd() : result.weights().back()});
  }

  [[nodiscard]] iteration_image draw() const;

 private:
  struct moment {
    std::size_t round = 0;
    gonio::brdf_table estimate;
    Eigen::MatrixXd weights;  ///< of the round's correction functions; empty before the first
  };

  void keep(moment now);
  [[nodiscard]] gonio::image draw_input() const;
  [[nodiscard]] gonio::image draw_factors(const moment& before) const;
  [[nodiscard]] gonio::image draw_correction(const moment& round) const;
  [[nodiscard]] gonio::image draw_true_correction(const moment& before) const;

  gonio::correction corrections_;
  gonio::sample_set samples_;
  std::optional<gonio::brdf_table> truth_;
  gonio::thread_count threads_;
  std::vector<moment> moments_;
};

}  // namespace cli
