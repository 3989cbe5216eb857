#include "gateway/forces/work_materials.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "places.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;
using testing::EndsWith;
using testing::HasSubstr;

json aluminium(const char* name = "Al7075-T6") {
  return {{"Name", name},  {"AlsoCalled", {"EN AW-7075"}},
          {"Ktc", 767.01}, {"Krc", 168.8},
          {"Kac", 222},    {"Kte", 27.7},
          {"Kre", 26.6},   {"Kae", 0.7},
          {"Tool", "x"},   {"Source", "table 5"}};
}

class MaterialsFile : public testing::Test {
 protected:
  Expected<WorkMaterials> read(const json& document) {
    std::ofstream(file_) << document.dump();
    return WorkMaterials::read(file_);
  }
  std::string refusal(const json& document) {
    const auto materials = read(document);
    return materials ? "taken" : materials.error().message;
  }
  std::string refusal_with(const char* key, const json& value) {
    json material = aluminium();
    material[key] = value;
    return refusal({{"Materials", {material}}});
  }
  std::filesystem::path file_ =
      testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name() + ".json";
  void TearDown() override { std::filesystem::remove(file_); }
};

TEST_F(MaterialsFile, IsReadWithWhatItSays) {
  const auto materials = read({{"Materials", {aluminium()}}});
  ASSERT_TRUE(materials) << materials.error().message;
  const WorkMaterial& found = *materials->find("Al7075-T6").value();
  EXPECT_EQ(found.coefficients.ktc, 767.01);
  EXPECT_EQ(found.coefficients.krc, 168.8);
  EXPECT_EQ(found.coefficients.kac, 222);
  EXPECT_EQ(found.coefficients.kte, 27.7);
  EXPECT_EQ(found.coefficients.kre, 26.6);
  EXPECT_EQ(found.coefficients.kae, 0.7);
  EXPECT_EQ(found.source, "table 5");
}

TEST_F(MaterialsFile, FindsAMaterialByAnyOfItsNames) {
  const auto materials = read({{"Materials", {aluminium()}}}).value();
  for (const char* name : {"Al7075-T6", "al 7075 t6", "AL7075T6", "EN AW-7075", "en_aw 7075"}) {
    EXPECT_TRUE(materials.find(name)) << name;
  }
  EXPECT_FALSE(materials.find(""));
  EXPECT_FALSE(materials.find("Al7075"));
}

TEST_F(MaterialsFile, SaysWhichMaterialMayHaveBeenMeant) {
  const auto materials = read({{"Materials", {aluminium()}}}).value();
  EXPECT_EQ(materials.find("Al7057-T6").error().message, "the material \"Al7057-T6\" is not in " + file_.string() +
                                                             "; did you mean \"Al7075-T6\"? there are \"Al7075-T6\"");
  EXPECT_THAT(materials.find("Inconel 718").error().message, EndsWith("; there are \"Al7075-T6\""));
}

TEST_F(MaterialsFile, IsRefusedWithTheValueThatCannotBe) {
  EXPECT_THAT(refusal_with("Ktc", -767), HasSubstr("/Materials/0/Ktc is -767; allowed is a number from 10 to 20000"));
  EXPECT_THAT(refusal_with("Ktc", 767e6), HasSubstr("(N/mm²)"));  // in Pa
  EXPECT_THAT(refusal_with("Kre", -1), HasSubstr("/Materials/0/Kre is -1; allowed is a number from 0 to 1000"));
  EXPECT_THAT(refusal_with("Kte", 27700), HasSubstr("/Materials/0/Kte is 27700"));  // in N/m
  EXPECT_THAT(refusal_with("Source", ""), HasSubstr("/Materials/0/Source"));
  EXPECT_THAT(refusal_with("Sorce", "x"), HasSubstr("did you mean \"Source\"?"));
  json without = aluminium();
  without.erase("Source");
  EXPECT_THAT(refusal({{"Materials", {without}}}), HasSubstr("Source"));
}

TEST_F(MaterialsFile, IsRefusedWhereTwoMaterialsHaveOneName) {
  EXPECT_EQ(refusal({{"Materials", {aluminium(), aluminium("Al7075")}}}),
            file_.string() + ": /Materials/1 is called \"EN AW-7075\", as /Materials/0 is; give each names of its own");
}

TEST(ShippedMaterials, AreReadAndEachHasASource) {
  const auto materials = WorkMaterials::read(RMAC_SOURCE_DIR "/etc/materials.json");
  ASSERT_TRUE(materials) << materials.error().message;
  for (const WorkMaterial& material : materials->all()) {
    EXPECT_THAT(material.source, HasSubstr("table")) << material.name;
    EXPECT_EQ(materials->find(material.name).value(), &material);
  }
  EXPECT_TRUE(materials->find("EN AW-6082-T6"));
}

}  // namespace
}  // namespace rmac::gateway
