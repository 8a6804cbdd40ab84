/// Learning from streamed tables, and adding materials to a prior.

#include "../io/scratch.hpp"
#include "../io/synthetic_spectra.hpp"
#include "../json.hpp"
#include "../synthetic_materials.hpp"
#include "tool.hpp"
#include <gonio/io/materials/merl.hpp>
#include <gonio/io/materials/prior.hpp>
#include <gonio/io/materials/rgl.hpp>
#include <gonio/model/lambert.hpp>

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace {

/// A folder of tables; priors are written next to it.
class learning_folder {
 public:
  explicit learning_folder(Eigen::Index count)
      : set_(synthetic_materials(gonio::valid_cells(gonio::grid({18, 12, 18})), static_cast<std::size_t>(count))) {
    std::filesystem::create_directory(folder_ / "tables");
    for (Eigen::Index m = 0; m < count; ++m)
      gonio::io::write_merl(table(set_.names[static_cast<std::size_t>(m)]), set_.table(m));
  }

  [[nodiscard]] std::string at(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string table(const std::string& name) const { return at("tables/" + name + ".binary"); }
  [[nodiscard]] const gonio::material_set& set() const { return set_; }
  [[nodiscard]] std::string learn(const std::string& options) const {
    return "learn --merl " + at("tables") + " --thin 1 1 --components 8 " + options;
  }
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(std::filesystem::directory_iterator(folder_.path()), {});
  }

 private:
  scratch::folder folder_;
  gonio::material_set set_;
};

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

TEST_CASE("gonio learn: the same bytes for any number of threads, memory and scratch folder, and as in memory") {
  const learning_folder made(12);
  run(made.learn("-o " + made.at("one.prior") + " --threads 1"));
  std::filesystem::create_directory(made.at("elsewhere"));
  run(made.learn("-o " + made.at("other.prior") + " --threads 3 --memory 1 --scratch " + made.at("elsewhere")));
  CHECK(bytes_of(made.at("one.prior")) == bytes_of(made.at("other.prior")));
  CHECK(made.entries() == 4);  // tables, elsewhere, two priors
  const auto read = gonio::io::read_prior(made.at("one.prior"));
  std::vector<Eigen::Index> by_name;  // in the order of the files
  for (const std::string& name : read.names()) by_name.push_back(made.set().find(name));
  const auto in_memory = learn(made.set().subset(by_name), 8);
  const auto known = gonio::io::read_prior(gonio::io::write_prior(in_memory), "in memory");
  // The stored codes are the same, except where a value is on the border between two codes.
  const float step = known.components().cwiseAbs().maxCoeff() / 127.0f;
  CHECK((read.components() - known.components()).cwiseAbs().maxCoeff() <= 2 * step);
  CHECK((read.coefficients() - known.coefficients()).cwiseAbs().maxCoeff() < 1e-5f);
}

TEST_CASE("gonio learn --add-to: materials join a prior without the tables of the others") {
  const learning_folder made(12);
  run(made.learn("-o " + made.at("ten.prior") + " --exclude material-10 --exclude material-11"));
  std::filesystem::create_directory(made.at("new"));
  for (const char* name : {"material-10", "material-11"})
    std::filesystem::rename(made.table(name), made.at("new/" + std::string(name) + ".binary"));
  const std::string add = "learn --merl " + made.at("new") + " --components 8 --add-to " + made.at("ten.prior");
  const std::string told = run(add + " -o " + made.at("twelve.prior"));
  CHECK(told.find("kept 8 components of 10 materials of tables") != std::string::npos);
  CHECK(told.find("; then 2 materials of new") != std::string::npos);
  const auto ten = gonio::io::read_prior(made.at("ten.prior")), twelve = gonio::io::read_prior(made.at("twelve.prior"));
  CHECK(twelve.names().size() == 12);
  CHECK(twelve.names().back() == "material-11");
  CHECK(twelve.cells() == ten.cells());
  refuses(add + " -o " + made.at("ten.prior"), {"ten.prior"});  // also the input
  refuses(add + " --thin 1 1 -o " + made.at("x.prior"), {"--thin"});
  refuses(add + " --split -o " + made.at("x.prior"), {"--split"});
  refuses("learn --merl " + made.at("new") + " --add-to " + made.at("twelve.prior") + " -o " + made.at("x.prior"),
          {"material-10", "already"});
  refuses("learn --merl " + made.at("new") + " --add-to " + made.at("no.prior") + " -o " + made.at("x.prior"),
          {"no.prior"});
}

TEST_CASE("gonio learn --spectra: a column for each wavelength, which the prior and its users know") {
  const scratch::folder folder;
  const auto at = [&](const std::string& name) { return (folder / name).string(); };
  write_synthetic_spectra(folder / "paints", 0, 3, 4);
  const std::string learn = "learn --spectra --rgl " + at("paints") + " --thin 30 60 --components 8 ";
  const std::string told = run(learn + "-o " + at("one.prior") + " --threads 1");
  CHECK(told.find("3 materials of paints, at 4 wavelengths from 400 to 700 nm") != std::string::npos);
  run(learn + "--memory 1 --wavelengths 400:100:700 -o " + at("other.prior") + " --threads 3");
  CHECK(bytes_of(at("one.prior")) == bytes_of(at("other.prior")));
  const auto prior = gonio::io::read_prior(at("one.prior"));
  CHECK(prior.wavelengths() == std::vector<double>{400.0, 500.0, 600.0, 700.0});
  CHECK(prior.coefficients().rows() == 12);
  CHECK(read_json(run("info --json " + at("one.prior"))).at("wavelengths_nm").size() == 4);
  run(learn + "--wavelengths 450:75:600 -o " + at("between.prior"));
  CHECK(gonio::io::read_prior(at("between.prior")).wavelengths() == std::vector<double>{450.0, 525.0, 600.0});

  run("expand --prior " + at("one.prior") + " --name paint-1 --albedo-tolerance 0 -o " + at("paint.bsdf"));
  CHECK(gonio::io::read_rgl(at("paint.bsdf")).spectra->wavelengths == prior.wavelengths());
  run("expand --prior " + at("one.prior") + " --name paint-1 --weights 0.1 -o " + at("paint.binary"));
  refuses("expand --prior " + at("one.prior") + " --weights 1 --weights 2 -o " + at("x.binary"), {"--weights", "4"});
  CHECK(run("info --weights-of paint-1 " + at("one.prior")).find("600nm") != std::string::npos);
  run("design --prior " + at("one.prior") + " --count 2 -o " + at("two.csv"));

  write_synthetic_spectra(folder / "more", 3, 4, 4);
  run("learn --spectra --rgl " + at("more") + " --add-to " + at("one.prior") + " --components 8 -o " +
      at("four.prior"));
  CHECK(gonio::io::read_prior(at("four.prior")).coefficients().rows() == 16);
  const std::string add = "learn --rgl " + at("more") + " --add-to " + at("one.prior") + " -o " + at("x.prior");
  refuses(add, {"at 4 wavelengths", "in RGB"});
  refuses(add + " --spectra --wavelengths 400:50:700", {"at 4 wavelengths", "at 7 wavelengths"});
}

TEST_CASE("gonio learn --spectra refuses what are no spectra, or spectra of other wavelengths") {
  const scratch::folder folder;
  const auto at = [&](const std::string& name) { return (folder / name).string(); };
  write_synthetic_spectra(folder / "paints", 0, 1, 4);
  write_synthetic_spectra(folder / "others", 1, 2, 3);
  const std::string learn = "learn --rgl " + at("paints") + " -o " + at("x.prior");
  refuses(learn + " --wavelengths 400:100:700", {"--wavelengths", "--spectra"});
  refuses(learn + " --spectra --split", {"--split"});
  refuses(learn + " --spectra --rgl " + at("others"), {"paint-1.bsdf", "wavelengths differ", "--wavelengths"});
  refuses(learn + " --spectra --wavelengths 400:100:800", {"paint-0.bsdf", "from 400 to 800 nm"});
  for (const char* range :
       {"400", "400:100", "400:0:700", "700:10:400", "400:x:700", "400:10:700:1", "nan:1:2", "400:inf:700"})
    refuses(learn + " --spectra --wavelengths " + range, {"--wavelengths", "FIRST:STEP:LAST"});
  refuses(learn + " --spectra --wavelengths 400:0.01:700", {"--wavelengths", "at most 1024"});
  refuses(learn + " --spectra --merl " + at("paints"), {"--spectra", "--rgl"});
  gonio::io::write_rgl(folder / "paints" / "grey.bsdf", gonio::model::lambertian{gonio::rgb::Constant(0.5)});
  refuses(learn + " --spectra", {"grey.bsdf", "in RGB"});
  CHECK_FALSE(std::filesystem::exists(at("x.prior")));
}

TEST_CASE("gonio learn refuses tables that do not belong together, or cannot be read, by their names") {
  const learning_folder made(4);
  const std::string learn = made.learn("-o " + made.at("x.prior"));
  const auto second = [&](const std::string& bytes) {
    std::ofstream(made.table("material-1"), std::ios::binary) << bytes;
  };
  const std::string whole = bytes_of(made.table("material-1"));
  SUBCASE("of another grid") {
    gonio::io::write_merl(made.table("material-1"), synthetic_materials(small_cells(), 1).table(0));
    refuses(learn, {"material-1.binary", "valid cells differ"});
  }
  SUBCASE("with a value that is no number") {
    std::string broken = whole;
    for (std::size_t byte = 12; byte < broken.size(); ++byte) broken[byte] = '\xff';
    second(broken);
    refuses(learn, {"material-1.binary", "expected a finite number"});
  }
  SUBCASE("truncated") {
    second(whole.substr(0, whole.size() / 2));
    refuses(learn, {"material-1.binary", "expected"});
  }
  SUBCASE("a folder of the same name") {
    std::filesystem::remove(made.table("material-1"));
    std::filesystem::create_directory(made.table("material-1"));
    refuses(learn, {"material-1.binary"});
  }
  SUBCASE("none") {
    std::filesystem::create_directory(made.at("empty"));
    refuses("learn --merl " + made.at("empty") + " -o " + made.at("x.prior"), {"empty"});
  }
  CHECK_FALSE(std::filesystem::exists(made.at("x.prior")));
}
