#pragma once
/// The reflection part of tensor trees in the XML of Radiance (genBSDF -t3 and -t4), read as Radiance reads them
/// (src/common/bsdf_t.c). A tree repeatedly halves each axis of a cube of directions, down to cells of one value. Two
/// axes form a square, which the map of Shirley and Chiu takes to the disk of the directions' x and y (A low distortion
/// map between disk and square, Journal of Graphics Tools 2 (3), 1997, doi:10.1080/10867651.1997.10487479).

#include <gonio/io/measurements/klems_xml.hpp>
#include <gonio/io/text/text.hpp>
#include <gonio/table/sample_set.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace gonio::io {

/// Does the text have a root element WindowElement and a data structure TensorTree?
[[nodiscard]] bool looks_like_tensor_tree_xml(std::string_view text);

/// Reads samples from the text of a file of a tensor tree: one value, sr^-1 without the cosine, for the centre of each
/// cell; cells wider than an eighth of the cube are divided. In trees of rank 3 the light is at azimuth 180 degrees.
/// Throws gonio::error naming the faulty line, and if there is no reflection. Errors call the file `name`.
[[nodiscard]] sample_set read_tensor_tree_xml(std::string_view text, const std::string& name,
                                              const window_block& wanted = {});

/// Reads a file of a tensor tree.
[[nodiscard]] sample_set read_tensor_tree_xml(const std::filesystem::path& path, const window_block& wanted = {});

}  // namespace gonio::io

#if !defined(GONIO_COMPILED)
#include <gonio/io/measurements/impl/tensor_tree_xml.ipp>
#endif
