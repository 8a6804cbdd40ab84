#include <gonio/core/uninitialised.hpp>

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace {

template <class T>
using vector = std::vector<T, gonio::uninitialised_allocator<T>>;

}  // namespace

TEST_CASE("only numbers constructed without a value are uninitialised") {
  vector<int> numbers(3, 7);
  CHECK(numbers == vector<int>{7, 7, 7});
  numbers.resize(4, 1);
  numbers.push_back(2);
  CHECK(numbers == vector<int>{7, 7, 7, 1, 2});
  CHECK(vector<int>(numbers) == numbers);
  CHECK(vector<std::string>(2) == vector<std::string>{"", ""});  // strings are constructed as usual
}
