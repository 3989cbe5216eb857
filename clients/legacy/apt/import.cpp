#include "clients/legacy/apt/import.hpp"

#include <algorithm>
#include <utility>

#include "clients/legacy/apt/passages.hpp"
#include "clients/legacy/apt/statements/scanner.hpp"

namespace rmac::apt {

namespace {

/// Where a place is, as people count.
legacy::Error error_at(std::string_view program, const Refusal& refusal) {
  const std::size_t place = std::min(refusal.place, program.size());
  const std::string_view before = program.substr(0, place);
  const std::size_t line_end = before.rfind('\n');
  const std::size_t begin = line_end == std::string_view::npos ? 0 : line_end + 1;
  return {1 + static_cast<std::size_t>(std::ranges::count(before, '\n')), place - begin + 1, refusal.message};
}

}  // namespace

tl::expected<legacy::Summary, legacy::Error> import_program(std::string_view program, const Options& options,
                                                            legacy::Writer::Sink sink) {
  Writer writer(std::move(sink), options.ids);
  Interpreter interpreter(options, writer);
  Passages passages(interpreter, writer);
  Scanner scanner(program);
  try {
    bool goes_on = true;
    for (Statement statement; goes_on && scanner.next(statement);) {
      writer.at_line(statement.line);
      goes_on = passages.take(statement);
    }
    passages.end(program.size());
  } catch (const Refusal& refusal) {
    return tl::unexpected(error_at(program, refusal));
  }
  writer.flush();
  return legacy::Summary{scanner.lines(), writer.moves(), writer.requests()};
}

}  // namespace rmac::apt
