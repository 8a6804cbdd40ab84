#include "measurement_files.hpp"

#include <gonio/io/cornell.hpp>
#include <gonio/io/merl.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/io/table_npy.hpp>

namespace cli {

gonio::sample_set read_measurements(const std::filesystem::path& path) {
  return path.extension() == ".brdf" ? gonio::io::read_cornell(path) : gonio::io::read_samples(path);
}

void write_table(const std::filesystem::path& path, const gonio::brdf_table& table) {
  if (path.extension() == ".npy" || path.extension() == ".NPY")
    gonio::io::write_table_npy(path, table);
  else
    gonio::io::write_merl(path, table);
}

}  // namespace cli
