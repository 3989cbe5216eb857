#include "clients/legacy/rs274/flow/sources.hpp"

#include <algorithm>
#include <utility>

#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

std::string Sources::file_of(std::string_view label) {
  std::string name;
  for (const char letter : label) {
    const bool is_capital = letter >= 'A' && letter <= 'Z';
    const bool stays =
        (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9') || letter == '_' || letter == '-';
    if (!is_capital && !stays) return {};  // what else a name may have leads out of the folder, or means other things
    name += is_capital ? static_cast<char>(letter - 'A' + 'a') : letter;
  }
  return name + ".ngc";
}

const Source* Sources::find_file(const std::string& label, std::size_t place) {
  const std::string name = file_of(label);
  if (!find_file_ || name.empty()) return nullptr;
  const auto [file, is_new] = files_.try_emplace(label);
  if (is_new) {
    auto found = find_file_(name);
    if (!found) refuse(place, found.error());
    if (*found) file->second = std::make_unique<File>(std::move(**found), block_delete_);
  }
  return file->second ? &file->second->source : nullptr;
}

}  // namespace rmac::rs274
