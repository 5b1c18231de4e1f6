// The natural order of file names: numbers in them count as numbers.
#include "files/natural_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

namespace heel {
namespace {

TEST(NaturalOrder, OrdersNumbersByValue) {
  const std::vector<std::string> sorted{"",
                                        "a",
                                        "a1",
                                        "a2",
                                        "a02",
                                        "a10",
                                        "a10b2",
                                        "a10b11",
                                        "a99999999999999999999998",
                                        "a99999999999999999999999",
                                        "b",
                                        "img-1.png",
                                        "img-9.png",
                                        "img-10.png",
                                        "img-100.png"};
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::vector<std::string> names = sorted;
    std::shuffle(names.begin(), names.end(), std::mt19937(seed));
    std::sort(names.begin(), names.end(), natural_less);
    EXPECT_EQ(names, sorted) << "seed " << seed;
  }
}

TEST(NaturalOrder, IsStrict) {
  for (const char* name : {"", "a", "007", "x0y00"}) EXPECT_FALSE(natural_less(name, name)) << name;
}

}  // namespace
}  // namespace heel
