// What is said of a line that cannot be opened: the likely cause, and what to do.
#include "robot/serial_hints.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cerrno>
#include <fstream>
#include <string>

#include "robot/device_holder.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

TEST(DeviceHolder, ARunningServiceIsNamedWithItsCommand) {
  EXPECT_EQ(in_use_text(DeviceHolder{7, "heeld"}),
            "in use by heeld (process 7); stop it first (systemctl stop heeld)");
  EXPECT_EQ(in_use_text(DeviceHolder{7, ""}), "in use by another program (process 7); stop it first");
}

TEST(SerialHints, APermissionThatIsMissingNamesTheGroup) {
  test::TemporaryFolder folder;
  const std::string path = folder.file("tty");
  std::ofstream(path) << "";
  ASSERT_EQ(::chmod(path.c_str(), 0660), 0);
  const std::string text = open_failure_text(path, EACCES);
  EXPECT_NE(text.find("Permission denied (only the group "), std::string::npos) << text;
  EXPECT_NE(text.find("sudo usermod -aG "), std::string::npos) << text;
  ASSERT_EQ(::chmod(path.c_str(), 0600), 0);
  EXPECT_NE(open_failure_text(path, EACCES).find("only its owner may"), std::string::npos);
  EXPECT_EQ(open_failure_text(path, EIO), "cannot open: Input/output error");
}

TEST(SerialHints, AMissingDeviceNamesTheAdaptersThatAreHere) {
  test::TemporaryFolder folder;
  EXPECT_EQ(missing_device_text(folder.file("none")),
            "cannot open: No such file or directory (no USB serial adapter is plugged in)");
  for (const char* name : {"usb-d", "usb-b", "usb-c", "usb-a"}) std::ofstream(folder.file(name)) << "";
  EXPECT_EQ(missing_device_text(folder.file("")),
            "cannot open: No such file or directory (adapters that are here: " + folder.file("usb-a") + ", " +
                folder.file("usb-b") + ", " + folder.file("usb-c") + " and 1 more)");
}

TEST(SerialHints, AnAdapterIsFoundUnderItsNewNameWhenItIsTheOnlyOne) {
  const UsbAdapter gone{"/dev/ttyUSB0", 0x0403, 0x6001, "A600"};
  const UsbAdapter same{"/dev/ttyUSB1", 0x0403, 0x6001, "A600"};
  const UsbAdapter other_serial{"/dev/ttyUSB2", 0x0403, 0x6001, "B700"};
  const UsbAdapter other_kind{"/dev/ttyUSB3", 0x067b, 0x2303, "A600"};
  EXPECT_EQ(moved_to(gone, {other_serial, same, other_kind}).value().device, "/dev/ttyUSB1");
  EXPECT_FALSE(moved_to(gone, {other_serial, other_kind}).has_value());
  EXPECT_FALSE(moved_to(gone, {}).has_value());
  // Two of a kind without a serial number: which one is the robot's is not known.
  const UsbAdapter cheap{"/dev/ttyUSB0", 0x1a86, 0x7523, ""};
  EXPECT_FALSE(moved_to(cheap, {{"/dev/ttyUSB1", 0x1a86, 0x7523, ""}, {"/dev/ttyUSB2", 0x1a86, 0x7523, ""}}));
  EXPECT_TRUE(moved_to(cheap, {{"/dev/ttyUSB1", 0x1a86, 0x7523, ""}}));
}

}  // namespace
}  // namespace heel
