// Command lines that heel-sim refuses.
#include <gtest/gtest.h>

#include <ostream>
#include <string>
#include <vector>

#include "support/process.h"

namespace heel {
namespace {

struct BadOption {
  std::string name;
  std::vector<std::string> arguments;
  std::string complaint;
};
void PrintTo(const BadOption& bad, std::ostream* out) {
  *out << testing::PrintToString(bad.arguments);
}
class HeelSimOptions : public testing::TestWithParam<BadOption> {};

TEST_P(HeelSimOptions, AreRefusedByNameAndExpectation) {
  std::vector<std::string> argv = GetParam().arguments;
  argv.insert(argv.begin(), test::built_program("heel-sim"));
  test::Process process(argv);
  EXPECT_GT(process.wait(), 0);
  EXPECT_NE(process.output().find(GetParam().complaint), std::string::npos) << process.output();
}

INSTANTIATE_TEST_SUITE_P(
    CommandLines, HeelSimOptions,
    testing::Values(
        BadOption{"NoRobot", {}, "--robot"},
        BadOption{"AnUnknownLine", {"--robot", "usb:1"}, "--robot usb:1: not an address (expected pty:PATH"},
        BadOption{"APtyWithoutAPath", {"--robot", "pty:"}, "not an address (expected pty:PATH"},
        BadOption{
            "APortThatIsNoNumber", {"--robot", "tcp:seven"}, "'seven' is not a port (expected 0…65535)"},
        BadOption{"APortTooGreat", {"--robot", "tcp:70000"}, "'70000' is not a port"},
        BadOption{"AFileInPlaceOfALink", {"--robot", "pty:/proc/version"}, "exists and is not a symlink"},
        BadOption{
            "AFolderThatIsMissing", {"--robot", "pty:/no-such-folder/robot"}, "cannot make the symlink"},
        BadOption{"ABaudRateThatArcosLacks", {"--robot", "tcp:0", "--boot-baud", "1200"}, "--boot-baud"},
        BadOption{"AnUnknownRateAfterClose", {"--robot", "tcp:0", "--after-close", "keep"}, "--after-close"},
        BadOption{"AnUnknownModel", {"--robot", "tcp:0", "--model", "roomba"}, "--model"},
        BadOption{"AFaultWithoutAStart", {"--robot", "tcp:0", "--fault", "drop"}, "fault 'drop': no start"},
        BadOption{"AnOptionMisspelt", {"--robot", "tcp:0", "--fualt", "drop@1"}, "--fualt"},
        BadOption{"ATruthFileThatCannotBe",
                  {"--robot", "tcp:0", "--truth", "/no-such-folder/t.csv"},
                  "cannot write"}),
    [](const auto& option) { return option.param.name; });

}  // namespace
}  // namespace heel
