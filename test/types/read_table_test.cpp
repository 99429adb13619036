#include "types/read_table.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

class ReadTable : public testing::Test {
 protected:
  std::vector<TableRow> read(const std::string& content, std::size_t columns = 2) {
    std::ofstream(file_) << content;
    return read_table(file_, columns, "time [s], pressure [Pa]");
  }
  std::string refused(const std::string& content) {
    try {
      read(content);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  const std::string file_ = testing::TempDir() + "read_table_test.csv";
};

TEST_F(ReadTable, ReadsNumbersHoweverTheyAreSeparated) {
  const std::vector<TableRow> rows = read("time, pressure\n# at rest\n0,1\n\n1;2;3\r\n 2\t-3e2\n");
  ASSERT_EQ(rows.size(), 3U);
  EXPECT_EQ(rows[0].numbers, (std::vector<double>{0, 1}));
  EXPECT_EQ(rows[1].numbers, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(rows[2].numbers, (std::vector<double>{2, -300}));
  EXPECT_EQ(rows[1].where, file_ + ":5");
}

TEST_F(ReadTable, NamesTheLineThatDoesNotFit) {
  EXPECT_EQ(refused("0,1\n1\n"), file_ + ":2: found '1'; allowed: time [s], pressure [Pa]");
  EXPECT_NE(refused("0,1\n1,nan\n").find(":2: found"), std::string::npos);
  EXPECT_NE(refused("0,1\ntime,pressure\n").find(":2: found"), std::string::npos);
  EXPECT_NE(refused("time,pressure\n").find("no rows"), std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
