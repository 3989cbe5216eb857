#pragma once

#include <list>
#include <string>

#include "gateway/simulators/vmodbus/line.hpp"

namespace rmac::vmodbus {

struct SerialSettings {
  std::string device;
  int bit_rate = 9600;
  char parity = 'N';
  int stop_bits = 1;
};

/// Where masters reach the devices: a TCP port, pseudo-terminals, serial ports. One thread.
class Endpoints {
 public:
  explicit Endpoints(Devices& devices) : devices_(devices) {}
  ~Endpoints();
  Endpoints(const Endpoints&) = delete;
  Endpoints& operator=(const Endpoints&) = delete;

  /// Listens on a TCP port of an address, 0 for any that is free; the port.
  [[nodiscard]] Expected<int> listen(const std::string& address, int port);
  /// Makes a pseudo-terminal, which is a serial port to a master, and a link to it at `path`.
  [[nodiscard]] Expected<> open_pseudo_terminal(const std::string& path);
  [[nodiscard]] Expected<> open_serial(const SerialSettings& settings);

  /// Serves for about so long.
  void serve(std::chrono::milliseconds duration);

 private:
  void accept_all();

  Devices& devices_;
  int listener_ = -1;
  std::list<Line> lines_;
  std::vector<int> other_ends_;  ///< of pseudo-terminals: held, so that a master may come and go
  std::vector<std::string> links_;
};

}  // namespace rmac::vmodbus
