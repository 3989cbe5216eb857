#include "modbus/pdu.hpp"

#include <gtest/gtest.h>

#include <array>
#include <random>

namespace rmac::fieldbus::modbus {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::array kTables{Table::Coils, Table::DiscreteInputs, Table::InputRegisters, Table::HoldingRegisters};

/// What a slave that keeps the protocol answers to `question`, with `values` in the table that is read.
Bytes honest_answer(const Request& request, const Bytes& question, const std::vector<std::uint16_t>& values) {
  if (request.writes) return {question.begin(), question.begin() + 6};
  Bytes answer{question[0], question[1], 0};
  if (of_bits(request.table)) {
    answer.resize(3 + (values.size() + 7) / 8, 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      answer[3 + i / 8] = static_cast<std::uint8_t>(answer[3 + i / 8] | (values[i] != 0 ? 1U : 0U) << i % 8);
    }
  } else {
    for (const std::uint16_t value : values) {
      answer.push_back(static_cast<std::uint8_t>(value >> 8U));
      answer.push_back(static_cast<std::uint8_t>(value));
    }
  }
  answer[2] = static_cast<std::uint8_t>(answer.size() - 3);
  return answer;
}

struct Case {
  Request request;
  std::vector<std::uint16_t> values;
  Bytes question;
};

Case random_case(std::mt19937& random) {
  const auto below = [&](std::size_t bound) {
    return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random);
  };
  Case made;
  made.request.table = kTables[below(kTables.size())];
  made.request.writes = writable(made.request.table) && below(2) == 0;
  made.request.slave = static_cast<int>(1 + below(247));
  made.request.count = 1 + below(most_values(made.request));
  made.request.address = static_cast<std::uint16_t>(below(65537 - made.request.count));
  made.values.resize(made.request.count);
  for (std::uint16_t& value : made.values) {
    value = static_cast<std::uint16_t>(of_bits(made.request.table) ? below(2) : below(65536));
  }
  made.question = encode(made.request, made.values);
  return made;
}

TEST(ModbusPdu, TakesWhatAnHonestSlaveAnswers) {
  std::mt19937 random(1);  // NOLINT: the same questions in every run
  for (int i = 0; i < 2000; ++i) {
    const Case made = random_case(random);
    std::vector<std::uint16_t> read(made.request.writes ? 0 : made.request.count, 0xABCD);
    const Bytes answer = honest_answer(made.request, made.question, made.values);
    ASSERT_EQ(decode(made.request, made.question, answer, read).verdict, Verdict::Fits) << "case " << i;
    if (!made.request.writes) {
      ASSERT_EQ(read, made.values) << "case " << i;
    }
    ASSERT_LE(made.question.size(), 254U);
  }
}

TEST(ModbusPdu, TellsAnException) {
  const Request request{3, false, Table::HoldingRegisters, 0x2103, 2};
  const Bytes question = encode(request, {});
  std::array<std::uint16_t, 2> values{};
  const Decoded decoded = decode(request, question, Bytes{3, 0x83, 6}, values);
  EXPECT_EQ(decoded.verdict, Verdict::Exception);
  EXPECT_EQ(decoded.exception_code, 6);
  EXPECT_EQ(decode(request, question, Bytes{3, 0x83, 6, 0}, values).verdict, Verdict::Wrong);
  EXPECT_EQ(decode(request, question, Bytes{3, 0x84, 6}, values).verdict, Verdict::Wrong);
}

TEST(ModbusPdu, SaysWhatAnExceptionMeans) {
  const std::vector<std::pair<int, std::string>> texts{
      {1, "it does not know the function"},  {2, "it has no such address"},
      {3, "it does not take the value"},     {4, "it failed in carrying it out"},
      {5, "it has begun and needs longer"},  {6, "it is busy"},
      {7, "for a reason of its own"},        {8, "its memory has a parity error"},
      {10, "the gateway has no path to it"}, {11, "the gateway got no answer from it"},
      {200, "for a reason of its own"}};
  for (const auto& [code, text] : texts) EXPECT_EQ(exception_text(code), text) << code;
}

TEST(ModbusPdu, TakesNothingForAnAnswerThatIsNot) {
  std::mt19937 random(2);  // NOLINT: the same damage in every run
  const auto below = [&](std::size_t bound) {
    return std::uniform_int_distribution<std::size_t>(0, bound - 1)(random);
  };
  for (int i = 0; i < 20000; ++i) {
    const Case made = random_case(random);
    Bytes answer = honest_answer(made.request, made.question, made.values);
    const Bytes before = answer;
    switch (below(4)) {
      case 0:
        answer.resize(below(answer.size()));
        break;
      case 1:
        answer.resize(answer.size() + 1 + below(40), static_cast<std::uint8_t>(below(256)));
        break;
      case 2:  // slave, function, length; of a write all of it
        answer[below(made.request.writes ? 6 : 3)] ^= static_cast<std::uint8_t>(1 + below(255));
        break;
      default:
        answer.resize(below(260));
        for (std::uint8_t& byte : answer) byte = static_cast<std::uint8_t>(below(256));
        break;
    }
    if (answer == before) continue;
    std::vector<std::uint16_t> read(made.request.writes ? 0 : made.request.count, 0xABCD);
    const std::vector<std::uint16_t> untouched = read;
    const Decoded decoded = decode(made.request, made.question, answer, read);
    // A flipped bit or noise can be an exception; a value it is never.
    ASSERT_NE(decoded.verdict, Verdict::Fits) << "case " << i;
    ASSERT_EQ(read, untouched) << "case " << i;
  }
}

}  // namespace
}  // namespace rmac::fieldbus::modbus
