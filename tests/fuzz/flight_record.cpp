// Flight records in the daemon's folder, as whoever can write there leaves them.
#include "gateway/record/flight_record.hpp"

#include <fstream>
#include <nlohmann/json.hpp>

#include "gateway/processes/temporary_folder.hpp"
#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const rmac::gateway::TemporaryFolder folder("fuzz");
  static const std::string name = "20261121T000000.000Z-demand-1";
  const rmac::gateway::FlightFolder records(folder.path());
  std::ofstream(records.file_of(name), std::ios::binary) << rmac::fuzz::text_of(data, size);
  static_cast<void>(records.list().dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  static_cast<void>(records.read(name, static_cast<std::int64_t>(size / 2)));
  static_cast<void>(records.read(std::string(rmac::fuzz::text_of(data, size)), 0));
  return 0;
}
