#pragma once
/// Principal components of measured BRDFs in the domain of an error metric.
/// Nielsen et al. 2015 (doi:10.1145/2816795.2818085), section 3, Eq. 4-6: every colour channel of every material is an
/// observation, X - mu = U Sigma V', and the basis is the scaled components Q = V Sigma.

#include <gonio/basis/basis.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/wavelengths.hpp>
#include <gonio/metric/log_relative.hpp>
#include <gonio/table/cell_matrix.hpp>

#include <Eigen/Core>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace gonio {

/// The parts of a principal component basis, for building or storing one.
template <error_metric Metric, domain Domain = valid_cells>
struct pca_parts {
  Domain cells;
  Metric metric;
  std::vector<std::string> names;        ///< names of the materials that the basis was learned from
  Eigen::VectorXd singular_values;       ///< Sigma, k values, largest first
  cell_matrix components;                ///< Q = V Sigma, cells x k
  std::vector<float> mean;               ///< mu, one value per cell
  Eigen::MatrixXf coefficients;          ///< U, observations x k: observation j is mu + Q row(j)'
  double explained_variance = 1.0;       ///< the k components' share of the observations' variance
  std::string source = {};               ///< origin of the data, for display
  std::vector<double> wavelengths = {};  ///< of each material's channels, nanometres; empty for red, green and blue
};

/// Principal components over the valid cells of a grid, or another domain. A value type; copies share their storage.
template <error_metric Metric, domain Domain = valid_cells>
class pca {
 public:
  using parts_type = pca_parts<Metric, Domain>;
  /// The sign of a component is arbitrary: see `has_arbitrary_sign`.
  static constexpr bool arbitrary_sign = true;

  /// Throws gonio::error if the sizes of the parts do not match, and for wavelengths that do not ascend.
  explicit pca(parts_type parts) : parts_(std::make_shared<const parts_type>(std::move(parts))) {
    const Eigen::Index cells = parts_->cells.size();
    const Eigen::Index k = parts_->components.cols();
    if (!parts_->wavelengths.empty()) require_wavelengths(parts_->wavelengths);
    if (k == 0 || parts_->components.rows() != cells || std::ssize(parts_->mean) != cells ||
        parts_->singular_values.size() != k || parts_->coefficients.cols() != k ||
        parts_->coefficients.rows() != channels() * std::ssize(parts_->names))
      refuse({"the parts of a principal component basis of ", k, " components over ", cells, " cells and ",
              parts_->names.size(), " materials of ", channels(), " channels do not match in size"});
  }

  /// Returns the number of components k.
  [[nodiscard]] Eigen::Index size() const noexcept { return parts_->components.cols(); }
  /// Returns the number of observations m that the components were learned from: the channels of all materials.
  [[nodiscard]] double observations() const noexcept { return static_cast<double>(parts_->coefficients.rows()); }
  [[nodiscard]] const Domain& cells() const noexcept { return parts_->cells; }
  [[nodiscard]] const Metric& metric() const noexcept { return parts_->metric; }

  /// Returns the k scaled components at a cell.
  [[nodiscard]] std::span<const float> row(Eigen::Index cell) const noexcept {
    return std::span(parts_->components.data() + cell * size(), size());
  }
  /// Returns the mean mu at a cell.
  [[nodiscard]] double offset(Eigen::Index cell) const noexcept { return parts_->mean[cell]; }

  /// Returns Q = V Sigma, cells x k.
  [[nodiscard]] const cell_matrix& components() const noexcept { return parts_->components; }
  [[nodiscard]] const std::vector<float>& mean() const noexcept { return parts_->mean; }
  [[nodiscard]] const Eigen::VectorXd& singular_values() const noexcept { return parts_->singular_values; }
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return parts_->names; }
  /// Returns the wavelengths of the materials, in nanometres, ascending; none for colours.
  [[nodiscard]] const std::vector<double>& wavelengths() const noexcept { return parts_->wavelengths; }
  /// Returns the number of channels of each material: its wavelengths or, if there are none, the number that the domain
  /// declares (three colours by default). The channels of a material are consecutive rows of `coefficients`.
  [[nodiscard]] Eigen::Index channels() const noexcept { return channels_at<Domain>(parts_->wavelengths); }
  [[nodiscard]] const Eigen::MatrixXf& coefficients() const noexcept { return parts_->coefficients; }
  [[nodiscard]] double explained_variance() const noexcept { return parts_->explained_variance; }
  [[nodiscard]] const std::string& source() const noexcept { return parts_->source; }

  /// Returns the first k components. Throws gonio::error unless k is from 1 to size().
  [[nodiscard]] pca truncated(Eigen::Index k) const {
    if (k < 1 || k > size()) refuse({"cannot keep ", k, " of ", size(), " components"});
    const double share = parts_->singular_values.head(k).squaredNorm() / parts_->singular_values.squaredNorm();
    return pca({parts_->cells, parts_->metric, parts_->names, parts_->singular_values.head(k),
                parts_->components.leftCols(k), parts_->mean, parts_->coefficients.leftCols(k),
                parts_->explained_variance * share, parts_->source, parts_->wavelengths});
  }

  /// Returns the same basis with another `source`.
  [[nodiscard]] pca with_source(std::string source) const {
    parts_type parts = *parts_;
    parts.source = std::move(source);
    return pca(std::move(parts));
  }

  /// Returns the weights, k x channels, of one of the materials that the basis was learned from.
  [[nodiscard]] Eigen::MatrixXd weights_of(Eigen::Index material) const {
    return parts_->coefficients.middleRows(channels() * material, channels()).transpose().template cast<double>();
  }

 private:
  std::shared_ptr<const parts_type> parts_;
};

/// The prior of Nielsen et al. 2015.
using log_relative_pca = pca<log_relative>;
static_assert(tabulated_basis<log_relative_pca>);

}  // namespace gonio
