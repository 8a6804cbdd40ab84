#include <gonio/core/error.hpp>

#include <cstring>

int main() {
  const gonio::error refused{"refused"};
  return std::strstr(refused.what(), "refused") ? 0 : 1;
}
