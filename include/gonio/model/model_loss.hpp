#pragma once
/// What a fit of lobes to measurements makes small: a norm of residuals, as a function of shapes and colours.

#include <gonio/metric/lin.hpp>
#include <gonio/model/analytic_brdf.hpp>
#include <gonio/model/fit_observations.hpp>
#include <gonio/solve/levenberg_marquardt.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/normal_equations.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace gonio {

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
  /// Random starts beside the consecutive scheme, of which the best end counts.
  std::size_t random_starts = 0;
  std::uint64_t seed = 0;
  std::size_t iteration_limit = 200;
  thread_count threads = {};
};

namespace detail {

/// A metric that is chosen at run time: what follows compiles once, not for each metric.
struct chosen_metric {
  std::function<double(double)> forward, slope;
  bool linear = false;

  template <smooth_metric Metric>
  explicit chosen_metric(const Metric& metric)
      : forward([metric](double rho) { return metric.forward(rho, std::size_t{0}); }),
        slope([metric](double rho) { return metric.slope(rho); }),
        linear(std::is_same_v<Metric, lin>) {}
};

/// One loss for all channels of all observations, as a function of the lobes' parameters and colours. `Metric` is
/// `chosen_metric`: a template costs nothing to compile where nothing is fitted.
template <class Metric>
class model_loss {
 public:
  model_loss(std::vector<const lobe_kind*> kinds, std::span<const fit_observation> observations, Metric metric,
             const model_fit_options& options)
      : kinds_(std::move(kinds)), observations_(observations), metric_(std::move(metric)), options_(options) {
    for (std::size_t l = 0; l < kinds_.size(); ++l)
      for (std::size_t p = 0; p < kinds_[l]->parameters().size(); ++p) owners_.push_back({l, p});
    std::vector<double> sizes;
    for (const fit_observation& seen : observations_) {
      total_weight_ += 3.0 * seen.weight;
      for (Eigen::Index c = 0; c < 3; ++c) sizes.push_back(std::abs(mapped(seen, seen.value[c])));
    }
    const auto middle = sizes.begin() + std::ssize(sizes) / 2;
    std::ranges::nth_element(sizes, middle);
    median_size_ = *middle;
    if (!(median_size_ > 0.0)) median_size_ = *std::ranges::max_element(sizes);
    for (const fit_observation& seen : observations_)
      for (Eigen::Index c = 0; c < 3; ++c)
        loss_of_nothing_ += seen.weight * norm_of(mapped(seen, seen.value[c])).loss / total_weight_;
  }

  [[nodiscard]] Eigen::Index lobes() const noexcept { return std::ssize(kinds_); }
  [[nodiscard]] Eigen::Index shapes() const noexcept { return std::ssize(owners_); }
  /// Shape parameters first, then the colours, lobe by lobe for each channel.
  [[nodiscard]] Eigen::Index unknowns() const noexcept { return shapes() + 3 * lobes(); }

  /// Logarithms of those parameters whose steps are factors.
  [[nodiscard]] Eigen::VectorXd coded(std::span<const lobe_kind::values> parameters) const {
    Eigen::VectorXd u(shapes());
    for (Eigen::Index j = 0; j < u.size(); ++j) {
      const auto [lobe, p] = owner(j);
      u[j] = code(description(j), parameters[lobe][p]);
    }
    return u;
  }
  [[nodiscard]] std::vector<lobe_kind::values> decoded(const Eigen::VectorXd& u) const {
    std::vector<lobe_kind::values> parameters(kinds_.size(), lobe_kind::values{});
    for (Eigen::Index j = 0; j < shapes(); ++j) {
      const auto [lobe, p] = owner(j);
      const shape_parameter& about = description(j);
      // exp(log(bound)) may round to what is out of bounds.
      parameters[lobe][p] = std::clamp(about.logarithmic ? std::exp(u[j]) : u[j], about.lowest, about.highest);
    }
    return parameters;
  }

  [[nodiscard]] unknown_bounds bounds() const {
    unknown_bounds all{Eigen::VectorXd::Zero(unknowns()),
                       Eigen::VectorXd::Constant(unknowns(), std::numeric_limits<double>::infinity())};
    for (Eigen::Index j = 0; j < shapes(); ++j) {
      all.lowest[j] = code(description(j), description(j).lowest);
      all.highest[j] = code(description(j), description(j).highest);
    }
    return all;
  }

  [[nodiscard]] analytic_brdf model(const Eigen::VectorXd& x) const {
    const auto parameters = decoded(x);
    std::vector<analytic_lobe> all;
    for (Eigen::Index l = 0; l < lobes(); ++l)
      all.emplace_back(*kinds_[static_cast<std::size_t>(l)], rgb(colours(x).row(l).transpose()),
                       parameters[static_cast<std::size_t>(l)]);
    return analytic_brdf(std::move(all));
  }

  /// The products of all columns with one another: L values of shapes, then P slopes by coded parameters, then three
  /// measured channels. Everything that is linear in the colours follows from them. O(N (L + P)^2).
  [[nodiscard]] Eigen::MatrixXd products(const Eigen::VectorXd& u) const {
    const Eigen::Index all = lobes() + shapes() + 3;
    const auto parameters = decoded(u);
    return sum_over_blocks(
        observations_.size(), block_size, Eigen::MatrixXd::Zero(all, all).eval(),
        [&](Eigen::MatrixXd& sum, block range) {
          Eigen::MatrixXd columns(all, static_cast<Eigen::Index>(range.size()));
          for (std::size_t i = range.begin; i < range.end; ++i) {
            const fit_observation& seen = observations_[i];
            auto column = columns.col(static_cast<Eigen::Index>(i - range.begin));
            evaluate(seen.at, parameters, column);
            column.tail(3) = seen.value.matrix();
            column *= std::sqrt(seen.weight) * cosine(seen);
          }
          sum.noalias() += columns * columns.transpose();
        },
        options_.threads);
  }

  /// The best colours by squares of linear residuals. Lobes that are dark everywhere stay black.
  [[nodiscard]] Eigen::MatrixXd solve_colours(const Eigen::MatrixXd& products) const {
    const Eigen::Index count = lobes();
    Eigen::MatrixXd found = Eigen::MatrixXd::Zero(count, 3);
    const double brightest = products.diagonal().head(count).maxCoeff();
    std::vector<Eigen::Index> bright;
    for (Eigen::Index l = 0; l < count; ++l)
      if (products(l, l) > 1e-280 && products(l, l) > 1e-200 * brightest) bright.push_back(l);
    if (bright.empty()) return found;
    // Columns of length one, so that a narrow lobe of huge values does not hide a dim one.
    const Eigen::VectorXd scale = products.diagonal()(bright).cwiseSqrt().cwiseInverse();
    const auto right = Eigen::seqN(count + shapes(), 3);
    const Eigen::MatrixXd gram = scale.asDiagonal() * products(bright, bright) * scale.asDiagonal();
    const Eigen::MatrixXd moment = scale.asDiagonal() * products(bright, right);
    found(bright, Eigen::all) = scale.asDiagonal() * nnls().solve(normal_equations(gram, moment)).weights;
    return found;
  }

  /// Half the mean square of linear residuals with the best colours, as a function of the shapes alone.
  [[nodiscard]] local_parabola projected(const Eigen::VectorXd& u) const {
    const Eigen::MatrixXd all = products(u);
    const Eigen::MatrixXd found = solve_colours(all);
    const Eigen::Index count = lobes(), p = shapes();
    local_parabola result{0.0, Eigen::VectorXd::Zero(p), Eigen::MatrixXd::Zero(p, p)};
    for (Eigen::Index c = 0; c < 3; ++c) {
      // The residual is G x - y, its slopes D times the colours of their lobes.
      Eigen::VectorXd residual = Eigen::VectorXd::Zero(all.rows());
      residual.head(count) = found.col(c);
      residual[count + p + c] = -1.0;
      const Eigen::VectorXd against = all * residual;
      result.value += 0.5 * residual.dot(against);
      Eigen::VectorXd colour(p);
      for (Eigen::Index j = 0; j < p; ++j) colour[j] = found(static_cast<Eigen::Index>(owner(j).lobe), c);
      result.gradient += colour.cwiseProduct(against.segment(count, p));
      result.hessian += colour.asDiagonal() * all.block(count, count, p, p) * colour.asDiagonal();
      // What colours that are not held at zero make up for.
      std::vector<Eigen::Index> lit;
      for (Eigen::Index l = 0; l < count; ++l)
        if (found(l, c) > 0.0) lit.push_back(l);
      if (lit.empty()) continue;
      const Eigen::MatrixXd crossed = all(lit, Eigen::seqN(count, p)) * colour.asDiagonal();
      const Eigen::MatrixXd among = all(lit, lit);
      result.hessian -= crossed.transpose() * among.ldlt().solve(crossed);
    }
    result.value /= total_weight_;
    result.gradient /= total_weight_;
    result.hessian /= total_weight_;
    return result;
  }

  /// The loss as a function of shapes and colours, and Gauss and Newton's parabola of it, whose norm is that of squares
  /// weighted by how far each residual is out.
  [[nodiscard]] local_parabola joint(const Eigen::VectorXd& x) const {
    const Eigen::Index count = lobes(), p = shapes(), n = p + count;
    const auto parameters = decoded(x);
    const Eigen::MatrixXd colour = colours(x);
    // For each channel the products of its slopes by shapes and its own colours, and of those with the residual.
    const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(3 * (n + 1), n + 1);
    const Eigen::MatrixXd sums = sum_over_blocks(
        observations_.size(), block_size, zero,
        [&](Eigen::MatrixXd& sum, block range) {
          std::array<Eigen::MatrixXd, 3> columns;
          columns.fill(Eigen::MatrixXd(n + 1, static_cast<Eigen::Index>(range.size())));
          Eigen::VectorXd value(n + 3);
          std::array<double, 3> losses{};
          for (std::size_t i = range.begin; i < range.end; ++i) {
            const fit_observation& seen = observations_[i];
            evaluate(seen.at, parameters, value);
            for (Eigen::Index c = 0; c < 3; ++c) {
              const double modelled = value.head(count).dot(colour.col(c));
              const double residual = mapped(seen, modelled) - mapped(seen, seen.value[c]);
              const auto [loss, curvature] = norm_of(residual);
              losses[static_cast<std::size_t>(c)] += seen.weight * loss;
              const double root = std::sqrt(seen.weight * curvature);
              const double slope = root * cosine(seen) * metric_.slope(modelled * cosine(seen));
              auto column = columns[static_cast<std::size_t>(c)].col(static_cast<Eigen::Index>(i - range.begin));
              for (Eigen::Index j = 0; j < p; ++j)
                column[j] = slope * value[count + j] * colour(static_cast<Eigen::Index>(owner(j).lobe), c);
              column.segment(p, count) = slope * value.head(count);
              column[n] = root * residual;
            }
          }
          for (Eigen::Index c = 0; c < 3; ++c) {
            const auto& own = columns[static_cast<std::size_t>(c)];
            auto part = sum.middleRows(c * (n + 1), n + 1);
            const double before = part(n, n);
            part.noalias() += own * own.transpose();
            part(n, n) = before + losses[static_cast<std::size_t>(c)];
          }
        },
        options_.threads);

    local_parabola result{0.0, Eigen::VectorXd::Zero(unknowns()), Eigen::MatrixXd::Zero(unknowns(), unknowns())};
    for (Eigen::Index c = 0; c < 3; ++c) {
      const auto part = sums.middleRows(c * (n + 1), n + 1) / total_weight_;
      const Eigen::Index own = p + c * count;
      result.value += part(n, n);
      result.gradient.head(p) += part.col(n).head(p);
      result.gradient.segment(own, count) = part.col(n).segment(p, count);
      result.hessian.topLeftCorner(p, p) += part.topLeftCorner(p, p);
      result.hessian.block(0, own, p, count) = part.block(0, p, p, count);
      result.hessian.block(own, 0, count, p) = part.block(p, 0, count, p);
      result.hessian.block(own, own, count, count) = part.block(p, p, count, count);
    }
    return result;
  }

  /// Whether the colours are linear in the residuals, which are squared.
  [[nodiscard]] bool separates() const noexcept { return metric_.linear && options_.norm == fit_norm::l2; }

  /// The loss of a model that is black.
  [[nodiscard]] double of_nothing() const noexcept { return loss_of_nothing_; }

  /// Shapes and the colours that are best for them by squares of linear residuals.
  [[nodiscard]] Eigen::VectorXd with_colours(const Eigen::VectorXd& u) const {
    Eigen::VectorXd x(unknowns());
    const Eigen::MatrixXd found = solve_colours(products(u));
    x << u.head(shapes()), found.reshaped();
    return x;
  }

 private:
  static constexpr std::size_t block_size = 256;

  struct parameter_owner {
    std::size_t lobe, parameter;
  };
  [[nodiscard]] parameter_owner owner(Eigen::Index j) const { return owners_[static_cast<std::size_t>(j)]; }
  [[nodiscard]] const shape_parameter& description(Eigen::Index j) const {
    return kinds_[owner(j).lobe]->parameters()[owner(j).parameter];
  }
  [[nodiscard]] static double code(const shape_parameter& about, double value) {
    return about.logarithmic ? std::log(value) : value;
  }
  /// L x 3.
  [[nodiscard]] Eigen::MatrixXd colours(const Eigen::VectorXd& x) const {
    return x.tail(3 * lobes()).reshaped(lobes(), 3);
  }

  [[nodiscard]] double cosine(const fit_observation& seen) const {
    return options_.cosine_weighted ? seen.at.cosine_i : 1.0;
  }
  [[nodiscard]] double mapped(const fit_observation& seen, double reflectance) const {
    return metric_.forward(reflectance * cosine(seen));
  }

  /// The values of all shapes, then their slopes by coded parameters.
  void evaluate(const lobe_geometry& at, const std::vector<lobe_kind::values>& parameters, auto&& out) const {
    Eigen::Index j = lobes();
    for (std::size_t l = 0; l < kinds_.size(); ++l) {
      lobe_kind::values slopes{};
      const double value = kinds_[l]->value_and_slopes(at, parameters[l], slopes);
      out[static_cast<Eigen::Index>(l)] = std::min(value, largest_reflectance);
      const auto about = kinds_[l]->parameters();
      for (std::size_t p = 0; p < about.size(); ++p, ++j)
        out[j] = about[p].logarithmic ? slopes[p] * parameters[l][p] : slopes[p];
    }
  }

  struct norm_value {
    double loss, curvature;  ///< of a residual; the slope of the loss is the curvature times the residual
  };
  [[nodiscard]] norm_value norm_of(double residual) const {
    const double size = std::abs(residual);
    if (options_.norm == fit_norm::l1) {
      const double rounded = std::hypot(residual, options_.rounding * median_size_);
      return {rounded, 1.0 / rounded};
    }
    const double width = options_.huber_width * median_size_;
    if (options_.norm == fit_norm::huber && size > width) return {width * (size - 0.5 * width), width / size};
    return {0.5 * residual * residual, 1.0};
  }

  std::vector<const lobe_kind*> kinds_;
  std::vector<parameter_owner> owners_;
  std::span<const fit_observation> observations_;
  Metric metric_;
  const model_fit_options& options_;
  double total_weight_ = 0.0, median_size_ = 0.0, loss_of_nothing_ = 0.0;
};

}  // namespace detail

}  // namespace gonio
