#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "gateway/device_driver_manager/device_driver_manager.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"

namespace rmac::gateway {
namespace {

using test::TemporaryFolder;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Table 4-1 on disk, and a client's SQL on it.
class Search : public testing::Test {
 protected:
  Search() {
    write_tree(folder_, test::table_4_1());
    auto opened = DeviceDriverManager::open(
        {.device_tree = folder_.path() / "tree", .database = database().string(), .searcher = test::kSearcher});
    if (!opened) throw std::runtime_error(opened.error().message);
    manager_ = std::move(*opened);
  }

  [[nodiscard]] std::filesystem::path database() const { return folder_.path() / "drivers.sqlite"; }

  std::vector<std::string> names(const std::string& sql) const {
    const auto found = manager_->search(sql);
    if (!found) return {"error: " + found.error().message};
    std::vector<std::string> names;
    for (const DriverRecord& record : *found) names.push_back(record.name);
    return names;
  }

  [[nodiscard]] std::string everything() const {
    std::ostringstream bytes;
    bytes << std::ifstream(database(), std::ios::binary).rdbuf();
    return bytes.str();
  }
  [[nodiscard]] std::size_t files() const {
    const std::filesystem::directory_iterator entries(folder_.path());
    return static_cast<std::size_t>(std::distance(begin(entries), end(entries)));
  }

  const TemporaryFolder folder_;
  std::unique_ptr<DeviceDriverManager> manager_;
};

TEST_F(Search, DissertationsExampleFindsTarusAlone) {
  EXPECT_THAT(names("SELECT * FROM DeviceDrivers WHERE Type = 'Mill' AND NumberOfJoints = 5 AND Length > 150 AND "
                    "Width > 150 AND Depth > 150 AND SpindleHorsePower > 5"),
              ElementsAre("TarusXYZCA"));
}

TEST_F(Search, GivesRowsInTheStatementsOrder) {
  EXPECT_THAT(names("SELECT MechanismID FROM DeviceDrivers WHERE NumberOfJoints = 3 ORDER BY Name DESC;"),
              ElementsAre("SuginoXYZ", "DMACXYZ", "CMM"));
  EXPECT_THAT(names("select name, mechanismid from devicedrivers order by 2 limit 1 -- the first\n ; ; "),
              ElementsAre("DMACXYZ"));
  EXPECT_THAT(names("SELECT * FROM DeviceDrivers WHERE Name LIKE 'Sug%' AND lower(Type) = 'mill'"),
              ElementsAre("SuginoXYZ", "SuginoXYZAC"));
  EXPECT_THAT(names("SELECT * FROM DeviceDrivers WHERE MaxFeedrate = (SELECT max(MaxFeedrate) FROM DeviceDrivers)"),
              ElementsAre("TarusXYZCA"));
  EXPECT_THAT(names("SELECT * FROM DeviceDrivers WHERE Length > 1e6"), IsEmpty());
  EXPECT_THAT(names("SELECT * FROM DeviceDrivers WHERE SpeedCapability = 'with speed' -- with nothing"), IsEmpty());
}

TEST_F(Search, RowsThatTellNoMechanismAreRefused) {
  EXPECT_THAT(names("SELECT Name FROM DeviceDrivers").front(), HasSubstr("select * or MechanismID"));
  EXPECT_THAT(names("SELECT count(*) FROM DeviceDrivers").front(), HasSubstr("select * or MechanismID"));
  EXPECT_THAT(names("SELECT 99 AS MechanismID").front(), HasSubstr("99 as a MechanismID, which no mechanism has"));
  EXPECT_THAT(names("SELECT Name AS MechanismID FROM DeviceDrivers").front(), HasSubstr("no MechanismID"));
}

TEST_F(Search, MistakeIsExplained) {
  EXPECT_THAT(names("SELECT * FROM DeviceDrivers WHERE Typ = 'Mill'").front(), HasSubstr("no such column: Typ"));
  EXPECT_THAT(names("SELECT * FROM DeviceDrivers WHERE Type = \"Mill\"").front(), HasSubstr("single quotes"));
  EXPECT_THAT(names("SELEKT").front(), HasSubstr("syntax error"));
}

struct Hostile {
  const char* name;
  std::string sql;
  const char* reason;
};

void PrintTo(const Hostile& hostile, std::ostream* stream) {
  *stream << hostile.name;
}

std::string repeated(const std::string& text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

/// DeviceDrivers joined `count` times.
std::string join(int count) {
  std::string sql = "SELECT a0.MechanismID FROM DeviceDrivers a0";
  for (int i = 1; i < count; ++i) sql += ", DeviceDrivers a" + std::to_string(i);
  return sql;
}

/// Each common table holds the one before it twice: 2^n copies to prepare, before anything runs.
std::string doubling_tables(int count) {
  std::string sql = "WITH t0 AS (SELECT MechanismID FROM DeviceDrivers)";
  for (int i = 1; i <= count; ++i) {
    const std::string before = "t" + std::to_string(i - 1);
    sql += ", t" + std::to_string(i) + " AS (SELECT a.MechanismID FROM " + before + " a, " + before + " b)";
  }
  return sql + " SELECT * FROM t" + std::to_string(count);
}

/// A table whose text `n` is the column, doubled `times` over.
std::string doubled(const std::string& column, int times) {
  std::string table = "(SELECT " + column + " n FROM DeviceDrivers LIMIT 9)";
  for (int i = 0; i < times; ++i) table = "(SELECT n||n n FROM " + table + " LIMIT 9)";
  return table;
}

std::string selecting(const std::string& expression) {
  return "SELECT MechanismID, " + expression + " FROM DeviceDrivers";
}

std::vector<Hostile> hostile_statements() {
  const std::string all = "SELECT * FROM DeviceDrivers";
  return {
      {"AnotherTable", "SELECT * FROM MechanismNumbers", "reads the table \"MechanismNumbers\""},
      {"AnotherTableInASubquery", all + " WHERE Name IN (SELECT Name FROM MechanismNumbers)", "MechanismNumbers"},
      {"AnotherTableInAUnion", "SELECT MechanismID FROM DeviceDrivers UNION SELECT MechanismID FROM MechanismNumbers",
       "MechanismNumbers"},
      {"Master", "SELECT *, 1 AS MechanismID FROM sqlite_master", "reads the table \"sqlite_master\""},
      {"Schema", "SELECT *, 1 AS MechanismID FROM sqlite_schema", "reads the table"},
      {"TemporarySchema", "SELECT *, 1 AS MechanismID FROM sqlite_temp_schema", "reads the table"},
      {"Delete", "DELETE FROM DeviceDrivers", "only SELECT"},
      {"DeleteReturning", "DELETE FROM DeviceDrivers RETURNING *", "only SELECT"},
      {"Update", "UPDATE DeviceDrivers SET Name = 'x'", "only SELECT"},
      {"Insert", "INSERT INTO DeviceDrivers SELECT * FROM DeviceDrivers", "only SELECT"},
      {"Replace", "REPLACE INTO MechanismNumbers VALUES ('x', 1)", "only SELECT"},
      {"Drop", "DROP TABLE DeviceDrivers", "only SELECT"},
      {"Alter", "ALTER TABLE DeviceDrivers ADD COLUMN x", "only SELECT"},
      {"Create", "CREATE TABLE x (MechanismID)", "only SELECT"},
      {"CreateTemporary", "CREATE TEMP TABLE x AS SELECT * FROM DeviceDrivers", "only SELECT"},
      {"CreateView", "CREATE VIEW x AS SELECT * FROM DeviceDrivers", "only SELECT"},
      {"Attach", "ATTACH DATABASE '/tmp/rmac-test-attached.sqlite' AS other", "only SELECT"},
      {"Detach", "DETACH DATABASE main", "only SELECT"},
      {"Vacuum", "VACUUM INTO '/tmp/rmac-test-vacuum.sqlite'", "only SELECT"},
      {"Pragma", "PRAGMA writable_schema = 1", "only SELECT"},
      {"PragmaFunction", "SELECT *, 1 AS MechanismID FROM pragma_table_info('DeviceDrivers')", "only SELECT"},
      {"Begin", "BEGIN EXCLUSIVE", "only SELECT"},
      {"Explain", "EXPLAIN " + all, "only SELECT"},
      {"Analyze", "ANALYZE", "only SELECT"},
      {"LoadExtension", selecting("load_extension('/tmp/x.so')"), "load_extension"},
      {"WriteFile", selecting("writefile('/tmp/rmac-test-written', 'x')"), "writefile"},
      {"ReadFile", selecting("readfile('/etc/passwd')"), "readfile"},
      {"JsonTable", "SELECT *, 1 AS MechanismID FROM json_each('[1,2]')", "only SELECT"},
      {"SecondStatement", all + "; DELETE FROM DeviceDrivers", "more than one statement"},
      {"SecondSelect", all + "; " + all, "more than one statement"},
      {"SecondStatementAfterComment", all + "; /* x */ DROP TABLE DeviceDrivers", "more than one statement"},
      {"GarbageAfterTheEnd", all + "; hello", "more than one statement"},
      {"EmbeddedNul", all + std::string("\0; DROP TABLE DeviceDrivers", 28), "NUL"},
      {"Empty", "", "empty"},
      {"Blank", " \n\t;;", "empty"},
      {"CommentAlone", "-- nothing", "empty"},
      {"OpenComment", "/* nothing", "empty"},
      {"RecursiveTable",
       "WITH RECURSIVE c(MechanismID) AS (SELECT 1 UNION ALL SELECT MechanismID + 1 FROM c) SELECT * FROM c", "WITH"},
      {"Join26Ways", join(26), ""},
      {"Join26WaysWithoutARow", join(26) + " WHERE a0.Length + a25.Length < 0", "ran longer than 200 ms"},
      {"Join26WaysCounted", join(26) + " GROUP BY a0.MechanismID HAVING count(*) > 1", "ran longer than 200 ms"},
      {"Join26WaysSorted", join(26) + " ORDER BY a25.Name || a24.Name", ""},
      {"Join26WaysDistinct", "SELECT DISTINCT *" + join(26).substr(21), ""},
      {"TooManyRows", join(6), "more than 10000 rows"},
      {"DoublingTables", doubling_tables(40), "WITH"},
      {"DoublingTablesBehindAComment", "/* ' */ -- '\n" + doubling_tables(40), "WITH"},
      {"DoublingTablesBehindATrickyText", all + " WHERE Name = 'a''b' OR Name IN (" + doubling_tables(40) + ")",
       "WITH"},
      {"TrimOfLongTexts",
       all + " a, " + doubled("Name", 9) + " x, " + doubled("Name", 9) + " y WHERE trim(x.n, y.n)='q'", ""},
      {"ZeroBlob", selecting("zeroblob(1000000000)"), "zeroblob"},
      {"RandomBlob", selecting("randomblob(1000000000)"), "randomblob"},
      {"Printf", selecting("printf('%.*c', 1000000000, 'x')"), "printf"},
      {"Format", selecting("format('%1000000000d', 1)"), "format"},
      {"ReplaceGrowth", selecting("replace('aaaaaaaaaaaa', 'a', 'aaaaaaaaaaaaaaaaaaaaaaa')"), "replace"},
      {"GroupConcat", "SELECT MechanismID, group_concat(Name) FROM DeviceDrivers", "group_concat"},
      {"Hex", selecting("hex(Name)"), "function hex"},
      {"LikePattern", all + " WHERE Name LIKE '" + repeated("%a", 100) + "'", "pattern too complex"},
      {"Glob", all + " WHERE Name GLOB '" + repeated("*a", 100) + "'", "glob"},
      {"DeepExpression", selecting(repeated("(", 60) + "1" + repeated("+1)", 60)), "maximum depth"},
      {"LongSum", selecting("1" + repeated("+1", 1500)), ""},
      {"LongStatement", selecting(repeated("1,", 10'000) + "1"), "at most 4000"},
      {"ManyColumns", selecting(repeated("1,", 200) + "1"), "too many columns"},
      {"CompoundSelect", "SELECT MechanismID FROM DeviceDrivers" + repeated(" UNION SELECT 1", 20), "too many terms"},
      {"Parameter", all + " WHERE MechanismID = ?5", ""},
      {"NestedSubqueries", repeated("SELECT * FROM (", 60) + all + repeated(")", 60), ""},
      {"RowIdentity", selecting("_rowid_ FROM MechanismNumbers, DeviceDrivers --"), ""},
  };
}

class HostileSql : public Search, public testing::WithParamInterface<Hostile> {};

TEST_P(HostileSql, GivesAnErrorAndChangesNothing) {
  const std::string before = everything();
  const std::size_t files_before = files();
  const auto found = manager_->search(GetParam().sql);
  ASSERT_FALSE(found) << found->size() << " rows";
  EXPECT_EQ(found.error().code, MinorCode::InvalidParameterValue);
  EXPECT_THAT(found.error().message, HasSubstr(GetParam().reason));
  EXPECT_THAT(found.error().message, HasSubstr("the SQL statement was refused: "));
  RecordProperty("message", found.error().message);

  EXPECT_EQ(everything(), before);
  EXPECT_EQ(files(), files_before);
  for (const char* file :
       {"/tmp/rmac-test-attached.sqlite", "/tmp/rmac-test-vacuum.sqlite", "/tmp/rmac-test-written"}) {
    EXPECT_FALSE(std::filesystem::exists(file));
  }
  EXPECT_EQ(names("SELECT * FROM DeviceDrivers").size(), 6U) << "the next search works";
  EXPECT_TRUE(manager_->rescan()) << "and so does the next scan";
}

INSTANTIATE_TEST_SUITE_P(Statements, HostileSql, testing::ValuesIn(hostile_statements()),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

}  // namespace
}  // namespace rmac::gateway
