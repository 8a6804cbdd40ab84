#include "job.hpp"

#include "ranks_team.hpp"
#include "tool/pages/fixed.hpp"
#include <gonio/core/error.hpp>
#include <gonio/io/bytes/file.hpp>
#include <gonio/mpi/ranks.hpp>

#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <iostream>
#include <optional>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace cli {

namespace {

/// During its lifetime, discards this process's standard output and captures its standard error.
class silence {
 public:
  silence() : out_(std::cout.rdbuf(nullptr)), error_(std::cerr.rdbuf(unsaid_.rdbuf())) {}
  silence(const silence&) = delete;
  silence& operator=(const silence&) = delete;
  ~silence() {
    std::cout.rdbuf(out_);
    std::cerr.rdbuf(error_);
  }

  /// Returns the first line that it captured from standard error.
  [[nodiscard]] std::string complaint() const {
    const std::string all = unsaid_.str();
    return all.substr(0, all.find('\n'));
  }

 private:
  std::stringstream unsaid_;
  std::streambuf *out_, *error_;
};

std::string last_words;  // the program's message if a signal ends it

/// Handles the signal that mpirun sends to the remaining ranks after one has died.
extern "C" void end_with_the_job(int signal) {
  static_cast<void>(!::write(STDERR_FILENO, last_words.data(), last_words.size()));
  gonio::io::remove_unfinished_files();
  ::raise(signal);  // its handler is again the default of the system
}

void end_with_a_sentence_on_signals(const std::string& program) {
  last_words = program +
               ": the job ended before its work was done: run the same command again, with any number of ranks, "
               "to resume\n";
  for (const int signal : {SIGINT, SIGTERM}) {
    struct sigaction ours {};
    ours.sa_handler = end_with_the_job;
    ours.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
    ::sigaction(signal, &ours, nullptr);
  }
}

struct rank_cost {
  gonio::mpi::traffic sent;
  double processor_seconds = 0.0;  ///< of all threads
};

rank_cost cost_of(const gonio::mpi::ranks& ranks) {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return {ranks.sent(), seconds(used.ru_utime) + seconds(used.ru_stime)};
}

/// Prints "rank 1 sent 12 messages, 3456789 bytes; 12.3 s of processor time, 0.4 s of it in MPI" for each rank.
void print_traffic(const gonio::mpi::ranks& ranks) {
  const auto all = ranks.gather(gonio::mpi::bytes_of(cost_of(ranks)));
  for (std::size_t rank = 0; rank < all.size(); ++rank) {
    const auto cost = gonio::mpi::number_of<rank_cost>(all[rank]);
    std::cout << "rank " << rank << " sent " << cost.sent.messages << " messages, " << cost.sent.bytes << " bytes; "
              << fixed(cost.processor_seconds, 2) << " s of processor time, " << fixed(cost.sent.processor_seconds, 2)
              << " s of it in MPI\n";
  }
}

int run(const job& what, const gonio::mpi::ranks& ranks, std::span<char*> given, const std::optional<silence>& unsaid) {
  const ranks_team all(ranks);
  const std::vector<std::string> words(given.begin(), given.end());
  bool has_begun = false, prints_traffic = false;
  program app(what.name, what.description, GONIO_VERSION);
  app.extend_subcommands(
      [&](command& added) {
        added.add_flag("--traffic", prints_traffic,
                       "Print the messages and bytes that each rank sent, and its processor time");
      },
      [&](const std::function<void()>& work) {
        has_begun = true;
        ranks.together([] {});  // checks that each rank has understood its command line
        ranks.agree_on(checksum_of(std::span(words).subspan(1)), "command line");
        work();
        if (prints_traffic) print_traffic(ranks);
      });
  what.add(app, words, all);
  const int code = app.run(static_cast<int>(given.size()), given.data());
  if (has_begun) return code;
  try {
    const std::string complaint = unsaid ? unsaid->complaint() : "";
    ranks.together([&] { gonio::refuse(complaint.empty() ? "was given no work" : complaint); });
  } catch (const gonio::error&) {  // already printed
  }
  return code;
}

}  // namespace

int run_in_ranks(int argc, char** argv, const job& what) {
  const gonio::mpi::ranks ranks;
  // Only rank 0 prints.
  std::optional<silence> unsaid;
  if (ranks.is_first())
    end_with_a_sentence_on_signals(what.name);
  else
    unsaid.emplace();
  const int code = run(what, ranks, std::span(argv, static_cast<std::size_t>(argc)), unsaid);
  if (code != 0 && !ranks.failed_together() && ranks.size() > 1) {
    const std::string complaint = unsaid ? unsaid->complaint() : "";
    unsaid.reset();
    if (!complaint.empty()) std::cerr << complaint << std::endl;  // before the job ends
    ranks.abort(code);
  }
  return ranks.is_first() ? code : 0;  // rank 0 passes it to mpirun
}

}  // namespace cli
