#pragma once
/// Who does a command's work: this process alone, or all processes of a job together (mpi/programs).

#include <gonio/core/parallel.hpp>
#include <gonio/solve/row_groups.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cli {

/// The processes that run the same command. This one is a team of one process; a larger one overrides all. Who uses it
/// calls the same functions in the same order in each process.
class team {
 public:
  team() = default;
  team(const team&) = delete;
  team& operator=(const team&) = delete;
  virtual ~team() = default;

  [[nodiscard]] bool is_alone() const { return size() == 1; }
  /// One process writes the command's files and prints what it found.
  [[nodiscard]] virtual bool writes() const { return true; }

  /// Threads of this process: those that were asked for, or its share of the machine's cores.
  [[nodiscard]] virtual gonio::thread_count threads(gonio::thread_count asked) const { return asked; }

  /// Work of each process. What it throws in one is thrown in all.
  virtual void together(const std::function<void()>& work) const { work(); }

  /// Throws gonio::error in all processes unless they all have read this, the checksum of an input that is called
  /// `what`.
  virtual void agree_on(std::uint32_t checksum, const std::string& what) const {
    static_cast<void>(checksum);
    static_cast<void>(what);
  }

  /// The part of a range of numbers from 0 on that is this process' to look at; it begins at a multiple of a block.
  [[nodiscard]] virtual gonio::block share_of(Eigen::Index count, Eigen::Index block_size) const {
    static_cast<void>(block_size);
    return {0, count};
  }
  /// Of what each process found best in its share, a value and its number, the number with the lowest value; of equal
  /// ones the lowest.
  [[nodiscard]] virtual Eigen::Index best(double value, Eigen::Index number) const {
    static_cast<void>(value);
    return number;
  }

  /// How passes over groups of rows are shared.
  [[nodiscard]] virtual gonio::shared_groups groups() const { return {}; }

  /// Processes, and which of them this is.
  [[nodiscard]] virtual std::size_t size() const { return 1; }
  [[nodiscard]] virtual std::size_t number() const { return 0; }
  /// Numbers for each of some rows, as many in each process: of each process' those that are of this one's groups, and
  /// 0 for other rows.
  [[nodiscard]] virtual std::vector<std::vector<float>> exchange_rows(std::vector<float> own, Eigen::Index rows) const {
    static_cast<void>(rows);
    return {std::move(own)};
  }

  /// The number of the process that writes.
  [[nodiscard]] virtual Eigen::Index number_of_writer(Eigen::Index number) const { return number; }

  using part = std::vector<std::byte>;
  /// The text of the process that writes.
  [[nodiscard]] virtual std::string text_of_writer(std::string text) const { return text; }
  /// What one process computes, that with the number `turn` modulo their number. The one that writes waits for it;
  /// others go on with nothing.
  [[nodiscard]] virtual std::optional<part> compute_in_turn(std::size_t turn,
                                                            const std::function<part()>& compute) const {
    static_cast<void>(turn);
    return compute();
  }
  /// `compute(i)` for each i of a range, each in one of the processes; the one that writes takes the parts in order.
  /// The next is computed while one is taken. Throws what either throws, once neither is at work.
  virtual void compute_in_order(gonio::block range, const std::function<part(Eigen::Index)>& compute,
                                const std::function<void(Eigen::Index, part)>& take) const;
};

[[nodiscard]] team::part bytes_of(std::string_view text);
[[nodiscard]] std::string text_of(const team::part& bytes);

/// This process alone.
[[nodiscard]] const team& alone();

/// The checksum of some words and where each ends.
[[nodiscard]] std::uint32_t checksum_of(std::span<const std::string> words);

/// Throws gonio::error in all processes unless they all read the same bytes from a file, or from none.
void agree_on_file(const team& processes, const std::filesystem::path& path, const std::string& what);

}  // namespace cli
