// Messages to systemd through a socket that is read late or not at all.
#include "daemon/service_notifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "support/collected_log.h"
#include "support/environment.h"
#include "support/full_notify_socket.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using test::FullNotifySocket;
using test::ScopedEnvironment;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// A name of the abstract namespace that no other test process uses.
std::string abstract_name() {
  return "@heel-test-" + std::to_string(getpid());
}

TEST(ServiceNotifier, SendsAtOnceWhatTheSocketTakes) {
  const test::TemporaryFolder folder;
  for (const std::string& name : {folder.file("notify"), abstract_name()}) {
    FullNotifySocket socket(name);
    socket.take();
    const ScopedEnvironment environment("NOTIFY_SOCKET", name);
    ServiceNotifier notifier;
    notifier.ready();
    notifier.status("following");
    notifier.status("following");
    notifier.reloading(5'000'000);
    notifier.stopping();
    EXPECT_THAT(socket.take(),
                ElementsAre("READY=1", "STATUS=following", "RELOADING=1\nMONOTONIC_USEC=5000", "STOPPING=1"))
        << name;
  }
}

TEST(ServiceNotifier, AFullSocketBlocksNoCallAndGetsTheMessagesLater) {
  FullNotifySocket socket(abstract_name());
  const ScopedEnvironment environment("NOTIFY_SOCKET", socket.name());
  ServiceNotifier notifier;
  notifier.status("waiting for the robot");
  notifier.ready();
  notifier.status("following");
  notifier.reloading(5'000'000);
  notifier.ready();
  EXPECT_FALSE(notifier.send_kept());
  EXPECT_THAT(socket.take(), IsEmpty());
  notifier.status("following");
  EXPECT_THAT(socket.take(),
              ElementsAre("READY=1", "RELOADING=1\nMONOTONIC_USEC=5000", "READY=1", "STATUS=following"));
  EXPECT_TRUE(notifier.send_kept());
  EXPECT_THAT(socket.take(), IsEmpty()) << "nothing is sent twice";
}

TEST(ServiceNotifier, KeepsTheNewestMessagesOfManyReloads) {
  FullNotifySocket socket(abstract_name());
  const ScopedEnvironment environment("NOTIFY_SOCKET", socket.name());
  ServiceNotifier notifier;
  for (int i = 1; i <= 100; ++i) {
    notifier.reloading(i * kNsPerUs);
    notifier.ready();
  }
  notifier.stopping();
  socket.take();
  EXPECT_TRUE(notifier.send_kept());
  EXPECT_THAT(socket.take(), ElementsAre("READY=1", "RELOADING=1\nMONOTONIC_USEC=99", "READY=1",
                                         "RELOADING=1\nMONOTONIC_USEC=100", "READY=1", "STOPPING=1"));
}

TEST(ServiceNotifier, FeedsTheWatchdogAThirdOfItsTimeApart) {
  FullNotifySocket socket(abstract_name());
  const ScopedEnvironment name("NOTIFY_SOCKET", socket.name());
  const ScopedEnvironment timeout("WATCHDOG_USEC", "3000000");
  const ScopedEnvironment pid("WATCHDOG_PID", std::to_string(getpid()));
  ServiceNotifier notifier;
  TimeNs t_ns = 100 * kNsPerS;
  notifier.alive(t_ns);
  EXPECT_THAT(socket.take(), IsEmpty()) << "the socket was full";
  notifier.alive(t_ns += kNsPerMs);
  EXPECT_THAT(socket.take(), ElementsAre("WATCHDOG=1")) << "sent by the next call, not a period later";
  notifier.alive(t_ns += 999 * kNsPerMs);
  EXPECT_THAT(socket.take(), IsEmpty());
  notifier.alive(t_ns += kNsPerMs);
  EXPECT_THAT(socket.take(), ElementsAre("WATCHDOG=1"));
}

TEST(ServiceNotifier, ASocketThatCannotBeNamedIsLoggedAndNothingIsSent) {
  for (const std::string& name : {std::string("notify"), std::string("/"), "/" + std::string(200, 'x')}) {
    const test::CollectedLog log;
    const ScopedEnvironment environment("NOTIFY_SOCKET", name);
    ServiceNotifier notifier;
    notifier.ready();
    EXPECT_TRUE(notifier.send_kept());
    EXPECT_EQ(log.count("[warning] NOTIFY_SOCKET=" + name + ": expected an absolute path"), 1) << log.text();
  }
}

}  // namespace
}  // namespace heel
