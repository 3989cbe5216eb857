#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "gateway/json/schemas.hpp"
#include "places.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;

std::string text_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Every key and every description of a schema, wherever it stands.
void collect(const json& schema, std::vector<std::string>& words) {
  if (schema.contains("properties")) {
    for (const auto& [key, value] : schema["properties"].items()) {
      words.push_back(key + "`");
      if (value.contains("description")) words.push_back(value["description"]);
    }
  }
  for (const auto& [key, value] : schema.items()) {
    if (value.is_object()) collect(value, words);
  }
}

TEST(ConfigurationPage, SaysWhatTheSchemasSay) {
  const std::string page = text_of(RMAC_SOURCE_DIR "/docs/configuration.md");
  ASSERT_FALSE(page.empty());
  std::vector<std::string> words;
  collect(json::parse(device_schema_text()), words);
  collect(json::parse(rmacd_schema_text()), words);
  collect(json::parse(modbus_spindle_schema_text()), words);
  collect(json::parse(modbus_io_schema_text()), words);
  collect(json::parse(tools_schema_text()), words);
  collect(json::parse(setup_schema_text()), words);
  collect(json::parse(measuring_plan_schema_text()), words);
  ASSERT_GT(words.size(), 100U);
  for (const std::string& word : words) {
    EXPECT_NE(page.find(word), std::string::npos)
        << "docs/configuration.md lacks: " << word << "\nrun docs/generate_configuration.py";
  }
}

TEST(CompiledSchemas, AreTheFilesOfEtc) {
  EXPECT_EQ(device_schema_text(), text_of(RMAC_SOURCE_DIR "/etc/device.schema.json"));
  EXPECT_EQ(rmacd_schema_text(), text_of(RMAC_SOURCE_DIR "/etc/rmacd.schema.json"));
  EXPECT_EQ(modbus_spindle_schema_text(), text_of(RMAC_SOURCE_DIR "/etc/modbus-spindle.schema.json"));
  EXPECT_EQ(modbus_io_schema_text(), text_of(RMAC_SOURCE_DIR "/etc/modbus-io.schema.json"));
  EXPECT_EQ(tools_schema_text(), text_of(RMAC_SOURCE_DIR "/etc/tools.schema.json"));
  EXPECT_EQ(setup_schema_text(), text_of(RMAC_SOURCE_DIR "/etc/setup.schema.json"));
  EXPECT_EQ(measuring_plan_schema_text(), text_of(RMAC_SOURCE_DIR "/etc/measuring-plan.schema.json"));
}

TEST(CompiledSchemas, MeanTheSameByAShape) {
  json device = json::parse(device_schema_text()), setup = json::parse(setup_schema_text());
  // A set-up comes over a socket too, without files: its meshes may have their points and triangles in them.
  for (json* schema : {&device, &setup}) EXPECT_EQ((*schema)["definitions"]["shape"]["properties"].erase("Mesh"), 1U);
  for (const char* word : {"shape", "bodyPose", "size", "colour", "bodyName"}) {
    EXPECT_EQ(device["definitions"][word], setup["definitions"][word]) << word;
  }
}

}  // namespace
}  // namespace rmac::gateway
