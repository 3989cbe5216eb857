// A line of a stranger's, as far as it goes without a machine: JSON, batch, method table, and the answer's line.
#include "gateway/requests/request_line.hpp"

#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rmac::gateway;
  RequestLine line(0, size, RequestLine::Time{});
  line.read(rmac::fuzz::text_of(data, size));
  line.answer_stops([](const Request&, std::uint64_t) { return refused(rmac::MinorCode::Other, "no machine"); });
  while (line.next() != nullptr) {
    auto refusal = line.refusal_of_next();
    line.answer_next(refusal ? std::move(*refusal) : refused(rmac::MinorCode::Other, "no machine"));
  }
  static_cast<void>(line.response());
  return 0;
}
