/// The time to render a sphere in an environment at equal error: render/sampled_sphere.hpp compared with paired draws
/// (tests/render/paired_draws_sphere.hpp). Prints a table for docs/results/renderers.md.
///
///     bench_render_environment_sphere LIGHT.hdr [--size N] [--quality N] [--reference N] TABLE...

#include "../../tests/render/paired_draws_sphere.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/images/image.hpp>
#include <gonio/io/materials/merl_gzip.hpp>
#include <gonio/render/half_vector_sampler.hpp>
#include <gonio/render/lookup_table.hpp>
#include <gonio/render/sampled_sphere.hpp>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace {

using sampled_material = gonio::render::half_vector_sampler<gonio::render::lookup_table<>>;

struct bench_options {
  std::filesystem::path light;
  std::vector<std::filesystem::path> tables;
  int size = 128, quality = 64, reference = 4096;
};

/// Returns the time of all threads in seconds.
double processor_time() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

/// Returns the root mean square difference relative to the reference's, over all pixels and channels.
double relative_error(const gonio::image& found, const gonio::image& reference) {
  double squares = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const double difference = double{found.data()[i]} - double{reference.data()[i]};
    squares += difference * difference;
    scale += double{reference.data()[i]} * double{reference.data()[i]};
  }
  return std::sqrt(squares / scale);
}

struct measured {
  double seconds = 0.0, error = 0.0;
};

/// Renders and compares with the reference.
template <class Render>
measured measure(const Render& render, const gonio::image& reference) {
  const double start = processor_time();
  const gonio::image found = render();
  const double seconds = processor_time() - start;
  return {seconds, relative_error(found, reference)};
}

bench_options parse(int count, char** words) {
  bench_options options;
  const auto number = [&](int& i) {
    if (++i == count) gonio::refuse({words[i - 1], " needs a number"});
    const int value = std::atoi(words[i]);
    if (value < 1) gonio::refuse({words[i - 1], " needs a number above 0, not '", words[i], "'"});
    return value;
  };
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    if (word == "--size")
      options.size = number(i);
    else if (word == "--quality")
      options.quality = number(i);
    else if (word == "--reference")
      options.reference = number(i);
    else if (options.light.empty())
      options.light = word;
    else
      options.tables.emplace_back(word);
  }
  if (options.tables.empty()) gonio::refuse("give an environment (.hdr) and tables (.binary or .binary.gz)");
  return options;
}

void run(const bench_options& options) {
  const gonio::render::environment_map map(gonio::io::read_hdr(options.light));
  const paired_draws::row_by_row_light rows(map);
  const gonio::render::environment_sampler light(map);
  const double white = gonio::render::white_sphere_luminance(map);  // makes the exposure 1
  std::printf("| material | paired draws: CPU s | error | now: CPU s | error | CPU time at equal error |\n");
  std::printf("|---|---|---|---|---|---|\n");
  for (const auto& path : options.tables) {
    const sampled_material material(gonio::render::lookup_table<>::of(gonio::io::read_merl_any(path)));
    const auto draw = [&](int quality, std::uint64_t seed) {
      return gonio::render::render_sphere(
          material, light,
          {.size = options.size, .samples = quality, .seed = seed, .white = white, .shows_environment = false});
    };
    const gonio::image reference = draw(options.reference, 77);
    const measured before = measure(
        [&] { return paired_draws::render_sphere(material, rows, options.size, options.quality, 1); }, reference);
    const measured now = measure([&] { return draw(options.quality, 1); }, reference);
    const double ratio = now.seconds * now.error * now.error / (before.seconds * before.error * before.error);
    std::printf("| %s | %.2f | %.2f %% | %.2f | %.2f %% | %.2f |\n", path.stem().stem().c_str(), before.seconds,
                100.0 * before.error, now.seconds, 100.0 * now.error, ratio);
    std::fflush(stdout);
  }
}

}  // namespace

int main(int count, char** words) try { run(parse(count, words)); } catch (const gonio::error& error) {
  std::fprintf(stderr, "bench_render_environment_sphere: %s\n", error.what());
  return 2;
}
