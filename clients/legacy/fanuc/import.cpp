#include "clients/legacy/fanuc/import.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "clients/legacy/fanuc/blocks/reader.hpp"
#include "clients/legacy/fanuc/blocks/refusal.hpp"
#include "clients/legacy/fanuc/flow/flow.hpp"
#include "clients/legacy/fanuc/rules.hpp"
#include "clients/legacy/fanuc/system_variables.hpp"
#include "clients/legacy/gcode/interpreter.hpp"

namespace rmac::fanuc {

namespace {

/// One import: line by line, in the order in which they are carried out, to the program's end.
class Import {
 public:
  Import(std::string_view program, const Options& options, Writer::Sink sink)
      : variables_(options.variables),
        writer_(std::move(sink), options.ids),
        interpreter_(options, rules(), writer_),
        flow_(program, options.block_delete, options.bounds, variables_, interpreter_.modes(),
              [this] {
                return gcode::Made{writer_.moves(), writer_.bytes()};
              }),
        reader_(options.passed_m),
        system_(interpreter_, flow_, writer_) {
    variables_.set_system({[this](int number, std::size_t place) { return system_.read(number, place); },
                           [this](int number, gcode::Maybe value, std::string_view message, std::size_t place) {
                             writer_.at_line(flow_.number());
                             system_.write(number, value, message, place);
                           }});
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
    if (text.substr(std::min(flow_.words(), text.size())).starts_with('%')) return mark(text);
    const Ordered ordered = reader_.read(text, flow_.words(), variables_, interpreter_.modes(), block_);
    if (!block_.empty()) begun_ = true;
    const bool moves = moves_of(block_);
    ended_ = interpreter_.execute(block_, flow_.line()).what == gcode::After::What::End;
    if (!ended_) flow_.go_on(ordered, moves);
  }

  /// Whether G66 calls behind it.
  [[nodiscard]] static bool moves_of(const gcode::Block& block) {
    return block.has_any("XYZ") && (!block.g(gcode::GGroup::Once) || block.once(530));
  }

  void mark(std::string_view text) {
    require_line_end(text, flow_.words() + 1);
    if (begun_ && !marked_) refuse(0, "a % in a program that did not begin with one");
    if (marked_) {
      require_main(0);
      interpreter_.end(0);
    }
    ended_ = marked_;
    marked_ = true;
  }

  void require_main(std::size_t place) const {
    if (const std::string running = flow_.running(); !running.empty())
      refuse(place, fmt::format("the file ends within {}, which M99 is to end; it may be cut off", running));
  }

  [[noreturn]] void refuse_end() const {
    const std::size_t end = flow_.line().text().size();
    require_main(end);
    refuse(end, marked_ ? "the program ends without its second %; it may be cut off"
                        : "the program ends without M30 or M2; it may be cut off");
  }

  Variables variables_;
  Writer writer_;
  gcode::Interpreter interpreter_;
  Flow flow_;
  BlockReader reader_;
  gcode::Block block_;
  SystemVariables system_;
  bool begun_ = false, marked_ = false, ended_ = false;
};

}  // namespace

tl::expected<Summary, Error> import_program(std::string_view program, const Options& options, Writer::Sink sink) {
  return Import(program, options, std::move(sink)).run();
}

}  // namespace rmac::fanuc
