#include <gonio/core/spelling.hpp>

#include <doctest/doctest.h>
#include <rapidcheck.h>

using gonio::nearest_word, gonio::spelling_distance;

TEST_CASE("how far words are apart") {
  CHECK(spelling_distance("", "") == 0);
  CHECK(spelling_distance("", "abc") == 3);
  CHECK(spelling_distance("plan", "paln") == 1);               // neighbours exchanged
  CHECK(spelling_distance("reconstuct", "reconstruct") == 1);  // a letter missing
  CHECK(spelling_distance("kitten", "sitting") == 3);
}

TEST_CASE("a word is as far from another as the other from it, and no farther than by way of a third") {
  const auto word = rc::gen::container<std::string>(rc::gen::elementOf(std::string("ab-")));
  CHECK(rc::check([&] {
    const std::string a = *word, b = *word;
    RC_ASSERT(spelling_distance(a, a) == 0);
    RC_ASSERT(spelling_distance(a, b) == spelling_distance(b, a));
    RC_ASSERT((spelling_distance(a, b) == 0) == (a == b));
    RC_ASSERT(spelling_distance(a, b) <= std::max(a.size(), b.size()));
    RC_ASSERT(spelling_distance(a, b) >= std::max(a.size(), b.size()) - std::min(a.size(), b.size()));
  }));
}

TEST_CASE("the nearest word, if it is near") {
  const std::vector<std::string> words{"reconstruct", "render", "lab"};
  CHECK(nearest_word("reconstuct", words) == "reconstruct");
  CHECK(nearest_word("rendre", words) == "render");
  CHECK(!nearest_word("frobnicate", words));
  CHECK(!nearest_word("x", {}));
}
