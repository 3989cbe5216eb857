#include "clients/legacy/rs274/import.hpp"

#include <utility>

#include "clients/legacy/rs274/interpreter.hpp"

namespace rmac::rs274 {

namespace {

/// Takes the first line off the text.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  const std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return line;
}

/// One import: line by line, to the program's end.
class Import {
 public:
  Import(const Options& options, Writer::Sink sink)
      : options_(options), writer_(std::move(sink), options.ids), interpreter_(options, writer_) {}

  tl::expected<Summary, Error> run(std::string_view text) {
    try {
      while (!text.empty() && !ended_) {
        writer_.at_line(++number_);
        line_.read(take_line(text));
        take(line_.text());
      }
      if (!ended_) {
        refuse(line_.text().size(), marked_ ? "the program ends without its second %; it may be cut off"
                                            : "the program ends without M2 or M30; it may be cut off");
      }
    } catch (const Refusal& refusal) {
      return tl::unexpected(Error{number_, line_.column(refusal.place), refusal.message});
    }
    writer_.flush();
    return Summary{number_, writer_.moves(), writer_.requests()};
  }

 private:
  void take(std::string_view text) {
    if (text.empty()) return;
    if (text.front() == '%') {
      if (text.size() > 1) refuse(1, "nothing stands behind %");
      if (begun_ && !marked_) refuse(0, "a % in a program that did not begin with one");
      if (marked_) interpreter_.require_closed(0);
      ended_ = marked_;
      marked_ = true;
    } else if (!(text.front() == '/' && options_.block_delete)) {
      ended_ = !interpreter_.execute(line_);
    }
    begun_ = true;
  }

  const Options& options_;
  Writer writer_;
  Interpreter interpreter_;
  Line line_;
  std::size_t number_ = 0;
  bool begun_ = false, marked_ = false, ended_ = false;
};

}  // namespace

tl::expected<Summary, Error> import_program(std::string_view program, const Options& options, Writer::Sink sink) {
  return Import(options, std::move(sink)).run(program);
}

}  // namespace rmac::rs274
