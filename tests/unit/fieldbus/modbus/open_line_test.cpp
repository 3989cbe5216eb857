#include "modbus/open_line.hpp"

#include <gmock/gmock.h>

#include <string>

// What is no endpoint is told before anything is opened.

namespace rmac::fieldbus::modbus {
namespace {

using testing::HasSubstr;

TEST(OpenLine, TakesNumericAddressesOfEitherKindAndAPort) {
  for (const std::string address : {"127.0.0.1", "192.168.1.20", "::1", "fe80::1"})
    EXPECT_EQ(check(TcpEndpoint{address, 502}), "") << address;
  EXPECT_EQ(check(TcpEndpoint{"127.0.0.1", 1}), "");
  EXPECT_EQ(check(TcpEndpoint{"127.0.0.1", 65535}), "");
  EXPECT_THAT(check(TcpEndpoint{"127.0.0.1", 0}), HasSubstr("port 0 cannot be connected to"));
  for (const std::string address :
       {"", "drive", "localhost", "192.168.1.256", "1.2.3.4.5", "127.0.0.1:502", " 127.0.0.1"}) {
    EXPECT_THAT(check(TcpEndpoint{address, 502}), HasSubstr("is no numeric IP address")) << address;
  }
}

TEST(OpenLine, TakesTheRatesParitiesAndStopBitsThatThereAre) {
  const auto said = [](int bit_rate, char parity, int stop_bits) {
    RtuEndpoint endpoint;
    endpoint.device = "/dev/ttyS0";
    endpoint.bit_rate = bit_rate;
    endpoint.parity = parity;
    endpoint.stop_bits = stop_bits;
    return check(endpoint);
  };
  for (const int rate : {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800, 500000, 921600}) {
    EXPECT_EQ(said(rate, 'E', 1), "") << rate;
    EXPECT_EQ(said(rate + 1, 'E', 1),
              "bit rate " + std::to_string(rate + 1) +
                  "; there are 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800, 500000, 921600");
  }
  for (const int rate : {0, -9600, 14400, 250000, 1000000})
    EXPECT_THAT(said(rate, 'E', 1), HasSubstr("; there are 1200,")) << rate;
  for (int letter = 0; letter < 127; ++letter) {
    const char parity = static_cast<char>(letter);
    const bool is_one = parity == 'N' || parity == 'E' || parity == 'O';
    EXPECT_EQ(said(19200, parity, 1).empty(), is_one) << letter;
  }
  for (int bits = -1; bits < 5; ++bits) EXPECT_EQ(said(19200, 'N', bits).empty(), bits == 1 || bits == 2) << bits;
  EXPECT_EQ(said(19200, 'N', 3), "3 stop bits; there are 1 and 2");
  EXPECT_EQ(check(RtuEndpoint{}), "no serial device is named");
}

}  // namespace
}  // namespace rmac::fieldbus::modbus
