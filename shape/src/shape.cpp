// The implementations of shape/ that use the model; shape_mesh.cpp and shape_io.cpp have the others.

#include <gonio/shape/impl/bootstrap.ipp>
#include <gonio/shape/impl/correspondence.ipp>
#include <gonio/shape/impl/cross_validated_uncertainty.ipp>
#include <gonio/shape/impl/fit_to_scan.ipp>
#include <gonio/shape/impl/fitted_shape.ipp>
#include <gonio/shape/impl/recovery.ipp>
#include <gonio/shape/impl/registration.ipp>
#include <gonio/shape/impl/shape_basis.ipp>
#include <gonio/shape/impl/shape_model.ipp>
#include <gonio/shape/impl/shape_uncertainty.ipp>
#include <gonio/shape/impl/shape_with_motion.ipp>
