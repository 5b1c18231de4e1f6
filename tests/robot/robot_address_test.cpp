// Addresses, and the messages for wrong ones.
#include "robot/robot_address.h"

#include <gtest/gtest.h>

#include "support/complaint.h"

namespace heel {
namespace {

TEST(RobotAddress, Serial) {
  const RobotAddress address = parse_robot_address("serial:/dev/ttyUSB0@38400");
  EXPECT_EQ(address.kind, RobotAddress::Kind::Serial);
  EXPECT_EQ(address.path, "/dev/ttyUSB0");
  EXPECT_EQ(address.baud, 38400);
  EXPECT_EQ(parse_robot_address("serial:/dev/ttyS0").baud, 38400);
  EXPECT_EQ(parse_robot_address("serial:/dev/a@b@115200").path, "/dev/a@b");
  EXPECT_EQ(parse_robot_address("serial:/dev/by-path/usb-0:1:1.0").path, "/dev/by-path/usb-0:1:1.0");
  EXPECT_EQ(parse_robot_address("serial:/dev/by path/a").path, "/dev/by path/a");
}

TEST(RobotAddress, PtyAndTcp) {
  const RobotAddress pty = parse_robot_address("pty:/dev/pts/7");
  EXPECT_EQ(pty.kind, RobotAddress::Kind::Pty);
  EXPECT_EQ(pty.path, "/dev/pts/7");
  EXPECT_EQ(pty.baud, 38400);
  EXPECT_EQ(parse_robot_address("pty:/tmp/robot@9600").path, "/tmp/robot");
  EXPECT_EQ(parse_robot_address("pty:/tmp/robot@9600").baud, 9600);
  const RobotAddress tcp = parse_robot_address("tcp:robot.local:8101");
  EXPECT_EQ(tcp.kind, RobotAddress::Kind::Tcp);
  EXPECT_EQ(tcp.host, "robot.local");
  EXPECT_EQ(tcp.port, 8101);
  EXPECT_EQ(parse_robot_address("tcp:[::1]:8101").host, "::1");
}

struct Wrong {
  const char* address;
  const char* said;  ///< must stand in the message
};

TEST(RobotAddress, WrongAddressesAreNamedWithWhatIsExpected) {
  const Wrong wrong[] = {
      {"", "expected serial:DEVICE@BAUD, pty:PATH@BAUD or tcp:HOST:PORT"},
      {"/dev/ttyUSB0", "expected serial:DEVICE@BAUD"},
      {"usb:1", "expected serial:DEVICE@BAUD"},
      {"serial", "expected serial:DEVICE@BAUD"},
      {"serial:", "expected a path after 'serial:'"},
      {"serial:@9600", "expected a path after 'serial:'"},
      {"serial:/dev/ttyUSB0@12345", "'12345' is not a baud rate"},
      {"serial:/dev/ttyUSB0@", "'' is not a baud rate"},
      {"serial:/dev/ttyUSB0@9600x", "'9600x' is not a baud rate"},
      {"pty:/tmp/robot@300", "'300' is not a baud rate"},
      {"pty:", "expected a path after 'pty:'"},
      {"serial:/dev/ttyUSB0:9600", "expected @9600"},
      {"serial:/dev/ttyUSB0,57600", "expected @57600"},
      {"serial:/dev/ttyUSB0 ", "a space at an end"},
      {" tcp:host:8101", "a space at an end"},
      {"tcp://host:8101", "expected tcp:HOST:PORT"},
      {"tcp:host", "no port"},
      {"tcp::8101", "no host"},
      {"tcp: 127.0.0.1:8101", "a space in the host's name"},
      {"tcp:my robot:8101", "a space in the host's name"},
      {"tcp:host:", "'' is not a port"},
      {"tcp:host:0", "'0' is not a port"},
      {"tcp:host:65536", "'65536' is not a port"},
      {"tcp:host:81o1", "'81o1' is not a port"},
  };
  for (const Wrong& one : wrong) {
    const std::string line = test::complaint_of([&] { parse_robot_address(one.address); });
    EXPECT_NE(line.find(one.said), std::string::npos) << one.address << ": " << line;
    EXPECT_NE(line.find("'" + std::string(one.address) + "'"), std::string::npos) << line;
    EXPECT_EQ(line.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace heel
