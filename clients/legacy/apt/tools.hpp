#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "clients/legacy/apt/statements/arguments.hpp"
#include "clients/legacy/program/writer.hpp"

namespace rmac::apt {

/// Which tool is in the spindle, and which one the program means to cut with.
class Tools {
 public:
  explicit Tools(legacy::Writer& writer) : writer_(writer) {}

  /// LOADTL/n,… and LOAD/TOOL,n,… What stands behind the number is of offsets: the appliance's Z is the tip's.
  void load(Arguments& arguments);
  /// SELECT/TOOL,n and SELCTL/n, which bring the next tool near: the appliance does so when it changes.
  static void select(Arguments& arguments);
  /// TOOLNO/n,…: what CAM systems describe before they load it.
  void describe(Arguments& arguments);
  /// TOOL PATH/name,TOOL,tool.
  void begin_path(const Statement& statement);
  /// Refuses a motion with another tool than the one that the program describes.
  void require_meant(std::size_t place) const;

 private:
  legacy::Writer& writer_;
  std::optional<int> loaded_, described_;
  std::string of_path_;
  bool loaded_since_path_ = false, path_has_another_ = false;
};

}  // namespace rmac::apt
