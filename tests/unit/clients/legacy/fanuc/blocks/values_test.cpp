#include <gmock/gmock.h>

#include "unit/clients/legacy/fanuc/imported.hpp"

namespace rmac::fanuc {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

double statement(const std::string& expression) {
  return value_of("#1", "#1=" + expression + "\n");
}

TEST(FanucValue, BindsAsMacrosHaveIt) {
  EXPECT_EQ(statement("2+3*4"), 14);
  EXPECT_EQ(statement("12 AND 10 + 1"), 9);
  EXPECT_EQ(statement("12 OR 3 * 1"), 15);
  EXPECT_EQ(statement("12 XOR 10"), 6);
  EXPECT_EQ(statement("-7 MOD 3"), -1);
  EXPECT_EQ(statement("[2+3]*-[1-2]"), 5);
  EXPECT_EQ(statement("10-2-3"), 5);
}

TEST(FanucValue, HasItsFunctions) {
  EXPECT_NEAR(statement("SIN[30]+COS[60]+TAN[45]"), 2, 1e-7);
  EXPECT_NEAR(statement("ATAN[1]/[-1]"), 135, 1e-6);
  EXPECT_NEAR(statement("ATAN[-1]/[1]"), 315, 1e-6);
  EXPECT_NEAR(statement("ATAN[-1,1]"), 315, 1e-6);
  EXPECT_NEAR(statement("ATAN[-1]"), -45, 1e-6);
  EXPECT_NEAR(statement("ATAN[1]/2"), 22.5, 1e-6);
  EXPECT_NEAR(statement("ASIN[-0.5]"), 330, 1e-6);
  EXPECT_NEAR(statement("ACOS[-0.5]"), 120, 1e-6);
  EXPECT_EQ(statement("SQRT[16.]+ABS[-2.]"), 6);
  EXPECT_EQ(statement("FIX[-1.7]"), -1);
  EXPECT_EQ(statement("FUP[-1.2]"), -2);
  EXPECT_EQ(statement("FUP[1.2]"), 2);
  EXPECT_EQ(statement("ROUND[2.5]"), 3);
  EXPECT_EQ(statement("BIN[19]"), 13);  // the bits of the decimal digits 1 and 3
  EXPECT_EQ(statement("BCD[13]"), 19);
  EXPECT_NEAR(statement("LN[EXP[2.]]"), 2, 1e-7);
  EXPECT_EQ(statement("POW[2.,10.]"), 1024);
}

/// The control's manual warns of sums of rounded ways; ROUND in a word is how they are made to fit.
TEST(FanucValue, IsRoundedToTheDigitsOfAWordThere) {
  EXPECT_EQ(value_of("[ROUND[1.2345]]"), 1.235);
  EXPECT_EQ(statement("ROUND[1.2345]"), 1);
}

TEST(FanucValue, IsRefusedWhereThereIsNone) {
  EXPECT_THAT(refusal_of(program_of("#1=1/0")), HasSubstr("division by zero"));
  EXPECT_THAT(refusal_of(program_of("#1=SQRT[-1]")), HasSubstr("square root"));
  EXPECT_THAT(refusal_of(program_of("#1=1.5 AND 2")), HasSubstr("whole numbers"));
  EXPECT_THAT(refusal_of(program_of("#1=[1")), HasSubstr("]"));
  EXPECT_THAT(refusal_of(program_of("#1=2 #2=3")), HasSubstr("nothing but a comment"));
  EXPECT_THAT(refusal_of(program_of("#1=" + std::string(500, '['))), HasSubstr("nested"));
  EXPECT_THAT(refusal_of(program_of("#1=1E5")), HasSubstr("nothing but a comment"));
}

TEST(FanucVariable, ThatIsVacantLeavesItsWordOut) {
  EXPECT_THAT(ends_of("G0 X1. Y#2 Z-#3"), ElementsAre(ElementsAre(1, 0, 10)));
  EXPECT_THAT(ends_of("#1=#0\nG#1 X1."), ElementsAre(ElementsAre(1, 0, 10)));
  EXPECT_THAT(ends_of("#1=5.\n#1=#0\nG0 X#1"), IsEmpty());
  EXPECT_THAT(ends_of("#2=#1+1.\n#3=#1*5\nG0 X#2 Y#3"), ElementsAre(ElementsAre(1, 0, 10)));
}

TEST(FanucVariable, ThatIsVacantIsNoZeroForEqAndNeAlone) {
  const auto holds = [](const std::string& condition, const std::string& before = "") {
    return !xs_of(before + "IF [" + condition + "] THEN #5=1.\nG0 X#5").empty();
  };
  EXPECT_TRUE(holds("#1 EQ #0"));
  EXPECT_FALSE(holds("#1 NE #0"));
  EXPECT_FALSE(holds("#1 EQ 0"));
  EXPECT_TRUE(holds("#1 NE 0"));
  EXPECT_TRUE(holds("#1 GE #0"));
  EXPECT_TRUE(holds("#1 LE 0"));
  EXPECT_FALSE(holds("#1 GT 0"));
  EXPECT_FALSE(holds("#1 LT 0"));
  EXPECT_FALSE(holds("#1 EQ #0", "#1=0\n"));
  EXPECT_FALSE(holds("#1 NE 0", "#1=0\n"));
}

TEST(FanucVariable, NumbersMayBeComputed) {
  EXPECT_EQ(value_of("#[#1+100]", "#1=2\n#102=7.\n"), 7);
  EXPECT_EQ(value_of("##1", "#1=2\n#2=7.\n"), 7);
}

TEST(FanucVariable, OfTheMachineIsNotKnownUnlessItIsGiven) {
  EXPECT_THAT(refusal_of(program_of("G0 X#500")), StartsWith("5:5: #500 was not set before"));
  Options options;
  options.variables = {{500, 4.5}};
  EXPECT_THAT(ends_of("G0 X#500", options), ElementsAre(ElementsAre(4.5, 0, 10)));
  EXPECT_THAT(refusal_of(program_of("#300=1.")), HasSubstr("there is no #300"));
  EXPECT_THAT(refusal_of(program_of("#0=1.")), HasSubstr("always vacant"));
}

TEST(FanucVariable, OfTheSystemSaysWhatIsInForce) {
  EXPECT_THAT(ends_of("#1=#4003\n#2=#4001\nG91 G1 X1.\nG#1 G#2 X5."),
              ElementsAre(ElementsAre(1, 0, 10), ElementsAre(5, 0, 10)));
  EXPECT_THAT(ends_of("G0 X3. Y4.\nG0 X[#5001+#5042]").back(), ElementsAre(7, 4, 10));
  EXPECT_THAT(refusal_of(program_of("G68 X0 Y0 R90.\n#1=#5041")), HasSubstr("6:4: #5041 is where the tool is, and in"));
  EXPECT_EQ(value_of("#4109"), 600);
  EXPECT_EQ(value_of("#4006"), 21);
  EXPECT_EQ(value_of("#4115"), 1);
}

TEST(FanucVariable, OfTheSystemIsRefusedByWhatItIs) {
  EXPECT_THAT(refusal_of(program_of("#1=#2001")), StartsWith("5:4: #2001 is one of those that are tool offsets"));
  EXPECT_THAT(refusal_of(program_of("#5221=1.")), HasSubstr("set them by G10 L2"));
  EXPECT_THAT(refusal_of(program_of("#3004=7")), HasSubstr("overrides"));
  EXPECT_THAT(refusal_of(program_of("#1=#3011")), HasSubstr("clocks"));
  EXPECT_THAT(refusal_of(program_of("#1=#5024")), HasSubstr("places of the tool"));
  EXPECT_THAT(refusal_of(program_of("#1=#50000")), HasSubstr("variable of the system"));
}

TEST(FanucVariable, RaisesAlarmsAndStops) {
  EXPECT_THAT(refusal_of(program_of("#3000=12 (TOOL BROKEN)")),
              StartsWith("5:1: the program raises its alarm 3012 here: TOOL BROKEN"));
  EXPECT_EQ(imported(program_of("#3006=1 (TURN THE PART)")).requests[1]["params"]["Message"], "TURN THE PART");
}

TEST(FanucValue, InAWordIsRoundedToItsIncrement) {
  EXPECT_EQ(value_of("[1/3]"), 0.333);
  EXPECT_EQ(value_of("#1", "#1=2/3\n"), 0.667);
  EXPECT_EQ(value_of("1.23456"), 1.23456);
  EXPECT_NEAR(value_of("[1/3]", "G20\n"), 0.3333 * 25.4, 1e-9);
  EXPECT_EQ(xs_of("G65 P7 A[2/3]", "O7\nG0 X[#1*3]\nM99\n").back(), 2) << "an argument is no length yet";
}

TEST(FanucValue, IsWholeForFixAndFupWhereItIsSoForEq) {
  EXPECT_EQ(statement("FIX[0.6/0.1]"), 6);
  EXPECT_EQ(statement("FUP[0.3/0.1]"), 3);
  EXPECT_EQ(statement("FUP[[0.1+0.2]*10]"), 3);
  EXPECT_EQ(statement("FIX[5.999]"), 5);
}

TEST(FanucVariable, TellsWhereTheToolIsInTheMachine) {
  Options options;
  options.offsets[0] = {-100, -50, -20};
  options.offsets[1] = {-200, -60, -20};
  EXPECT_THAT(ends_of("G0 X3. Y4.\n#1=#5021\nG0 X#1 Y#5022", options).back(), ElementsAre(-97, -46, 10));
  EXPECT_THAT(ends_of("G0 X3. Y4.\nG55\nG0 X#5021 Y0", options).back(), ElementsAre(-97, 0, 10)) << "it did not move";
  EXPECT_THAT(ends_of("G0 X3.\nG20\nG0 X#5021 F1.", options).back(), ElementsAre(DoubleNear(-97, 2e-3), 0, 10));
  EXPECT_THAT(refusal_of(program_of("#1=#5021")), HasSubstr("give --offset G54=X,Y,Z"));
  EXPECT_THAT(refusal_of(program_of("#1=#5023"), options), HasSubstr("the spindle is without its tool"));
  options.tool_diameters_mm = {{1, 4}};
  EXPECT_THAT(refusal_of(program_of("G1 G41 D1 X10.\n#1=#5021\nY20.\nG40 X0"), options), HasSubstr("write G40"));
}

}  // namespace
}  // namespace rmac::fanuc
