#include "scratch.hpp"
#include <gonio/io/bytes/npy.hpp>

#include <rapidcheck.h>

using gonio::io::read_npy;
using gonio::io::write_npy;
using scratch::bytes_of;
using scratch::check_refused;

namespace {

/// A file of this version whose header is the dictionary, unpadded.
std::string npy(const std::string& dictionary, const std::string& elements, char version = 1) {
  std::string text = std::string("\x93NUMPY") + version + '\0';
  for (std::size_t i = 0, size = dictionary.size(); i < (version == 1 ? 2u : 4u); ++i, size /= 256)
    text += static_cast<char>(size % 256);
  return text + dictionary + elements;
}

template <class T>
std::string raw(std::initializer_list<T> values) {
  return {reinterpret_cast<const char*>(values.begin()), values.size() * sizeof(T)};
}

const std::string dictionary = "{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), }\n";
const std::string six = raw<float>({1, 2, 3, 4, 5, 6});

template <class A, class B>
bool same(const A& a, const B& b) {
  return std::ranges::equal(a.shape(), b.shape()) && std::equal(a.data(), a.data() + a.size(), b.data());
}

void check_text_refused(const std::string& text, std::initializer_list<std::string> words) {
  CAPTURE(text);
  check_refused([&] { return read_npy<float, 2>(bytes_of(text), "a.npy"); }, {"a.npy: "});
  check_refused([&] { return read_npy<float, 2>(bytes_of(text), "a.npy"); }, words);
}

}  // namespace

/// An array with random extents and elements, written, read and written again.
template <class T, std::size_t Rank>
void check_round_trip(const scratch::fs::path& path) {
  CHECK(rc::check("npy round trip", [&] {
    std::array<std::size_t, Rank> shape{};
    for (std::size_t& extent : shape) extent = *rc::gen::inRange(0, 5);
    xt::xtensor<T, Rank> array(shape);
    for (std::size_t i = 0; i < array.size(); ++i) array.data()[i] = *rc::gen::arbitrary<T>();
    write_npy(path, array);
    const auto again = read_npy<T, Rank>(path);
    RC_ASSERT(again.shape() == array.shape());
    // Compare bytes: NaN differs from itself.
    const auto bytes_in = [](const auto& a) { return std::as_bytes(std::span(a.data(), a.size())); };
    RC_ASSERT(std::ranges::equal(bytes_in(again), bytes_in(array)));
    const std::string bytes = scratch::get(path);
    RC_ASSERT((bytes.size() - array.size() * sizeof(T)) % 64 == 0u);
    write_npy(path, again);
    RC_ASSERT(scratch::get(path) == bytes);
  }));
}

TEST_CASE("an array is written with numpy's bytes") {
  const scratch::folder here;
  write_npy(here / "a", xt::xtensor<double, 2>({{1.0, 2.0, 3.0}, {4.0, 5.0, 6.0}}));
  // numpy.save of the same array.
  std::string expected =
      std::string("\x93NUMPY\x01\x00v\x00", 10) + "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3), }";
  expected.resize(127, ' ');
  CHECK(scratch::get(here / "a") == expected + "\n" + raw<double>({1, 2, 3, 4, 5, 6}));
  write_npy(here / "a", xt::xtensor<float, 1>({1.0f}));
  CHECK(scratch::get(here / "a").find("'shape': (1,), }") != std::string::npos);

  write_npy(here / "b", xt::xtensor<float, 2>(std::array<std::size_t, 2>{100, 675}));
  const scratch::fs::path shared = GONIO_SHARED_DATA "/measured-materials/merl_networks.npy";
  if (scratch::fs::exists(shared))
    CHECK(scratch::get(here / "b").substr(0, 128) == scratch::get(shared).substr(0, 128));
  else
    MESSAGE("skipped: " << shared.string() << " is not here");
}

TEST_CASE("arrays are read back") {
  const scratch::folder here;
  check_round_trip<double, 0>(here / "a");
  check_round_trip<float, 1>(here / "a");
  check_round_trip<double, 2>(here / "a");
  check_round_trip<float, 4>(here / "a");
}

TEST_CASE("elements of the other type are converted") {
  const scratch::folder here;
  write_npy(here / "f", xt::xtensor<float, 1>({0.1f, -2.0f}));
  CHECK(same(read_npy<double, 1>(here / "f"), xt::xtensor<double, 1>({double{0.1f}, -2.0})));
  const double inf = std::numeric_limits<double>::infinity();
  write_npy(here / "d", xt::xtensor<double, 1>({0.1, -inf, 1e-300}));
  CHECK(same(read_npy<float, 1>(here / "d"),
             xt::xtensor<float, 1>({0.1f, -std::numeric_limits<float>::infinity(), 0.0f})));
  write_npy(here / "d", xt::xtensor<double, 1>({std::nan("")}));
  CHECK(std::isnan(read_npy<float, 1>(here / "d")(0)));
  write_npy(here / "d", xt::xtensor<double, 1>({0.0, 1e39}));
  check_refused([&] { return read_npy<float, 1>(here / "d"); }, {"d: ", "element 1", "too large for float32"});
}

TEST_CASE("headers are read in every form that numpy allows") {
  const auto reads = [](const std::string& text) {
    return same(read_npy<float, 2>(bytes_of(text), "x"), xt::xtensor<float, 2>({{1.f, 2.f, 3.f}, {4.f, 5.f, 6.f}}));
  };
  for (const char version : {char{1}, char{2}, char{3}}) CHECK(reads(npy(dictionary, six, version)));
  CHECK(reads(npy("{'shape':(2,3),'descr':'<f4','fortran_order':False}", six)));
  CHECK(reads(npy("{\"descr\": \"<f4\", \"fortran_order\": False, \"shape\": (2, 3,), }     \n", six)));
  const auto scalar = bytes_of(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (), }\n", raw<float>({7})));
  CHECK(read_npy<float, 0>(scalar, "x")() == 7.0f);
  const auto empty = bytes_of(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (3, 0), }\n", ""));
  CHECK(read_npy<float, 2>(empty, "x").size() == 0);
}

TEST_CASE("bad npy files are refused") {
  scratch::check_refuses_non_files([](const auto& path) { return read_npy<float, 1>(path); });
  const std::string valid = npy(dictionary, six);
  for (std::size_t size = 0; size < valid.size(); ++size)
    check_text_refused(valid.substr(0, size), {size < 6                   ? "not an npy file"
                                               : size < valid.size() - 24 ? "truncated"
                                                                          : "bytes of elements, expected 24"});
  check_text_refused(valid + "x", {"has 25 bytes of elements", "expected 24"});
  check_text_refused("\x93NUMPX\x01", {"not an npy file"});
  check_text_refused(npy(dictionary, six, 4), {"version 4.0", "expected 1.0, 2.0 or 3.0"});
  check_text_refused(npy(dictionary, six, 0), {"version 0.0"});
  const auto header_refused = [](const std::string& header, std::initializer_list<std::string> words) {
    check_text_refused(npy(header, six), {"npy header"});
    check_text_refused(npy(header, six), words);
  };
  header_refused("", {"expected '{'"});
  header_refused("{}", {"'descr' is missing"});
  header_refused("{'descr': '<f4', 'shape': (2, 3)}", {"'fortran_order' is missing"});
  header_refused("{'descr': '<f4', 'fortran_order': False}", {"'shape' is missing"});
  header_refused("{'descr': '<f4', 'fortran_order': False, 'shape': (2, 3), 'x': 1}", {"'x' is unknown"});
  header_refused("{'descr': '<f4', 'descr': '<f4', 'fortran_order': False, 'shape': (2, 3)}",
                 {"'descr'", "appears twice"});
  header_refused("{'descr': '<f4', 'fortran_order': True, 'shape': (2, 3)}", {"Fortran order", "expected C order"});
  header_refused("{'descr': '<f4', 'fortran_order': Maybe, 'shape': (2, 3)}", {"neither True nor False"});
  for (const char* type : {">f4", "<i4", ">f2", "<c8", "|u1", "", "<f44"})
    header_refused("{'descr': '" + std::string(type) + "', 'fortran_order': False, 'shape': (2, 3)}",
                   {"type '" + std::string(type) + "'", "expected '<f2', '<f4' or '<f8'"});
  header_refused("{'descr': [('x', '<f4')], 'fortran_order': False, 'shape': (2, 3)}", {"expected a quoted text"});
  header_refused("{'descr: (2, 3)}", {"no end"});
  const auto shape_refused = [&](const std::string& shape, std::initializer_list<std::string> words) {
    header_refused("{'descr': '<f4', 'fortran_order': False, 'shape': " + shape + ", }\n", words);
  };
  shape_refused("(-2, 3)", {"extent of the shape is not a number"});
  shape_refused("(2.5, 3)", {"expected ')'"});
  shape_refused("(2, 3", {"not a number"});
  shape_refused("2, 3)", {"expected '('"});
  shape_refused("(4294967296, 4294967296)", {"product of the shape is too large"});
  shape_refused("(0, 4294967296, 4294967296)", {"product of the shape is too large"});
  shape_refused("(99999999999999999999999,)", {"extent of the shape is not a number"});
  shape_refused("(1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1,1)", {"more than 32 dimensions"});
  header_refused(dictionary + "x", {"expected nothing after"});
  for (const char* shape : {"()", "(6,)", "(1, 2, 3)"})
    check_text_refused(npy("{'descr': '<f4', 'fortran_order': False, 'shape': " + std::string(shape) + ", }", six),
                       {"has shape " + std::string(shape), "expected 2 dimensions"});
  check_text_refused(npy("{'descr': '<f4', 'fortran_order': False, 'shape': (1, 1000000000000)}", six),
                     {"has 24 bytes of elements", "expected 4000000000000"});
  check_text_refused(npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3)}", six),
                     {"has 24 bytes", "expected 48"});
}

TEST_CASE("damaged npy files are read or refused") {
  scratch::check_survives_damage(bytes_of(npy(dictionary, six)), 5000,
                                 [](auto bytes) { return read_npy<double, 2>(bytes, "x"); });
}

TEST_CASE("npy: half floats are read and written, rounded to the nearest") {
  const std::string halves = "{'descr': '<f2', 'fortran_order': False, 'shape': (6,), }\n";
  // numpy.array([1, -2, 65504, 2**-24, 0.1, 2**-14], dtype='<f2').tobytes()
  const std::string bytes("\x00\x3c\x00\xc0\xff\x7b\x01\x00\x66\x2e\x00\x04", 12);
  const auto array = read_npy<float, 1>(bytes_of(npy(halves, bytes)), "a.npy");
  CHECK(array(0) == 1.0f);
  CHECK(array(1) == -2.0f);
  CHECK(array(2) == 65504.0f);
  CHECK(array(3) == 0x1p-24f);
  CHECK(array(4) == 0.0999755859375f);
  CHECK(array(5) == 0x1p-14f);
  CHECK(read_npy<double, 1>(bytes_of(npy(halves, bytes)), "a.npy")(4) == 0.0999755859375);
  int other = 0;
  for (std::uint32_t bits = 0; bits < 0x10000; ++bits) {
    const float value = gonio::from_half(static_cast<std::uint16_t>(bits));
    other += std::isnan(value) || gonio::to_half(value) == bits ? 0 : 1;
  }
  CHECK(other == 0);
  const scratch::folder here;
  gonio::io::write_npy_halves(here / "h.npy", array);
  const std::string written = scratch::get(here / "h.npy");
  CHECK(written.size() == 128 + 12);
  CHECK(written.ends_with(bytes));
  CHECK(same(read_npy<float, 1>(here / "h.npy"), array));
  const xt::xtensor<float, 2> large{{1.0f, 65519.0f}, {7e4f, 0.0f}};
  check_refused([&] { return gonio::io::write_npy_halves(here / "l.npy", large), 0; },
                {"l.npy", "element 2 is 70000", "65504"});
  CHECK(here.entries() == 1);
}
