#pragma once
/// Two priors in one: the principal components of soft and of specular materials, and the contrast that separates them.
/// Nielsen et al. 2015 (doi:10.1145/2816795.2818085), section 8. estimate/soft_specular_decomposition.hpp learns and
/// uses it; io/materials/soft_specular_prior.hpp reads and writes its file.

#include <gonio/basis/pca.hpp>

#include <Eigen/Core>

#include <string>

namespace gonio {

/// Components of soft and of specular materials over the same cells and relative to the reference of all materials. A
/// value type; copies share their storage.
class soft_specular_prior {
 public:
  /// Throws gonio::error unless both priors have the same metric over the same cells, and the threshold is finite.
  soft_specular_prior(log_relative_pca soft, log_relative_pca specular, double threshold);

  [[nodiscard]] const log_relative_pca& soft() const noexcept { return soft_; }
  [[nodiscard]] const log_relative_pca& specular() const noexcept { return specular_; }
  /// Returns the highlight contrast below which a material is soft (estimate/highlight_contrast.hpp).
  [[nodiscard]] double threshold() const noexcept { return threshold_; }

  [[nodiscard]] const valid_cells& cells() const noexcept { return soft_.cells(); }
  /// Returns the common metric of the soft and the specular prior.
  [[nodiscard]] const log_relative& metric() const noexcept { return soft_.metric(); }
  /// Returns the number of soft and specular materials together.
  [[nodiscard]] Eigen::Index materials() const noexcept {
    return std::ssize(soft_.names()) + std::ssize(specular_.names());
  }

  /// Returns the prior over other, usually fewer, cells; see `thin` in basis/learn_pca.hpp.
  [[nodiscard]] soft_specular_prior on(const valid_cells& cells) const;

  /// Returns the prior with another `source` in both parts.
  [[nodiscard]] soft_specular_prior with_source(const std::string& source) const;

 private:
  log_relative_pca soft_, specular_;
  double threshold_;
};

}  // namespace gonio

#if !defined(GONIO_COMPILED)
#include <gonio/basis/impl/soft_specular_prior.ipp>
#endif
