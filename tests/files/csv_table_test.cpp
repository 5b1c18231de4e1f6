#include "files/csv_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "heel/error.h"
#include "support/complaint.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using ::testing::HasSubstr;

TEST(CsvTable, ReadsLinesThatEndAsOnWindows) {
  const test::TemporaryFolder folder;
  test::write_text(folder.file("a.csv"), "name,value\r\nfirst,1.5\r\nsecond,-2\r\n");
  const CsvTable table(folder.file("a.csv"));
  ASSERT_EQ(table.rows(), 2U);
  EXPECT_EQ(table.text(1, "name"), "second");
  EXPECT_EQ(table.number(0, "value"), 1.5);
  EXPECT_EQ(table.number(1, "value"), -2.0);
}

TEST(CsvTable, NamesFileLineAndColumnOfWhatIsWrong) {
  const test::TemporaryFolder folder;
  const std::string file = test::write_text(folder.file("a.csv"), "name,value\nfirst,much\n");
  const CsvTable table(file);
  EXPECT_THAT(test::complaint_of([&] { table.number(0, "value"); }),
              HasSubstr(file + ":2: value is 'much' (expected a number)"));
  EXPECT_THAT(test::complaint_of([&] { table.number(0, "other"); }), HasSubstr(file + ": no column 'other'"));
  test::write_text(file, "name,value\nfirst\n");
  EXPECT_THAT(test::complaint_of([&] { CsvTable{file}; }), HasSubstr(file + ":2: 1 cells (expected 2"));
}

}  // namespace
}  // namespace heel
