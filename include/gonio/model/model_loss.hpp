#pragma once
/// The objective of a fit of lobes to measurements: a norm of residuals, as a function of shapes and colours.

#include <gonio/metric/lin.hpp>
#include <gonio/model/analytic_brdf.hpp>
#include <gonio/model/fit_observations.hpp>
#include <gonio/solve/levenberg_marquardt.hpp>

#include <Eigen/Core>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <vector>

namespace gonio::model {

/// The norm of the residuals.
enum class fit_norm {
  l2,    ///< half their squares: follows the peaks of highlights
  l1,    ///< their sizes, smoothed at zero (see `model_fit_options::rounding`): follows the base of highlights
  huber  ///< squares if small, sizes if large
};

struct model_fit_options {
  fit_norm norm = fit_norm::l2;
  /// Multiplies reflectance by the cosine of the light before mapping it.
  bool cosine_weighted = false;
  /// The residual at which the L1 and Huber norms change from squares to sizes, relative to the median size of the
  /// mapped measurements. L1 is sqrt(r^2 + (rounding median)^2), so that the error of its minimum is smaller than
  /// rounding times median.
  double rounding = 1e-3, huber_width = 0.1;
  /// The largest fraction of light, from up to 88 degrees, that a channel of the model may reflect; 1 is all.
  double largest_albedo = std::numeric_limits<double>::infinity();
  /// Lambertian lobes keep the colour of the first stage, as Nielsen et al. 2014 print the last one.
  bool diffuse_stays = false;
  /// Random starts in addition to the consecutive scheme. The best result is kept.
  Eigen::Index random_starts = 0;
  std::uint64_t seed = 0;
  Eigen::Index iteration_limit = 200;
  thread_count threads = {};
};

namespace detail {

/// A metric chosen at run time, so that the code below is compiled only once.
struct chosen_metric {
  std::function<double(double)> forward, slope;
  bool linear = false;

  template <smooth_metric Metric>
  explicit chosen_metric(const Metric& metric)
      : forward([metric](double rho) { return metric.forward(rho, Eigen::Index{0}); }),
        slope([metric](double rho) { return metric.slope(rho); }),
        linear(std::is_same_v<Metric, lin>) {}
};

/// The loss over all channels of all observations, as a function of the lobes' parameters and colours.
class model_loss {
 public:
  model_loss(std::vector<const lobe_kind*> kinds, std::span<const fit_observation> observations, chosen_metric metric,
             const model_fit_options& options);

  [[nodiscard]] Eigen::Index lobes() const noexcept { return std::ssize(kinds_); }
  [[nodiscard]] Eigen::Index shapes() const noexcept { return std::ssize(owners_); }
  /// Shape parameters first, then the colours, lobe by lobe for each channel.
  [[nodiscard]] Eigen::Index unknowns() const noexcept { return shapes() + 3 * lobes(); }

  /// Returns true if a lobe has no shape, like Lambert's.
  [[nodiscard]] bool is_diffuse(Eigen::Index lobe) const { return kinds_[lobe]->parameters().empty(); }

  /// Returns the parameters, with logarithms of those marked logarithmic.
  [[nodiscard]] Eigen::VectorXd coded(std::span<const lobe_kind::values> parameters) const;
  [[nodiscard]] std::vector<lobe_kind::values> parameters_of(const Eigen::VectorXd& u) const;

  [[nodiscard]] unknown_bounds bounds() const;

  [[nodiscard]] analytic_brdf model(const Eigen::VectorXd& x) const;

  /// Returns the products of all columns with one another: L values of shapes, P slopes by coded parameters, and three
  /// measured channels. They determine all quantities that are linear in the colours. One matrix for all channels if
  /// each observation has the same weight in all, otherwise one per channel. O(N (L + P)^2).
  [[nodiscard]] std::vector<Eigen::MatrixXd> products(const Eigen::VectorXd& u) const;

  /// Returns the best colours in least squares of linear residuals, L x 3. Lobes that are dark everywhere stay black.
  [[nodiscard]] Eigen::MatrixXd solve_colours(const std::vector<Eigen::MatrixXd>& products) const;

  /// Half the mean square of linear residuals with the best colours, as a function of the shapes alone.
  [[nodiscard]] local_parabola projected(const Eigen::VectorXd& u) const;

  /// The loss as a function of shapes and colours, with its Gauss-Newton parabola. Other norms than squares are
  /// reweighted squares, with weights that depend on each residual. Adds half the squared excess of each albedo over
  /// the largest one allowed, times the steepness times the loss of a black model.
  [[nodiscard]] local_parabola joint(const Eigen::VectorXd& x, double albedo_steepness = 0.0) const;

  /// Whether residuals are linear in the colours and are squared.
  [[nodiscard]] bool separates() const noexcept { return metric_.linear && options_.norm == fit_norm::l2; }

  /// The loss of a black model.
  [[nodiscard]] double of_nothing() const noexcept { return loss_of_nothing_; }

  /// Returns the largest albedo of each channel, relative to the largest one allowed. Uses the midpoint rule over
  /// `bins`^2 half vectors at each angle.
  [[nodiscard]] rgb relative_albedo(const Eigen::VectorXd& x, int bins) const;

  /// Returns shapes and their best colours in least squares of linear residuals.
  [[nodiscard]] Eigen::VectorXd with_colours(const Eigen::VectorXd& u) const;

 private:
  static constexpr Eigen::Index block_size = 256;

  struct parameter_owner {
    Eigen::Index lobe, parameter;
  };
  [[nodiscard]] parameter_owner owner(Eigen::Index j) const { return owners_[j]; }
  [[nodiscard]] const shape_parameter& description(Eigen::Index j) const {
    return kinds_[owner(j).lobe]->parameters()[owner(j).parameter];
  }
  [[nodiscard]] static double code(const shape_parameter& about, double value) {
    return about.logarithmic ? std::log(value) : value;
  }
  /// L x 3.
  [[nodiscard]] Eigen::MatrixXd colours(const Eigen::VectorXd& x) const;

  /// Returns the lobes' albedos and their slopes by coded parameters: a column of L + P for each of `albedo_angles`.
  [[nodiscard]] Eigen::MatrixXd lobe_albedos(const std::vector<lobe_kind::values>& parameters, int bins) const;
  void add_albedo_penalty(const std::vector<lobe_kind::values>& parameters, const Eigen::MatrixXd& colour,
                          double steepness, local_parabola& to) const;

  /// Returns the products with the weights of one channel.
  [[nodiscard]] Eigen::MatrixXd products(const Eigen::VectorXd& u, Eigen::Index channel) const;
  /// Returns the best colours of `channels` channels from `first` on, which share these products.
  [[nodiscard]] Eigen::MatrixXd solve_colours(const Eigen::MatrixXd& products, Eigen::Index first,
                                              Eigen::Index channels) const;

  [[nodiscard]] double cosine(const fit_observation& seen) const {
    return options_.cosine_weighted ? seen.at.cosine_i : 1.0;
  }
  [[nodiscard]] double mapped(const fit_observation& seen, double reflectance) const {
    return metric_.forward(reflectance * cosine(seen));
  }

  /// Writes the values of all shapes, then their slopes by coded parameters.
  void evaluate(const lobe_geometry& at, const std::vector<lobe_kind::values>& parameters,
                Eigen::Ref<Eigen::VectorXd> out) const;

  struct norm_value {
    double loss, curvature;  ///< of a residual; the loss has the slope curvature times residual
  };
  [[nodiscard]] norm_value norm_of(double residual) const;

  std::vector<const lobe_kind*> kinds_;
  std::vector<parameter_owner> owners_;
  std::span<const fit_observation> observations_;
  chosen_metric metric_;
  const model_fit_options& options_;
  bool weighs_channels_apart_;
  double total_weight_ = 0.0, median_size_ = 0.0, loss_of_nothing_ = 0.0;
};

}  // namespace detail

}  // namespace gonio::model

#if !defined(GONIO_COMPILED)
#include <gonio/model/impl/model_loss.ipp>
#endif
