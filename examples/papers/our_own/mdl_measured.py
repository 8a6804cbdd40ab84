#!/usr/bin/env python3
"""Compares the values that NVIDIA's MDL SDK and gonio read from .mbsdf files, the SDK's own and gonio's:
  gonio-papers run --markdown docs/results/renderers.md -- examples/papers/our_own/mdl_measured.py MDL-SDK \\
    merl_networks.npy
The arguments are a git repository of github.com/NVIDIA/MDL-SDK and a file of networks. Extracts the SDK's loader and
CPU run-time of measured BSDFs from its sources, and compiles them in a temporary folder. GONIO is the tool (default:
gonio), NAMES are materials of the networks. Needs g++ and git."""

import os
import pathlib
import subprocess
import sys
import tempfile

from fetched_sources import between, git

TOOL = os.environ.get("GONIO", "gonio")
NAMES = os.environ.get("NAMES", "white-fabric blue-rubber gold-metallic-paint").split()
ROOT = pathlib.Path(__file__).resolve().parents[3]
EXAMPLES = ("carpaint_blue", "carpaint_green", "carpaint_red", "example_modules")

# The declarations that the SDK's lines need, and the comparison.
PROGRAM = r"""
#include <gonio/io/materials/mbsdf.hpp>

#include <mi/base.h>
#include <mi/math.h>
#include <mi/neuraylib/bsdf_isotropic_data.h>
#include <mi/neuraylib/ireader.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

using mi::Sint64;
namespace mi {
using Uint32_2 = math::Vector<Uint32, 2>;
using Float32_2 = math::Vector<Float32, 2>;
using Float32_3 = math::Vector<Float32, 3>;
}  // namespace mi
#define M_ONE_OVER_PI 0.318309886183790671538

/// A file with the interface that the loader needs.
class file_reader : public mi::base::Interface_implement<mi::neuraylib::IReader> {
 public:
  explicit file_reader(const char* path) : file_(std::fopen(path, "rb")) {}
  mi::Sint32 get_error_number() const override { return 0; }
  const char* get_error_message() const override { return ""; }
  bool eof() const override { return std::feof(file_) != 0; }
  mi::Sint32 get_file_descriptor() const override { return -1; }
  bool supports_recorded_access() const override { return false; }
  const mi::neuraylib::IStream_position* tell_position() const override { return nullptr; }
  bool seek_position(const mi::neuraylib::IStream_position*) override { return false; }
  bool rewind() override { return false; }
  bool supports_absolute_access() const override { return false; }
  Sint64 tell_absolute() const override { return 0; }
  bool seek_absolute(Sint64) override { return false; }
  Sint64 get_file_size() const override { return 0; }
  bool seek_end() override { return false; }
  Sint64 read(char* buffer, Sint64 size) override { return std::fread(buffer, 1, size, file_); }
  bool readline(char* buffer, mi::Sint32 size) override {
    buffer[0] = 0;
    return std::fgets(buffer, size, file_) != nullptr || eof();
  }
  bool supports_lookahead() const override { return false; }
  Sint64 lookahead(Sint64, const char**) const override { return 0; }

 private:
  std::FILE* file_;
};

@MAGIC@
@LOADER@

enum Mbsdf_part { reflection_part, transmission_part };

struct Bsdf_measurement {
  mi::Uint32 m_has_data[2] = {0, 0};
  float *m_eval_data[2], *m_sample_data[2], *m_albedo_data[2], m_max_albedo[2];
  mi::Uint32_2 m_angular_resolution[2];
  mi::Float32_2 m_inv_angular_resolution[2];
  unsigned m_num_channels[2];
  void prepare_mbsdfs_part(Mbsdf_part, const mi::neuraylib::IBsdf_isotropic_data*);
  mi::Float32_3 evaluate(const mi::Float32_2&, const mi::Float32_2&, Mbsdf_part) const;
};

@RUNTIME@

constexpr double pi = 3.14159265358979323846;

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

/// Returns the albedo of the brightest channel for light from one direction.
double albedo(const gonio::model::polar_grid_brdf& f, double theta_i) {
  constexpr int steps = 360;
  gonio::rgb sum = gonio::rgb::Zero();
  for (int a = 0; a < steps; ++a)
    for (int b = 0; b < steps; ++b) {
      const double theta = (a + 0.5) / steps * pi / 2, phi = (b + 0.5) / steps * pi;
      sum += f(gonio::spherical_direction(theta_i, 0.0), gonio::spherical_direction(theta, phi)) *
             (std::cos(theta) * std::sin(theta) * (pi / 2 / steps) * (2 * pi / steps));
    }
  return sum.maxCoeff();
}

int main(int, char** arguments) {
  file_reader reader(arguments[1]);
  mi::base::Handle<mi::neuraylib::IBsdf_isotropic_data> reflection, transmission;
  if (!import_measurement_from_reader(&reader, reflection, transmission) || !reflection) return 1;
  Bsdf_measurement theirs;
  theirs.prepare_mbsdfs_part(reflection_part, reflection.get());
  const gonio::model::polar_grid_brdf ours = gonio::io::read_mbsdf(arguments[1]).reflection;
  const unsigned steps = reflection->get_resolution_theta(), around = reflection->get_resolution_phi();
  // Stay away from the borders: there is no cell half a cell before them.
  const double margin = 1.0 / steps;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(margin, 1.0 - margin);
  std::vector<double> at_centres, at_edges;
  for (int i = 0; i < 20000; ++i) {
    const double theta_i = uniform(random) * pi / 2, theta_o = uniform(random) * pi / 2, phi = uniform(random) * pi;
    const double f = ours(gonio::spherical_direction(theta_i, 0.0), gonio::spherical_direction(theta_o, phi))[1];
    const auto off = [&](double cells) {
      const double theta = cells * pi / 2 / steps;
      const auto value = theirs.evaluate(
          mi::Float32_2(static_cast<float>(theta_i - theta), 0.0f),
          mi::Float32_2(static_cast<float>(theta_o - theta), static_cast<float>(phi - cells * pi / around)),
          reflection_part);
      return std::abs(value[1] - f) / (std::abs(f) + 0.01);
    };
    at_centres.push_back(off(0.5));
    at_edges.push_back(off(0.0));
  }
  const unsigned middle = steps / 2;
  std::printf("%u | %.1e | %.2f | %.4f | %.4f |\n", steps, quantile(at_centres, 0.999), 100 * quantile(at_edges, 0.5),
              theirs.m_albedo_data[0][middle], albedo(ours, (middle + 0.5) / steps * pi / 2));
}
"""


def compiled(sdk, folder):
    """Returns the program, compiled with the SDK's sources at HEAD."""
    def show(path):
        return git(sdk, "show", f"HEAD:{path}")

    loader = show("src/io/scene/bsdf_measurement/bsdf_measurement.cpp")
    runtime = show("src/render/mdl/runtime/mdlrt_bsdf_measurement.cpp")
    parts = {
        "MAGIC": between(loader, "const char\\* magic_header", "$"),
        "LOADER": between(loader, "bool read\\( mi::neuraylib::IReader", "\\} // namespace"),
        "RUNTIME": between(runtime, "void Bsdf_measurement::prepare_mbsdfs_part", "mi::Uint32_3 ")
        + between(runtime, "namespace $", "// binary search"),
    }
    program = PROGRAM
    for name, text in parts.items():
        program = program.replace(f"@{name}@", text)
    (folder / "beside.cpp").write_text(program)
    headers = subprocess.run(["git", "-C", sdk, "archive", "HEAD:include"], check=True, capture_output=True).stdout
    (folder / "include").mkdir()
    subprocess.run(["tar", "-x", "-C", folder / "include"], input=headers, check=True)
    subprocess.run(["g++", "-std=c++20", "-O2", "-w", "-I", ROOT / "include", "-I", folder / "include", "-isystem",
                    "/usr/include/eigen3", folder / "beside.cpp", "-o", folder / "beside"], check=True)
    return folder / "beside"


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: mdl_measured.py MDL-SDK NETWORKS")
    sdk, networks = sys.argv[1:]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        beside = compiled(sdk, folder)
        print("| file | steps of theta | MDL beside gonio, at 99.9 % of directions | from the edges of cells: median, % "
              "| albedo in the middle, MDL | gonio |\n|---|---|---|---|---|---|")

        def row(label, path):
            line = subprocess.run([beside, path], check=True, capture_output=True, text=True).stdout
            print(f"| {label} | {line}", end="", flush=True)

        for example in EXAMPLES:
            path = folder / f"{example}.mbsdf"
            blob = f"HEAD:examples/mdl/nvidia/sdk_examples/resources/{example}.mbsdf"
            path.write_bytes(subprocess.run(["git", "-C", sdk, "show", blob], check=True, capture_output=True).stdout)
            row(f"{example}, of the SDK", path)
        for material in NAMES:
            table, path = folder / "table.binary", folder / f"{material}.mbsdf"
            subprocess.run([TOOL, "expand", "--networks", networks, "--name", material, "-o", table], check=True)
            subprocess.run([TOOL, "convert", table, path], check=True)
            row(material, path)


main()
