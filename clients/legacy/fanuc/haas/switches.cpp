#include "clients/legacy/fanuc/haas/switches.hpp"

#include <fmt/format.h>

#include "clients/legacy/fanuc/blocks/refusal.hpp"

namespace rmac::fanuc::haas {

void Switches::write(int number, bool on) {
  writer_.output(options_.outputs.at(number), on);
}

void Switches::on(const HaasWords& words) {
  for (const auto& switched : words.switched) {
    if (!switched.on) continue;
    if (!options_.outputs.contains(switched.number))
      refuse(switched.place,
             fmt::format("which output of the machine is {1} is not known here; give --output {0}=NAME, "
                         "or --pass-over M{0} where the cut may go without",
                         switched.number, switched.what));
    if (on_.insert(switched.number).second) write(switched.number, true);
  }
}

void Switches::off(const HaasWords& words) {
  for (const auto& switched : words.switched) {
    if (!switched.on && on_.erase(switched.number) > 0) write(switched.number, false);
  }
}

void Switches::all_off() {
  for (const int number : on_) write(number, false);
  on_.clear();
}

}  // namespace rmac::fanuc::haas
