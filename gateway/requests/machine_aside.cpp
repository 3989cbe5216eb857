#include "gateway/requests/machine_aside.hpp"

#include <memory>

namespace rmac::gateway {

MachineAside::MachineAside(asio::io_context& io, Dispatcher& dispatcher, std::function<void()> on_back)
    : io_(io), dispatcher_(dispatcher), on_back_(std::move(on_back)) {}

void MachineAside::run(std::function<void()> work, std::function<void()> done) {
  run_on(thread_, std::move(work), std::move(done));
}

void MachineAside::run_on(asio::thread_pool& thread, std::function<void()> work, std::function<void()> done) {
  asio::post(thread, [this, work = std::move(work), done = std::move(done)]() mutable {
    work();
    work = nullptr;
    asio::post(io_, std::move(done));
  });
}

void MachineAside::take_machine(std::uint64_t client, std::function<void(MachineStatus&)> work,
                                std::function<bool()> done) {
  last_served_ = client;
  away_ = true;
  auto status = std::make_shared<MachineStatus>(dispatcher_.status());
  run([work = std::move(work), status] { work(*status); },
      [this, status, before = *status, done = std::move(done)] {
        away_ = mechanism_changes_ = false;
        take_over(before, *status);
        // A move that must wait for room is tried again at the next tick, not at once.
        if (done()) on_back_();
      });
}

void MachineAside::take_over(const MachineStatus& before, const MachineStatus& after) {
  if (after == before) return;
  // What went wrong here meanwhile is not cleared with what was known before.
  if (after.major != 0 || dispatcher_.status() == before) dispatcher_.status() = after;
}

void MachineAside::carry_out(const Request& request, SessionPort& session, std::uint64_t client,
                             std::function<bool(Answer)> done) {
  mechanism_changes_ = request.method->slow && request.effect() == Effect::Starts;
  auto answer = std::make_shared<Answer>();
  take_machine(
      client,
      [this, &request, &session, answer](MachineStatus& status) {
        *answer = dispatcher_.carry_out(request, session, status);
      },
      [answer, done = std::move(done)] { return done(std::move(*answer)); });
}

void MachineAside::run_apart(bool changes_status, std::function<void(MachineStatus&)> work,
                             std::function<void()> done) {
  auto status = std::make_shared<MachineStatus>(dispatcher_.status());
  run_on(
      apart_, [work = std::move(work), status] { work(*status); },
      [this, changes_status, status, before = *status, done = std::move(done)] {
        if (changes_status) take_over(before, *status);
        done();
      });
}

void MachineAside::carry_out_apart(const Request& request, SessionPort& session, std::function<void(Answer)> done) {
  auto answer = std::make_shared<Answer>();
  run_apart(
      Dispatcher::changes_status(request, session),
      [this, &request, &session, answer](MachineStatus& status) {
        *answer = dispatcher_.carry_out(request, session, status);
      },
      [answer, done = std::move(done)] { done(std::move(*answer)); });
}

void MachineAside::prepare(const Request& request, SessionPort& session, Method::Job job,
                           std::function<void(std::optional<Answer>)> done) {
  auto failed = std::make_shared<std::optional<Answer>>();
  run_apart(
      Dispatcher::changes_status(request, session),
      [this, &request, job = std::move(job), failed](MachineStatus& status) {
        *failed = dispatcher_.prepare(request, job, status);
      },
      [failed, done = std::move(done)] { done(std::move(*failed)); });
}

void MachineAside::stop() {
  for (asio::thread_pool* thread : {&thread_, &apart_}) {
    thread->stop();
    thread->join();
  }
}

}  // namespace rmac::gateway
