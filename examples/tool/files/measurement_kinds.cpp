#include "measurement_kinds.hpp"

#include "file_start.hpp"
#include <gonio/io/bytes/file.hpp>
#include <gonio/io/measurements/alta.hpp>
#include <gonio/io/measurements/astm_e1392.hpp>
#include <gonio/io/measurements/bird.hpp>
#include <gonio/io/measurements/cornell.hpp>
#include <gonio/io/measurements/fred_bsdf.hpp>
#include <gonio/io/measurements/klems_xml.hpp>
#include <gonio/io/measurements/lighttools_bsdf.hpp>
#include <gonio/io/measurements/openmaterial.hpp>
#include <gonio/io/measurements/rt300s.hpp>
#include <gonio/io/measurements/speos_brdf.hpp>
#include <gonio/io/measurements/ssdd.hpp>
#include <gonio/io/measurements/tensor_tree_xml.hpp>
#include <gonio/io/measurements/zemax_bsdf.hpp>

#include <array>
#include <cstddef>
#include <string_view>
#include <vector>

namespace cli {

namespace {

/// Reads a tensor tree or a Klems matrix. Searches the whole text: geometry may precede a tree's data structure.
gonio::sample_set read_window_block(const std::filesystem::path& path, const gonio::io::window_block& wanted) {
  const std::vector<std::byte> content = gonio::io::read_bytes(path);
  const std::string_view text = gonio::io::as_text(content);
  return gonio::io::looks_like_tensor_tree_xml(text) ? gonio::io::read_tensor_tree_xml(text, path.string(), wanted)
                                                     : gonio::io::read_klems_xml(text, path.string(), wanted);
}

gonio::sample_set read_window_xml(const std::filesystem::path& path) { return read_window_block(path, {}); }

constexpr std::array<measurement_kind, 13> kinds{{
    // Must precede Zemax's files, which have the same first keywords.
    {"LightTools BSDF",
     [](std::string_view, std::string_view start) { return gonio::io::looks_like_lighttools_bsdf(start); },
     gonio::io::read_lighttools_bsdf},
    {"Zemax BSDF", [](std::string_view, std::string_view start) { return gonio::io::looks_like_zemax_bsdf(start); },
     gonio::io::read_zemax_bsdf},
    {"SSDD", [](std::string_view, std::string_view start) { return gonio::io::looks_like_ssdd(start); },
     gonio::io::read_ssdd},
    {"ASTM E1392",
     [](std::string_view extension, std::string_view start) {
       return extension == ".astm" || gonio::io::looks_like_astm_e1392(start);
     },
     gonio::io::read_astm_e1392},
    {"OpenMATERIAL",
     [](std::string_view extension, std::string_view start) {
       return extension == ".xompt" || gonio::io::looks_like_openmaterial(start);
     },
     gonio::io::read_openmaterial},
    {"ALTA", [](std::string_view, std::string_view start) { return gonio::io::looks_like_alta(start); },
     gonio::io::read_alta},
    {"tensor tree",
     [](std::string_view, std::string_view start) { return gonio::io::looks_like_tensor_tree_xml(start); },
     read_window_xml, read_window_block},
    {"Klems matrix", [](std::string_view, std::string_view start) { return gonio::io::looks_like_klems_xml(start); },
     read_window_xml, read_window_block},
    {"Speos", [](std::string_view, std::string_view start) { return gonio::io::looks_like_speos_brdf(start); },
     gonio::io::read_speos_brdf},
    {"FRED", [](std::string_view, std::string_view start) { return gonio::io::looks_like_fred_bsdf(start); },
     gonio::io::read_fred_bsdf},
    {"RT-300S", [](std::string_view, std::string_view start) { return gonio::io::looks_like_rt300s(start); },
     gonio::io::read_rt300s},
    {"BiRD", [](std::string_view, std::string_view start) { return gonio::io::looks_like_bird(start); },
     gonio::io::read_bird},
    {"spectral samples of Cornell", [](std::string_view extension, std::string_view) { return extension == ".brdf"; },
     gonio::io::read_cornell},
}};

}  // namespace

const measurement_kind* measurement_kind_of(const std::filesystem::path& path) {
  const std::string start = file_start(path), extension = lower_extension(path);
  for (const measurement_kind& kind : kinds)
    if (kind.recognises(extension, start)) return &kind;
  return nullptr;
}

}  // namespace cli
