// A stranger's SELECT, on a table of one row: on one of more rows a join may take hours, which is why the daemon has it
// run by a program that it kills.
#include <cstdlib>
#include <filesystem>
#include <iostream>

#include "gateway/device_driver_manager/device_driver_manager.hpp"
#include "gateway/processes/temporary_folder.hpp"
#include "gateway/searcher/guarded_search.hpp"
#include "memory_file.hpp"
#include "places.hpp"

namespace {

namespace fs = std::filesystem;

std::string database_of_one_machine() {
  static const rmac::gateway::TemporaryFolder room("fuzz");
  const fs::path& folder = room.path();
  const fs::path of_machine = "mill/3-axis/DMACXYZ";
  fs::create_directories(folder / "tree" / of_machine);
  fs::copy_file(fs::path(RMAC_BINARY_DIR) / "drivers" / of_machine / "device.json",
                folder / "tree" / of_machine / "device.json", fs::copy_options::overwrite_existing);
  const std::string database = (folder / "drivers.sqlite").string();
  const auto made = rmac::gateway::DeviceDriverManager::open({folder / "tree", database});
  if (!made) {
    std::cerr << made.error().message << '\n';
    std::abort();
  }
  return database;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string database = database_of_one_machine();
  static_cast<void>(rmac::gateway::search_mechanisms(database, std::string(rmac::fuzz::text_of(data, size))));
  return 0;
}
