#pragma once

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc::haas {

/// Lines of a program for a Haas, as program_of() has them.
inline legacy::Imported done(const std::string& lines, const Options& options = {}, std::string_view behind = {}) {
  return imported(program_of(lines, behind), options, Dialect::Haas);
}
inline std::string refusal(const std::string& lines, const Options& options = {}, std::string_view behind = {}) {
  return refusal_of(program_of(lines, behind), options, Dialect::Haas);
}
/// Where their moves end, after the first rapid.
inline std::vector<std::vector<double>> ends(const std::string& lines, const Options& options = {},
                                             std::string_view behind = {}) {
  return legacy::ends_in(done(lines, options, behind));
}

}  // namespace rmac::fanuc::haas
