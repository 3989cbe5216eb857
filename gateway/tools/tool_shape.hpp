#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "gateway/bodies/body.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// What a tool's body is made of, by ISO 13399's BMC.
enum class BodyMaterial { Unknown, Carbide, HighSpeedSteel };

/// One way in which a tool swings in its holder, as a knock on its tip shows it: alike in all directions across its
/// axis.
struct TipMode {
  double frequency_hz = 0;
  double damping_ratio = 0;
  double stiffness_n_mm = 0;  ///< modal, at the tip
};

/// What a tool looks like, by the symbols of ISO 13399. mm, along the tool's axis from its tip up.
struct ToolShape {
  double dc = 0;                  ///< cutting diameter
  double re = 0;                  ///< corner radius; half of DC: a ball
  double apmx = 0;                ///< deepest cut
  double lcf = 0;                 ///< length of the chip flutes; the part of the tool that may cut ends here
  double oal = 0;                 ///< overall length, with what sits in the holder
  int zefp = 0;                   ///< teeth; 0: not given
  double fha = 0;                 ///< helix angle of the flutes, degrees
  std::vector<ConeShape> shank;   ///< from the flutes up
  std::vector<ConeShape> holder;  ///< its last one ends at the tool interface, `Length` above the tip
  BodyMaterial bmc{};
  std::vector<TipMode> modes{};  ///< as measured; none: nobody did

  /// How far above the tip the holder begins.
  [[nodiscard]] double holder_begins(double tool_length_mm) const;
};

/// `Shape` of a tool of this length, from a document that etc/tools.schema.json has passed. Refused where its parts
/// leave a gap or do not fit each other.
[[nodiscard]] Expected<ToolShape> read_tool_shape(const nlohmann::json& object, double tool_length_mm);
[[nodiscard]] nlohmann::json to_json(const ToolShape& shape);

}  // namespace rmac::gateway
