#include "clients/legacy/apt/tools.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace rmac::apt {

namespace {

constexpr int kMostTool = 9999;

/// What may stand behind the tool's number, and means nothing to a machine that knows its tools.
void pass_offsets(Arguments& arguments) {
  static constexpr std::array<std::string_view, 14> kWords{"ADJUST", "ZOFF", "OSETNO", "OFFSET", "LENGTH",
                                                           "IN",     "MILL", "DRILL",  "NOTE",   "AUTO",
                                                           "HOLDER", "HEAD", "PLUS",   "SETOOL"};
  while (!arguments.done()) {
    if (arguments.has_number()) {
      static_cast<void>(arguments.number("a number"));
      continue;
    }
    const std::string& word = arguments.word("ADJUST, LENGTH or their like");
    if (std::ranges::find(kWords, word) == kWords.end())
      refuse(arguments.last_place(), fmt::format("{}: {} is not understood here", arguments.major(), word));
  }
}

}  // namespace

void Tools::load(Arguments& arguments) {
  if (arguments.major() == "LOAD" && !arguments.take("TOOL"))
    refuse(arguments.next_place(), "LOAD is taken as LOAD/TOOL,n");
  loaded_ = arguments.integer("a tool's number", kMostTool);
  pass_offsets(arguments);
  described_ = loaded_;
  loaded_since_path_ = true;
  path_has_another_ = false;
  writer_.change_tool(*loaded_);
}

void Tools::select(Arguments& arguments) {
  if (arguments.major() == "SELECT" && !arguments.take("TOOL"))
    refuse(arguments.next_place(), "SELECT is taken as SELECT/TOOL,n");
  static_cast<void>(arguments.integer("a tool's number", kMostTool));
  pass_offsets(arguments);
}

void Tools::describe(Arguments& arguments) {
  described_ = arguments.integer("a tool's number", kMostTool);
  arguments.pass();
}

void Tools::begin_path(const Statement& statement) {
  const std::size_t comma = statement.text.rfind(',');
  const std::string tool = comma == std::string::npos ? "" : statement.text.substr(comma + 1);
  path_has_another_ = !of_path_.empty() && tool != of_path_ && !loaded_since_path_;
  of_path_ = tool;
  loaded_since_path_ = false;
}

void Tools::require_meant(std::size_t place) const {
  if (path_has_another_) {
    refuse(place, fmt::format("TOOL PATH names another tool, {}, than the one before it, and no LOAD/TOOL,n brings it; "
                              "write it, or import one tool's paths alone",
                              of_path_));
  }
  if (described_ && described_ != loaded_) {
    refuse(place, fmt::format("TOOLNO says that tool {0} cuts, and no LOADTL/{0} brings it; write it before this",
                              *described_));
  }
}

}  // namespace rmac::apt
