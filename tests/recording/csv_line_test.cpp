#include "recording/csv_line.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <limits>
#include <string>

namespace heel {
namespace {

TEST(CsvLine, NumbersReadBackAsTheSameValue) {
  for (const double value : {0.0, -0.1, 1.0 / 3.0, 6.02e23, -4.9e-324, 1.7976931348623157e308}) {
    CsvLine line;
    line.number(value);
    EXPECT_EQ(std::strtod(std::string(line.finish()).c_str(), nullptr), value);
  }
  CsvLine line;
  line.number(std::numeric_limits<double>::quiet_NaN());
  line.number(-std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(line.finish(), "nan,nan\n");
}

TEST(CsvLine, SecondsAreExactToTheNanosecond) {
  CsvLine line;
  line.seconds(0);
  line.seconds(1);
  line.seconds(123'456'789'012'345'678);
  line.seconds(-1'500'000'000);
  EXPECT_EQ(line.finish(), "0.000000000,0.000000001,123456789.012345678,-1.500000000\n");
}

TEST(CsvLine, TextCannotBreakTheLineAndALongLineIsCut) {
  CsvLine line;
  line.text("a,b\n\"c\"");
  line.integer(std::int64_t{-7});
  line.flag(true);
  EXPECT_EQ(line.finish(), "a b  c ,-7,1\n");
  line.text(std::string(100'000, 'x'));
  line.text(std::string(100'000, 'y'));
  const std::string_view cut = line.finish();
  EXPECT_LE(cut.size(), 4096u);
  EXPECT_EQ(cut.back(), '\n');
}

}  // namespace
}  // namespace heel
