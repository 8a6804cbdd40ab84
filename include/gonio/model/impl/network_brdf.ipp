#pragma once
/// Bodies of model/network_brdf.hpp.

#include <gonio/core/brdf.hpp>
#include <gonio/core/compiled.hpp>
#include <gonio/core/parallel.hpp>
#include <gonio/core/progress.hpp>
#include <gonio/model/network_brdf.hpp>
#include <gonio/table/material_set.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace gonio::model::detail {

GONIO_INLINE network_block::network_block(const valid_cells& all, block range) : count_(range.size()) {
  for (std::size_t i = 0; i < count_; ++i) {
    const half_difference angles = all.angles(range.begin + i);
    const direction h = spherical_direction(angles.theta_h, 0.0);
    const direction d = spherical_direction(angles.theta_d, angles.phi_d);
    const std::array<double, 6> input{h.x(), 0.0, h.z(), d.x(), d.y(), d.z()};
    for (std::size_t unit = 0; unit < input.size(); ++unit) inputs_[unit][i] = static_cast<float>(input[unit]);
  }
}

GONIO_INLINE void network_block::evaluate(const network_brdf& network, float* out, std::size_t stride) {
  affine(network, network_brdf::first_layer, inputs_, first_);
  relu(first_);
  affine(network, network_brdf::second_layer, first_, second_);
  relu(second_);
  affine(network, network_brdf::third_layer, second_, outputs_);
  Eigen::Map<Eigen::Array<float, 3 * cells, 1>> y(outputs_[0].data());
  y = y.max(0.0f).min(static_cast<float>(network_brdf::largest_output)).expm1();
  for (std::size_t i = 0; i < count_; ++i)
    for (std::size_t channel = 0; channel < 3; ++channel) out[i * stride + channel] = outputs_[channel][i];
}

}  // namespace gonio::model::detail

namespace gonio::model {

GONIO_INLINE void tabulate_networks(std::span<const network_brdf> networks, const valid_cells& cells, cell_matrix& out,
                                    thread_count threads, const progress& listener) {
  out.resize(cells.size(), 3 * std::ssize(networks));
  const std::size_t columns = 3 * networks.size();
  std::mutex reporting;
  std::size_t done = 0;
  for_each_block(
      cells.size(), detail::network_block::cells,
      [&](block range) {
        detail::network_block work(cells, range);
        for (std::size_t n = 0; n < networks.size(); ++n)
          work.evaluate(networks[n], out.data() + range.begin * columns + 3 * n, columns);
        const std::scoped_lock lock(reporting);
        done += range.size();
        report(listener, "expanding networks", static_cast<double>(done) / static_cast<double>(cells.size()));
      },
      threads);
}

GONIO_INLINE material_set tabulate_networks(const named_networks& materials, const valid_cells& cells,
                                            thread_count threads, const progress& listener) {
  material_set tables{cells, materials.names, {}};
  tabulate_networks(materials.networks, cells, tables.values, threads, listener);
  return tables;
}

}  // namespace gonio::model
