/// The computations of the lesson pages, as WebAssembly: the library's own estimators with the shipped prior. A page
/// and this program exchange doubles in one buffer; the comment of each function states its input ("Finds") and output
/// ("Leaves"). Angles are in degrees, reflectance in sr^-1.

#include <gonio/basis/component_variance.hpp>
#include <gonio/estimate/fitted_brdf.hpp>
#include <gonio/estimate/reconstruction.hpp>
#include <gonio/evaluate/comparison.hpp>
#include <gonio/evaluate/simulated_measurement.hpp>
#include <gonio/io/materials/prior_payload.hpp>
#include <gonio/model/formula_materials.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <exception>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

#define PAGE_CALLS(name) extern "C" __attribute__((export_name(#name)))  // NOLINT: attributes are no expressions

/// Implemented by the page: throws the message.
extern "C" __attribute__((import_module("page"), import_name("refused"))) [[noreturn]] void refused(
    const char* message);

// No exception is caught here: it ends the call, and the page receives its message.
extern "C" void* __cxa_allocate_exception(std::size_t size) noexcept { return std::malloc(size); }     // NOLINT
extern "C" [[noreturn]] void __cxa_throw(void* thrown, void* /*type*/, void (* /*destroy*/)(void*)) {  // NOLINT
  refused(static_cast<const std::exception*>(thrown)->what());
}

namespace {

constexpr Eigen::Index shown_components = 5;

std::vector<double> buffer;
std::optional<gonio::log_relative_pca> prior, first_components;

/// The weights of the first components, one column for each channel.
auto weights_in_buffer() { return Eigen::Map<Eigen::MatrixXd>(buffer.data(), shown_components, 3); }

/// An in-plane scan of the viewer with the light at 45 degrees; positive angles are on the side of the mirror
/// direction.
constexpr double light = 45.0, last_sample = 75.0, sample_step = 5.0, last_of_curve = 85.0, curve_step = 0.5;
constexpr double scan_noise = 0.02;

gonio::direction_pair in_plane(double theta_o) {
  // Uses a negative polar angle instead of an azimuth of pi. The rounding error of pi would tilt the half vector of the
  // mirror direction slightly off the normal, and so give it a meaningless azimuth.
  return {gonio::spherical_direction(gonio::radians(light), 0.0),
          gonio::spherical_direction(gonio::radians(-theta_o), 0.0)};
}

/// Returns angles from -last to last.
std::vector<double> angles_of(double last, double step) {
  std::vector<double> angles;
  for (Eigen::Index i = 0; static_cast<double>(i) * step <= 2.0 * last; ++i)
    angles.push_back(static_cast<double>(i) * step - last);
  return angles;
}

template <gonio::brdf Brdf>
void leave_curve(const Brdf& f) {
  for (const double theta_o : angles_of(last_of_curve, curve_step)) {
    const auto [wi, wo] = in_plane(theta_o);
    for (const double value : f(wi, wo)) buffer.push_back(value);
  }
}

/// A Lambertian base below a lobe of GGX.
auto model_in_buffer() {
  const gonio::rgb colour(buffer[0], buffer[1], buffer[2]);
  const double metal = buffer[3], highlight = buffer[4], alpha = buffer[5];
  return gonio::model::sum_of_lobes{
      gonio::model::lambertian{.albedo = (1.0 - metal) * colour},
      gonio::model::ggx{.alpha = alpha, .f0 = metal * colour + (1.0 - metal) * highlight}};
}

const gonio::model::formula_brdf& scanned_material() {
  static const auto material = gonio::model::formula_material("red-paint");
  return material;
}

}  // namespace

/// Resizes the buffer to `doubles` elements and returns its address. All memory may move when it grows.
PAGE_CALLS(buffer_of) double* buffer_of(Eigen::Index doubles) {
  buffer.resize(doubles);
  return buffer.data();
}

PAGE_CALLS(buffer_size) Eigen::Index buffer_size() { return std::ssize(buffer); }

/// Finds: the inflated payload of a prior's file, with its number of bytes as argument.
PAGE_CALLS(take_prior) void take_prior(std::size_t bytes) {
  gonio::io::byte_reader in(std::as_bytes(std::span(buffer)).first(bytes), "the prior of the page");
  prior = gonio::io::read_prior(in, "the prior of the page");
  first_components = prior->truncated(shown_components);
}

/// Leaves: the standard deviations of the shown components' weights, then the components' fractions of the variance.
PAGE_CALLS(describe_components) void describe_components() {
  const Eigen::VectorXd deviations = gonio::weight_deviations(prior->coefficients());
  const Eigen::VectorXd shares = gonio::variance_shares(*prior);
  buffer.assign(deviations.begin(), deviations.begin() + shown_components);
  buffer.insert(buffer.end(), shares.begin(), shares.begin() + shown_components);
}

/// Leaves: the weights of a material of the prior. Returns false if its number is too large.
PAGE_CALLS(weights_of) bool weights_of(Eigen::Index material) {
  if (material >= std::ssize(prior->names())) return false;
  buffer.resize(3 * shown_components);
  weights_in_buffer() = prior->weights_of(material).topRows(shown_components);
  return true;
}

/// Returns the name of a material of the prior as a C string.
PAGE_CALLS(name_of) const char* name_of(Eigen::Index material) { return prior->names()[material].c_str(); }

/// Leaves: the extents of the prior's grid in theta_h, theta_d and phi_d, the position of the node in a cell, the
/// smallest cosine of a valid cell, and the number of valid cells.
PAGE_CALLS(describe_cells) void describe_cells() {
  const gonio::valid_cells& cells = prior->cells();
  const auto [theta_h, theta_d, phi_d] = cells.grid().extents();
  buffer.assign({static_cast<double>(theta_h), static_cast<double>(theta_d), static_cast<double>(phi_d),
                 cells.grid().anchor() == gonio::cell_anchor::centre ? 0.5 : 0.0,
                 std::max(cells.minimum_cosine(), gonio::valid_cells::horizon), static_cast<double>(cells.size())});
}

/// Finds: weights. Returns the reflectance of each valid cell: red, green, blue as floats.
PAGE_CALLS(tabulate) const float* tabulate() {
  static gonio::brdf_table table(first_components->cells());
  table = gonio::fitted_brdf(*first_components, Eigen::MatrixXd(weights_in_buffer())).tabulate(table.cells());
  return table.values().data();
}

/// Returns the reflectance of each valid cell of a material of the prior, by all its components, as `tabulate` does.
PAGE_CALLS(tabulate_material) const float* tabulate_material(Eigen::Index material) {
  static gonio::brdf_table table(prior->cells());
  table = gonio::fitted_brdf(*prior, prior->weights_of(material)).tabulate(table.cells());
  return table.values().data();
}

/// Finds: red, green and blue of the colour, the share of it that the highlight has (1 for metal, 0 for paint), the
/// reflectance of a paint's highlight at normal incidence, and the roughness alpha. Returns the reflectance of each
/// valid cell as `tabulate` does.
PAGE_CALLS(tabulate_model) const float* tabulate_model() {
  static gonio::brdf_table table(prior->cells());
  table = gonio::tabulate(model_in_buffer(), table.cells());
  return table.values().data();
}

/// Leaves: red, green and blue of a material of the prior along the curve.
PAGE_CALLS(material_curve) void material_curve(Eigen::Index material) {
  buffer.clear();
  leave_curve(gonio::fitted_brdf(*prior, prior->weights_of(material)));
}

/// Finds: the model as `tabulate_model` does. Leaves: red, green and blue of the model along the curve.
PAGE_CALLS(model_curve) void model_curve() {
  const auto model = model_in_buffer();
  buffer.clear();
  leave_curve(model);
}

/// Finds: theta_i, phi_i, theta_o and phi_o of each measurement. Returns Delta E of a sphere of a formula material (0:
/// red-paint, 1: blue-rubber), measured in these directions and reconstructed with this number of components as gonio
/// reconstruct does: examples/learn/why_twenty.cpp.
PAGE_CALLS(delta_e) double delta_e(int material, Eigen::Index components) {
  static const gonio::appearance_metric appearance(gonio::valid_cells(gonio::grid({90, 30, 36})));
  static const std::array names{"red-paint", "blue-rubber"};
  const auto truth = gonio::model::formula_material(names[material]);
  gonio::sample_set samples;
  for (std::size_t i = 0; i + 4 <= buffer.size(); i += 4) {
    const auto towards = [&](std::size_t at) {
      return gonio::spherical_direction(gonio::radians(buffer[at]), gonio::radians(buffer[at + 1]));
    };
    const gonio::direction_pair pair{towards(i), towards(i + 2)};
    samples.push_back({pair, truth(pair.wi, pair.wo)});
  }
  const auto fit = gonio::reconstruction{prior->truncated(components)}.fit(samples);
  return appearance.difference(fit.tabulate(appearance.cells()), gonio::tabulate(truth, appearance.cells()))
      .environment;
}

/// Leaves: the viewer's angle for each sample of the scan.
PAGE_CALLS(sample_angles) void sample_angles() { buffer = angles_of(last_sample, sample_step); }

/// Leaves: red, green and blue of each sample, with noise.
PAGE_CALLS(measure_scan) void measure_scan() {
  gonio::sample_set samples;
  for (const double theta_o : angles_of(last_sample, sample_step)) {
    const gonio::direction_pair pair = in_plane(theta_o);
    samples.push_back({pair, scanned_material()(pair.wi, pair.wo)});
  }
  const auto no_outlier = [](auto&) { return gonio::rgb(gonio::rgb::Zero()); };
  buffer.clear();
  for (const gonio::sample& each : gonio::corrupt(samples, {.noise = scan_noise}, 1, no_outlier))
    buffer.insert(buffer.end(), each.value.begin(), each.value.end());
}

/// Leaves: the viewer's angle for each point of the curve.
PAGE_CALLS(curve_angles) void curve_angles() { buffer = angles_of(last_of_curve, curve_step); }

/// Leaves: red, green and blue of the truth along the curve.
PAGE_CALLS(true_curve) void true_curve() {
  buffer.clear();
  leave_curve(scanned_material());
}

/// Finds: red, green and blue of each sample, as `measure_scan` leaves them. Leaves: Delta E of a sphere, the mapped
/// rms over all directions, for each sample the probability that it is wrong (0 if it is kept), and the curve.
/// `rejects`: as in `gonio reconstruct`; else as with --no-reject.
PAGE_CALLS(fit_scan) void fit_scan(bool rejects) {
  static const gonio::appearance_metric appearance(prior->cells());
  static const gonio::brdf_table truth = gonio::tabulate(scanned_material(), appearance.cells());
  gonio::sample_set samples;
  const double* value = buffer.data();
  for (const double theta_o : angles_of(last_sample, sample_step)) {
    samples.push_back({in_plane(theta_o), gonio::rgb(value[0], value[1], value[2])});
    value += 3;
  }
  const gonio::reconstruction estimator{*prior, {.noise = scan_noise}};
  const auto fit = (rejects ? estimator : estimator.keeping_all()).fit(samples);
  const auto difference = gonio::compare(fit.tabulate(truth.cells()), truth, prior->metric(), appearance);
  buffer.assign(2 + samples.size(), 0.0);
  buffer[0] = difference.delta_e_env;
  buffer[1] = difference.mapped_rms.mean();
  for (const gonio::outlying_sample& out : fit.contradicted()) buffer[2 + out.number] = out.probability;
  leave_curve(fit);
}
