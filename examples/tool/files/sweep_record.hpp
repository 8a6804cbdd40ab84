#pragma once
/// A file beside a search's output with the results so far, from which the next run resumes.

#include "tool/options/team.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <vector>

namespace cli {

/// The best candidate of each sweep of a search, in order. These candidates determine the search: with those of an
/// earlier run, it reaches the same state without repeating the sweeps. The file is text: a line that identifies the
/// search, and a line for each sweep.
class sweep_record {
 public:
  /// The record of a search that writes `output`: the file `output`.part. `checksum` covers all inputs of the result.
  /// Throws gonio::error in all processes if the file was begun with another checksum. There is no file before the
  /// first sweep, nor if the output is not a regular file, such as a pipe.
  sweep_record(const std::filesystem::path& output, std::uint32_t checksum, const team& processes);

  /// Returns the result of the next sweep, from an earlier run or computed now. Throws gonio::error, which names the
  /// file, if the earlier run names none of the search's `candidates`.
  [[nodiscard]] Eigen::Index next(const std::function<Eigen::Index()>& sweep, Eigen::Index candidates);
  /// Returns the number of sweeps of earlier runs.
  [[nodiscard]] std::size_t earlier() const noexcept { return earlier_.size(); }
  /// Removes the file, once the output is written.
  void remove();

 private:
  void append(Eigen::Index best);

  std::filesystem::path path_;  ///< empty if there is no file
  std::string head_;
  std::vector<Eigen::Index> earlier_;
  std::size_t done_ = 0;
  bool writes_;
  std::ofstream file_;
};

}  // namespace cli
