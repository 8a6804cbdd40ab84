// The bodies of model/.

#include <gonio/model/impl/adaptive_brdf.ipp>
#include <gonio/model/impl/analytic_brdf.ipp>
#include <gonio/model/impl/angle_grid_brdf.ipp>
#include <gonio/model/impl/fit_model.ipp>
#include <gonio/model/impl/fit_observations.ipp>
#include <gonio/model/impl/formula_materials.ipp>
#include <gonio/model/impl/instrument_readings.ipp>
#include <gonio/model/impl/lobe.ipp>
#include <gonio/model/impl/lobe_sampler.ipp>
#include <gonio/model/impl/measured_properties.ipp>
#include <gonio/model/impl/model_loss.ipp>
#include <gonio/model/impl/network_brdf.ipp>
#include <gonio/model/impl/physical_properties.ipp>
#include <gonio/model/impl/polar_grid_brdf.ipp>
#include <gonio/model/impl/sampling_techniques.ipp>
#include <gonio/model/impl/smooth_spectra.ipp>
#include <gonio/model/impl/sufficient_wavelengths.ipp>
#include <gonio/model/impl/tabulate_adaptively.ipp>

namespace gonio {

template brdf_table tabulate(const model::formula_brdf&, const valid_cells&, thread_count);

}  // namespace gonio
