#pragma once
/// What a fit of lobes to measurements makes small: a norm of residuals, as a function of shapes and colours.

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

/// How residuals add up.
enum class fit_norm {
  l2,    ///< half their squares: follows the tops of highlights
  l1,    ///< their sizes, rounded off at zero (see `model_fit_options::rounding`): follows their base
  huber  ///< squares when small, sizes when large
};

struct model_fit_options {
  fit_norm norm = fit_norm::l2;
  /// Reflectance is multiplied by the cosine of the light before it is mapped.
  bool cosine_weighted = false;
  /// Where L1 and Huber's norm turn from squares to sizes, as a share of the median size of the mapped measurements: L1
  /// is sqrt(r^2 + (rounding median)^2), so that its error in the minimum is below that.
  double rounding = 1e-3, huber_width = 0.1;
  /// What a channel of the model may reflect at most of light that falls in at up to 88 degrees; 1 is all of it.
  double largest_albedo = std::numeric_limits<double>::infinity();
  /// Does a Lambertian lobe keep the colour that the first stage gave it, as Nielsen et al. 2014 print the last one?
  bool diffuse_stays = false;
  /// Random starts beside the consecutive scheme, of which the best end counts.
  Eigen::Index random_starts = 0;
  std::uint64_t seed = 0;
  Eigen::Index iteration_limit = 200;
  thread_count threads = {};
};

namespace detail {

/// A metric that is chosen at run time: what follows compiles once, not for each metric.
struct chosen_metric {
  std::function<double(double)> forward, slope;
  bool linear = false;

  template <smooth_metric Metric>
  explicit chosen_metric(const Metric& metric)
      : forward([metric](double rho) { return metric.forward(rho, Eigen::Index{0}); }),
        slope([metric](double rho) { return metric.slope(rho); }),
        linear(std::is_same_v<Metric, lin>) {}
};

/// One loss for all channels of all observations, as a function of the lobes' parameters and colours.
class model_loss {
 public:
  model_loss(std::vector<const lobe_kind*> kinds, std::span<const fit_observation> observations, chosen_metric metric,
             const model_fit_options& options);

  [[nodiscard]] Eigen::Index lobes() const noexcept { return std::ssize(kinds_); }
  [[nodiscard]] Eigen::Index shapes() const noexcept { return std::ssize(owners_); }
  /// Shape parameters first, then the colours, lobe by lobe for each channel.
  [[nodiscard]] Eigen::Index unknowns() const noexcept { return shapes() + 3 * lobes(); }

  /// Does a lobe have no shape, as Lambert's?
  [[nodiscard]] bool is_diffuse(Eigen::Index lobe) const { return kinds_[lobe]->parameters().empty(); }

  /// Logarithms of those parameters whose steps are factors.
  [[nodiscard]] Eigen::VectorXd coded(std::span<const lobe_kind::values> parameters) const;
  [[nodiscard]] std::vector<lobe_kind::values> parameters_of(const Eigen::VectorXd& u) const;

  [[nodiscard]] unknown_bounds bounds() const;

  [[nodiscard]] analytic_brdf model(const Eigen::VectorXd& x) const;

  /// The products of all columns with one another: L values of shapes, then P slopes by coded parameters, then three
  /// measured channels. Everything that is linear in the colours follows from them. One matrix for all channels if each
  /// observation counts the same in them, else one for each. O(N (L + P)^2).
  [[nodiscard]] std::vector<Eigen::MatrixXd> products(const Eigen::VectorXd& u) const;

  /// The best colours by squares of linear residuals, L x 3. Lobes that are dark everywhere stay black.
  [[nodiscard]] Eigen::MatrixXd solve_colours(const std::vector<Eigen::MatrixXd>& products) const;

  /// Half the mean square of linear residuals with the best colours, as a function of the shapes alone.
  [[nodiscard]] local_parabola projected(const Eigen::VectorXd& u) const;

  /// The loss as a function of shapes and colours, and Gauss and Newton's parabola of it, whose norm is that of squares
  /// weighted by how far each residual is out. Half the square of what an albedo exceeds the largest one by is added,
  /// times the steepness, relative to the loss of a black model.
  [[nodiscard]] local_parabola joint(const Eigen::VectorXd& x, double albedo_steepness = 0.0) const;

  /// Whether the colours are linear in the residuals, which are squared.
  [[nodiscard]] bool separates() const noexcept { return metric_.linear && options_.norm == fit_norm::l2; }

  /// The loss of a model that is black.
  [[nodiscard]] double of_nothing() const noexcept { return loss_of_nothing_; }

  /// The largest albedo of each channel of a model, relative to the one that it may have. By the midpoint rule over
  /// `bins`^2 half vectors at each angle.
  [[nodiscard]] rgb relative_albedo(const Eigen::VectorXd& x, int bins) const;

  /// Shapes and the colours that are best for them by squares of linear residuals.
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

  /// The albedos of the lobes and their slopes by coded parameters: a column of L + P for each of `albedo_angles`.
  [[nodiscard]] Eigen::MatrixXd lobe_albedos(const std::vector<lobe_kind::values>& parameters, int bins) const;
  void add_albedo_penalty(const std::vector<lobe_kind::values>& parameters, const Eigen::MatrixXd& colour,
                          double steepness, local_parabola& to) const;

  /// The products with the weights of one channel.
  [[nodiscard]] Eigen::MatrixXd products(const Eigen::VectorXd& u, Eigen::Index channel) const;
  /// The best colours of `channels` channels from `first` on, which have these products in common.
  [[nodiscard]] Eigen::MatrixXd solve_colours(const Eigen::MatrixXd& products, Eigen::Index first,
                                              Eigen::Index channels) const;

  [[nodiscard]] double cosine(const fit_observation& seen) const {
    return options_.cosine_weighted ? seen.at.cosine_i : 1.0;
  }
  [[nodiscard]] double mapped(const fit_observation& seen, double reflectance) const {
    return metric_.forward(reflectance * cosine(seen));
  }

  /// The values of all shapes, then their slopes by coded parameters.
  void evaluate(const lobe_geometry& at, const std::vector<lobe_kind::values>& parameters,
                Eigen::Ref<Eigen::VectorXd> out) const;

  struct norm_value {
    double loss, curvature;  ///< of a residual; the slope of the loss is the curvature times the residual
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
