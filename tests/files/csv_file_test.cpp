// CSV files cell by cell and by sampled columns, and the errors of files that cannot be written.
#include "files/csv_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "files/sampled_csv.h"
#include "heel/error.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using ::testing::StartsWith;

std::string error_of(const std::function<void()>& write) {
  try {
    write();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(CsvFile, WritesCellsAndNanForNumbersThatAreNotFinite) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("cells.csv");
  CsvFile file(path, "name,value,count");
  file.text("a").number(1.0 / 3.0, 3).count(7);
  file.end_row();
  file.text("").number(-std::numeric_limits<double>::infinity(), 3).number(kNoValue, 1);
  file.end_row();
  file.flush();
  EXPECT_EQ(test::read_text(path), "name,value,count\na,0.333,7\n,nan,nan\n");
}

TEST(SampledCsv, ReadsEveryColumnOnceForEachRow) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("rows.csv");
  SampledCsv file(path);
  double t_s = 0.0;
  int calls = 0;
  file.add_column("t_s", 2, [&] { return t_s; });
  file.add_column("calls", 0, [&] { return static_cast<double>(++calls); });
  for (t_s = 0.5; t_s < 2.0; t_s += 1.0) file.write_row();
  file.flush();
  EXPECT_EQ(test::read_text(path), "t_s,calls\n0.50,1\n1.50,2\n");
}

TEST(OutputFile, NamesTheFileThatCannotBeWritten) {
  EXPECT_THAT(error_of([] { OutputFile file("/no-such-folder/x.csv"); }),
              StartsWith("/no-such-folder/x.csv: cannot write: No such file or directory (expected "));
  EXPECT_THAT(error_of([] {
                OutputFile file("/dev/full");
                file.print("{}\n", 1);
                file.flush();
              }),
              StartsWith("/dev/full: cannot write: No space left on device (expected "));
}

}  // namespace
}  // namespace heel
