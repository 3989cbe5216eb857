#include "gateway/rmac/measuring/measuring_plan.hpp"

#include <fmt/format.h>

#include <cmath>

#include "gateway/json/json_document.hpp"
#include "gateway/json/schemas.hpp"

namespace rmac::cli {

Result<MeasuringPlan> read_measuring_plan(const std::string& file) {
  const gateway::JsonSchema schema(gateway::measuring_plan_schema_text());
  const auto document = gateway::read_json_document(file, schema);
  if (!document) return fail(document.error().message);
  MeasuringPlan plan;
  plan.ways.safe_height_mm = (*document)["SafeHeight"];
  plan.ways.clearance_mm = document->value("Clearance", plan.ways.clearance_mm);
  plan.ways.speed_mm_s = document->value("Speed", plan.ways.speed_mm_s);
  if (document->contains("TipRadius")) plan.tip_radius_mm = (*document)["TipRadius"];
  std::size_t feature_number = 0;
  for (const auto& feature : (*document)["Features"]) {
    std::size_t point_number = 0;
    if (feature.contains("Tool")) plan.cut_by[feature["Name"]] = feature["Tool"];
    for (const auto& entry : feature["Points"]) {
      gateway::SurfacePoint point;
      point.feature = feature["Name"];
      entry["Point"].get_to(point.nominal);
      entry["Normal"].get_to(point.normal);
      const double length = std::hypot(point.normal[0], point.normal[1], point.normal[2]);
      if (!(length > 1e-9)) {
        return fail(
            fmt::format("{}: /Features/{}/Points/{}/Normal has no length; allowed is the way out of the material", file,
                        feature_number, point_number));
      }
      for (double& c : point.normal) c /= length;
      plan.points.push_back(std::move(point));
      ++point_number;
    }
    ++feature_number;
  }
  return plan;
}

}  // namespace rmac::cli
