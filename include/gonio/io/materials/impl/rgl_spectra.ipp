#pragma once
/// Bodies of io/materials/rgl_spectra.hpp.

#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/spectrum.hpp>
#include <gonio/io/materials/rgl_spectra.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/model/sufficient_wavelengths.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// The BRDF of a spectral table at three of the chosen wavelengths, from `first` on, as red, green and blue. If fewer
/// than three wavelengths are left, repeats the last one.
class three_wavelengths {
 public:
  three_wavelengths(const spectral_table& table, std::span<const Eigen::Index> chosen, Eigen::Index first)
      : table_(table) {
    for (Eigen::Index c = 0; c < 3; ++c) bands_[c] = chosen[std::min(first + c, std::ssize(chosen) - 1)];
  }

  [[nodiscard]] rgb operator()(const direction& wi, const direction& wo) const noexcept {
    rgb sum(0.0, 0.0, 0.0);
    if (!(wi.z() > 0.0 && wo.z() > 0.0)) return sum;
    const location found = locate(table_.cells(), to_half_difference(wi, wo));
    for (int corner = 0; corner < found.count; ++corner)
      for (Eigen::Index c = 0; c < 3; ++c)
        sum[c] += found.weight[corner] * double{table_.values()(Eigen::Index{found.cell[corner]}, bands_[c])};
    return sum;
  }

 private:
  const spectral_table& table_;
  std::array<Eigen::Index, 3> bands_{};
};

static_assert(brdf<three_wavelengths>);

/// Calls `copy(i, j)` for each theta_i and each of three wavelengths from `first` on: i is the table's index among
/// tables of three channels, and j its index among tables of all wavelengths.
template <class Copy>
void for_each_shared_table(Eigen::Index angles, Eigen::Index bands, Eigen::Index first, const Copy& copy) {
  for (Eigen::Index angle = 0; angle < angles; ++angle)
    for (Eigen::Index c = 0; c < std::min<Eigen::Index>(3, bands - first); ++c)
      copy(3 * angle + c, angle * bands + first + c);
}

GONIO_INLINE void require_in_spectra(const rgl_material& material) {
  if (!material.spectra) gonio::refuse("the material is in RGB, expected spectra");
}

/// Returns the index of the last of ascending numbers that is at most `value`, and the fraction of the way to the next.
[[nodiscard]] GONIO_INLINE std::pair<Eigen::Index, double> between(const std::vector<double>& numbers, double value) {
  const auto next = std::ranges::upper_bound(numbers, value);
  const Eigen::Index lower = next - numbers.begin() - 1;
  return {lower, next == numbers.end() ? 0.0 : (value - numbers[lower]) / (*next - numbers[lower])};
}

/// Returns the material at three of its wavelengths, from `first` on.
[[nodiscard]] GONIO_INLINE model::adaptive_brdf three_wavelengths_of(const rgl_material& material, Eigen::Index first) {
  model::adaptive_brdf_parts parts = material.material.parts();
  const model::unit_square_tables& all = material.spectra->values;
  const Eigen::Index size = all.rows * all.columns, angles = parts.lights();
  parts.reflectance = {3 * angles, all.rows, all.columns, std::vector<float>(3 * angles * size)};
  for_each_shared_table(angles, std::ssize(material.spectra->wavelengths), first, [&](auto colour, auto table) {
    std::copy_n(all.row(table, 0), size, parts.reflectance.values.data() + colour * size);
  });
  return model::adaptive_brdf(std::move(parts));
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE rgl_material tabulate_adaptively(const spectral_table& table, double tolerance,
                                              const std::string& description, thread_count threads) {
  if (table.bands() < 2) refuse("a spectral material needs at least two wavelengths, not one: write a table in RGB");
  const std::vector<Eigen::Index> chosen = model::sufficient_wavelengths(table, tolerance, threads);
  // Colours decide where and how finely to tabulate; if no wavelength is visible, three wavelengths decide.
  const bool has_colours = std::ranges::any_of(table.wavelengths(), is_visible);
  rgl_material made{has_colours ? model::tabulate_adaptively(table.colours(illuminant::d65, threads), {}, threads)
                                : model::tabulate_adaptively(detail::three_wavelengths(table, chosen, 0), {}, threads),
                    description,
                    {}};
  const model::unit_square_tables& colours = made.material.parts().reflectance;
  const Eigen::Index size = colours.rows * colours.columns, angles = colours.tables / 3, bands = std::ssize(chosen);
  rgl_spectra spectra{{}, {angles * bands, colours.rows, colours.columns, std::vector<float>(angles * bands * size)}};
  for (const Eigen::Index band : chosen) spectra.wavelengths.push_back(table.wavelengths()[band]);
  for (Eigen::Index first = 0; first < bands; first += 3) {
    const model::unit_square_tables three =
        model::tabulate_over(made.material, detail::three_wavelengths(table, chosen, first), threads);
    detail::for_each_shared_table(angles, bands, first, [&](auto colour, auto target) {
      std::copy_n(three.row(colour, 0), size, spectra.values.values.data() + target * size);
    });
  }
  made.spectra = std::move(spectra);
  return made;
}

GONIO_INLINE rgl_spectra at_wavelengths(const rgl_spectra& spectra, std::vector<double> wavelengths) {
  require_wavelengths(wavelengths);
  const std::vector<double>& known = spectra.wavelengths;
  const model::unit_square_tables& all = spectra.values;
  if (wavelengths.front() < known.front() || wavelengths.back() > known.back())
    refuse({"a material at wavelengths from ", shortest(known.front()), " to ", shortest(known.back()),
            " nm has no values from ", shortest(wavelengths.front()), " to ", shortest(wavelengths.back()), " nm"});
  const Eigen::Index size = all.rows * all.columns, bands = std::ssize(wavelengths), others = std::ssize(known),
                     angles = all.tables / others;
  rgl_spectra found{std::move(wavelengths),
                    {angles * bands, all.rows, all.columns, std::vector<float>(angles * bands * size)}};
  for (Eigen::Index band = 0; band < bands; ++band) {
    const auto [lower, share] = detail::between(known, found.wavelengths[band]);
    const Eigen::Index upper = std::min(lower + 1, others - 1);
    for (Eigen::Index angle = 0; angle < angles; ++angle) {
      const float *below = all.row(angle * others + lower, 0), *above = all.row(angle * others + upper, 0);
      float* const value = found.values.values.data() + (angle * bands + band) * size;
      for (Eigen::Index i = 0; i < size; ++i)
        value[i] = static_cast<float>((1.0 - share) * double{below[i]} + share * double{above[i]});
    }
  }
  return found;
}

GONIO_INLINE spectral_table tabulate_spectra(const rgl_material& material, const valid_cells& cells,
                                             thread_count threads) {
  detail::require_in_spectra(material);
  if (material.material.is_anisotropic())
    refuse("the material is anisotropic, but a table over half and difference angles needs an isotropic one");
  return tabulate_by_threes(cells, material.spectra->wavelengths, [&](Eigen::Index first) {
    return tabulate(detail::three_wavelengths_of(material, first), cells, threads);
  });
}

GONIO_INLINE sample_set sample_spectra(const rgl_material& material, std::span<const sample_directions> directions) {
  detail::require_in_spectra(material);
  sample_set samples(channels(material.spectra->wavelengths));
  const Eigen::Index bands = samples.channels().size();
  std::vector<model::adaptive_brdf> by_threes;
  for (Eigen::Index first = 0; first < bands; first += 3)
    by_threes.push_back(detail::three_wavelengths_of(material, first));
  for (const sample_directions& each : directions) {
    std::vector<double> spectrum;
    for (const model::adaptive_brdf& three : by_threes) {
      const rgb value = three(each.pair().wi, each.pair().wo);
      spectrum.insert(spectrum.end(), value.begin(), value.end());
    }
    spectrum.resize(static_cast<std::size_t>(bands));
    samples.add(each, spectrum);
  }
  require_usable(samples);
  return samples;
}

}  // namespace gonio::io
