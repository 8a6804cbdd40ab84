#include "measurement_files.hpp"

#include "file_kinds.hpp"
#include <gonio/io/cornell.hpp>
#include <gonio/io/samples.hpp>

namespace cli {

gonio::sample_set read_measurements(const std::filesystem::path& path) {
  return path.extension() == ".brdf" ? gonio::io::read_cornell(path) : gonio::io::read_samples(path);
}

std::vector<Eigen::Index> counting_samples(const gonio::sample_set& samples) {
  std::vector<Eigen::Index> numbers;
  for (Eigen::Index i = 0; i < std::ssize(samples); ++i)
    if (samples[i].weight.counts()) numbers.push_back(i);
  return numbers;
}

void write_table(const std::filesystem::path& path, const gonio::brdf_table& table) { write_file(path, table); }

}  // namespace cli
