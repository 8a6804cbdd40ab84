#pragma once
/// Bodies of model/model_loss.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/statistics.hpp>
#include <gonio/model/model_loss.hpp>
#include <gonio/model/physical_properties.hpp>
#include <gonio/solve/cholesky.hpp>
#include <gonio/solve/nnls.hpp>
#include <gonio/solve/normal_equations.hpp>
#include <gonio/solve/product.hpp>
#include <gonio/solve/semidefinite.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace gonio::model::detail {

/// Returns the submatrix with the given rows and columns.
[[nodiscard]] GONIO_INLINE Eigen::MatrixXd entries(const Eigen::MatrixXd& of, const std::vector<Eigen::Index>& rows,
                                                   const std::vector<Eigen::Index>& columns) {
  Eigen::MatrixXd found(std::ssize(rows), std::ssize(columns));
  for (Eigen::Index j = 0; j < std::ssize(columns); ++j)
    for (Eigen::Index i = 0; i < std::ssize(rows); ++i) found(i, j) = of(rows[i], columns[j]);
  return found;
}

/// Angles of the light in radians at which the albedo is bounded. They are denser towards grazing angles, where the
/// albedo grows.
inline constexpr std::array albedo_angles{0.0,           radians(45.0), radians(60.0), radians(70.0),
                                          radians(80.0), radians(85.0), radians(88.0)};

/// Returns `count` consecutive numbers from `first` on.
[[nodiscard]] GONIO_INLINE std::vector<Eigen::Index> numbers_from(Eigen::Index first, Eigen::Index count) {
  std::vector<Eigen::Index> all(count);
  std::iota(all.begin(), all.end(), first);
  return all;
}

GONIO_INLINE model_loss::model_loss(std::vector<const lobe_kind*> kinds, std::span<const fit_observation> observations,
                                    chosen_metric metric, const model_fit_options& options)
    : kinds_(std::move(kinds)),
      observations_(observations),
      metric_(std::move(metric)),
      options_(options),
      weighs_channels_apart_(weigh_channels_apart(observations)) {
  for (Eigen::Index l = 0; l < std::ssize(kinds_); ++l)
    for (Eigen::Index p = 0; p < std::ssize(kinds_[l]->parameters()); ++p) owners_.push_back({l, p});
  std::vector<double> sizes;
  for (const fit_observation& seen : observations_) {
    total_weight_ += seen.weight.of_each().sum();
    for (Eigen::Index c = 0; c < 3; ++c) sizes.push_back(std::abs(mapped(seen, seen.value[c])));
  }
  median_size_ = upper_median(sizes);
  if (!(median_size_ > 0.0)) median_size_ = *std::ranges::max_element(sizes);
  for (const fit_observation& seen : observations_)
    for (Eigen::Index c = 0; c < 3; ++c)
      loss_of_nothing_ += seen.weight[c] * norm_of(mapped(seen, seen.value[c])).loss / total_weight_;
}

GONIO_INLINE Eigen::VectorXd model_loss::coded(std::span<const lobe_kind::values> parameters) const {
  Eigen::VectorXd u(shapes());
  for (Eigen::Index j = 0; j < u.size(); ++j) {
    const auto [lobe, p] = owner(j);
    u[j] = code(description(j), parameters[lobe][p]);
  }
  return u;
}

GONIO_INLINE std::vector<lobe_kind::values> model_loss::parameters_of(const Eigen::VectorXd& u) const {
  std::vector<lobe_kind::values> parameters(kinds_.size(), lobe_kind::values{});
  for (Eigen::Index j = 0; j < shapes(); ++j) {
    const auto [lobe, p] = owner(j);
    const shape_parameter& about = description(j);
    // exp(log(bound)) may round to a value outside the bounds.
    parameters[lobe][p] = std::clamp(about.logarithmic ? std::exp(u[j]) : u[j], about.lowest, about.highest);
  }
  return parameters;
}

GONIO_INLINE Eigen::MatrixXd model_loss::colours(const Eigen::VectorXd& x) const {
  return x.tail(3 * lobes()).reshaped(lobes(), 3);
}

GONIO_INLINE unknown_bounds model_loss::bounds() const {
  unknown_bounds all{Eigen::VectorXd::Zero(unknowns()),
                     Eigen::VectorXd::Constant(unknowns(), std::numeric_limits<double>::infinity())};
  for (Eigen::Index j = 0; j < shapes(); ++j) {
    all.lowest[j] = code(description(j), description(j).lowest);
    all.highest[j] = code(description(j), description(j).highest);
  }
  return all;
}

GONIO_INLINE analytic_brdf model_loss::model(const Eigen::VectorXd& x) const {
  const auto parameters = parameters_of(x);
  std::vector<analytic_lobe> all;
  for (Eigen::Index l = 0; l < lobes(); ++l)
    all.emplace_back(*kinds_[l], rgb(colours(x).row(l).transpose()), parameters[l]);
  return analytic_brdf(std::move(all));
}

GONIO_INLINE std::vector<Eigen::MatrixXd> model_loss::products(const Eigen::VectorXd& u) const {
  if (!weighs_channels_apart_) return {products(u, 0)};
  return {products(u, 0), products(u, 1), products(u, 2)};
}

GONIO_INLINE Eigen::MatrixXd model_loss::products(const Eigen::VectorXd& u, Eigen::Index channel) const {
  const Eigen::Index all = lobes() + shapes() + 3;
  const auto parameters = parameters_of(u);
  return sum_over_blocks(
      observations_.size(), block_size, Eigen::MatrixXd::Zero(all, all).eval(),
      [&](Eigen::MatrixXd& sum, block range) {
        Eigen::MatrixXd columns(all, range.size());
        for (Eigen::Index i = range.begin; i < range.end; ++i) {
          const fit_observation& seen = observations_[i];
          auto column = columns.col(i - range.begin);
          evaluate(seen.at, parameters, column);
          column.tail(3) = seen.value.matrix();
          column *= std::sqrt(seen.weight[channel]) * cosine(seen);
        }
        sum += product_with_transpose(columns);
      },
      options_.threads);
}

GONIO_INLINE Eigen::MatrixXd model_loss::solve_colours(const std::vector<Eigen::MatrixXd>& products) const {
  if (products.size() == 1) return solve_colours(products.front(), 0, 3);
  Eigen::MatrixXd found(lobes(), 3);
  for (Eigen::Index c = 0; c < 3; ++c) found.col(c) = solve_colours(products[c], c, 1);
  return found;
}

GONIO_INLINE Eigen::MatrixXd model_loss::solve_colours(const Eigen::MatrixXd& products, Eigen::Index first,
                                                       Eigen::Index channels) const {
  const Eigen::Index count = lobes();
  Eigen::MatrixXd found = Eigen::MatrixXd::Zero(count, channels);
  const double brightest = products.diagonal().head(count).maxCoeff();
  std::vector<Eigen::Index> bright;
  for (Eigen::Index l = 0; l < count; ++l)
    if (products(l, l) > 1e-280 && products(l, l) > 1e-200 * brightest) bright.push_back(l);
  if (bright.empty()) return found;
  // Scale columns to length one, so that a narrow lobe of huge values does not hide a dim lobe.
  Eigen::MatrixXd gram = entries(products, bright, bright),
                  rhs = entries(products, bright, numbers_from(count + shapes() + first, channels));
  const Eigen::VectorXd scale = gram.diagonal().cwiseSqrt().cwiseInverse();
  for (Eigen::Index i = 0; i < scale.size(); ++i) {
    rhs.row(i) *= scale[i];
    for (Eigen::Index j = 0; j < scale.size(); ++j) gram(i, j) *= scale[i] * scale[j];
  }
  const Eigen::MatrixXd scaled = nnls().solve(normal_equations(std::move(gram), std::move(rhs))).weights;
  for (Eigen::Index i = 0; i < scale.size(); ++i) found.row(bright[i]) = scale[i] * scaled.row(i);
  return found;
}

GONIO_INLINE local_parabola model_loss::projected(const Eigen::VectorXd& u) const {
  // Solve for the best colours of each channel: the normal equations with the constraint that no colour is negative.
  const std::vector<Eigen::MatrixXd> of_channels = products(u);
  const Eigen::MatrixXd found = solve_colours(of_channels);
  const Eigen::Index count = lobes(), p = shapes();
  local_parabola result{0.0, Eigen::VectorXd::Zero(p), Eigen::MatrixXd::Zero(p, p)};
  for (Eigen::Index c = 0; c < 3; ++c) {
    const Eigen::MatrixXd& all = of_channels[weighs_channels_apart_ ? c : 0];
    // Evaluate the loss. The residual is the sum of the lobes times their colours, minus the measured channel.
    Eigen::VectorXd residual = Eigen::VectorXd::Zero(all.rows());
    residual.head(count) = found.col(c);
    residual[count + p + c] = -1.0;
    const Eigen::VectorXd against = all * residual;
    result.value += 0.5 * residual.dot(against);
    // Add the gradient and the Gauss-Newton Hessian with respect to the shapes' parameters.
    Eigen::VectorXd colour(p);
    for (Eigen::Index j = 0; j < p; ++j) colour[j] = found(owner(j).lobe, c);
    result.gradient += colour.cwiseProduct(against.segment(count, p));
    for (Eigen::Index j = 0; j < p; ++j)
      for (Eigen::Index i = 0; i < p; ++i) result.hessian(i, j) += colour[i] * all(count + i, count + j) * colour[j];
    // Subtract the part of the Hessian that changing colours compensate. Colours that are held at zero compensate
    // nothing.
    std::vector<Eigen::Index> lit;
    for (Eigen::Index l = 0; l < count; ++l)
      if (found(l, c) > 0.0) lit.push_back(l);
    if (lit.empty()) continue;
    Eigen::MatrixXd crossed = entries(all, lit, numbers_from(count, p));
    for (Eigen::Index j = 0; j < p; ++j) crossed.col(j) *= colour[j];
    const Eigen::MatrixXd among = entries(all, lit, lit);
    result.hessian -= product(crossed.transpose(), solve_semidefinite(among, crossed));
  }
  // Divide by the total weight: the loss is a mean.
  result.value /= total_weight_;
  result.gradient /= total_weight_;
  result.hessian /= total_weight_;
  return result;
}

GONIO_INLINE local_parabola model_loss::joint(const Eigen::VectorXd& x, double albedo_steepness) const {
  const Eigen::Index count = lobes(), p = shapes(), n = p + count;
  // Split the unknowns into shapes and colours.
  const auto parameters = parameters_of(x);
  const Eigen::MatrixXd colour = colours(x);
  // For each channel, sum over the observations the products of the slopes with one another and with the residual. The
  // slopes are with respect to the shapes and to the channel's own colours.
  const Eigen::MatrixXd zero = Eigen::MatrixXd::Zero(3 * (n + 1), n + 1);
  const Eigen::MatrixXd sums = sum_over_blocks(
      observations_.size(), block_size, zero,
      [&](Eigen::MatrixXd& sum, block range) {
        std::array<Eigen::MatrixXd, 3> columns;
        columns.fill(Eigen::MatrixXd(n + 1, range.size()));
        // Evaluate each lobe and its slopes with respect to the shapes at an observation.
        Eigen::VectorXd value(n + 3);
        std::array<double, 3> losses{};
        for (Eigen::Index i = range.begin; i < range.end; ++i) {
          const fit_observation& seen = observations_[i];
          evaluate(seen.at, parameters, value);
          for (Eigen::Index c = 0; c < 3; ++c) {
            // Compute the loss of each channel's residual, and weight the residual by the square root of the loss's
            // curvature.
            const double modelled = value.head(count).dot(colour.col(c));
            const double residual = mapped(seen, modelled) - mapped(seen, seen.value[c]);
            const auto [loss, curvature] = norm_of(residual);
            losses[c] += seen.weight[c] * loss;
            const double root = std::sqrt(seen.weight[c] * curvature);
            const double slope = root * cosine(seen) * metric_.slope(modelled * cosine(seen));
            auto column = columns[c].col(i - range.begin);
            // Store a column: the slopes with respect to shapes and to the channel's colours, and the residual.
            for (Eigen::Index j = 0; j < p; ++j) column[j] = slope * value[count + j] * colour(owner(j).lobe, c);
            column.segment(p, count) = slope * value.head(count);
            column[n] = root * residual;
          }
        }
        // Add the products of all columns. The last diagonal entry would sum squared residuals; sum the losses there
        // instead.
        for (Eigen::Index c = 0; c < 3; ++c) {
          const auto& own = columns[c];
          auto part = sum.middleRows(c * (n + 1), n + 1);
          const double before = part(n, n);
          part += product_with_transpose(own);
          part(n, n) = before + losses[c];
        }
      },
      options_.threads);

  // Assemble the parabola from the sums of the channels, which share the shapes but have their own colours.
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
  if (albedo_steepness > 0.0) add_albedo_penalty(parameters, colour, albedo_steepness * loss_of_nothing_, result);
  return result;
}

GONIO_INLINE Eigen::MatrixXd model_loss::lobe_albedos(const std::vector<lobe_kind::values>& parameters,
                                                      int bins) const {
  const bool is_anisotropic = std::ranges::any_of(kinds_, [](const lobe_kind* kind) { return kind->is_anisotropic(); });
  const Eigen::Index angles = std::ssize(albedo_angles), azimuths = is_anisotropic ? 4 : 1;
  Eigen::MatrixXd albedos(lobes() + shapes(), angles * azimuths);
  for_each_index(
      albedos.cols(), 1,
      [&](Eigen::Index number) {
        const double azimuth = radians(45.0 * static_cast<double>(number / angles));
        const auto turned = [&](const direction& w) { return is_anisotropic ? turned_about_normal(w, azimuth) : w; };
        Eigen::VectorXd sum = Eigen::VectorXd::Zero(albedos.rows()), value(albedos.rows());
        for_each_light(albedo_angles[number % angles], bins,
                       [&](const direction& wi, const direction& wo, double weight) {
                         evaluate(lobe_geometry(turned(wi), turned(wo)), parameters, value);
                         sum += weight * value;
                       });
        albedos.col(number) = sum;
      },
      options_.threads);
  return albedos;
}

GONIO_INLINE void model_loss::add_albedo_penalty(const std::vector<lobe_kind::values>& parameters,
                                                 const Eigen::MatrixXd& colour, double steepness,
                                                 local_parabola& to) const {
  constexpr int bins = 40;
  const Eigen::Index count = lobes(), p = shapes();
  const Eigen::MatrixXd albedos = lobe_albedos(parameters, bins);
  for (Eigen::Index angle = 0; angle < albedos.cols(); ++angle)
    for (Eigen::Index c = 0; c < 3; ++c) {
      const double excess = albedos.col(angle).head(count).dot(colour.col(c)) - options_.largest_albedo;
      if (excess <= 0.0) continue;
      Eigen::VectorXd slopes = Eigen::VectorXd::Zero(unknowns());
      for (Eigen::Index j = 0; j < p; ++j) slopes[j] = albedos(count + j, angle) * colour(owner(j).lobe, c);
      slopes.segment(p + c * count, count) = albedos.col(angle).head(count);
      to.value += 0.5 * steepness * excess * excess;
      to.gradient += steepness * excess * slopes;
      to.hessian += steepness * slopes * slopes.transpose();
    }
}

GONIO_INLINE rgb model_loss::relative_albedo(const Eigen::VectorXd& x, int bins) const {
  const Eigen::MatrixXd albedos = lobe_albedos(parameters_of(x), bins).topRows(lobes()).transpose() * colours(x);
  return albedos.colwise().maxCoeff().transpose().array() / options_.largest_albedo;
}

GONIO_INLINE Eigen::VectorXd model_loss::with_colours(const Eigen::VectorXd& u) const {
  Eigen::VectorXd x(unknowns());
  const Eigen::MatrixXd found = solve_colours(products(u));
  x << u.head(shapes()), found.reshaped();
  return x;
}

GONIO_INLINE void model_loss::evaluate(const lobe_geometry& at, const std::vector<lobe_kind::values>& parameters,
                                       Eigen::Ref<Eigen::VectorXd> out) const {
  Eigen::Index j = lobes();
  for (Eigen::Index l = 0; l < std::ssize(kinds_); ++l) {
    lobe_kind::values slopes{};
    const double value = kinds_[l]->value_and_slopes(at, parameters[l], slopes);
    out[l] = std::min(value, largest_reflectance);
    const auto about = kinds_[l]->parameters();
    for (Eigen::Index p = 0; p < std::ssize(about); ++p, ++j)
      out[j] = about[p].logarithmic ? slopes[p] * parameters[l][p] : slopes[p];
  }
}

GONIO_INLINE model_loss::norm_value model_loss::norm_of(double residual) const {
  const double size = std::abs(residual);
  if (options_.norm == fit_norm::l1) {
    const double rounded = std::hypot(residual, options_.rounding * median_size_);
    return {rounded, 1.0 / rounded};
  }
  const double width = options_.huber_width * median_size_;
  if (options_.norm == fit_norm::huber && size > width) return {width * (size - 0.5 * width), width / size};
  return {0.5 * residual * residual, 1.0};
}

}  // namespace gonio::model::detail
