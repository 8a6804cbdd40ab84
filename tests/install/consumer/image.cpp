#include <gonio/io/images/image.hpp>

int main() {
  gonio::io::write_png("white.png", gonio::uniform_image(2, 3, gonio::rgb::Ones()));
  return gonio::io::read_png("white.png").shape(1) == 3 ? 0 : 1;
}
