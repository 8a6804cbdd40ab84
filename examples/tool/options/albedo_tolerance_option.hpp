#pragma once
/// The option for the accuracy of materials for renderers.

#include "command.hpp"
#include "tool/files/file_start.hpp"
#include <gonio/core/error.hpp>
#include <gonio/model/tabulate_adaptively.hpp>

#include <filesystem>

namespace cli {

/// Adds `--albedo-tolerance X`.
inline void add_albedo_tolerance_option(command& to, double& tolerance) {
  to.add_option("--albedo-tolerance", tolerance,
                "For .bsdf: largest relative change of the albedo by the conversion. It decides whether an RGB table "
                "takes 7, 13 or 24 MB. Of spectra, wavelengths that can be interpolated linearly within this tolerance "
                "are omitted (0: no wavelength is omitted)")
      .check(check::range(0.0, 1.0))
      .capture_default_str();
}

/// Throws gonio::error if a tolerance is given and the output is not a .bsdf file.
inline void require_bsdf(double tolerance, const std::filesystem::path& output) {
  if (tolerance != gonio::model::usual_albedo_tolerance && lower_extension(output) != ".bsdf")
    gonio::refuse({"--albedo-tolerance needs an output that ends in .bsdf, not ", output.native()});
}

}  // namespace cli
