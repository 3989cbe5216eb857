#include "rmac/fieldbus/modbus/register_map.hpp"

#include <fmt/format.h>

namespace rmac::fieldbus::modbus {
namespace {

constexpr std::size_t kIoBits = 64;

/// Addresses that an entry takes, for telling which overlap.
struct Extent {
  std::string entry;
  Table table;
  std::size_t first;
  std::size_t count;

  [[nodiscard]] std::size_t end() const { return first + count; }
  [[nodiscard]] bool same(const Extent& other) const { return first == other.first && count == other.count; }
  [[nodiscard]] bool overlaps(const Extent& other) const {
    return table == other.table && first < other.end() && other.first < end();
  }
  [[nodiscard]] std::string text() const {
    return count == 1 ? fmt::format("{} ({} {:04X}h)", entry, to_string(table), first)
                      : fmt::format("{} ({}s {:04X}h to {:04X}h)", entry, to_string(table), first, end() - 1);
  }
};

Extent extent(std::string entry, const Place& place) {
  return {std::move(entry), place.table, place.address, place.count()};
}

Extent extent(const std::string& list, std::size_t entry, const BitRange& range) {
  return {fmt::format("{}/{}", list, entry), range.place.table, range.place.address, range.addresses()};
}

/// The first mistake that was found; an empty text is none.
class Findings {
 public:
  explicit Findings(const std::string& map) : map_(map) {}
  void refuse(const std::string& what) {
    if (problem_.empty()) problem_ = fmt::format("register map {}: {}", map_, what);
  }
  void within(const Extent& one) {
    if (one.end() > kAddresses) refuse(one.text() + " goes beyond address FFFFh");
  }
  [[nodiscard]] Expected<> result() const {
    if (problem_.empty()) return {};
    return failure(MinorCode::InvalidParameterValue, problem_);
  }

 private:
  const std::string& map_;
  std::string problem_;
};

void check_place(Findings& findings, const std::string& entry, const Place& place) {
  findings.within(extent(entry, place));
  if (of_bits(place.table) && (place.bits != 1 || place.is_signed)) {
    findings.refuse(fmt::format("{} is a {}, which has 1 bit without a sign", entry, to_string(place.table)));
  }
  if (!of_bits(place.table) && place.bits != 16 && place.bits != 32) {
    findings.refuse(fmt::format("{} has {} bits; a register has 16, and two make 32", entry, place.bits));
  }
}

/// Values that are read may share a register, each with its mask, but not half of one.
void check_reads(Findings& findings, const std::vector<Extent>& reads, std::size_t most_per_read) {
  for (std::size_t i = 0; i < reads.size(); ++i) {
    if (reads[i].count > most_per_read) {
      findings.refuse(fmt::format("{} is longer than the {} that MostPerRead allows", reads[i].text(), most_per_read));
    }
    for (std::size_t j = 0; j < i; ++j) {
      if (reads[i].overlaps(reads[j]) && !reads[i].same(reads[j])) {
        findings.refuse(fmt::format("{} and {} overlap", reads[j].text(), reads[i].text()));
      }
    }
  }
}

void check_writes(Findings& findings, const std::string& entry, const std::vector<RegisterWrite>& writes,
                  const Extent& speed) {
  if (writes.empty()) findings.refuse(entry + " writes nothing");
  for (const RegisterWrite& write : writes) {
    const Extent one{entry, write.table, write.address, 1};
    if (!writable(write.table)) findings.refuse(one.text() + " cannot be written");
    if (of_bits(write.table) && write.value > 1) findings.refuse(one.text() + " takes 0 or 1");
    if (one.overlaps(speed)) findings.refuse(fmt::format("{} and {} overlap", speed.text(), one.text()));
  }
}

void check_bits(Findings& findings, const std::string& list, const std::vector<BitRange>& ranges) {
  std::uint64_t taken = 0;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const BitRange& range = ranges[i];
    const Extent one = extent(list, i, range);
    findings.within(one);
    if (range.count == 0 || range.first + range.count > kIoBits) {
      findings.refuse(fmt::format("{} fills bits {} to {}; there are {}", one.text(), range.first,
                                  static_cast<std::int64_t>(range.first + range.count) - 1, kIoBits));
      return;
    }
    const std::uint64_t bits = (range.count == kIoBits ? ~std::uint64_t{0} : (std::uint64_t{1} << range.count) - 1)
                               << range.first;
    if ((taken & bits) != 0) findings.refuse(one.text() + " fills bits that another one fills already");
    taken |= bits;
    for (std::size_t j = 0; j < i; ++j) {
      const Extent other = extent(list, j, ranges[j]);
      if (one.overlaps(other)) findings.refuse(fmt::format("{} and {} overlap", other.text(), one.text()));
    }
  }
}

}  // namespace

Expected<> check(const SpindleMap& map) {
  Findings findings(map.name);
  const Extent command = extent("SpeedCommand", map.speed_command.place);
  check_place(findings, "SpeedCommand", map.speed_command.place);
  if (!writable(map.speed_command.place.table)) findings.refuse(command.text() + " cannot be written");
  if (!map.tripped && !map.fault_code) findings.refuse("neither Fault/Tripped nor Fault/Code tells a fault");
  std::vector<Extent> reads;
  const auto add = [&](const char* entry, const Place& place) {
    check_place(findings, entry, place);
    reads.push_back(extent(entry, place));
  };
  add("Speed", map.speed.place);
  if (map.speed_read_back) add("ReadBack", *map.speed_read_back);
  if (map.running) add("Running", map.running->place);
  if (map.backward) add("Reversed", map.backward->place);
  if (map.tripped) add("Fault/Tripped", map.tripped->place);
  if (map.fault_code) add("Fault/Code", *map.fault_code);
  check_reads(findings, reads, map.most_per_read);
  check_writes(findings, "Forward", map.forward_run, command);
  if (!map.backward_run.empty()) check_writes(findings, "Reverse", map.backward_run, command);
  check_writes(findings, "Stop", map.stop, command);
  check_writes(findings, "ResetFault", map.reset_fault, command);
  return findings.result();
}

Expected<> check(const IoMap& map) {
  Findings findings(map.name);
  check_bits(findings, "Inputs", map.inputs);
  check_bits(findings, "Outputs", map.outputs);
  for (std::size_t i = 0; i < map.outputs.size(); ++i) {
    const Extent one = extent("Outputs", i, map.outputs[i]);
    if (!writable(one.table)) findings.refuse(one.text() + " cannot be written");
  }
  if (map.inputs.empty() && map.outputs.empty()) findings.refuse("it has neither inputs nor outputs");
  return findings.result();
}

}  // namespace rmac::fieldbus::modbus
