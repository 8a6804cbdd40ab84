#pragma once
/// Measurements in the text format of Cornell's reflectance database (Foo, A Gonioreflectometer for Measuring the
/// Bidirectional Reflectance of Material for Use in Illumination Computation, 1997): the number of wavelengths, the
/// wavelengths in nanometres, then a line for each pair of directions: theta_i, phi_i, theta_s, phi_s in radians, and a
/// reflectance in sr^-1 for each wavelength. Lines that start with # are comments.

#include <gonio/io/measurements/sample_collector.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gonio::io {

namespace detail {

/// Reads a file line by line.
class cornell_reader {
 public:
  explicit cornell_reader(text_position& position) : position_(position) {}

  void read(std::string_view line);

  /// Returns the samples read. Throws gonio::error if the measurement is incomplete.
  [[nodiscard]] sample_collector samples() &&;

 private:
  [[nodiscard]] double number(std::size_t field) const {
    return read_number(fields_[field], position_, [&] { return "field " + std::to_string(field + 1); });
  }

  void read_count();

  void read_wavelengths();

  void read_sample();

  /// Reads a direction from a polar angle in this field and an azimuth in the next.
  [[nodiscard]] direction read_direction(std::size_t field) const;

  text_position& position_;
  std::size_t count_ = 0;
  std::vector<double> wavelengths_, reflectances_;
  std::vector<std::string_view> fields_;
  std::optional<sample_collector> collector_;
};

}  // namespace detail

/// Reads samples from the text of a Cornell file, at the file's wavelengths. Throws gonio::error naming the faulty line
/// and field. Errors call the file `name`.
[[nodiscard]] sample_set read_cornell(std::string_view text, const std::string& name);

/// Reads a Cornell file.
[[nodiscard]] sample_set read_cornell(const std::filesystem::path& path);

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/cornell.ipp>
#endif
