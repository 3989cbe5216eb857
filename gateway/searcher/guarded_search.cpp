#include "gateway/searcher/guarded_search.hpp"

#include <fmt/format.h>
#include <sqlite3.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdarg>
#include <cstdio>
#include <memory>
#include <string_view>

namespace rmac::gateway {
namespace {

constexpr std::size_t kMaxRows = 10'000;
constexpr sqlite3_int64 kMaxHeapBytes = 64 << 20;

constexpr std::array<std::string_view, 18> kColumns = {"MechanismID",
                                                       "Name",
                                                       "DeviceDriver",
                                                       "Type",
                                                       "ConfigurationType",
                                                       "NumberOfJoints",
                                                       "Length",
                                                       "Width",
                                                       "Depth",
                                                       "SpindleHorsePower",
                                                       "SpindleMaxSpeed",
                                                       "SpindleMaxTorque",
                                                       "MaxFeedrate",
                                                       "MaxPalletLoad",
                                                       "PositioningTolerance",
                                                       "RepeatabilityTolerance",
                                                       "SpeedCapability",
                                                       "DriverVersion"};
// Not in it, because their result grows at will or they reach outside: printf, replace, hex, zeroblob, randomblob,
// group_concat, char, glob, load_extension and the rest.
constexpr std::array<std::string_view, 21> kFunctions = {
    "abs", "avg",    "coalesce", "count", "ifnull", "instr",     "length", "like",  "lower", "ltrim", "max",
    "min", "nullif", "round",    "rtrim", "substr", "substring", "sum",    "total", "trim",  "upper"};

struct Limit {
  int id;
  int value;
};
constexpr std::array<Limit, 12> kLimits = {{{SQLITE_LIMIT_LENGTH, 8'192},
                                            {SQLITE_LIMIT_SQL_LENGTH, 4'096},
                                            {SQLITE_LIMIT_COLUMN, 64},
                                            {SQLITE_LIMIT_EXPR_DEPTH, 50},
                                            {SQLITE_LIMIT_COMPOUND_SELECT, 4},
                                            {SQLITE_LIMIT_VDBE_OP, 25'000},
                                            {SQLITE_LIMIT_FUNCTION_ARG, 8},
                                            {SQLITE_LIMIT_ATTACHED, 0},
                                            {SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 100},
                                            {SQLITE_LIMIT_VARIABLE_NUMBER, 0},
                                            {SQLITE_LIMIT_TRIGGER_DEPTH, 0},
                                            {SQLITE_LIMIT_WORKER_THREADS, 0}}};

bool same(std::string_view a, const char* b) {
  const std::string_view other = b == nullptr ? "" : b;
  return a.size() == other.size() && strncasecmp(a.data(), other.data(), a.size()) == 0;
}

template <std::size_t N>
bool listed(const std::array<std::string_view, N>& names, const char* name) {
  return std::any_of(names.begin(), names.end(), [&](std::string_view entry) { return same(entry, name); });
}

/// What the callbacks share with the search: they run inside SQLite and may not throw, so the reason has a fixed size.
struct Guard {
  std::array<char, 160> reason{};

  [[gnu::format(printf, 2, 3)]] int deny(const char* format, ...) noexcept {
    va_list arguments;
    va_start(arguments, format);
    if (reason[0] == '\0') std::vsnprintf(reason.data(), reason.size(), format, arguments);
    va_end(arguments);
    return SQLITE_DENY;
  }
};

const char* or_nothing(const char* text) {
  return text == nullptr ? "" : text;
}

int authorize(void* data, int action, const char* first, const char* second, const char* schema, const char*) {
  Guard& guard = *static_cast<Guard*>(data);
  switch (action) {
    case SQLITE_SELECT:
      return SQLITE_OK;
    case SQLITE_READ: {
      // An empty column stands for the row as such, as in count(*), and comes without a schema.
      const bool row_alone = second == nullptr || *second == '\0';
      if (!same("DeviceDrivers", first) || (schema == nullptr ? !row_alone : !same("main", schema))) {
        return guard.deny("it reads the table \"%.60s\"; only DeviceDrivers may be read", or_nothing(first));
      }
      if (!row_alone && !listed(kColumns, second)) {
        return guard.deny("DeviceDrivers has no column \"%.60s\" for clients", second);
      }
      return SQLITE_OK;
    }
    case SQLITE_FUNCTION:
      if (listed(kFunctions, second)) return SQLITE_OK;
      return guard.deny("the function %.60s is not available here", or_nothing(second));
    case SQLITE_RECURSIVE:
      return guard.deny("it is recursive");
    default:
      return guard.deny("only SELECT on the table DeviceDrivers is allowed");
  }
}

struct Close {
  void operator()(sqlite3* connection) const noexcept { sqlite3_close_v2(connection); }
  void operator()(sqlite3_stmt* statement) const noexcept { sqlite3_finalize(statement); }
};
using Connection = std::unique_ptr<sqlite3, Close>;
using Statement = std::unique_ptr<sqlite3_stmt, Close>;

tl::unexpected<Error> refused(const std::string& reason) {
  return failure(MinorCode::InvalidParameterValue, reason);
}

/// Where the quoted text or comment that starts at `from` ends; `from` when none starts there.
std::size_t skip_quoted(std::string_view sql, std::size_t from) {
  struct Quote {
    std::string_view open, close;
  };
  // A doubled quote inside a text reads as two texts in a row, which ends at the same place.
  constexpr std::array<Quote, 6> kQuotes = {
      {{"'", "'"}, {"\"", "\""}, {"`", "`"}, {"[", "]"}, {"--", "\n"}, {"/*", "*/"}}};
  for (const Quote& quote : kQuotes) {
    if (sql.substr(from, quote.open.size()) != quote.open) continue;
    const std::size_t end = sql.find(quote.close, from + quote.open.size());
    return end == std::string_view::npos ? sql.size() : end + quote.close.size();
  }
  return from;
}

/// Whether the statement has the word WITH. SQLite copies a common table for each mention while it prepares, so forty
/// of them, each naming the one before twice, take 2^40 copies.
bool has_common_table(std::string_view sql) {
  const auto in_word = [](char letter) {
    return letter == '_' || letter == '$' || std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter < 0;
  };
  for (std::size_t at = 0; at < sql.size();) {
    if (const std::size_t end = skip_quoted(sql, at); end != at) {
      at = end;
    } else if (in_word(sql[at])) {
      const std::size_t start = at;
      while (at < sql.size() && in_word(sql[at])) ++at;
      if (same(sql.substr(start, at - start), "WITH")) return true;
    } else {
      ++at;
    }
  }
  return false;
}

/// Why SQLite gave up, in the order of what helps most.
tl::unexpected<Error> refused_by(sqlite3* connection, const Guard& guard, int result) {
  if (guard.reason[0] != '\0') return refused(guard.reason.data());
  if (result == SQLITE_NOMEM) return refused("it needs too much memory; select less");
  const std::string reason = sqlite3_errmsg(connection);
  return refused(reason.starts_with("no such column") ? reason + " (a text stands in single quotes)" : reason);
}

Connection open(const char* name, int flags) {
  sqlite3* raw = nullptr;
  const int opened = sqlite3_open_v2(name, &raw, flags | SQLITE_OPEN_NOMUTEX, nullptr);
  Connection connection(raw);
  return opened == SQLITE_OK ? std::move(connection) : nullptr;
}

/// A copy in memory: the statement has no file open, and no lock that a scan would have to wait for. Null when the file
/// cannot be read.
Connection copy_of(const std::string& database) {
  const Connection file = open(database.c_str(), SQLITE_OPEN_READONLY);
  Connection copy = open(":memory:", SQLITE_OPEN_READWRITE);
  if (file == nullptr || copy == nullptr) return nullptr;
  constexpr int kPatienceMs = 1000;
  sqlite3_backup* backup = sqlite3_backup_init(copy.get(), "main", file.get(), "main");
  if (backup == nullptr) return nullptr;
  // A scan that writes just now is waited for; sqlite3_backup_step itself does not.
  int result = SQLITE_OK;
  for (int waited_ms = 0; waited_ms < kPatienceMs; ++waited_ms) {
    result = sqlite3_backup_step(backup, -1);
    if (result != SQLITE_BUSY && result != SQLITE_LOCKED) break;
    sqlite3_sleep(1);
  }
  return sqlite3_backup_finish(backup) == SQLITE_OK && result == SQLITE_DONE ? std::move(copy) : nullptr;
}

/// Null when the file cannot be read.
Connection open_guarded(const std::string& database, Guard& guard) {
  sqlite3_hard_heap_limit64(kMaxHeapBytes);
  Connection connection = copy_of(database);
  if (connection == nullptr) return nullptr;
  sqlite3* const raw = connection.get();
  for (const auto& [option, value] : {std::pair(SQLITE_DBCONFIG_DEFENSIVE, 1),
                                      {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
                                      {SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0},
                                      {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
                                      {SQLITE_DBCONFIG_ENABLE_VIEW, 0},
                                      // A mistyped column would otherwise pass as a text.
                                      {SQLITE_DBCONFIG_DQS_DML, 0}}) {
    if (sqlite3_db_config(raw, option, value, nullptr) != SQLITE_OK) return nullptr;
  }
  // What does not fit is an error, never a file.
  if (sqlite3_exec(raw, "PRAGMA temp_store = MEMORY; PRAGMA query_only = ON", nullptr, nullptr, nullptr) != SQLITE_OK) {
    return nullptr;
  }
  for (const Limit& limit : kLimits) sqlite3_limit(raw, limit.id, limit.value);
  sqlite3_set_authorizer(raw, authorize, &guard);
  return connection;
}

/// Prepares the one statement that `sql` may hold.
Expected<Statement> prepare_alone(sqlite3* connection, const std::string& sql, const Guard& guard) {
  sqlite3_stmt* raw = nullptr;
  const char* tail = nullptr;
  int result = sqlite3_prepare_v2(connection, sql.c_str(), static_cast<int>(sql.size() + 1), &raw, &tail);
  Statement statement(raw);
  if (result != SQLITE_OK) return refused_by(connection, guard, result);
  if (statement == nullptr) return refused("it is empty");
  // Blanks, comments and semicolons prepare to nothing; anything else is a statement, sound or not.
  result = sqlite3_prepare_v2(connection, tail, -1, &raw, nullptr);
  const Statement second(raw);
  if (result != SQLITE_OK || second != nullptr) return refused("it holds more than one statement");
  if (sqlite3_stmt_readonly(statement.get()) == 0 || sqlite3_stmt_isexplain(statement.get()) != 0) {
    return refused("only SELECT on the table DeviceDrivers is allowed");
  }
  return statement;
}

Expected<int> number_column(sqlite3_stmt* statement) {
  for (int column = 0; column < sqlite3_column_count(statement); ++column) {
    if (same("MechanismID", sqlite3_column_name(statement, column))) return column;
  }
  return refused("its rows have no column MechanismID, which tells the mechanism; select * or MechanismID");
}

}  // namespace

Expected<std::vector<std::int64_t>> search_mechanisms(const std::string& database, const std::string& sql) {
  if (has_common_table(sql)) return refused("common tables (WITH) are not available here; use a subquery");
  Guard guard;
  const Connection connection = open_guarded(database, guard);
  if (connection == nullptr) {
    return failure(MinorCode::Other, fmt::format("the device driver database {} cannot be read", database));
  }
  const Expected<Statement> statement = prepare_alone(connection.get(), sql, guard);
  if (!statement) return tl::make_unexpected(statement.error());
  const Expected<int> column = number_column(statement->get());
  if (!column) return tl::make_unexpected(column.error());

  std::vector<std::int64_t> numbers;
  int result = SQLITE_OK;
  while ((result = sqlite3_step(statement->get())) == SQLITE_ROW) {
    if (numbers.size() == kMaxRows) return refused(fmt::format("it yields more than {} rows; select less", kMaxRows));
    if (sqlite3_column_type(statement->get(), *column) != SQLITE_INTEGER) {
      return refused("its column MechanismID holds something that is no MechanismID");
    }
    numbers.push_back(sqlite3_column_int64(statement->get(), *column));
  }
  if (result != SQLITE_DONE) return refused_by(connection.get(), guard, result);
  return numbers;
}

}  // namespace rmac::gateway
