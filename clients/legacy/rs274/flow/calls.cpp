// Which text has what a call calls.
#include <fmt/format.h>

#include "clients/legacy/rs274/blocks/refusal.hpp"
#include "clients/legacy/rs274/flow/flow.hpp"

namespace rmac::rs274 {

namespace {

std::string nowhere(const std::string& label, bool numbered, const Sources& sources) {
  const std::string name = numbered ? "O" + label : name_of(label);
  const std::string file = Sources::file_of(label);
  const std::string place = numbered ? "behind the end of the main program" : "into this file";
  const std::string write = numbered ? fmt::format("{} … M99", name) : fmt::format("{0} sub … {0} endsub", name);
  if (!sources.has_files() || file.empty())
    return fmt::format("{} is not in this file, and no other is read; write {} {}", name, write, place);
  return fmt::format(
      "{} is not in this file, and there is no {} beside the program or in --subroutines; write {} {}, or say "
      "where that file is",
      name, file, write, place);
}

}  // namespace

/// LinuxCNC takes what it came by, then a file, and then what stands behind the call. Who has the last two can hardly
/// mean both.
Flow::Callee Flow::find(const std::string& label, bool numbered, std::size_t place) {
  const auto here = find_in_texts(label, numbered);
  const std::size_t furthest = here && here->source == &sources_.program() ? furthest_ : number_;
  if (here && here->source->outline.statements()[here->statement].line <= furthest) return *here;
  const Source* file = sources_.find_file(label, place);
  const auto there = file != nullptr ? file->outline.find(label, numbered) : std::nullopt;
  if (here && there) {
    refuse(place, fmt::format("{} stands in line {}{} and in {}, too; give one of them another name",
                              numbered ? "O" + label : name_of(label),
                              here->source->outline.statements()[here->statement].line,
                              here->source == read_from_ ? "" : " of the program", file->file));
  }
  if (here) return *here;
  if (there) return {file, *there};
  for (const Source* text : {static_cast<const Source*>(read_from_), file}) {
    if (text != nullptr && text->outline.trouble()) refuse_trouble(*text);
  }
  for (const Source* text : {static_cast<const Source*>(read_from_), &sources_.program(), file}) {
    if (text == nullptr || !text->outline.find(label, !numbered)) continue;
    refuse(place, numbered ? fmt::format("o{0} is a sub; call it by o{0} call", label)
                           : fmt::format("{} is a numbered program; call it by M98 P{}", name_of(label), label));
  }
  if (file != nullptr)
    refuse(place, fmt::format("{} has no {}, which is what is called", file->file,
                              numbered ? "O" + label : name_of(label) + " sub"));
  refuse(place, nowhere(label, numbered, sources_));
}

std::optional<Flow::Callee> Flow::find_in_texts(const std::string& label, bool numbered) const {
  for (const Source* text : {read_from_, &sources_.program()}) {
    if (const auto statement = text->outline.find(label, numbered)) return Callee{text, *statement};
  }
  return std::nullopt;
}

std::size_t Flow::line_of_program() const noexcept {
  if (read_from_ == &sources_.program()) return number_;
  for (auto call = calls_.rbegin(); call != calls_.rend(); ++call) {
    if (call->back.source == &sources_.program()) return call->back.lines;
  }
  return furthest_;
}

}  // namespace rmac::rs274
