#pragma once
/// The reflection part of BSDF files in the XML of LBNL's Window and of Radiance (genBSDF, wrapBSDF), by the schema
/// BSDF-v1.7.7.xsd of github.com/LBNL-ETA/BSDFXMLParser: matrices over patches of the hemisphere, which J. Klems
/// described (A new method for predicting the solar heat gain of complex fenestration systems, ASHRAE Transactions 100
/// (1), 1994). A patch is a ring of polar angles divided into equal azimuths, the first about azimuth 0.

#include <gonio/io/text/text.hpp>
#include <gonio/io/text/xml_element.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Which block of such a file is read.
struct window_block {
  enum class side { either, front, back };
  side of = side::either;              ///< either: the front, or the back where there is no front
  std::string wavelength = "Visible";  ///< as the file calls it: Visible, Solar, ...
};

namespace detail {

/// The block of reflection. Throws gonio::error naming the file and the blocks that it has if it is not there.
[[nodiscard]] xml_element reflection_of(const xml_element& file, const std::string& name, const window_block& wanted);

/// The number that a word of <ScatteringData> is, sr^-1.
[[nodiscard]] double scattering_value(const xml_element& data, std::string_view word);

}  // namespace detail

/// Does the text have the root element of such a file, WindowElement?
[[nodiscard]] bool looks_like_klems_xml(std::string_view text);

/// Samples from the text of such a file; `name` is what errors call it: one value, sr^-1 without the cosine, for each
/// pair of patches at their centres, 145 x 145 of the full basis. An incident patch is named by the way that the light
/// goes, so that the light comes from its azimuth and 180 degrees, and the mirror direction has the same patch. Throws
/// gonio::error naming the line of what is wrong, of a tensor tree, and where there is no reflection.
[[nodiscard]] sample_set read_klems_xml(std::string_view text, const std::string& name,
                                        const window_block& wanted = {});

/// Reads such a file.
[[nodiscard]] sample_set read_klems_xml(const std::filesystem::path& path, const window_block& wanted = {});

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/klems_xml.ipp>
#endif
