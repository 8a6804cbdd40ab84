#pragma once
/// A BRDF that is the sum of others, for example a diffuse and a specular lobe.
/// J. B. Nielsen's thesis (2016), Sec. 2.2.4: the form of all its analytic models.

#include <gonio/core/brdf.hpp>

#include <tuple>
#include <utility>

namespace gonio::model {

/// f = f_1 + f_2 + ... The lobes keep their own parameters. The sum's albedo may exceed 1.
/// ```cpp
/// const gonio::model::sum_of_lobes paint{gonio::model::lambertian{}, gonio::model::ggx{}};
/// ```
template <brdf... Lobes>
class sum_of_lobes {
 public:
  explicit sum_of_lobes(Lobes... lobes) : lobes_(std::move(lobes)...) {}

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    return std::apply(
        [&](const auto&... lobe) {
          rgb sum = rgb::Zero();
          ((sum += rgb(lobe(wi, wo))), ...);
          return sum;
        },
        lobes_);
  }

  [[nodiscard]] const std::tuple<Lobes...>& lobes() const noexcept { return lobes_; }

 private:
  std::tuple<Lobes...> lobes_;
};

static_assert(brdf<sum_of_lobes<>>);

}  // namespace gonio::model
