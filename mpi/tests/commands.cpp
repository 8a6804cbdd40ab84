/// gonio-mpi under mpirun, as a user runs it: results equal to gonio's, ranks that die, ranks that disagree.

#include "io/scratch.hpp"
#include "io/synthetic_spectra.hpp"
#include "run_program.hpp"
#include "synthetic_materials.hpp"
#include <gonio/io/bytes/npy.hpp>
#include <gonio/io/materials/prior.hpp>

#include <doctest/doctest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace {

const std::string tool = std::string("'") + GONIO_MPI_TOOL + "' ";

/// Runs `gonio-mpi ARGUMENTS` in some ranks.
tool_result in_ranks(int ranks, const std::string& arguments) {
  return run_program(GONIO_MPIEXEC, "-n " + std::to_string(ranks) + ' ' + tool + arguments);
}

std::string run_alone(const std::string& arguments) {
  const auto result = run_program(GONIO_TOOL, arguments);
  REQUIRE_MESSAGE(result.exit_code == 0, arguments, ": ", result.output);
  return result.output;
}

std::string run_in(int ranks, const std::string& arguments) {
  const auto result = in_ranks(ranks, arguments);
  REQUIRE_MESSAGE(result.exit_code == 0, arguments, ": ", result.output);
  return result.output;
}

/// Checks for exit code 2, and that the program printed a single line, with these words; mpirun prints other lines.
void check_refused_by_all(const tool_result& result, std::initializer_list<const char*> words) {
  CAPTURE(result.output);
  CHECK(result.exit_code == 2);
  std::istringstream lines(result.output);
  std::string line, own;
  int count = 0;
  while (std::getline(lines, line))
    if (line.starts_with("gonio-mpi: ")) {
      own = line;
      ++count;
    }
  CHECK(count == 1);
  for (const char* word : words) CHECK(own.find(word) != std::string::npos);
}

/// Images of 900 x 1000 texels in 57 bands of 16 rows, and a small prior.
struct job {
  scratch::folder folder;

  job() {
    gonio::io::write_prior(folder / "small.prior",
                           learn(synthetic_materials(gonio::valid_cells(gonio::grid({18, 9, 12})), 12), 6));
    std::string list;
    for (int i = 0; i < 4; ++i) {
      std::mt19937 generator(static_cast<unsigned>(i));
      std::uniform_real_distribution<float> value(0.01f, 0.4f);
      xt::xtensor<float, 3> image(std::array<std::size_t, 3>{900, 1000, 3});
      for (float& each : image) each = value(generator);
      gonio::io::write_npy(folder / ("image-" + std::to_string(i) + ".npy"), image);
      list += std::string(i > 0 ? "," : "") + "{\"image\": \"image-" + std::to_string(i) +
              ".npy\", \"theta_h\": " + std::to_string(5 + 10 * i) + ", \"theta_d\": 20, \"phi_d\": 50}";
    }
    scratch::put(folder / "images.json", "{\"quantity\": \"brdf\", \"images\": [" + list + "]}");
  }

  [[nodiscard]] std::string command(const std::string& output) const {
    return "svbrdf '" + (folder / "images.json").string() + "' --prior '" + (folder / "small.prior").string() +
           "' --eta 2.5 -o '" + (folder / output).string() + "'";
  }

  /// Sets a value of the third image to NaN.
  void corrupt(std::size_t row) const {
    auto image = gonio::io::read_npy<float, 3>(folder / "image-2.npy");
    image(row, 7, 1) = std::nanf("");
    gonio::io::write_npy(folder / "image-2.npy", image);
  }
};

/// Returns the process of a rank of a job started by mpirun; 0 if there is none yet.
pid_t process_of_rank(pid_t mpirun, int rank) {
  std::ifstream children("/proc/" + std::to_string(mpirun) + "/task/" + std::to_string(mpirun) + "/children");
  pid_t child = 0;
  while (children >> child) {
    const std::string environment = scratch::get("/proc/" + std::to_string(child) + "/environ");
    const std::string words = '\0' + environment;
    if (words.find('\0' + ("OMPI_COMM_WORLD_RANK=" + std::to_string(rank)) + '\0') != std::string::npos) return child;
  }
  return 0;
}

/// Kills a rank of two once a file has grown. Returns mpirun's output.
tool_result kill_rank(int rank, const std::string& arguments, const scratch::fs::path& file,
                      const scratch::fs::path& output) {
  const std::string line = "exec '" GONIO_MPIEXEC "' -n 2 " + tool + arguments + " > '" + output.string() + "' 2>&1";
  const pid_t mpirun = ::fork();
  REQUIRE(mpirun >= 0);
  if (mpirun == 0) {
    ::execl("/bin/sh", "sh", "-c", line.c_str(), nullptr);
    ::_exit(127);
  }
  const auto has_grown = [&] {
    std::error_code none;
    const auto size = scratch::fs::file_size(file, none);
    return !none && size > 2000000;
  };
  int status = 0;
  bool has_ended = false;
  while (!has_grown() && !(has_ended = ::waitpid(mpirun, &status, WNOHANG) != 0))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  if (!has_ended) {
    if (const pid_t victim = process_of_rank(mpirun, rank); victim > 0) ::kill(victim, SIGKILL);
    ::waitpid(mpirun, &status, 0);
  }
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, scratch::get(output)};
}

}  // namespace

TEST_CASE("gonio-mpi svbrdf: the bytes of gonio svbrdf with 1, 2 and 3 ranks") {
  const job given;
  const std::string said = run_alone(given.command("map.gsv"));
  const std::string whole = scratch::get(given.folder / "map.gsv");
  for (const int ranks : {1, 2, 3}) {
    CHECK(run_in(ranks, given.command("ranks.gsv")) == said);
    CHECK(scratch::get(given.folder / "ranks.gsv") == whole);
    CHECK(!scratch::fs::exists(given.folder / "ranks.gsv.part"));
    scratch::fs::remove(given.folder / "ranks.gsv");
  }
  // Ranks continue an interrupted gonio.
  scratch::put(given.folder / "ranks.gsv.part", whole.substr(0, whole.size() / 2));
  CHECK(run_in(2, given.command("ranks.gsv")).find("resumed after band 28 of 57") != std::string::npos);
  CHECK(scratch::get(given.folder / "ranks.gsv") == whole);
}

TEST_CASE("gonio-mpi svbrdf: a rank that is killed ends the job, and the next goes on to the same bytes") {
  const job given;
  run_alone(given.command("map.gsv"));
  for (const int rank : {0, 1}) {
    const auto part = given.folder / "again.gsv.part";
    const tool_result killed = kill_rank(rank, given.command("again.gsv"), part, given.folder / "said.txt");
    if (killed.exit_code == 0) {
      MESSAGE("rank " << rank << " was faster than its end");
    } else {
      CAPTURE(killed.output);
      CHECK(killed.output.find("rank " + std::to_string(rank)) != std::string::npos);
      CHECK(killed.output.find("signal 9") != std::string::npos);
      if (rank == 1) CHECK(killed.output.find("the same command") != std::string::npos);
      CHECK(scratch::fs::exists(part));
      CHECK(run_in(3 - rank, given.command("again.gsv")).find("resumed after band") != std::string::npos);
    }
    CHECK(scratch::get(given.folder / "again.gsv") == scratch::get(given.folder / "map.gsv"));
    scratch::fs::remove(given.folder / "again.gsv");
  }
}

TEST_CASE("gonio-mpi svbrdf: bad input of any rank is refused in one line") {
  const job given;
  check_refused_by_all(in_ranks(2, "svbrdf nothing.json -o map.gsv"), {"nothing.json", "No such file"});
  check_refused_by_all(in_ranks(2, given.command("map.gsv") + " --et 3"), {"'--et'", "--eta"});
  // Rank 1 has the bands 1, 3, ...: row 20 is in band 1, which has rows from 16 on.
  given.corrupt(20);
  check_refused_by_all(in_ranks(2, given.command("map.gsv")), {"rank 1", "image-2.npy", "row 20, column 7"});
  CHECK(scratch::fs::exists(given.folder / "map.gsv.part"));
}

TEST_CASE("gonio-mpi: ranks that read different inputs are refused") {
  const job given, other;
  other.corrupt(0);  // the first row is compared
  scratch::fs::create_directory(given.folder / "here");
  scratch::fs::create_directory(given.folder / "there");
  // As on two machines: the same names, but other files.
  const auto on_two = [&](const std::string& arguments) {
    const auto half = [&](const char* folder) {
      return "-n 1 -wdir '" + (given.folder / folder).string() + "' " + tool + arguments;
    };
    return run_program(GONIO_MPIEXEC, half("here") + " : " + half("there"));
  };
  for (const char* folder : {"here", "there"})
    for (const char* name : {"images.json", "small.prior", "image-0.npy", "image-1.npy", "image-2.npy", "image-3.npy"})
      scratch::fs::copy_file(given.folder / name, given.folder / folder / name);
  const std::string svbrdf = "svbrdf images.json --prior small.prior --eta 2.5 -o map.gsv";
  CHECK(on_two(svbrdf).exit_code == 0);
  // Another image.
  auto image = gonio::io::read_npy<float, 3>(given.folder / "there/image-2.npy");
  image(0, 5, 0) += 0.1f;
  gonio::io::write_npy(given.folder / "there/image-2.npy", image);
  check_refused_by_all(on_two(svbrdf), {"different inputs", "rank 1's images"});
  // Another prior.
  gonio::io::write_prior(given.folder / "there/small.prior",
                         learn(synthetic_materials(gonio::valid_cells(gonio::grid({18, 9, 12})), 11), 6));
  check_refused_by_all(on_two(svbrdf), {"different inputs", "rank 1's prior"});
  check_refused_by_all(on_two("design -n 2 --prior small.prior -o two.csv"), {"different inputs", "rank 1's prior"});
  // A file that one rank lacks.
  scratch::fs::remove(given.folder / "there/images.json");
  check_refused_by_all(on_two(svbrdf), {"rank 1: ", "images.json"});
  // Other options.
  const std::string design = "-n 1 " + tool + "design --prior small.prior -o two.csv";
  check_refused_by_all(run_program(GONIO_MPIEXEC, design + " -n 2 : " + design + " -n 3"),
                       {"different inputs", "rank 1's command line"});
}

TEST_CASE("gonio-mpi design: the directions of gonio design") {
  const job given;
  const auto design = [&](const std::string& options, const char* output) {
    return "design --prior '" + (given.folder / "small.prior").string() + "' " + options + " -o '" +
           (given.folder / output).string() + "'";
  };
  for (const char* options : {"-n 5", "-n 3 --search exchange", "-n 2 --criterion d-optimal", "--published 5",
                              "-n 2 --geometry near-field --step 30", "-n 3 --noise 0.05 --seed 4"}) {
    CAPTURE(options);
    const std::string said = run_alone(design(options, "alone.csv"));
    for (const int ranks : {2, 3}) {
      CHECK(run_in(ranks, design(options, "ranks.csv")) == said);
      CHECK(scratch::get(given.folder / "ranks.csv") == scratch::get(given.folder / "alone.csv"));
    }
  }
  check_refused_by_all(in_ranks(2, design("-n 0", "none.csv")), {"cannot choose 0"});
  // Ranks continue the sweeps of a gonio that finished but could not write the requested page.
  const std::string exchanged = "-n 5 --search exchange";
  const std::string said = run_alone(design(exchanged, "alone.csv"));
  const auto part = given.folder / "ranks.csv.part";
  const auto page = given.folder / "page.html";
  scratch::fs::create_symlink("/dev/full", page);
  CHECK(run_program(GONIO_TOOL, design(exchanged + " --report '" + page.string() + '\'', "ranks.csv")).exit_code == 2);
  const std::string whole = scratch::get(part);
  REQUIRE(std::ranges::count(whole, '\n') > 10);
  for (const std::size_t size : {whole.size(), whole.size() / 2, std::size_t{3}}) {
    CAPTURE(size);
    scratch::put(part, whole.substr(0, size));
    const std::string again = run_in(2, design(exchanged, "ranks.csv"));
    CHECK(again.starts_with("resumed after sweep ") == (size > 3));
    CHECK(again.ends_with(said));
    CHECK(scratch::get(given.folder / "ranks.csv") == scratch::get(given.folder / "alone.csv"));
    CHECK(!scratch::fs::exists(part));
  }
  scratch::put(part, whole);
  check_refused_by_all(in_ranks(2, design("-n 4", "ranks.csv")), {"ranks.csv.part", "other inputs or options"});
}

TEST_CASE("gonio-mpi learn: the prior of gonio learn, bad files are refused") {
  const scratch::folder folder;
  const auto file = [&](const char* name) { return '\'' + (folder / name).string() + '\''; };
  scratch::fs::create_directory(folder / "tables");
  scratch::fs::create_directory(folder / "more");
  for (const char* name : {"red-paint", "blue-rubber", "gold-metal"})
    run_alone(std::string("expand --formula ") + name + " -o " + file("tables") + '/' + name + ".binary");
  scratch::fs::copy_file(folder / "tables/gold-metal.binary", folder / "more/gold.binary");
  const std::string both = " --merl " + file("tables") + ' ' + file("more");
  // Each rank reads a single folder; two folders are shared.
  for (const std::string& sources : {" --merl " + file("tables") + " --components 4", both + " --components 4"}) {
    const std::string said = run_alone("learn" + sources + " -o " + file("alone.prior"));
    for (const int ranks : {2, 3}) {
      CHECK(run_in(ranks, "learn" + sources + " -o " + file("ranks.prior")) == said);
      CHECK(scratch::get(folder / "ranks.prior") == scratch::get(folder / "alone.prior"));
    }
  }
  scratch::put(folder / "tables/blue-rubber.binary", "no table");
  check_refused_by_all(in_ranks(2, "learn" + both + " -o " + file("none.prior")), {"blue-rubber.binary"});
  CHECK(!scratch::fs::exists(folder / "none.prior"));
}

TEST_CASE(
    "gonio-mpi learn: learns from spectra, too, and refuses folders whose wavelengths differ, even if different ranks "
    "read them") {
  const scratch::folder folder;
  const auto file = [&](const char* name) { return '\'' + (folder / name).string() + '\''; };
  write_synthetic_spectra(folder / "paints", 0, 2, 4);
  write_synthetic_spectra(folder / "more", 2, 4, 4);
  write_synthetic_spectra(folder / "others", 4, 5, 3);
  const std::string learn = "learn --spectra --thin 30 60 --components 6 --rgl " + file("paints") + ' ';
  const std::string said = run_alone(learn + file("more") + " -o " + file("alone.prior"));
  CHECK(run_in(2, learn + file("more") + " -o " + file("ranks.prior")) == said);
  CHECK(scratch::get(folder / "ranks.prior") == scratch::get(folder / "alone.prior"));
  check_refused_by_all(in_ranks(2, learn + file("others") + " -o " + file("none.prior")),
                       {"paint-4.bsdf", "wavelengths differ"});
  CHECK(!scratch::fs::exists(folder / "none.prior"));
}

TEST_CASE("gonio-mpi: what was sent is printed") {
  const job given;
  const std::string said = run_in(2, given.command("map.gsv") + " --traffic");
  CHECK(said.find("rank 0 sent ") != std::string::npos);
  CHECK(said.find("rank 1 sent ") != std::string::npos);
  CHECK(run_in(1, given.command("map.gsv") + " --traffic").find("rank 0 sent 0 messages, 0 bytes") !=
        std::string::npos);
}
