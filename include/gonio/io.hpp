#pragma once
/// All of `io/`: files, but for PNG and HDR images (io/image.hpp, which needs stb), OpenEXR and TIFF images and EXIF
/// data (io/exr.hpp, io/tiff.hpp, io/exif.hpp, which need OpenEXR, libtiff and libexif) and those of shapes
/// (shape.hpp).

#include <gonio/io/believable.hpp>
#include <gonio/io/byte_stream.hpp>
#include <gonio/io/camera_calibration.hpp>
#include <gonio/io/capture_constraint.hpp>
#include <gonio/io/checked_file.hpp>
#include <gonio/io/cornell.hpp>
#include <gonio/io/exposure_times.hpp>
#include <gonio/io/file.hpp>
#include <gonio/io/gzip.hpp>
#include <gonio/io/merl.hpp>
#include <gonio/io/merl_directory.hpp>
#include <gonio/io/merl_gzip.hpp>
#include <gonio/io/named_files.hpp>
#include <gonio/io/near_field_setup.hpp>
#include <gonio/io/networks.hpp>
#include <gonio/io/npy.hpp>
#include <gonio/io/pnm.hpp>
#include <gonio/io/prior.hpp>
#include <gonio/io/quantise.hpp>
#include <gonio/io/reference_reflectance.hpp>
#include <gonio/io/renderer_material.hpp>
#include <gonio/io/rgl.hpp>
#include <gonio/io/rules.hpp>
#include <gonio/io/sample_collector.hpp>
#include <gonio/io/samples.hpp>
#include <gonio/io/scan_journal.hpp>
#include <gonio/io/setup_text.hpp>
#include <gonio/io/soft_specular_prior.hpp>
#include <gonio/io/sphere_setup.hpp>
#include <gonio/io/table_npy.hpp>
#include <gonio/io/text.hpp>
#include <gonio/io/words.hpp>
#include <gonio/io/zemax_bsdf.hpp>
