#pragma once
/// Bodies of io/materials/prior_payload.hpp.

#include <gonio/basis/pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/error.hpp>
#include <gonio/core/finite.hpp>
#include <gonio/core/huge_pages.hpp>
#include <gonio/core/wavelengths.hpp>
#include <gonio/io/bytes/byte_stream.hpp>
#include <gonio/io/bytes/quantise.hpp>
#include <gonio/io/materials/prior_payload.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace gonio::io::detail {

/// Returns cell anchor, cosine weighting and the presence of wavelengths as one number. Older programs know only the
/// anchor's 0 or 1 and refuse larger numbers.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::uint32_t conventions_of(const log_relative_pca& prior) {
  const bool corner = prior.cells().grid().anchor() == cell_anchor::lower_corner;
  const bool larger = prior.metric().weighting() == cosine_weighting::larger;
  return (corner ? 1u : 0u) + (larger ? 2u : 0u) + (prior.wavelengths().empty() ? 0u : 4u);
}

[[nodiscard]] GONIO_INLINE std::vector<float> log_of_reference(const log_relative& metric) {
  std::vector<float> logarithm;
  logarithm.reserve(metric.cells().size());
  for (const float rho : metric.reference()) logarithm.push_back(static_cast<float>(log_relative::log_reference(rho)));
  return logarithm;
}

/// Calls `act` and adds the file's name to its errors.
template <class Act>
auto naming_prior(const std::string& name, const Act& act) {
  try {
    return act();
  } catch (const error& refusal) {
    gonio::refuse({name, ": ", refusal.what()});
  }
}

/// A prior's cells, the cosine weighting of its metric, and whether its materials are spectra.
struct prior_domain {
  valid_cells cells;
  cosine_weighting weighting;
  bool is_spectral;
};

[[nodiscard]] GONIO_INLINE prior_domain read_domain(byte_reader& in, const std::string& name) {
  const auto extent = [&] { return static_cast<int>(std::min<std::uint32_t>(in.read<std::uint32_t>(), 1u << 30)); };
  const int theta_h = extent(), theta_d = extent(), phi_d = extent();
  const auto conventions = in.read<std::uint32_t>();
  if (conventions > 7)
    gonio::refuse(
        {name, ": the flags of anchor, cosine weight and wavelengths are ", conventions, ", expected 0 to 7"});
  const auto minimum_cosine = in.read<double>();
  if (!(minimum_cosine >= 0.0 && minimum_cosine < 1.0))
    gonio::refuse({name, ": the smallest cosine of a valid cell must be in [0, 1)"});
  const gonio::grid grid = naming_prior(name, [&] {
    return gonio::grid({theta_h, theta_d, phi_d},
                       conventions % 2 == 0 ? cell_anchor::centre : cell_anchor::lower_corner);
  });
  // A valid cell takes at least 5 bytes: two codes of 16 bits, and one of 8 for each component. At least half of a
  // grid's cells are valid, unless the grid is small or the smallest cosine is large.
  constexpr Eigen::Index small_grid = Eigen::Index{1} << 21;
  const Eigen::Index most = in.left() / 5;
  Eigen::Index valid = 0;
  if (grid.size() <= std::max(2 * most, small_grid))
    for_each_smaller_cosine(grid, [&](Eigen::Index, double cosine) {
      if (cosine > std::max(minimum_cosine, valid_cells::horizon)) ++valid;
    });
  if (valid > most || grid.size() > std::max(2 * most, small_grid))
    gonio::refuse({name, ": the grid has more cells than the file has values"});
  return {naming_prior(name, [&] { return valid_cells(grid, minimum_cosine); }),
          (conventions & 2u) == 0 ? cosine_weighting::product : cosine_weighting::larger, (conventions & 4u) != 0};
}

/// Returns the fewest bytes that can follow the counts: explained variance, a length for each text, all numbers.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE double least_rest_of_prior(double cells, double components, double materials,
                                                                    double channels) {
  return 8.0 + 4.0 * (1.0 + materials) + components * (8.0 + 4.0 * channels * materials) + 2.0 * (8.0 + 2.0 * cells) +
         components * (8.0 + cells);
}

/// Reads the number of wavelengths and the wavelengths; returns none for a prior in RGB.
[[gnu::cold]] [[nodiscard]] GONIO_INLINE std::vector<double> read_wavelengths(byte_reader& in, bool is_spectral,
                                                                              const std::string& name) {
  if (!is_spectral) return {};
  const auto count = in.read<std::uint32_t>();
  if (count == 0 || count > in.left() / sizeof(double))
    gonio::refuse({name, ": ", in.left(), " bytes cannot hold ", count, " wavelengths"});
  std::vector<double> wavelengths = in.read_all<double>(count);
  naming_prior(name, [&] { require_wavelengths(wavelengths); });
  return wavelengths;
}

[[nodiscard]] GONIO_INLINE std::vector<float> dequantise_all(const quantised<std::uint16_t>& column) {
  std::vector<float> values(column.codes.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = dequantise(column, i);
  return values;
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE void write_prior(byte_writer& out, const log_relative_pca& prior) {
  const gonio::grid& grid = prior.cells().grid();
  out.write(static_cast<std::uint32_t>(grid.extents().theta_h));
  out.write(static_cast<std::uint32_t>(grid.extents().theta_d));
  out.write(static_cast<std::uint32_t>(grid.extents().phi_d));
  out.write(detail::conventions_of(prior));
  out.write(prior.cells().minimum_cosine());
  out.write(static_cast<std::uint32_t>(prior.size()));
  out.write(static_cast<std::uint32_t>(prior.names().size()));
  if (const std::vector<double>& wavelengths = prior.wavelengths(); !wavelengths.empty()) {
    out.write(static_cast<std::uint32_t>(wavelengths.size()));
    out.write_bytes(wavelengths.data(), wavelengths.size() * sizeof(double));
  }
  out.write(prior.explained_variance());
  out.write_text(prior.source());
  for (const std::string& name : prior.names()) out.write_text(name);
  out.write_bytes(prior.singular_values().data(), prior.size() * sizeof(double));
  const Eigen::MatrixXf& coefficients = prior.coefficients();
  out.write_bytes(coefficients.data(), coefficients.size() * sizeof(float));
  write_quantised(out, quantise<std::uint16_t>(detail::log_of_reference(prior.metric())));
  write_quantised(out, quantise<std::uint16_t>(prior.mean()));
  std::vector<float> component(prior.cells().size());
  for (Eigen::Index k = 0; k < prior.size(); ++k) {
    for (std::size_t cell = 0; cell < component.size(); ++cell) component[cell] = prior.row(cell)[k];
    write_quantised(out, quantise<std::uint8_t>(component));
  }
}

GONIO_INLINE log_relative_pca read_prior(byte_reader& in, const std::string& name) {
  // Read the grid and the counts, and refuse counts that the rest of the file cannot hold.
  const auto [cells, weighting, is_spectral] = detail::read_domain(in, name);
  const auto components = in.read<std::uint32_t>();
  const auto materials = in.read<std::uint32_t>();
  std::vector<double> wavelengths = detail::read_wavelengths(in, is_spectral, name);
  const std::uint64_t channels = is_spectral ? wavelengths.size() : 3;
  if (components == 0 || components > channels * materials)
    gonio::refuse(
        {name, ": ", components, " components of ", materials, " materials, expected 1 to ", channels * materials});
  if (detail::least_rest_of_prior(static_cast<double>(cells.size()), components, materials,
                                  static_cast<double>(channels)) > static_cast<double>(in.left()))
    gonio::refuse({name, ": the file is truncated or its counts are wrong: ", in.left(), " bytes cannot hold ",
                   components, " components of ", materials, " materials over ", cells.size(), " cells"});
  // Read the description of the training: variance, source, names, singular values and coefficients.
  const auto explained_variance = in.read<double>();
  std::string source = in.read_text();
  std::vector<std::string> names(materials);
  for (std::string& material : names) material = in.read_text();
  const Eigen::Index k = components;
  const auto singular = in.read_all<double>(components);
  const auto observed = in.read_all<float>(channels * materials * components);

  // Read the quantised reference, mean and components.
  std::vector<float> reference = detail::dequantise_all(read_quantised<std::uint16_t>(in, cells.size()));
  for (float& value : reference) value = std::exp(value);
  std::vector<float> mean = detail::dequantise_all(read_quantised<std::uint16_t>(in, cells.size()));
  cell_matrix functions(cells.size(), k);
  advise_huge_pages(functions.data(), functions.size() * sizeof(float));  // expanding a prior reads all of them
  for (Eigen::Index c = 0; c < k; ++c) {
    const auto column = read_quantised<std::uint8_t>(in, cells.size());
    for (Eigen::Index cell = 0; cell < cells.size(); ++cell) functions(cell, c) = dequantise(column, cell);
  }
  if (in.left() != 0) gonio::refuse({name, ": ", in.left(), " bytes follow the last component"});

  Eigen::VectorXd singular_values(k);
  std::copy(singular.begin(), singular.end(), singular_values.data());
  Eigen::MatrixXf coefficients(static_cast<Eigen::Index>(channels * materials), k);
  std::copy(observed.begin(), observed.end(), coefficients.data());
  const std::span<const float> values(functions.data(), functions.size());
  const bool finite = std::isfinite(explained_variance) && all_finite(singular) && all_finite(observed) &&
                      all_finite(values) && all_finite(mean);
  if (!finite) gonio::refuse({name, ": a value of the prior is not finite"});
  // Construct the prior; add the file's name to the errors of its checks.
  return detail::naming_prior(name, [&] {
    return log_relative_pca({cells, log_relative(cells, std::move(reference), weighting), std::move(names),
                             std::move(singular_values), std::move(functions), std::move(mean), std::move(coefficients),
                             explained_variance, std::move(source), std::move(wavelengths)});
  });
}

}  // namespace gonio::io
