#include "gateway/rmac/wire/connection.hpp"

#include <fmt/format.h>
#include <sys/un.h>
#include <unistd.h>

#include <asio/local/stream_protocol.hpp>
#include <csignal>
#include <istream>

#include "gateway/api/methods/method_table.hpp"
#include "gateway/json/printable.hpp"

namespace rmac::cli {

namespace {

constexpr std::size_t kMaxLineBytes = 64U << 20U;
constexpr auto kCallBound = std::chrono::seconds(60);
/// Machines are verified by processes of low priority: longer than the appliance's own patience with them.
constexpr auto kSlowCallBound = std::chrono::seconds(660);

std::chrono::seconds bound_of(const std::string& method) {
  const gateway::Method* found = gateway::find_method(method);
  return found != nullptr && found->slow ? kSlowCallBound : kCallBound;
}

}  // namespace

std::string to_string(const Endpoint& endpoint) {
  return endpoint.socket.empty() ? fmt::format("{}:{}", endpoint.host, endpoint.port) : endpoint.socket;
}

Connection::Connection(Endpoint endpoint) : endpoint_(std::move(endpoint)) {
  signals_.async_wait([this](const asio::error_code& error, int) {
    if (!error) {
      interrupted_ = true;
      // A second Ctrl-C ends the client at once, whatever it waits for.
      asio::error_code ignored;
      signals_.clear(ignored);
    }
  });
}

Result<std::unique_ptr<Connection>> Connection::open(const Endpoint& endpoint) {
  std::unique_ptr<Connection> connection(new Connection(endpoint));
  asio::error_code error;
  if (endpoint.socket.size() >= sizeof(sockaddr_un::sun_path)) {
    error = asio::error::name_too_long;
  } else if (!endpoint.socket.empty()) {
    connection->socket_.connect(asio::local::stream_protocol::endpoint(endpoint.socket), error);
  } else {
    asio::ip::tcp::resolver resolver(connection->io_);
    const auto addresses = resolver.resolve(endpoint.host, std::to_string(endpoint.port), error);
    for (const auto& address : addresses) {
      asio::error_code ignored;
      connection->socket_.close(ignored);
      connection->socket_.connect(address.endpoint(), error);
      if (!error) {
        connection->socket_.set_option(asio::ip::tcp::no_delay(true), ignored);
        break;
      }
    }
  }
  if (error) {
    return fail(
        fmt::format("no appliance answers at {} ({}): start rmacd, or name its place with --host, --port or --socket",
                    to_string(endpoint), error.message()));
  }
  connection->read();
  auto hello = connection->call("hello", {{"client", "rmac"}, {"version", RMAC_VERSION}});
  if (!hello) {
    return tl::unexpected(hello.error());
  }
  connection->greeting_ = std::move(*hello);
  return connection;
}

void Connection::send(const std::string& method, const nlohmann::json& params, AnswerHandler handler) {
  if (!lost_.empty()) {
    handler(fail(lost_));
    return;
  }
  const auto id = next_id_++;
  open_.emplace(id, std::move(handler));
  nlohmann::json request{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}};
  if (!params.is_null()) {
    request["params"] = params;
  }
  // Words of a command line may be no UTF-8.
  output_.push_back(gateway::text_of(request) + '\n');
  if (output_.size() == 1) {
    write();
  }
}

Connection::Answer Connection::call(const std::string& method, const nlohmann::json& params) {
  // Shared, because an answer that comes after the bound must not write into a dead frame.
  auto slot = std::make_shared<std::optional<Answer>>();
  send(method, params, [slot](const Answer& received) { *slot = received; });
  const auto bound = bound_of(method);
  const auto answered = wait([&] { return slot->has_value(); }, bound);
  if (!answered) {
    return tl::unexpected(answered.error());
  }
  if (!*answered) {
    return fail(fmt::format("{} did not answer {} within {} s", to_string(endpoint_), method, bound.count()));
  }
  return std::move(**slot);
}

Result<> Connection::command(const std::string& method, const nlohmann::json& params) {
  return call(method, params).map([](const nlohmann::json&) {});
}

void Connection::on_entered_line(std::optional<int> terminal, std::function<void(const std::string& line)> handler) {
  entered_line_ = std::move(handler);
  if (terminal && !terminal_.is_open()) {
    // In the background of a shell, reading ends with an error instead of stopping the process.
    std::signal(SIGTTIN, SIG_IGN);
    terminal_.assign(dup(*terminal));
    read_terminal();
  }
}

void Connection::read_terminal() {
  asio::async_read_until(terminal_, entered_, '\n', [this](const asio::error_code& error, std::size_t) {
    if (error) {
      return;
    }
    std::string line;
    std::istream entered(&entered_);
    std::getline(entered, line);
    if (entered_line_) {
      entered_line_(line);
    }
    read_terminal();
  });
}

Result<> Connection::wait(const std::function<bool()>& done) {
  while (!done()) {
    if (!lost_.empty()) {
      return fail(lost_);
    }
    if (interrupted_ && !interruption_told_) {
      interruption_told_ = true;
      return fail("interrupted");
    }
    io_.run_one();
  }
  return {};
}

Result<bool> Connection::wait(const std::function<bool()>& done, std::chrono::milliseconds bound) {
  bool late = false;
  timer_.expires_after(bound);
  timer_.async_wait([&late](const asio::error_code& error) { late = !error; });
  auto waited = wait([&] { return late || done(); });
  timer_.cancel();
  // The cancelled handler refers to `late`: it must have run before this frame goes.
  io_.poll();
  if (!waited) {
    return tl::unexpected(waited.error());
  }
  return done();
}

void Connection::read() {
  asio::async_read_until(socket_, asio::dynamic_buffer(input_, kMaxLineBytes), '\n',
                         [this](const asio::error_code& error, std::size_t) {
                           if (error) {
                             lose(error.message());
                             return;
                           }
                           // Whole lines are taken out in one go: erasing per line would be quadratic on a full-rate
                           // stream.
                           std::string lines;
                           const auto end = input_.rfind('\n') + 1;
                           lines.assign(input_, 0, end);
                           input_.erase(0, end);
                           std::size_t begin = 0;
                           while (begin < lines.size()) {
                             const auto stop = lines.find('\n', begin);
                             take(std::string_view(lines).substr(begin, stop - begin));
                             begin = stop + 1;
                           }
                           read();
                         });
}

void Connection::write() {
  asio::async_write(socket_, asio::buffer(output_.front()), [this](const asio::error_code& error, std::size_t) {
    if (error) {
      lose(error.message());
      return;
    }
    output_.pop_front();
    if (!output_.empty()) {
      write();
    }
  });
}

void Connection::take(std::string_view line) {
  const auto message = nlohmann::json::parse(line, nullptr, false);
  if (!message.is_object()) {
    lose("it sent a line that is not JSON-RPC");
    return;
  }
  if (const auto method = message.find("method"); method != message.end() && method->is_string()) {
    if (notify_) {
      notify_(method->get_ref<const std::string&>(), message.value("params", nlohmann::json::object()));
    }
    return;
  }
  const auto id = message.find("id");
  const auto entry = id != message.end() && id->is_number_integer() ? open_.find(id->get<std::int64_t>()) : open_.end();
  const auto error = message.find("error");
  if (entry == open_.end()) {
    // An error without an id is about the stream itself, such as a line too long: nothing after it can be trusted.
    if (error != message.end()) {
      lose(error->value("message", "an error without a message"));
    }
    return;
  }
  const auto handler = std::move(entry->second);
  open_.erase(entry);
  if (error == message.end()) {
    handler(message.value("result", nlohmann::json()));
    return;
  }
  Failure failure{error->value("message", "an error without a message")};
  if (const auto code = error->find("code"); code != error->end() && code->is_number_integer()) {
    failure.rpc_code = code->get<int>();
  }
  handler(tl::unexpected(failure));
}

void Connection::lose(const std::string& why) {
  if (!lost_.empty()) {
    return;
  }
  lost_ = fmt::format("the connection to {} ended: {}", to_string(endpoint_), why);
  asio::error_code ignored;
  socket_.close(ignored);
  const auto open = std::move(open_);
  open_.clear();
  for (const auto& [id, handler] : open) {
    handler(fail(lost_));
  }
}

}  // namespace rmac::cli
