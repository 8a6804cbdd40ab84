#include <gonio/core/error.hpp>

#include <stb/stb_image_write.h>

#include <cstdio>

int main() {
  const unsigned char white[3] = {255, 255, 255};
  return stbi_write_png("white.png", 1, 1, 3, white, 3) ? 0 : 1;
}
