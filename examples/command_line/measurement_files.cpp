#include "measurement_files.hpp"

#include "measurement_kinds.hpp"
#include <gonio/io/merl.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/io/table_npy.hpp>

namespace cli {

gonio::sample_set read_measurements(const std::filesystem::path& path) {
  if (const measurement_kind* kind = measurement_kind_of(path)) return kind->read(path);
  return gonio::io::read_samples(path);
}

std::vector<Eigen::Index> counting_samples(const gonio::sample_set& samples) {
  std::vector<Eigen::Index> numbers;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i)
    if (samples[i].weight.counts()) numbers.push_back(i);
  return numbers;
}

void write_table(const std::filesystem::path& path, const gonio::brdf_table& table) {
  if (path.extension() == ".npy" || path.extension() == ".NPY")
    gonio::io::write_table_npy(path, table);
  else
    gonio::io::write_merl(path, table);
}

}  // namespace cli
