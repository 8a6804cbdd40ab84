/// gonio-papers-mpi under mpirun: the same tables and result files as gonio-papers, and continued results.

#include "papers/synthetic_networks.hpp"
#include "run_program.hpp"
#include <gonio/evaluate/test_materials.hpp>

#include <doctest/doctest.h>

#include <string>
#include <vector>

namespace {

tool_result in_ranks(int ranks, const std::string& arguments) {
  return run_program(GONIO_MPIEXEC, "-n " + std::to_string(ranks) + " '" GONIO_PAPERS_MPI "' " + arguments);
}

/// Synthetic materials with the names of the ten test materials, and four others.
struct database {
  scratch::folder folder;

  database() {
    std::vector<std::string> names = gonio::nielsen_test_materials();
    for (const char* name : {"a", "b", "c", "d"}) names.emplace_back(name);
    write_synthetic_networks(folder, names);
  }

  [[nodiscard]] std::string at(const char* name) const { return (folder / name).string(); }
};

/// Checks that state and output equal gonio-papers' for any number of ranks and any continuation.
void check_same(const database& given, const std::string& experiment) {
  CAPTURE(experiment);
  const std::string arguments = experiment + " --networks " + given.at("n.npy") + " --threads 1 --state ";
  const tool_result alone = run_program(GONIO_PAPERS, arguments + given.at("alone"));
  REQUIRE_MESSAGE(alone.exit_code == 0, alone.output);
  const std::string state = scratch::get(given.folder / "alone");
  for (const int ranks : {2, 3}) {
    const tool_result shared = in_ranks(ranks, arguments + given.at("shared"));
    CHECK_MESSAGE(shared.exit_code == 0, shared.output);
    CHECK(shared.output == alone.output);
    CHECK(scratch::get(given.folder / "shared") == state);
    scratch::fs::remove(given.folder / "shared");
  }
  // A killed job left some results, and half of one.
  scratch::put(given.folder / "shared", state.substr(0, state.size() / 2));
  const tool_result again = in_ranks(2, arguments + given.at("shared"));
  CHECK_MESSAGE(again.exit_code == 0, again.output);
  CHECK(again.output == alone.output);
  CHECK(run_program(GONIO_PAPERS, arguments + given.at("shared")).output == alone.output);
  scratch::fs::remove(given.folder / "shared");
  scratch::fs::remove(given.folder / "alone");
}

}  // namespace

TEST_CASE("gonio-papers-mpi: the table and the results of gonio-papers with 2 and 3 ranks") {
  const database given;
  check_same(given, "models --models phong --losses l2 --materials a b c blue-metallic-paint2");
  check_same(given, "directions --thin 9 20 -n 5 --sets published industry random");
}

TEST_CASE("gonio-papers-mpi: bad input is refused in one line") {
  const database given;
  for (const std::string& arguments : {std::string("models --networks /no/such/file.npy"),
                                       "directions --networks " + given.at("n.npy") + " --state " + given.at("")}) {
    const tool_result refused = in_ranks(2, arguments);
    CAPTURE(refused.output);
    CHECK(refused.exit_code == 2);
    const std::size_t first = refused.output.find("gonio-papers-mpi: ");
    REQUIRE(first != std::string::npos);
    CHECK(refused.output.find("gonio-papers-mpi: ", first + 1) == std::string::npos);
  }
}
