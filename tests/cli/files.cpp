/// No command overwrites its own input, or writes a file with the wrong extension for its format.

#include "../io/scratch.hpp"
#include "tool.hpp"

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <string>
#include <thread>
#include <vector>

namespace {

/// A folder with a small file of every kind that commands read. No command gets far enough to read their content.
struct given_files {
  scratch::folder folder;

  given_files() {
    for (const char* name : {"s.csv", "d.csv", "t.binary", "t.binary.gz", "u.npy", "p.prior", "l.png", "e.hdr",
                             "a.scan", "m.json", "n.txt", "x.ply", "y.obj", "z.shapes", "b.pbrt", "c.xml"})
      scratch::put(folder / name, "precious");
    std::filesystem::create_directory(folder / "tables");
    scratch::put(folder / "tables" / "t.binary", "precious");
    std::filesystem::create_symlink("s.csv", folder / "link.csv");
    std::filesystem::create_hard_link(folder / "s.csv", folder / "hard.csv");
  }

  /// Runs a command in the folder. It must refuse its files and leave them unchanged.
  void refuses(const std::string& arguments, std::initializer_list<const char*> words) const {
    CAPTURE(arguments);
    const auto result =
        run_program("/bin/sh", "-c 'cd " + folder.path().string() + " && " + GONIO_TOOL + " " + arguments + "'");
    CAPTURE(result.output);
    CHECK(result.exit_code == 2);
    CHECK(std::ranges::count(result.output, '\n') == 1);
    for (const char* word : words) CHECK(result.output.find(word) != std::string::npos);
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
      if (entry.is_directory()) continue;
      ++files;
      CHECK(scratch::get(entry.path()) == "precious");
    }
    CHECK(files == 19);
  }
};

}  // namespace

TEST_CASE("no command writes over what it reads") {
  const given_files given;
  const auto refuses = [&](const std::string& arguments, const char* option) {
    given.refuses(arguments, {"would overwrite the input ", option});
  };
  refuses("design --start s.csv -o s.csv", "--start");
  refuses("sample t.binary --directions d.csv -o d.csv", "--directions");
  refuses("reconstruct u.npy -o u.npy", "samples");
  refuses("reconstruct s.csv --method correction --history s.csv", "samples");
  refuses("reconstruct s.csv --method correction --iteration-figure . --truth iterations.png", "--truth");
  refuses("reconstruct s.csv --method linear --merl tables -o tables/t.binary", "--merl");
  refuses("reconstruct s.csv --method linear --merl tables -o tables/new.binary", "--merl");
  refuses("reconstruct s.csv --method linear --networks u.npy -o u.npy", "--networks");
  refuses("fit t.binary -o t.binary", "measurements");
  refuses("fit c.xml --mitsuba c.xml", "measurements");
  refuses("fit b.pbrt --pbrt b.pbrt", "measurements");
  refuses("fit l.png --image l.png", "measurements");
  refuses("render l.png -o l.png", "tables");
  refuses("render t.binary l.png -o l.png", "tables");
  refuses("render t.binary --environment l.png -o l.png", "--environment");
  refuses("learn --networks p.prior -o p.prior", "--networks");
  refuses("expand --networks u.npy --name a -o u.npy", "--networks");
  refuses("expand --prior u.npy --name a -o u.npy", "--prior");
  refuses("plan l.png --image l.png", "directions");
  refuses("near-field e.hdr s.csv -o s.csv", "images");
  refuses("near-field e.hdr n.txt --labels l.png --prior l.png -o new.csv", "--prior");
  refuses("lab plan d.csv -o d.csv", "directions");
  refuses("lab scan a.scan --white -o a.scan", "plan");
  refuses("lab scan d.csv --material a.scan -o a.scan", "--material");
  refuses("lab replay a.scan -o a.scan", "manifest");
  refuses("lab calibrate s.csv --reference a.scan -o s.csv", "material");
  refuses("lab calibrate a.scan --reference s.csv -o s.csv", "--reference");
  refuses("lab calibrate a.scan --reference s.csv --response s.csv -o new.csv", "--reference");
  refuses("lab probe e.hdr -o e.hdr", "environment");
  refuses("lab unwrap e.hdr -o e.hdr", "image");
  refuses("lab unwrap l.png --image l.png -o new.hdr", "image");
  refuses("lab unwrap l.png --truth e.hdr -o e.hdr", "--truth");
}

TEST_CASE("a file is the same by whatever way it is named") {
  const given_files given;
  for (const char* name : {"link.csv", "hard.csv", "./s.csv", "tables/../s.csv"})
    given.refuses(std::string("lab plan s.csv -o ") + name, {"would overwrite the input directions", name});
  given.refuses("lab plan link.csv -o \"$PWD/s.csv\"", {"would overwrite the input directions"});
}

TEST_CASE("no command writes two things into one file, be it there or not") {
  const given_files given;
  given.refuses("lab calibrate a.scan --reference m.json --response new.csv -o ./new.csv",
                {"--output ./new.csv", "is also written by --response"});
  given.refuses("fit s.csv -o new.npy --image new.png --pbrt b.pbrt --mitsuba tables/../new.png",
                {"--mitsuba", "expected a name that ends in .xml"});
  given.refuses("reconstruct s.csv --method correction --iteration-figure tables --history tables/history.csv",
                {"is also written by "});
}

TEST_CASE("a name that its format does not have is refused") {
  const given_files given;
  const auto refuses = [&](const std::string& arguments, const char* expected) {
    given.refuses(arguments, {"expected a name that ends in ", expected});
  };
  refuses("reconstruct s.csv -o x.exr", "--output x.exr: expected a name that ends in .binary or .npy");
  refuses("reconstruct s.csv -o x.binary.gz", ".binary or .npy");
  refuses("reconstruct s.csv -o x", ".binary or .npy");
  refuses("reconstruct s.csv --image x.jpg", "--image x.jpg: expected a name that ends in .png");
  refuses("reconstruct s.csv --method correction --history x.png", ".csv");
  refuses("render t.binary -o x.jpg", ".png");
  refuses("fit s.csv --image x.jpg", ".png");
  refuses("fit s.csv --pbrt x.txt", ".pbrt");
  refuses("fit s.csv --mitsuba x.txt", ".xml");
  refuses("fit s.csv -o x.csv", ".binary or .npy");
  refuses("expand --formula red-paint -o x.exr", ".binary or .npy");
  refuses("learn --merl tables -o x.binary", ".prior");
  refuses("design -o x.txt", ".csv");
  refuses("sample t.binary --count 3 -o x.binary", ".csv");
  refuses("plan d.csv --image x.pdf", ".png");
  refuses("near-field e.hdr n.txt -o x.hdr", ".csv");
  refuses("near-field e.hdr n.txt --labels x.jpg -o x.csv", ".png");
  refuses("lab plan d.csv -o x.scan", ".csv");
  refuses("lab scan d.csv --white -o x.csv", ".scan");
  refuses("lab replay m.json -o x.csv", ".scan");
  refuses("lab calibrate a.scan --reference a.scan -o x.scan", ".csv");
  refuses("lab calibrate a.scan --reference a.scan --response x.scan -o x.csv", ".csv");
  refuses("lab probe e.hdr -o x.png", ".hdr");
  refuses("lab unwrap e.hdr -o x.png", ".hdr");
  refuses("lab unwrap e.hdr --image x.hdr -o y.hdr", ".png");
}

TEST_CASE("a place where nothing can be written is refused before the work") {
  const given_files given;
  given.refuses("design -o absent/x.csv", {"--output absent/x.csv", "there is no folder"});
  given.refuses("design -o s.csv/x.csv", {"s.csv/x.csv", "there is no folder"});
  std::filesystem::create_directory(given.folder / "folder.csv");
  given.refuses("design -o folder.csv", {"folder.csv", "is a directory"});
}
