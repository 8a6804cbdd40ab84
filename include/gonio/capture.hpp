#pragma once
/// All of `capture/`: devices, calibration, cameras, images.

#include <gonio/capture/calibration.hpp>
#include <gonio/capture/camera_response.hpp>
#include <gonio/capture/colour_clusters.hpp>
#include <gonio/capture/dark_signal.hpp>
#include <gonio/capture/device.hpp>
#include <gonio/capture/high_dynamic_range.hpp>
#include <gonio/capture/k_means.hpp>
#include <gonio/capture/known_surface.hpp>
#include <gonio/capture/light_probe.hpp>
#include <gonio/capture/merged_frames.hpp>
#include <gonio/capture/mirror_sphere.hpp>
#include <gonio/capture/near_field_image.hpp>
#include <gonio/capture/outline_circle.hpp>
#include <gonio/capture/reference_reflectance.hpp>
#include <gonio/capture/relative_reflectance.hpp>
#include <gonio/capture/scan.hpp>
#include <gonio/capture/sphere_outline.hpp>
#include <gonio/capture/surface_light.hpp>
#include <gonio/capture/surface_photograph.hpp>
#include <gonio/capture/trajectory.hpp>
