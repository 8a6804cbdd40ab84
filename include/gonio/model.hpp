#pragma once
/// All of `model/`: analytic BRDFs, and their fit.

#include <gonio/model/adaptive_brdf.hpp>
#include <gonio/model/analytic_brdf.hpp>
#include <gonio/model/fit_model.hpp>
#include <gonio/model/fit_observations.hpp>
#include <gonio/model/formula_materials.hpp>
#include <gonio/model/fresnel.hpp>
#include <gonio/model/fresnel_lobe.hpp>
#include <gonio/model/ggx.hpp>
#include <gonio/model/lafortune.hpp>
#include <gonio/model/lambert.hpp>
#include <gonio/model/lobe.hpp>
#include <gonio/model/lobe_sampler.hpp>
#include <gonio/model/measured_properties.hpp>
#include <gonio/model/model_loss.hpp>
#include <gonio/model/network_brdf.hpp>
#include <gonio/model/phong.hpp>
#include <gonio/model/physical_properties.hpp>
#include <gonio/model/polar_grid_brdf.hpp>
#include <gonio/model/sampling_techniques.hpp>
#include <gonio/model/smooth_spectra.hpp>
#include <gonio/model/sufficient_wavelengths.hpp>
#include <gonio/model/sum_of_lobes.hpp>
#include <gonio/model/tabulate_adaptively.hpp>
#include <gonio/model/torrance_sparrow.hpp>
#include <gonio/model/ward.hpp>
