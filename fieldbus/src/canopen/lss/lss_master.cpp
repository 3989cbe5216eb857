#include "canopen/lss/lss_master.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rmac/fieldbus/canopen/bus_scan.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::uint16_t kRequestId = 0x7E5, kAnswerId = 0x7E4;
constexpr std::chrono::milliseconds kStep{1};

bool is_answer(const CanFrame& frame, LssCommand command) {
  return frame.id == kAnswerId && frame.size == 8 && frame.data[0] == static_cast<std::uint8_t>(command);
}

}  // namespace

IdentityParts parts_of(const Identity& identity) noexcept {
  return {identity.vendor_id, identity.product_code, identity.revision_number, identity.serial_number};
}

Error several_of(const Identity& identity, std::size_t nodes) {
  return {MinorCode::InvalidParameterValue,
          fmt::format("{} answers {} times, as several nodes of one identity do: connect them one after the other, so "
                      "that each gets an id of its own",
                      to_string(identity), nodes)};
}

Expected<> LssMaster::begin() {
  auto idle = check_idle(port_, options_.listen);
  if (idle) switch_all(false);
  return idle;
}

void LssMaster::switch_all(bool configure) {
  send(LssCommand::SwitchAll, {static_cast<std::uint8_t>(configure ? 1 : 0)});
}

void LssMaster::activate_bit_timing(std::chrono::milliseconds delay) {
  const auto ms = static_cast<std::uint32_t>(delay.count());
  send(LssCommand::ActivateBitTiming, {byte(ms, 0), byte(ms, 1)});
}

LssMaster::Answers LssMaster::gather(LssCommand request, std::initializer_list<std::uint8_t> rest, LssCommand answer,
                                     std::chrono::nanoseconds window) {
  forget_received();
  send(request, rest);
  Answers came;
  const auto start = port_.now();
  while (port_.now() < start + window) {
    port_.wait(std::min<std::chrono::nanoseconds>(start + window - port_.now(), kStep));
    CanFrame frame;
    while (port_.receive(frame)) {
      if (!is_answer(frame, answer)) continue;
      came.frames.push_back(frame);
      came.last = port_.now() - start;
    }
  }
  return came;
}

std::optional<CanFrame> LssMaster::ask(LssCommand request, std::initializer_list<std::uint8_t> rest,
                                       LssCommand answer) {
  constexpr int kAttempts = 2;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    forget_received();
    send(request, rest);
    for (const auto end = port_.now() + options_.patience; port_.now() < end;) {
      CanFrame frame;
      while (port_.receive(frame)) {
        if (is_answer(frame, answer)) return frame;
      }
      port_.wait(std::min<std::chrono::nanoseconds>(end - port_.now(), kStep));
    }
  }
  return {};
}

Expected<> LssMaster::select(const Identity& identity) {
  switch_all(false);
  const IdentityParts parts = parts_of(identity);
  constexpr std::array kNaming{LssCommand::SelectVendor, LssCommand::SelectProduct, LssCommand::SelectRevision};
  for (std::size_t part = 0; part < kNaming.size(); ++part) {
    const std::uint32_t number = parts.at(part);
    send(kNaming.at(part), {byte(number, 0), byte(number, 1), byte(number, 2), byte(number, 3)});
  }
  const std::uint32_t serial = parts.back();
  const auto told = ask(LssCommand::SelectSerial, {byte(serial, 0), byte(serial, 1), byte(serial, 2), byte(serial, 3)},
                        LssCommand::Selected);
  if (told) return {};
  return failure(MinorCode::CommTimeout,
                 fmt::format("no node answers to {}: it is not there, or knows no LSS", to_string(identity)));
}

Expected<> LssMaster::check_selected(const Identity& identity) {
  const IdentityParts parts = parts_of(identity);
  for (std::uint8_t part = 0; part < parts.size(); ++part) {
    // Asked of all that configure, so the slowest has to be waited for. Not every node knows the question.
    const auto inquire = static_cast<LssCommand>(static_cast<std::uint8_t>(LssCommand::InquireVendor) + part);
    const Answers told = gather(inquire, {}, inquire, options_.listen);
    if (told.frames.empty()) return {};
    const bool other = std::any_of(told.frames.begin(), told.frames.end(),
                                   [&](const CanFrame& frame) { return long_at(&frame.data[1]) != parts.at(part); });
    if (other) {
      return failure(MinorCode::Other,
                     fmt::format("another node than {} configures, too; switch both off and on", to_string(identity)));
    }
    if (told.frames.size() > 1) return tl::unexpected(several_of(identity, told.frames.size()));
  }
  return {};
}

Expected<> LssMaster::configure(LssCommand request, std::initializer_list<std::uint8_t> rest, const std::string& what) {
  const auto done = ask(request, rest, request);
  if (!done) return failure(MinorCode::CommTimeout, fmt::format("the node did not answer when {}", what));
  if (done->data[1] == 0) return {};
  constexpr std::uint8_t kNotKept = 2, kOfItsOwn = 0xFF;
  const std::string why = done->data[1] == kOfItsOwn  ? fmt::format("error {} of its maker", done->data[2])
                          : done->data[1] == kNotKept ? "its memory cannot be written"
                                                      : "out of its range, or not supported";
  return failure(MinorCode::Other, fmt::format("the node refused when {}: {}", what, why));
}

std::optional<std::uint8_t> LssMaster::node_of_selected() {
  const auto told = ask(LssCommand::InquireNode, {}, LssCommand::InquireNode);
  return told ? std::optional(told->data[1]) : std::nullopt;
}

void LssMaster::forget_received() {
  CanFrame frame;
  while (port_.receive(frame)) {
  }
}

void LssMaster::send(LssCommand command, std::initializer_list<std::uint8_t> rest) {
  CanFrame frame{.id = kRequestId, .size = 8};
  frame.data[0] = static_cast<std::uint8_t>(command);
  std::copy(rest.begin(), rest.end(), frame.data.begin() + 1);
  port_.send(frame);
}

}  // namespace rmac::fieldbus::canopen
