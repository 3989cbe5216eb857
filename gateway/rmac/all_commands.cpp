#include "gateway/rmac/all_commands.hpp"

#include <array>

#include "gateway/rmac/commands/bus/registrations.hpp"
#include "gateway/rmac/commands/commission/registrations.hpp"
#include "gateway/rmac/commands/machines/registrations.hpp"
#include "gateway/rmac/commands/measure/registrations.hpp"
#include "gateway/rmac/commands/operate/registrations.hpp"
#include "gateway/rmac/commands/programs/registrations.hpp"
#include "gateway/rmac/commands/records/registrations.hpp"
#include "gateway/rmac/commands/tools/registrations.hpp"
#include "gateway/rmac/commands/watch/registrations.hpp"

namespace rmac::cli {

std::span<const Registration> all_commands() {
  static constexpr std::array kAll{add_machines,
                                   add_show,
                                   add_load,
                                   add_unload,
                                   add_run,
                                   add_status,
                                   add_cycles,
                                   add_events,
                                   add_jog,
                                   add_home,
                                   add_hold,
                                   add_resume,
                                   add_stop,
                                   add_reset,
                                   add_parked,
                                   add_override,
                                   add_tools,
                                   add_confirm,
                                   add_measure,
                                   add_qualify,
                                   add_trace,
                                   add_tune,
                                   add_measure_following,
                                   add_simulate,
                                   add_import,
                                   add_verify,
                                   add_bus};
  return kAll;
}

}  // namespace rmac::cli
