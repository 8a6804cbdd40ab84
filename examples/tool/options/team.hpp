#pragma once
/// The processes that do a command's work: this one alone, or all processes of a job (mpi/programs).

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

/// The processes that run the same command. This class is a team of one process; a larger one overrides all functions.
/// Every process must call the same functions in the same order.
class team {
 public:
  team() = default;
  team(const team&) = delete;
  team& operator=(const team&) = delete;
  virtual ~team() = default;

  [[nodiscard]] bool is_alone() const { return size() == 1; }
  /// Does this process write the command's files and print its results? Only one does.
  [[nodiscard]] virtual bool writes() const { return true; }

  /// Returns the threads of this process: as requested, or its share of the machine's cores.
  [[nodiscard]] virtual gonio::thread_count threads(gonio::thread_count asked) const { return asked; }

  /// Runs the work of each process. An exception in one process is thrown in all.
  virtual void together(const std::function<void()>& work) const { work(); }

  /// Throws gonio::error in all processes unless they have the same checksum of an input, which errors call `what`.
  virtual void agree_on(std::uint32_t checksum, const std::string& what) const {
    static_cast<void>(checksum);
    static_cast<void>(what);
  }

  /// Returns this process' share of the numbers below `count`; it begins at a multiple of `block_size`.
  [[nodiscard]] virtual gonio::block share_of(Eigen::Index count, Eigen::Index block_size) const {
    static_cast<void>(block_size);
    return {0, count};
  }
  /// Returns the `number` passed with the lowest `value` of all processes; of equal values, the lowest number.
  [[nodiscard]] virtual Eigen::Index best(double value, Eigen::Index number) const {
    static_cast<void>(value);
    return number;
  }

  /// Returns how the processes share passes over groups of rows.
  [[nodiscard]] virtual gonio::shared_groups groups() const { return {}; }

  /// `size` is the number of processes, `number` the number of this process, from 0.
  [[nodiscard]] virtual std::size_t size() const { return 1; }
  [[nodiscard]] virtual std::size_t number() const { return 0; }
  /// Exchanges values of `rows` rows; each process passes the same number of values. Returns one list for each process:
  /// of this one, all its values; of another one, its values in this process' row groups and 0 in other rows.
  [[nodiscard]] virtual std::vector<std::vector<float>> exchange_rows(std::vector<float> own, Eigen::Index rows) const {
    static_cast<void>(rows);
    return {std::move(own)};
  }

  /// Returns the number that the writing process passed.
  [[nodiscard]] virtual Eigen::Index number_of_writer(Eigen::Index number) const { return number; }

  using part = std::vector<std::byte>;
  /// Returns the text of the writing process.
  [[nodiscard]] virtual std::string text_of_writer(std::string text) const { return text; }
  /// Calls `compute` in process number `turn` modulo `size()` only. The writing process waits for the
  /// result; processes that neither write nor compute return at once, without a result.
  [[nodiscard]] virtual std::optional<part> compute_in_turn(std::size_t turn,
                                                            const std::function<part()>& compute) const {
    static_cast<void>(turn);
    return compute();
  }
  /// Calls `compute(i)` for each i of a range, in any of the processes, and `take(i, part)` in order in the writing
  /// process. The next part is computed while one is taken. After both have ended, throws their exceptions.
  virtual void compute_in_order(gonio::block range, const std::function<part(Eigen::Index)>& compute,
                                const std::function<void(Eigen::Index, part)>& take) const;
};

[[nodiscard]] team::part bytes_of(std::string_view text);
[[nodiscard]] std::string text_of(const team::part& bytes);

/// This process alone.
[[nodiscard]] const team& alone();

/// Returns a checksum of words that also depends on where each word ends.
[[nodiscard]] std::uint32_t checksum_of(std::span<const std::string> words);

/// Throws gonio::error in all processes unless all read the same bytes from the file, or all have no file.
void agree_on_file(const team& processes, const std::filesystem::path& path, const std::string& what);

}  // namespace cli
