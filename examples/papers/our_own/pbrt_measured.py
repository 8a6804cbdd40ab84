#!/usr/bin/env python3
"""Compares the values that pbrt-v4 and gonio read from the .bsdf files with spectra that gonio writes:
  gonio-papers run --markdown docs/results/renderers.md -- examples/papers/our_own/pbrt_measured.py pbrt-v4 \\
    cardboard.binary.gz satin_purple.binary.gz
The arguments are a git repository of github.com/mmp/pbrt-v4 and tables; three materials by formulas come with gonio.
Extracts pbrt's material `measured` from its sources, and compiles it with pbrt's headers in a temporary folder. GONIO
is the tool (default: gonio). Needs g++ and git."""

import json
import os
import pathlib
import subprocess
import sys
import tempfile

from fetched_sources import between, git

TOOL = os.environ.get("GONIO", "gonio")
ANGLES = (0, 40, 60, 80)
ROOT = pathlib.Path(__file__).resolve().parents[3]

# The interface between pbrt, which is C++17, and gonio.
INTERFACE = r"""
#include <array>
#include <vector>
using vector3 = std::array<double, 3>;
struct drawn { bool valid; vector3 wi; double pdf; std::vector<double> f; };
namespace theirs {
bool read(const char* path);
std::vector<double> f(const vector3& wo, const vector3& wi, const std::vector<double>& wavelengths);
double pdf(const vector3& wo, const vector3& wi);
drawn draw(const vector3& wo, double u, double v, const std::vector<double>& wavelengths);
}
"""

# The declarations that pbrt's lines need.
PBRT = r"""
#include <pbrt/pbrt.h>
#include <pbrt/base/bxdf.h>
#include <pbrt/util/check.h>
#include <pbrt/util/error.h>
#include <pbrt/util/file.h>
#include <pbrt/util/print.h>
#include <pbrt/util/sampling.h>
#include <pbrt/util/scattering.h>
#include <pbrt/util/spectrum.h>
#include <pbrt/util/stats.h>

#include <cstdio>
#include <cstdlib>
#include <map>
#include <unordered_map>
#include "interface.hpp"

namespace pbrt {
struct MeasuredBxDFData;
@CLASS@
@BODIES@

// Stubs for pbrt's messages, statistics and memory.
void Error(const FileLoc*, const char* message) { std::fputs(message, stderr); }
void ErrorExit(const FileLoc*, const char* message) { std::fputs(message, stderr); std::exit(2); }
void LogFatal(LogLevel, const char* file, int line, const char* message) {
  std::fprintf(stderr, "%s:%d: %s\n", file, line, message);
  std::exit(2);
}
FILE* FOpenRead(std::string name) { return std::fopen(name.c_str(), "rb"); }
StatRegisterer::StatRegisterer(AccumFunc, PixelAccumFunc) {}
void StatsAccumulator::ReportMemoryCounter(const char*, int64_t) {}
namespace detail {
void stringPrintfRecursive(std::string* text, const char* format) { *text += format; }
std::string copyToFormatString(const char** format, std::string* text) {
  *text += *format;
  *format += std::char_traits<char>::length(*format);
  return "%s";
}
}  // namespace detail
}  // namespace pbrt

namespace {
struct heap : pstd::pmr::memory_resource {
  void* do_allocate(size_t bytes, size_t alignment) override {
    return std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  }
  void do_deallocate(void* at, size_t, size_t) override { std::free(at); }
  bool do_is_equal(const memory_resource& other) const noexcept override { return this == &other; }
} the_heap;

pbrt::MeasuredBxDFData* material;
pbrt::Vector3f of(const vector3& w) { return {float(w[0]), float(w[1]), float(w[2])}; }

// pbrt has four wavelengths at a time.
template <class Act>
void for_each_four(const std::vector<double>& wavelengths, const Act& act) {
  for (size_t first = 0; first < wavelengths.size(); first += 4) {
    pbrt::SampledWavelengths four = pbrt::SampledWavelengths::SampleUniform(0.5f);
    for (size_t i = 0; i < 4; ++i) four[i] = float(wavelengths[std::min(first + i, wavelengths.size() - 1)]);
    act(pbrt::MeasuredBxDF(material, four));
  }
}

void append(std::vector<double>& to, const pbrt::SampledSpectrum& four, size_t most) {
  for (int i = 0; i < 4 && to.size() < most; ++i) to.push_back(four[i]);
}
constexpr auto radiance = pbrt::TransportMode::Radiance;
constexpr auto all = pbrt::BxDFReflTransFlags::All;
}  // namespace

namespace pstd::pmr {
memory_resource::~memory_resource() = default;
memory_resource* new_delete_resource() noexcept { return &the_heap; }
}  // namespace pstd::pmr

namespace theirs {
bool read(const char* path) { return (material = pbrt::MeasuredBxDF::BRDFDataFromFile(path, {})) != nullptr; }

std::vector<double> f(const vector3& wo, const vector3& wi, const std::vector<double>& wavelengths) {
  std::vector<double> values;
  for_each_four(wavelengths, [&](const pbrt::MeasuredBxDF& bxdf) {
    append(values, bxdf.f(of(wo), of(wi), radiance), wavelengths.size());
  });
  return values;
}

double pdf(const vector3& wo, const vector3& wi) {
  const auto any = pbrt::SampledWavelengths::SampleUniform(0.5f);
  return pbrt::MeasuredBxDF(material, any).PDF(of(wo), of(wi), radiance, all);
}

drawn draw(const vector3& wo, double u, double v, const std::vector<double>& wavelengths) {
  drawn found{};
  for_each_four(wavelengths, [&](const pbrt::MeasuredBxDF& bxdf) {
    const auto sample = bxdf.Sample_f(of(wo), 0.5f, {float(u), float(v)}, radiance, all);
    if (!sample) return;
    found.valid = true;
    found.wi = {sample->wi.x, sample->wi.y, sample->wi.z};
    found.pdf = sample->pdf;
    append(found.f, sample->f, wavelengths.size());
  });
  return found;
}
}  // namespace theirs
"""

# The comparison.
PROGRAM = r"""
#include <gonio/core/spectrum.hpp>
#include <gonio/io/materials/rgl_spectra.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include "interface.hpp"

namespace {
constexpr double pi = 3.14159265358979323846;
std::mt19937 generator(1);

double uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(generator); }
vector3 of(const gonio::direction& w) { return {w.x(), w.y(), w.z()}; }
vector3 at(double theta, double phi) { return of(gonio::spherical_direction(theta, phi)); }

double quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

/// The file's wavelengths, and those half-way between them.
std::vector<double> with_middles(const std::vector<double>& wavelengths) {
  std::vector<double> all;
  for (std::size_t i = 0; i < wavelengths.size(); ++i) {
    if (i > 0) all.push_back(0.5 * (wavelengths[i - 1] + wavelengths[i]));
    all.push_back(wavelengths[i]);
  }
  return all;
}

/// Pairs of directions above the horizon: half of them anywhere, half near the mirror direction.
std::vector<gonio::sample_directions> pairs(int count) {
  const double lowest = std::acos(0.05);
  std::vector<gonio::sample_directions> all;
  while (static_cast<int>(all.size()) < count) {
    const gonio::direction wo = gonio::spherical_direction(lowest * uniform(), 2.0 * pi * uniform());
    gonio::direction wi;
    if (all.size() % 2 == 0) {
      wi = gonio::spherical_direction(std::acos(uniform()), 2.0 * pi * uniform());
    } else {
      const double theta = 0.5 * pi * std::pow(uniform(), 3);
      const gonio::direction m = gonio::spherical_direction(theta, 2.0 * pi * uniform());
      wi = 2.0 * wo.dot(m) * m - wo;
    }
    if (wi.z() > 0.05) all.push_back(gonio::direction_pair{wi, wo});
  }
  return all;
}

/// Prints the difference of f, the mean of both orders as in gonio, relative to f + 0.01 sr^-1: the 99.9th percentile
/// and the maximum of pairs whose half vector is more than 0.1 degrees from the normal; then the maximum of the others.
/// pbrt's polar angles are arc cosines of floats, which have steps of 0.02 degrees at the normal.
void compare_values(const gonio::io::rgl_material& ours) {
  const std::vector<double> wavelengths = with_middles(ours.spectra->wavelengths);
  const auto directions = pairs(20000);
  const gonio::sample_set read = gonio::io::sample_spectra(ours, directions);
  const double near = pi / 1800.0;
  std::vector<double> off, off_near;
  for (Eigen::Index i = 0; i < std::ssize(read); ++i) {
    const vector3 wi = of(directions[i].pair().wi), wo = of(directions[i].pair().wo);
    const auto one = theirs::f(wo, wi, wavelengths), other = theirs::f(wi, wo, wavelengths);
    double largest = 0.0;
    for (std::size_t j = 0; j < wavelengths.size(); ++j) {
      const std::size_t band = j / 2, next = (j + 1) / 2;
      const double mean = 0.5 * (one[j] + other[j]);
      double f = 0.5 * (read.values(i)[band] + read.values(i)[next]);
      // pbrt sets negative values of either order to 0.
      if (one[j] == 0.0 || other[j] == 0.0) f = std::max(f, mean);
      largest = std::max(largest, std::abs(mean - f) / (std::abs(f) + 0.01));
    }
    const gonio::half_difference angles = directions[i].angles();
    (angles.theta_h < near ? off_near : off).push_back(largest);
  }
  std::printf("%.9g %.9g %.9g\n", quantile(off, 0.999), quantile(off, 1.0), quantile(off_near, 1.0));
}

/// Returns the integral of the density over the hemisphere, by half vectors: d wi = 4 (wo . m) d m.
double integral_of_pdf(const vector3& wo, int steps) {
  const gonio::direction out(wo[0], wo[1], wo[2]);
  double sum = 0.0;
  for (int a = 0; a < steps; ++a)
    for (int b = 0; b < steps; ++b) {
      const double u = (a + 0.5) / steps, theta = 0.5 * pi * u * u;
      const gonio::direction m = gonio::spherical_direction(theta, 2.0 * pi * (b + 0.5) / steps);
      const double cosine = out.dot(m);
      const gonio::direction wi = 2.0 * cosine * m - out;
      if (!(cosine > 0.0 && wi.z() > 0.0)) continue;
      sum += theirs::pdf(wo, of(wi)) * 4.0 * cosine * std::sin(theta) * (pi * u / steps) * (2.0 * pi / steps);
    }
  return sum;
}

/// Prints the integral of the density, and for draws from one direction on a jittered grid: the fraction below the
/// horizon, the relative difference of their density from PDF's, and the mean of f cos / pdf as a colour.
void draw_from(const vector3& wo, const std::vector<double>& wavelengths, int steps) {
  const Eigen::MatrixXd weights = gonio::interpolated_colour(wavelengths);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(weights.cols());
  std::vector<double> off;
  int lost = 0;
  for (int a = 0; a < steps; ++a)
    for (int b = 0; b < steps; ++b) {
      const double u = (a + uniform()) / steps, v = (b + uniform()) / steps;
      const drawn one = theirs::draw(wo, u, v, wavelengths);
      if (!one.valid) {
        ++lost;
        continue;
      }
      for (Eigen::Index i = 0; i < sum.size(); ++i) sum[i] += one.f[i] * one.wi[2] / one.pdf;
      off.push_back(std::abs(theirs::pdf(wo, one.wi) / one.pdf - 1.0));
    }
  const double count = static_cast<double>(steps) * steps;
  const Eigen::Vector3d albedo = weights * sum / count;
  std::printf("%.9g %.9g %.9g %.9g %.9g %.9g\n", integral_of_pdf(wo, 1024), lost / count, quantile(off, 0.99),
              albedo[0], albedo[1], albedo[2]);
}
}  // namespace

int main(int count, char** arguments) {
  if (!theirs::read(arguments[1])) return 1;
  const gonio::io::rgl_material ours = gonio::io::read_rgl(arguments[1]);
  compare_values(ours);
  for (int i = 2; i < count; ++i)
    draw_from(at(std::stod(arguments[i]) * pi / 180.0, 0.3), ours.spectra->wavelengths, 512);
}
"""


def compiled(repository, folder):
    """Returns the program, compiled with pbrt's sources at HEAD."""
    for path in git(repository, "ls-tree", "-r", "--name-only", "HEAD", "src/pbrt").splitlines():
        if path.endswith(".h"):
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(git(repository, "show", f"HEAD:{path}"))
    theirs = PBRT.replace("@CLASS@", between(git(repository, "show", "HEAD:src/pbrt/bxdfs.h"), "class MeasuredBxDF ",
                                             "// NormalizedFresnelBxDF"))
    theirs = theirs.replace("@BODIES@", between(git(repository, "show", "HEAD:src/pbrt/bxdfs.cpp"), "class Tensor ",
                                                "std::string MeasuredBxDF::ToString"))
    (folder / "interface.hpp").write_text("#pragma once" + INTERFACE)
    (folder / "theirs.cpp").write_text(theirs)
    (folder / "beside.cpp").write_text(PROGRAM)
    for name, options in (("theirs", ["-std=c++17", "-w", "-I", folder / "src"]),
                          ("beside", ["-std=c++20", "-I", ROOT / "include", "-isystem", "/usr/include/eigen3"])):
        subprocess.run(["g++", "-O2", *options, "-c", folder / f"{name}.cpp", "-o", folder / f"{name}.o"], check=True)
    subprocess.run(["g++", folder / "theirs.o", folder / "beside.o", "-o", folder / "beside"], check=True)
    return folder / "beside"


def run(*words):
    return subprocess.run([str(word) for word in words], check=True, capture_output=True, text=True).stdout


def row(name, source, beside, folder):
    """Prints a material's row of the table."""
    rgb, spectra = folder / "rgb.bsdf", folder / "spectra.bsdf"
    run(TOOL, *source, rgb)
    run(TOOL, "convert", "--spectra", rgb, spectra)
    lines = [[float(word) for word in line.split()] for line in run(beside, spectra, *ANGLES).splitlines()]
    (most, largest, near), *draws = lines
    by_angle = {round(e["theta_i"]): e["albedo"]
                for e in json.loads(run(TOOL, "properties", spectra, "--json"))["energy"]["by_angle"]}
    # Draws below the horizon are lost.
    integral = max(abs(draw[0] + draw[1] - 1) for draw in draws)
    off = [max(abs(found / ours - 1) for found, ours in zip(draw[3:], by_angle[angle]))
           for angle, draw in zip(ANGLES, draws)]
    print(f"| {name} | {most:.1e} | {largest:.1e} | {near:.1e} | {100 * integral:.2f} | "
          f"{100 * max(draw[1] for draw in draws):.2f} | {max(draw[2] for draw in draws):.1e} | "
          + " | ".join(f"{100 * share:.2f}" for share in off) + " |", flush=True)


def main():
    if len(sys.argv) < 2:
        sys.exit("usage: pbrt_measured.py PBRT-V4 [TABLE...]")
    repository, *tables = sys.argv[1:]
    sources = [(name, ("expand", "--formula", name, "-o")) for name in ("red-paint", "gold-metal", "blue-rubber")]
    sources += [(pathlib.Path(table).name.split(".")[0], ("convert", table)) for table in tables]
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        beside = compiled(repository, folder)
        commit = subprocess.run(["git", "-C", repository, "log", "-1", "--format=%h, %cd", "--date=short"], check=True,
                                capture_output=True, text=True).stdout.strip()
        print(f"pbrt-v4 {commit}.\n")
        print("| written by gonio | f, at 99.9 % | largest | half vector at the normal | integral of PDF, % | "
              "draws lost, % | pdf of draws | albedo at 0, % | at 40 | at 60 | at 80 |")
        print("|---" * 11 + "|")
        for source in sources:
            row(*source, beside, folder)


main()
