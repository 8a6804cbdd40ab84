/// gonio samples: pictures of a flat sample, taken from close by, as measurements.

#include "command.hpp"
#include <gonio/io/image.hpp>
#include <gonio/io/near_field_setup.hpp>
#include <gonio/io/samples.hpp>

#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace cli {

namespace {

struct samples_options {
  std::vector<std::pair<std::string, std::string>> pictures;  ///< each with its set-up
  std::filesystem::path output;
};

gonio::sample_set samples_of_picture(const std::filesystem::path& picture, const std::filesystem::path& setup) {
  const gonio::near_field_setup taken = gonio::io::read_near_field_setup(setup);
  const gonio::image pixels = gonio::io::read_hdr(picture);
  try {
    return gonio::near_field_samples(pixels, taken);
  } catch (const gonio::error& refusal) {
    throw gonio::error(picture.string() + " (as " + setup.string() + " says): " + refusal.what());
  }
}

void write_samples_of_pictures(const samples_options& options) {
  gonio::sample_set all;
  std::string counts;
  for (const auto& [picture, setup] : options.pictures) {
    if (setup.empty()) throw gonio::error("pictures: " + picture + " is not followed by its set-up");
    const gonio::sample_set samples = samples_of_picture(picture, setup);
    counts += picture + ": " + std::to_string(samples.size()) + " samples\n";
    all.insert(all.end(), samples.begin(), samples.end());
  }
  gonio::io::write_samples(options.output, all);
  std::cout << counts;
}

}  // namespace

void add_samples(CLI::App& app) {
  auto* command = app.add_subcommand("samples", "Turn pictures of a flat sample into samples for gonio reconstruct");
  const auto options = std::make_shared<samples_options>();
  command
      ->add_option("pictures", options->pictures,
                   "Pictures of linear radiance (.hdr), each followed by its set-up (docs/formats.md): camera, distant "
                   "light and region of interest")
      ->type_name("PICTURE SETUP")
      ->required();
  command->add_option("-o,--output", options->output, "Samples to write (.csv)")->required();
  command->callback([options] { write_samples_of_pictures(*options); });
}

}  // namespace cli
