#pragma once
/// OpenEXR files as other programs write them.

#include <gonio/table/image.hpp>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include <cstddef>
#include <filesystem>

/// Adds red, green and blue to a header; returns the frame buffer of an image.
inline Imf::FrameBuffer channels_of(gonio::image& picture, Imf::Header& header) {
  Imf::FrameBuffer buffer;
  const std::size_t across = 3 * sizeof(float);
  std::size_t channel = 0;
  for (const char* kind : {"R", "G", "B"}) {
    header.channels().insert(kind, Imf::Channel(Imf::FLOAT));
    buffer.insert(kind, Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(picture.data() + channel++), across,
                                   across * picture.shape(1)));
  }
  return buffer;
}

/// Writes scan lines with any compression and line order.
inline void put_lines(const std::filesystem::path& path, gonio::image picture, Imf::Compression compression,
                      Imf::LineOrder order = Imf::INCREASING_Y) {
  Imf::Header header(static_cast<int>(picture.shape(1)), static_cast<int>(picture.shape(0)));
  header.compression() = compression;
  header.lineOrder() = order;
  const Imf::FrameBuffer buffer = channels_of(picture, header);
  Imf::OutputFile file(path.c_str(), header, 0);
  file.setFrameBuffer(buffer);
  file.writePixels(static_cast<int>(picture.shape(0)));
}

/// Writes square tiles.
inline void put_tiles(const std::filesystem::path& path, gonio::image picture, unsigned size) {
  Imf::Header header(static_cast<int>(picture.shape(1)), static_cast<int>(picture.shape(0)));
  header.setTileDescription(Imf::TileDescription(size, size));
  const Imf::FrameBuffer buffer = channels_of(picture, header);
  Imf::TiledOutputFile file(path.c_str(), header, 0);
  file.setFrameBuffer(buffer);
  file.writeTiles(0, file.numXTiles() - 1, 0, file.numYTiles() - 1);
}
