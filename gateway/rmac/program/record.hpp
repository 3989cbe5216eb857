#pragma once

#include <cstddef>
#include <fstream>
#include <string>
#include <vector>

#include "gateway/rmac/wire/failure.hpp"
#include "gateway/rmac/wire/notes.hpp"

namespace rmac::cli {

/// Writes the setpoint record: a header, then one row a cycle, every number with all its digits. A mechanism with
/// another number of joints gets a file of its own, `name-2.csv` and so on, because its columns differ. Where no drives
/// ran, samples have no measured positions, and the record has no columns for them.
class Record {
 public:
  explicit Record(std::string file) : file_(std::move(file)) {}

  /// Makes (empties) the file, so that a path that cannot be written is known before anything moves.
  [[nodiscard]] Result<> open();
  [[nodiscard]] Result<> add(const JointSample& sample);
  [[nodiscard]] Result<> close();

  [[nodiscard]] std::size_t rows() const noexcept { return rows_; }
  [[nodiscard]] const std::vector<std::string>& files() const noexcept { return files_; }
  /// Cycles that the appliance did not send: differences over such a gap mean nothing.
  [[nodiscard]] std::int64_t missing_cycles() const noexcept { return missing_; }

 private:
  [[nodiscard]] Result<> start_file(std::size_t joints, bool measured);
  [[nodiscard]] std::string name_of(std::size_t number) const;

  std::string file_;
  std::vector<std::string> files_;
  std::ofstream output_;
  std::string row_;
  std::size_t joints_ = 0, rows_ = 0;
  std::int64_t last_cycle_ = -1, missing_ = 0;
};

}  // namespace rmac::cli
