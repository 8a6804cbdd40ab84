// The bodies of io/, but for what image.cpp and shape_io.cpp have.

#include <gonio/io/impl/byte_stream.ipp>
#include <gonio/io/impl/camera_calibration.ipp>
#include <gonio/io/impl/capture_constraint.ipp>
#include <gonio/io/impl/checked_file.ipp>
#include <gonio/io/impl/cornell.ipp>
#include <gonio/io/impl/exposure_times.ipp>
#include <gonio/io/impl/file.ipp>
#include <gonio/io/impl/gzip.ipp>
#include <gonio/io/impl/merl.ipp>
#include <gonio/io/impl/merl_directory.ipp>
#include <gonio/io/impl/merl_gzip.ipp>
#include <gonio/io/impl/named_files.ipp>
#include <gonio/io/impl/near_field_setup.ipp>
#include <gonio/io/impl/networks.ipp>
#include <gonio/io/impl/npy.ipp>
#include <gonio/io/impl/pnm.ipp>
#include <gonio/io/impl/prior.ipp>
#include <gonio/io/impl/renderer_material.ipp>
#include <gonio/io/impl/rgl.ipp>
#include <gonio/io/impl/rules.ipp>
#include <gonio/io/impl/samples.ipp>
#include <gonio/io/impl/scan_journal.ipp>
#include <gonio/io/impl/setup_text.ipp>
#include <gonio/io/impl/sphere_setup.ipp>
#include <gonio/io/impl/table_npy.ipp>
#include <gonio/io/impl/text.ipp>
