#pragma once

#include <asio.hpp>
#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/api/dispatch/dispatcher.hpp"
#include "gateway/server/telemetry.hpp"

namespace rmac::gateway {

class Server;

/// One client: reads lines, carries requests out in order (stops at once), writes answers and pushed topics.
class Connection final : public SessionPort, public std::enable_shared_from_this<Connection> {
 public:
  using Socket = asio::generic::stream_protocol::socket;

  Connection(Server& server, Socket socket, std::uint64_t id, std::string where);

  void start();
  /// Closes at once; nothing more is written.
  void abort();
  /// Closes once everything that was to be sent is sent, or some seconds have passed.
  void dismiss();
  /// Carries out what waits, as far as it goes.
  void pump();

  void push_sample(const CycleSample& sample);
  void push_event(const std::string& line);
  /// Sends the batches that `push_sample` collected.
  void flush_topics();

  [[nodiscard]] std::uint64_t id() const noexcept { return id_; }
  /// "cam-tool (127.0.0.1:40312)", for messages.
  [[nodiscard]] std::string name() const;
  [[nodiscard]] bool watches_fast() const noexcept;
  [[nodiscard]] bool behind() const noexcept;
  /// Behind for longer than the limit, without reading a byte.
  [[nodiscard]] bool stalled(std::chrono::steady_clock::time_point now) const noexcept;

  /// Whether the client waits for an answer.
  [[nodiscard]] bool waits() const noexcept { return !pending_.empty(); }
  /// Bytes that the client has sent so far, read by us or not.
  [[nodiscard]] std::uint64_t arrived_bytes() const;
  /// A stop that `what` names took effect: what stands before `position` of the input must start nothing.
  void stopped(Effect effect, const std::string& what, std::uint64_t position);

  void introduce(const std::string& client, const std::string& version) override;
  [[nodiscard]] nlohmann::json greeting() const override;
  [[nodiscard]] RecordCursor& records() override { return *records_; }
  [[nodiscard]] bool has_authority() const override;
  [[nodiscard]] std::string authority_holder() const override;
  tl::expected<nlohmann::json, RpcError> acquire_authority() override;
  tl::expected<void, RpcError> renew_authority() override;
  tl::expected<void, RpcError> release_authority() override;
  tl::expected<void, RpcError> subscribe(const std::vector<std::string>& topics, double rate_hz) override;
  void unsubscribe(const std::vector<std::string>& topics) override;
  void animate(bool on) override;

 private:
  /// The requests of one line.
  struct Work {
    bool away = false;      ///< on the thread beside the gateway's: being read, or its next request carried out
    bool prepared = false;  ///< its next request is, for being carried out
    bool batch = false;
    std::size_t answer_bytes = 0;  ///< of a batch's answers so far
    bool refuse_moves = false;     ///< a move before these found the queue full: taking a later one would leave a gap
    std::vector<Request> requests;
    std::vector<std::optional<Answer>> answers;
    std::size_t next = 0;
    std::uint64_t position = 0;  ///< of the line in the input; its requests count on from there
    std::size_t bytes = 0;
    std::chrono::steady_clock::time_point received;
  };
  enum class Phase {
    Open,      ///< reads and writes
    Draining,  ///< the client ended its side: what it sent is answered, then closed
    Leaving,   ///< refused for good: the last answer is written, input is thrown away
    Closed
  };

  void read();
  void take_input(std::size_t bytes);
  void take_line(std::string_view line);
  /// Makes the requests of a line. Any thread.
  static void read_requests(std::string_view line, Work& work);
  /// Carries out the stops in it, before anything that waits.
  void stop_first(Work& work);
  void end_of_input();
  void refuse_and_leave(RpcError error);
  void discard_input();
  void leave_within(std::chrono::seconds bound);

  [[nodiscard]] bool run(const std::shared_ptr<Work>& work);
  void carry_out_aside(const std::shared_ptr<Work>& work);
  /// Notes the answer to the next request. False when that is a move that must be tried again.
  [[nodiscard]] bool settle(Work& work, Answer answer);
  /// Whether a move that found the queue full is tried again.
  [[nodiscard]] bool must_wait(const Work& work) const;
  void refuse_pending_moves();
  /// Why a request must not run any more, if so.
  [[nodiscard]] std::optional<Answer> refusal_of(const Work& work, const Request& request) const;
  void answer(const Work& work);

  void send(std::string line);
  void write();
  void finish_if_drained();

  [[nodiscard]] std::vector<TopicPace*> paces(const std::vector<std::string>& topics);

  Server& server_;
  Socket socket_;
  std::uint64_t id_;
  std::string where_;
  std::string client_;
  std::unique_ptr<RecordCursor> records_;
  Phase phase_ = Phase::Open;

  std::array<char, 65536> buffer_{};
  std::string input_;
  bool reading_ = false;
  std::size_t discarded_ = 0;
  asio::steady_timer leaving_;

  std::uint64_t read_bytes_ = 0;        ///< of the input so far
  std::uint64_t line_position_ = 0;     ///< where the next line begins
  std::uint64_t no_starts_before_ = 0;  ///< position in the input: what starts motion and was sent before is refused
  std::uint64_t no_moves_before_ = 0;   ///< the same for moves
  std::string last_stop_;               ///< which stop that was

  std::deque<std::shared_ptr<Work>> pending_;
  std::size_t pending_bytes_ = 0;
  bool pump_posted_ = false;

  std::deque<std::string> output_;
  std::size_t output_bytes_ = 0;
  std::size_t writing_ = 0;  ///< lines of `output_` in the write under way
  std::chrono::steady_clock::time_point last_progress_;

  TopicPace state_, joints_, drives_;
  std::optional<std::int64_t> joints_before_animation_;  ///< cycles between samples; 0: none went out
  bool events_ = false;
  bool state_now_ = false;  ///< the first state goes out without waiting for a cycle
  std::string joints_batch_, drives_batch_;
};

}  // namespace rmac::gateway
