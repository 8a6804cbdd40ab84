#include "contact_sheet.hpp"

#include "image_text.hpp"

#include <algorithm>
#include <sstream>
#include <utility>

namespace cli {

namespace {

constexpr std::size_t margin = 8;

/// The height of a line of text with the space below it, in points of the font.
constexpr std::size_t line_points = 14;

const gonio::rgb grey(0.6, 0.6, 0.6);

std::size_t width_of(const std::string& text, std::size_t scale) { return extent_of(text, scale).columns; }

std::string shortened(const std::string& text, std::size_t width, std::size_t scale) {
  if (width_of(text, scale) <= width) return text;
  std::string start = text;
  while (!start.empty() && width_of(start + "...", scale) > width) start.pop_back();
  return start + "...";
}

/// Breaks text into lines of at most `width` pixels; a word wider than a line has its own line.
std::vector<std::string> broken_into_lines(const std::string& text, std::size_t width, std::size_t scale) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string longer = lines.empty() ? word : lines.back() + ' ' + word;
    if (!lines.empty() && width_of(longer, scale) <= width)
      lines.back() = longer;
    else
      lines.push_back(word);
  }
  return lines;
}

}  // namespace

gonio::image contact_sheet(std::span<const gonio::image> images, std::size_t columns, const sheet_text& text) {
  const std::size_t size = images[0].shape(1), scale = std::max<std::size_t>(size / 200, 1), line = line_points * scale;
  const std::size_t across = size + margin, down = images[0].shape(0) + margin + (text.labels.empty() ? 0 : line);
  const std::size_t rows = (images.size() + columns - 1) / columns, width = columns * across + margin;
  const std::vector<std::string> caption = broken_into_lines(text.caption, width - 2 * margin, scale);

  gonio::image sheet =
      gonio::uniform_image(rows * down + margin + caption.size() * line, width, gonio::rgb(gonio::rgb::Zero()));
  for (std::size_t i = 0; i < images.size(); ++i) {
    const std::size_t top = margin + i / columns * down, left = margin + i % columns * across;
    gonio::render::paste(sheet, images[i], top, left);
    if (i >= text.labels.size()) continue;
    const std::string label = shortened(text.labels[i], size, scale);
    draw_text(sheet, top + images[i].shape(0) + 4 * scale, left + (size - std::min(size, width_of(label, scale))) / 2,
              label, scale, grey);
  }
  for (std::size_t i = 0; i < caption.size(); ++i)
    draw_text(sheet, rows * down + margin + i * line, margin, caption[i], scale, grey);
  return sheet;
}

}  // namespace cli
