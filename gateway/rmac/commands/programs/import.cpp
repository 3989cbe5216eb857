#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "gateway/rmac/commands/programs/registrations.hpp"
#include "gateway/rmac/commands/programs/source.hpp"

namespace rmac::cli {
namespace {

/// Becomes the program that reads other controls' languages. It is no part of this one: what it is fed comes from
/// strangers, and it needs nothing of the appliance.
Result<> become(const char* program, const std::vector<std::string>& words) {
  const std::string path = beside_rmac(program);
  std::vector<std::string> all{path};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> arguments;
  arguments.reserve(all.size() + 1);
  for (std::string& word : all) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  execv(path.c_str(), arguments.data());
  return fail(fmt::format("{} cannot be started: {}; it is installed beside rmac", path, std::strerror(errno)));
}

}  // namespace

void add_import(Command& rmac) {
  const auto words = std::make_shared<std::vector<std::string>>();
  Command importing = rmac.add(
      "import",
      "make a .rmac program of another control's (RS274/NGC, Fanuc, Haas), or of APT; rmac import --help tells how");
  importing.passes_on(words.get());
  importing.does(without_appliance([words](bool) { return become(kImporter, *words); }));
}

}  // namespace rmac::cli
