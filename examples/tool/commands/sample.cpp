/// gonio sample: simulates a measurement of a table.

#include "commands.hpp"
#include "tool/files/file_kinds.hpp"
#include "tool/files/measurement_files.hpp"
#include "tool/options/shipped_data.hpp"
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/measurements/samples.hpp>

#include <memory>
#include <variant>
#include <vector>

namespace cli {

namespace {

struct sample_options {
  std::filesystem::path table, directions, output;
  Eigen::Index count = 0;
  double ratio = 0.0;
  gonio::measurement_defects defects;
  aperture_option aperture;
  std::uint64_t seed = 0;
};

std::vector<Eigen::Index> chosen_cells(const sample_options& options, const gonio::valid_cells& cells) {
  if (!options.directions.empty())
    return gonio::cells_at(cells, cli::read_directions(options.directions, reading_of()));
  const Eigen::Index count = options.count != 0 ? options.count : gonio::share_of(cells.size(), options.ratio);
  return gonio::random_cells(cells, count, options.seed);
}

std::vector<gonio::direction_pair> chosen_pairs(const sample_options& options) {
  if (!options.directions.empty()) return cli::read_direction_pairs(options.directions, reading_of());
  const gonio::valid_cells cells;
  const Eigen::Index count = options.count != 0 ? options.count : gonio::share_of(cells.size(), options.ratio);
  return gonio::random_pairs(cells, count, options.seed);
}

void sample(const sample_options& options) {
  const any_material material = read_material(options.table);
  if (const auto* table = std::get_if<gonio::brdf_table>(&material)) {
    const auto cells = chosen_cells(options, table->cells());
    return gonio::io::write_samples(options.output, gonio::sample_table(*table, cells, options.defects, options.seed));
  }
  const auto pairs = chosen_pairs(options);
  const gonio::sample_set samples =
      std::visit([&](const auto& f) { return gonio::sample_brdf(f, pairs, options.defects, options.seed); }, material);
  gonio::io::write_samples(options.output, samples, {}, gonio::io::direction_columns::pairs);
}

}  // namespace

void add_sample(command& app) {
  auto command = app.add_subcommand("sample", "Simulate a measurement: read a table at some of its cells");
  const auto options = std::make_shared<sample_options>();
  command
      .add_input("table", options->table,
                 "Table to measure (.binary, .binary.gz, .npy, .bsdf, .mbsdf or .bin). Samples of an anisotropic "
                 "material are at random azimuths, and keep them")
      .required();
  auto where = command.add_option_group("where", "Cells to measure (one of)");
  where.add_option("--count", options->count, "Number of different cells, at random").check(check::positive_number());
  where.add_option("--ratio", options->ratio, "Share of all cells, at random, above 0 and up to 1")
      .check(check::positive_number() & check::range(0.0, 1.0));
  where.add_input("--directions", options->directions,
                  "Directions, measured at the nearest cells (.csv); an anisotropic material is "
                  "measured in these directions themselves");
  where.require_option(1);
  command.add_option("--outliers", options->defects.outlier_ratio,
                     "Share of outliers: samples replaced by a random other value of the table");
  command.add_option("--noise", options->defects.noise, "Standard deviation of Gaussian noise relative to the value");
  add_aperture_options(command, options->aperture);
  command.add_option("--seed", options->seed, "Seed of the random cells, noise and outliers").capture_default_str();
  command.add_output("-o,--output", options->output, {".csv"}, "Samples to write (.csv)").required();
  command.callback([options] {
    options->defects.aperture = options->aperture.in_radians();
    sample(*options);
  });
}

}  // namespace cli
