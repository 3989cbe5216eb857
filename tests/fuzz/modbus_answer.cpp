// What a Modbus slave answers. The first bytes are the question: its kind, its address, how much is asked for.
#include <vector>

#include "memory_file.hpp"
#include "modbus/pdu.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace rmac::fieldbus::modbus;
  constexpr std::size_t kQuestion = 5;
  if (size < kQuestion) return 0;
  Request request{.slave = data[0],
                  .writes = (data[1] & 4U) != 0,
                  .table = static_cast<Table>(data[1] & 3U),
                  .address = static_cast<std::uint16_t>(data[2] | data[3] << 8),
                  .count = 1};
  if (request.writes && !writable(request.table)) return 0;
  request.count = 1 + data[4] % most_values(request);
  std::vector<std::uint16_t> values(request.count, 1);
  const auto question = encode(request, values);
  static_cast<void>(decode(request, question, {data + kQuestion, size - kQuestion}, values));
  return 0;
}
