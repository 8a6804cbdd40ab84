#pragma once
/// The objective of a fit of lobes to measurements: a norm of the residuals as a function of the lobes' shapes and
/// colours.

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
  l2,    ///< half the squared residuals: follows the peaks of highlights
  l1,    ///< absolute residuals, smoothed at zero (`model_fit_options::rounding`): follows the base of highlights
  huber  ///< squares of small residuals, absolute values of large ones
};

struct model_fit_options {
  fit_norm norm = fit_norm::l2;
  /// Multiplies reflectance by the cosine of the light before mapping it.
  bool cosine_weighted = false;
  /// The residual at which the L1 and Huber norms change from squares to absolute values, relative to the median
  /// absolute value of the mapped measurements. For L1, a residual r counts sqrt(r^2 + (rounding * median)^2), which
  /// moves the minimum by less than rounding * median.
  double rounding = 1e-3, huber_width = 0.1;
  /// The largest allowed albedo of the model in any channel, with light at seven angles up to 88 degrees. An albedo of
  /// 1 means that all light is reflected.
  double largest_albedo = std::numeric_limits<double>::infinity();
  /// If true, Lambertian lobes keep their colour from the first stage, as in the last stage that Nielsen et al. 2014
  /// print.
  bool diffuse_stays = false;
  /// Number of random starts in addition to the consecutive optimisation. The best result is kept.
  Eigen::Index random_starts = 0;
  std::uint64_t seed = 0;
  Eigen::Index iteration_limit = 200;
  thread_count threads = {};
};

namespace detail {

/// A metric chosen at run time, so that `model_loss` is compiled only once.
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
  /// Returns the number of unknowns: first the shape parameters, then the colours, lobe by lobe for each channel.
  [[nodiscard]] Eigen::Index unknowns() const noexcept { return shapes() + 3 * lobes(); }

  /// Returns true if a lobe has no shape parameters, like Lambert's.
  [[nodiscard]] bool is_diffuse(Eigen::Index lobe) const { return kinds_[lobe]->parameters().empty(); }

  /// Returns coded parameters: the logarithm of each parameter marked logarithmic, all other parameters unchanged.
  [[nodiscard]] Eigen::VectorXd coded(std::span<const lobe_kind::values> parameters) const;
  [[nodiscard]] std::vector<lobe_kind::values> parameters_of(const Eigen::VectorXd& u) const;

  [[nodiscard]] unknown_bounds bounds() const;

  [[nodiscard]] analytic_brdf model(const Eigen::VectorXd& x) const;

  /// Returns the weighted scalar products of L + P + 3 columns over the N observations: the values of L shapes, their P
  /// slopes with respect to the coded parameters, and three measured channels. These products suffice for the squared
  /// loss of linear residuals, its gradient and its Hessian, for any colours. Returns a single matrix if each
  /// observation weighs its channels equally, otherwise one matrix per channel. O(N (L + P)^2).
  [[nodiscard]] std::vector<Eigen::MatrixXd> products(const Eigen::VectorXd& u) const;

  /// Returns the colours that minimise the squares of linear residuals, L x 3 for L lobes. Lobes that are dark
  /// everywhere stay black.
  [[nodiscard]] Eigen::MatrixXd solve_colours(const std::vector<Eigen::MatrixXd>& products) const;

  /// Returns half the mean square of linear residuals as a function of the shapes alone, each with its best colours.
  [[nodiscard]] local_parabola projected(const Eigen::VectorXd& u) const;

  /// Returns the loss as a function of shapes and colours, with its Gauss-Newton parabola. Norms other than L2 are
  /// reweighted squares, with weights that depend on each residual. Adds a penalty: half the squared excess of each
  /// albedo over `largest_albedo`, times the steepness, times the loss of a black model.
  [[nodiscard]] local_parabola joint(const Eigen::VectorXd& x, double albedo_steepness = 0.0) const;

  /// Returns true if residuals are linear in the colours and are squared.
  [[nodiscard]] bool separates() const noexcept { return metric_.linear && options_.norm == fit_norm::l2; }

  /// Returns the loss of a black model.
  [[nodiscard]] double of_nothing() const noexcept { return loss_of_nothing_; }

  /// Returns the largest albedo of each channel, relative to `largest_albedo`. Integrates over `bins`^2 half vectors at
  /// each angle.
  [[nodiscard]] rgb relative_albedo(const Eigen::VectorXd& x, int bins) const;

  /// Returns the shapes followed by their best colours, which minimise the squares of linear residuals.
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

  /// Returns the L lobes' albedos and their P slopes with respect to the coded parameters, a column per albedo angle;
  /// for anisotropic lobes, at each of four azimuths.
  [[nodiscard]] Eigen::MatrixXd lobe_albedos(const std::vector<lobe_kind::values>& parameters, int bins) const;
  void add_albedo_penalty(const std::vector<lobe_kind::values>& parameters, const Eigen::MatrixXd& colour,
                          double steepness, local_parabola& to) const;

  /// Returns the products of `products(u)` for one channel, with its weights.
  [[nodiscard]] Eigen::MatrixXd products(const Eigen::VectorXd& u, Eigen::Index channel) const;
  /// Returns the best colours of `channels` successive channels that share these products; `first` is the first of
  /// them.
  [[nodiscard]] Eigen::MatrixXd solve_colours(const Eigen::MatrixXd& products, Eigen::Index first,
                                              Eigen::Index channels) const;

  [[nodiscard]] double cosine(const fit_observation& seen) const {
    return options_.cosine_weighted ? seen.at.cosine_i : 1.0;
  }
  [[nodiscard]] double mapped(const fit_observation& seen, double reflectance) const {
    return metric_.forward(reflectance * cosine(seen));
  }

  /// Writes the values of all shapes, then their slopes with respect to the coded parameters.
  void evaluate(const lobe_geometry& at, const std::vector<lobe_kind::values>& parameters,
                Eigen::Ref<Eigen::VectorXd> out) const;

  struct norm_value {
    double loss, curvature;  ///< of a residual; the slope of the loss is curvature times residual
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
