// The bodies of capture/.

#include <gonio/capture/impl/calibration.ipp>
#include <gonio/capture/impl/camera_response.ipp>
#include <gonio/capture/impl/colour_clusters.ipp>
#include <gonio/capture/impl/dark_signal.ipp>
#include <gonio/capture/impl/high_dynamic_range.ipp>
#include <gonio/capture/impl/k_means.ipp>
#include <gonio/capture/impl/known_surface.ipp>
#include <gonio/capture/impl/light_probe.ipp>
#include <gonio/capture/impl/merged_frames.ipp>
#include <gonio/capture/impl/mirror_sphere.ipp>
#include <gonio/capture/impl/near_field_image.ipp>
#include <gonio/capture/impl/reference_reflectance.ipp>
#include <gonio/capture/impl/relative_reflectance.ipp>
#include <gonio/capture/impl/scan.ipp>
#include <gonio/capture/impl/sphere_outline.ipp>
#include <gonio/capture/impl/surface_light.ipp>
#include <gonio/capture/impl/surface_photograph.ipp>
#include <gonio/capture/impl/trajectory.ipp>
