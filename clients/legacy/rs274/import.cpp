#include "clients/legacy/rs274/import.hpp"

#include <optional>
#include <string_view>
#include <utility>

#include "clients/legacy/gcode/flow/carry_out.hpp"
#include "clients/legacy/gcode/interpreter.hpp"
#include "clients/legacy/rs274/blocks/reader.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"
#include "clients/legacy/rs274/flow/flow.hpp"
#include "clients/legacy/rs274/saved_states.hpp"
#include "clients/legacy/rs274/told.hpp"
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
    .turns_as_written = true,
    .cycles = {},
};

/// One import.
class Import {
 public:
  Import(std::string_view program, const Options& options, Writer::Sink sink, FindFile find_file)
      : options_(options),
        reader_(options.passed_m),
        writer_(std::move(sink), options.ids),
        interpreter_(options, kRules, writer_),
        saved_(interpreter_),
        flow_(program, options.block_delete, options.bounds, parameters_,
              {.made =
                   [this] {
                     return Made{writer_.moves(), writer_.bytes()};
                   },
               .find_file = std::move(find_file),
               .leaving = [this](std::size_t place) { saved_.leave(flow_.call_level(), place); }}),
        extent_(options.assume_end) {
    parameters_.ask_control([this](const gcode::Name& name) { return told(interpreter_, flow_, name); });
  }

  tl::expected<Summary, Error> run() {
    return gcode::carry_out(
        flow_, writer_, extent_, [this](std::string_view text) { take(text); }, [this] { interpreter_.end(); });
  }

 private:
  void take(std::string_view text) {
    if (text.empty()) return;
    if (text.front() == '%') {
      if (text.size() > 1) refuse(1, "nothing stands behind %");
      if (extent_.mark(flow_.running())) interpreter_.end();
    } else if (!(text.front() == '/' && options_.block_delete)) {
      reader_.read(flow_.line(), parameters_, block_);
      go_on(interpreter_.execute(block_, flow_.line()));
    }
    extent_.begin();
  }

  void go_on(const After& after) {
    if (after.what == After::What::Call) flow_.call(after.label, after.times, after.place);
    if (after.what == After::What::EndOfNumbered) flow_.end_of_numbered(after.place);
    if (after.what == After::What::Modes) saved_.act(after, flow_.call_level());
    if (after.what == After::What::End) extent_.end();
  }

  const Options& options_;
  Parameters parameters_;
  BlockReader reader_;
  Block block_;
  Writer writer_;
  gcode::Interpreter interpreter_;
  SavedStates saved_;
  Flow flow_;
  gcode::Extent extent_;
};

}  // namespace

tl::expected<Summary, Error> import_program(std::string_view program, const Options& options, Writer::Sink sink,
                                            FindFile find_file) {
  return Import(program, options, std::move(sink), std::move(find_file)).run();
}

}  // namespace rmac::rs274
