#include "clients/legacy/rs274/import.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "clients/legacy/gcode/interpreter.hpp"
#include "clients/legacy/rs274/blocks/reader.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"
#include "clients/legacy/rs274/flow/flow.hpp"
#include "clients/legacy/rs274/work_systems.hpp"

namespace rmac::rs274 {

using gcode::After, gcode::Made;

namespace {

constexpr gcode::Rules kRules{
    .system_of = system_of,
    .system_name = system_name,
    .set_coordinates = set_coordinates,
    .arcs_have_turns = true,
    .needs_path_tolerance = true,
    .cycles = {},
};

/// One import: line by line, in the order in which they are carried out, to the program's end.
class Import {
 public:
  Import(std::string_view program, const Options& options, Writer::Sink sink)
      : options_(options),
        writer_(std::move(sink), options.ids),
        interpreter_(options, kRules, writer_),
        flow_(program, options.block_delete, options.bounds, parameters_, [this] {
          return Made{writer_.moves(), writer_.bytes()};
        }) {
    parameters_.ask_control([this](int number) { return control_parameter(number); });
  }

  tl::expected<Summary, Error> run() {
    try {
      while (!ended_ && flow_.next()) {
        writer_.at_line(flow_.number());
        take(flow_.line().text());
      }
      if (!ended_) refuse_end();
    } catch (const Refusal& refusal) {
      return tl::unexpected(Error{flow_.number(), flow_.line().column(refusal.place), refusal.message});
    }
    writer_.flush();
    return Summary{flow_.furthest(), writer_.moves(), writer_.requests()};
  }

 private:
  void take(std::string_view text) {
    if (text.empty()) return;
    if (text.front() == '%') {
      if (text.size() > 1) refuse(1, "nothing stands behind %");
      if (begun_ && !marked_) refuse(0, "a % in a program that did not begin with one");
      if (marked_) require_main(0);
      if (marked_) interpreter_.end(0);
      ended_ = marked_;
      marked_ = true;
    } else if (!(text.front() == '/' && options_.block_delete)) {
      reader_.read(flow_.line(), parameters_, block_);
      go_on(interpreter_.execute(block_, flow_.line()));
    }
    begun_ = true;
  }

  void go_on(const After& after) {
    if (after.what == After::What::Call) flow_.call(after.label, after.times, after.place);
    if (after.what == After::What::EndOfNumbered) flow_.end_of_numbered(after.place);
    ended_ = after.what == After::What::End;
  }

  /// Of the numbers that LinuxCNC's manual gives to the control, those that a program's own words make known. Those of
  /// G92 and the work systems (5211 to 5383) are not: the control keeps the former while G92.2 suspends them, and the
  /// latter in the unit of the machine, which no program says.
  [[nodiscard]] std::optional<double> control_parameter(int number) const {
    if (number == 5220) return static_cast<double>(interpreter_.coordinates().active() + 1);
    if (number == 5400) return interpreter_.switches().tool();
    if (number < 5420 || number > 5422) return std::nullopt;
    return interpreter_.tip(static_cast<std::size_t>(number - 5420));
  }

  void require_main(std::size_t place) const {
    if (const std::string running = flow_.running(); !running.empty())
      refuse(place, fmt::format("the file ends within {}, which M99 is to end; it may be cut off", running));
  }

  [[noreturn]] void refuse_end() const {
    const std::size_t end = flow_.line().text().size();
    require_main(end);
    refuse(end, marked_ ? "the program ends without its second %; it may be cut off"
                        : "the program ends without M2 or M30; it may be cut off");
  }

  const Options& options_;
  Parameters parameters_;
  BlockReader reader_;
  Block block_;
  Writer writer_;
  gcode::Interpreter interpreter_;
  Flow flow_;
  bool begun_ = false, marked_ = false, ended_ = false;
};

}  // namespace

tl::expected<Summary, Error> import_program(std::string_view program, const Options& options, Writer::Sink sink) {
  return Import(program, options, std::move(sink)).run();
}

}  // namespace rmac::rs274
