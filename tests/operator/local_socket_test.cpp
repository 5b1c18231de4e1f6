// The operators' socket as a file: stale, of another, of another user.
#include "operator/local_socket.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "support/complaint.h"
#include "support/socket_client.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::SocketClient;
using ::testing::HasSubstr;

TEST(OperatorSocket, AStaleSocketIsReplacedAndALiveOneIsNot) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("control.sock");
  {
    const LocalSocket live(path);
    EXPECT_THAT(test::complaint_of([&] { LocalSocket second(path); }),
                HasSubstr("operator.socket: " + path + ": another process serves it"));
    EXPECT_TRUE(std::filesystem::exists(path)) << "the refused one must not remove it";
    std::filesystem::rename(path, folder.file("stale.sock"));
  }
  // The first socket could not remove its file under the new name: nobody serves it any more.
  ASSERT_TRUE(std::filesystem::exists(folder.file("stale.sock")));
  std::filesystem::rename(folder.file("stale.sock"), path);
  {
    const LocalSocket next(path);
    const SocketClient client(path);
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(OperatorSocket, OneOfAnotherUserIsNamedWithThePermission) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("control.sock");
  std::filesystem::permissions(folder.path(), std::filesystem::perms{0755});
  const LocalSocket live(path);
  const uid_t owner = geteuid();
  std::filesystem::permissions(path, std::filesystem::perms{0000});
  // Permissions do not hold for root, who becomes another user for this call.
  ASSERT_EQ(owner == 0 ? seteuid(65534) : 0, 0);
  const uid_t user = geteuid();
  const std::string complaint = test::complaint_of([&] { LocalSocket second(path); });
  ASSERT_EQ(owner == 0 ? seteuid(0) : 0, 0);
  EXPECT_EQ(complaint, "operator.socket: " + path + ": permission denied: it belongs to user " +
                           std::to_string(owner) + " (expected a socket that user " + std::to_string(user) +
                           " may use, or a name that is free)");
}

TEST(OperatorSocket, WhatIsNoSocketIsNotRemoved) {
  const test::TemporaryFolder folder;
  const std::string path = test::write_text(folder.file("control.sock"), "mine");
  EXPECT_THAT(test::complaint_of([&] { LocalSocket socket(path); }), HasSubstr("exists and is no socket"));
  EXPECT_EQ(test::read_text(path), "mine");
  EXPECT_THAT(test::complaint_of([&] { LocalSocket socket(folder.file("no/control.sock")); }),
              HasSubstr("cannot be made: No such file or directory (expected a folder that exists"));
  EXPECT_THAT(test::complaint_of([&] { LocalSocket socket(folder.file(std::string(200, 'x'))); }),
              HasSubstr("(expected at most 107)"));
}

}  // namespace
}  // namespace heel
