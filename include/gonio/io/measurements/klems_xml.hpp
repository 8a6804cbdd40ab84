#pragma once
/// The reflection part of BSDF files in the XML of LBNL's Window and of Radiance (genBSDF, wrapBSDF), by the schema
/// BSDF-v1.7.7.xsd of github.com/LBNL-ETA/BSDFXMLParser: matrices over patches of the hemisphere by J. Klems (A new
/// method for predicting the solar heat gain of complex fenestration systems, ASHRAE Transactions 100 (1), 1994). A
/// ring of polar angles is divided into patches of equal width in azimuth, the first centred on azimuth 0.

#include <gonio/io/text/text.hpp>
#include <gonio/io/text/xml_element.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// The block of a file to read.
struct window_block {
  enum class side { either, front, back };
  side of = side::either;              ///< either: the front, or the back if the file has no front
  std::string wavelength = "Visible";  ///< name in the file: Visible, Solar, ...
};

namespace detail {

/// Returns the block of reflection. If it is missing, throws gonio::error naming the file and its blocks.
[[nodiscard]] xml_element reflection_of(const xml_element& file, const std::string& name, const window_block& wanted);

/// Reads a word of <ScatteringData> as a number, sr^-1.
[[nodiscard]] double scattering_value(const xml_element& data, std::string_view word);

}  // namespace detail

/// Does the text have the root element WindowElement?
[[nodiscard]] bool looks_like_klems_xml(std::string_view text);

/// Reads samples from the text of a file of Klems matrices: one value, sr^-1 without the cosine, for each pair of
/// patches at their centres, 145 x 145 in the full basis. The azimuth of an incident patch is the azimuth to which the
/// light travels: the light comes from this azimuth plus 180 degrees, and the mirror direction is in the outgoing patch
/// with the same centre. Throws gonio::error naming the faulty line, for a tensor tree, and if there is no reflection.
/// Errors call the file `name`.
[[nodiscard]] sample_set read_klems_xml(std::string_view text, const std::string& name,
                                        const window_block& wanted = {});

/// Reads a file of Klems matrices.
[[nodiscard]] sample_set read_klems_xml(const std::filesystem::path& path, const window_block& wanted = {});

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/klems_xml.ipp>
#endif
