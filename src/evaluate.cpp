// The bodies of evaluate/.

#include <gonio/evaluate/impl/appearance.ipp>
#include <gonio/evaluate/impl/comparison.ipp>
#include <gonio/evaluate/impl/perceived_norm.ipp>
#include <gonio/evaluate/impl/simulated_measurement.ipp>
#include <gonio/evaluate/impl/sphere_judge.ipp>
#include <gonio/evaluate/impl/test_materials.ipp>
