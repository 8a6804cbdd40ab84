#pragma once
/// Bodies of io/prior.hpp.

#include <gonio/basis/pca.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/io/checked_file.hpp>
#include <gonio/io/prior.hpp>
#include <gonio/io/quantise.hpp>

#include <cstdint>
#include <string>

namespace gonio::io::detail {

GONIO_INLINE std::vector<float> log_of_reference(const log_relative& metric) {
  std::vector<float> logarithm(metric.reference().size());
  std::ranges::transform(metric.reference(), logarithm.begin(),
                         [](float rho) { return static_cast<float>(log_relative::log_reference(rho)); });
  return logarithm;
}

GONIO_INLINE void put_prior(byte_writer& out, const log_relative_pca& prior) {
  const gonio::grid& grid = prior.cells().grid();
  out.put(static_cast<std::uint32_t>(grid.extents().theta_h));
  out.put(static_cast<std::uint32_t>(grid.extents().theta_d));
  out.put(static_cast<std::uint32_t>(grid.extents().phi_d));
  out.put(static_cast<std::uint32_t>(grid.anchor() == cell_anchor::centre ? 0 : 1));
  out.put(prior.cells().minimum_cosine());
  out.put(static_cast<std::uint32_t>(prior.size()));
  out.put(static_cast<std::uint32_t>(prior.names().size()));
  out.put(prior.explained_variance());
  out.put_text(prior.source());
  for (const std::string& name : prior.names()) out.put_text(name);
  out.put_all(std::span<const double>(prior.singular_values().data(), prior.size()));
  const Eigen::MatrixXf& coefficients = prior.coefficients();
  out.put_all(std::span<const float>(coefficients.data(), static_cast<std::size_t>(coefficients.size())));
  put_quantised(out, quantise<std::uint16_t>(log_of_reference(prior.metric())));
  put_quantised(out, quantise<std::uint16_t>(prior.mean()));
  for (Eigen::Index k = 0; k < prior.components().cols(); ++k) {
    const Eigen::VectorXf component = prior.components().col(k);
    put_quantised(out, quantise<std::uint8_t>(std::span<const float>(component.data(), prior.cells().size())));
  }
}

GONIO_INLINE valid_cells take_cells(byte_reader& in, const std::string& name) {
  const auto extent = [&] { return static_cast<int>(std::min<std::uint32_t>(in.take<std::uint32_t>(), 1u << 30)); };
  const int theta_h = extent(), theta_d = extent(), phi_d = extent();
  const auto anchor = in.take<std::uint32_t>();
  if (anchor > 1) throw error{name, ": the cell anchor is ", anchor, ", expected 0 (centre) or 1 (lower corner)"};
  const auto minimum_cosine = in.take<double>();
  if (!(minimum_cosine >= 0.0 && minimum_cosine < 1.0))
    throw error{name, ": the smallest cosine of a valid cell must be in [0, 1)"};
  const gonio::grid grid({theta_h, theta_d, phi_d}, anchor == 0 ? cell_anchor::centre : cell_anchor::lower_corner);
  // Components, mean and reference take at least 6 bytes a cell, most of the cells are valid.
  if (grid.size() > 4 * in.left()) throw error{name, ": the grid has more cells than the file has values"};
  return valid_cells(grid, minimum_cosine);
}

GONIO_INLINE std::vector<float> dequantise_all(const quantised<std::uint16_t>& column) {
  std::vector<float> values(column.codes.size());
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = dequantise(column, i);
  return values;
}

GONIO_INLINE log_relative_pca take_prior(byte_reader& in, const std::string& name) {
  const valid_cells cells = take_cells(in, name);
  const auto components = in.take<std::uint32_t>();
  const auto materials = in.take<std::uint32_t>();
  if (components == 0 || components > 3 * std::uint64_t{materials} || materials > in.left())
    throw error{name, ": ", components, " components of ", materials, " materials are impossible"};
  const auto explained_variance = in.take<double>();
  std::string source = in.take_text();
  std::vector<std::string> names(materials);
  for (std::string& material : names) material = in.take_text();
  const auto k = static_cast<Eigen::Index>(components);
  const auto singular = in.take_all<double>(components);
  const auto observed = in.take_all<float>(std::size_t{3} * materials * components);

  std::vector<float> reference = dequantise_all(take_quantised<std::uint16_t>(in, cells.size()));
  std::ranges::transform(reference, reference.begin(), [](float logarithm) { return std::exp(logarithm); });
  std::vector<float> mean = dequantise_all(take_quantised<std::uint16_t>(in, cells.size()));
  if (cells.size() > in.left()) throw error{name, ": the file is truncated or its counts are wrong"};
  cell_matrix functions(static_cast<Eigen::Index>(cells.size()), k);
  for (Eigen::Index c = 0; c < k; ++c) {
    const auto column = take_quantised<std::uint8_t>(in, cells.size());
    for (std::size_t cell = 0; cell < cells.size(); ++cell)
      functions(static_cast<Eigen::Index>(cell), c) = dequantise(column, cell);
  }
  if (in.left() != 0) throw error{name, ": ", in.left(), " bytes follow the last component"};

  const Eigen::Map<const Eigen::VectorXd> singular_values(singular.data(), k);
  const Eigen::Map<const Eigen::MatrixXf> coefficients(observed.data(), 3 * static_cast<Eigen::Index>(materials), k);
  const bool finite = std::isfinite(explained_variance) && singular_values.allFinite() && coefficients.allFinite() &&
                      functions.allFinite() &&
                      std::ranges::all_of(mean, [](float value) { return std::isfinite(value); });
  if (!finite) throw error{name, ": a value of the prior is not finite"};
  return log_relative_pca({cells, log_relative(cells, std::move(reference)), std::move(names), singular_values,
                           std::move(functions), std::move(mean), coefficients, explained_variance, std::move(source)});
}

}  // namespace gonio::io::detail

namespace gonio::io {

GONIO_INLINE std::vector<std::byte> encode_prior(const log_relative_pca& prior) {
  byte_writer payload;
  detail::put_prior(payload, prior);
  return encode_checked(detail::prior_kind, payload.bytes());
}

GONIO_INLINE log_relative_pca decode_prior(std::span<const std::byte> bytes, const std::string& name) {
  const auto payload = decode_checked(detail::prior_kind, bytes, name);
  byte_reader in(payload, name);
  return detail::take_prior(in, name);
}

}  // namespace gonio::io
