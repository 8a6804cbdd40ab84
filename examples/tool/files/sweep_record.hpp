#pragma once
/// What a search has found so far, in a file beside its output, so that the next run goes on from it.

#include "tool/options/team.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <vector>

namespace cli {

/// The best candidate of each sweep of a search, in order. A search is determined by these: with those of an earlier
/// run it comes to where that was, without its sweeps. The file is text: a line of what is searched for, and a line
/// for each sweep.
class sweep_record {
 public:
  /// Of a search that writes `output`, in its folder: output.part. `checksum` is of all that the result depends on.
  /// Throws gonio::error in all processes if the file was begun with another one. There is no file where the output is
  /// none, a pipe say, and until the first sweep.
  sweep_record(const std::filesystem::path& output, std::uint32_t checksum, const team& processes);

  /// What the next sweep has found, in an earlier run or now.
  [[nodiscard]] Eigen::Index next(const std::function<Eigen::Index()>& sweep);
  /// Sweeps of earlier runs.
  [[nodiscard]] std::size_t earlier() const noexcept { return earlier_.size(); }
  /// Once the output is written.
  void remove();

 private:
  void append(Eigen::Index best);

  std::filesystem::path path_;  ///< empty where there is none
  std::string head_;
  std::vector<Eigen::Index> earlier_;
  std::size_t done_ = 0;
  bool writes_;
  std::ofstream file_;
};

}  // namespace cli
