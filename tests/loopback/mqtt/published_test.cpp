// heeld with a broker of MQTT: what it publishes, that nothing comes back, and that it drives on whatever the
// broker does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "evaluation/metrics/process_figures.h"
#include "loopback/daemon/operated_heeld.h"
#include "loopback/mqtt/mqtt_broker.h"
#include "realtime/schedule.h"
#include "support/sanitized.h"
#include "support/socket_client.h"
#include "support/temporary_folder.h"
#include "support/text.h"

namespace heel {
namespace {

using nlohmann::json;
using test::eventually;
using test::monotonic_s;
using test::MqttBroker;
using test::MqttReader;
using test::SocketClient;

using ::testing::HasSubstr;

constexpr const char* kStatus = "site/robot/status";
constexpr const char* kOnline = "site/robot/online";

std::set<std::string> fields_of(const json& object, const std::string& before = "") {
  std::set<std::string> names;
  for (const auto& [name, value] : object.items()) {
    names.insert(before + name);
    if (value.is_object()) names.merge(fields_of(value, before + name + "."));
  }
  return names;
}

class PublishedHeeld : public test::OperatedHeeldFixture {
 protected:
  std::string mqtt_config(const std::string& address, const std::string& more = "") const {
    return operated_config("[mqtt]\naddress = \"" + address + "\"\ntopic = \"site/robot\"\n" + more);
  }
  /// It is ready, started, and moves.
  void drive(const std::string& config) {
    get_ready(config);
    client_ = std::make_unique<SocketClient>(socket());
    ASSERT_TRUE(drives_after_start(*client_)) << logs();
  }
  /// Vision under the thread sanitizer loses the target now and then.
  bool drives_on() { return test::kThreadSanitizer ? starts_to_drive() : speed() > 0.2; }
  bool state_becomes(const MqttReader& reader, const std::string& state) {
    return eventually([&] {
      const json status = reader.newest_json(kStatus);
      return status.is_object() && status["state"] == state;
    });
  }
  std::string logged_once(const std::string& text) {
    const int times = test::occurrences(daemon_->output(), text);
    return times == 1 ? "" : text + ": " + std::to_string(times) + " times\n" + logs();
  }
  std::string maps() const { return test::read_text("/proc/" + std::to_string(daemon_->pid()) + "/maps"); }
  bool has_mqtt_thread() const {
    const auto threads = evaluation::threads_of(daemon_->pid());
    return std::any_of(threads.begin(), threads.end(),
                       [](const auto& thread) { return thread.name == "heel-mqtt"; });
  }

  std::unique_ptr<SocketClient> client_;
};

TEST_F(PublishedHeeld, GivesTheOperatorsStatusAlsoToThoseWhoComeLater) {
  MqttBroker broker;
  broker.start();
  drive(mqtt_config(broker.address(), "period_s = 0.2\n"));
  ASSERT_TRUE(state_becomes(MqttReader(broker), "following")) << logs();
  const MqttReader late(broker);
  ASSERT_TRUE(late.hears(kOnline, "online")) << "retained" << logs();
  ASSERT_TRUE(eventually([&] { return late.of(kStatus).size() > 5; })) << "it comes every period" << logs();
  const json published = late.newest_json(kStatus);
  json asked = command(*client_, "status");
  for (const char* of_the_answer : {"v", "ok"}) asked.erase(of_the_answer);
  EXPECT_EQ(fields_of(published), fields_of(asked));
  EXPECT_EQ(published["limits"], asked["limits"]);
  EXPECT_GT(published["robot"]["battery_v"], 10.0);
  EXPECT_GT(published["camera"]["frames"], 0);
  EXPECT_TRUE(has_mqtt_thread());
  std::set<std::string> planned;
  for (const ThreadPlan& plan : make_schedule({})) planned.insert(plan.name);
  for (const auto& thread : evaluation::threads_of(daemon_->pid()))
    EXPECT_TRUE(planned.contains(thread.name)) << "the library has a thread of its own: " << thread.name;
  EXPECT_THAT(maps(), HasSubstr("libpaho")) << "so that the next test can fail";
}

TEST_F(PublishedHeeld, WithoutAnAddressHasNeitherThreadNorLibrary) {
  get_ready(operated_config());
  EXPECT_FALSE(has_mqtt_thread());
  for (const char* library : {"libpaho", "mqtt.so"})
    EXPECT_EQ(test::occurrences(maps(), library), 0) << library;
}

TEST_F(PublishedHeeld, PublishesChangesOfTheStateAtOnce) {
  MqttBroker broker;
  broker.start();
  const MqttReader reader(broker);
  drive(mqtt_config(broker.address(), "period_s = 3600\n"));
  double fastest_s = 1e9;
  for (int attempt = 0; attempt < 3; ++attempt) {
    ASSERT_TRUE(state_becomes(reader, "following")) << logs();
    EXPECT_EQ(command(*client_, "estop")["state"], "emergency");
    const double asked_s = monotonic_s();
    ASSERT_TRUE(state_becomes(reader, "emergency")) << logs();
    fastest_s = std::min(fastest_s, monotonic_s() - asked_s);
    EXPECT_EQ(command(*client_, "reset")["state"], "idle");
    ASSERT_TRUE(state_becomes(reader, "idle")) << logs();
    ASSERT_TRUE(drives_after_start(*client_)) << logs();
  }
  EXPECT_LE(fastest_s, 0.3);
}

TEST_F(PublishedHeeld, TheBrokerSaysThatItIsGoneWhenItIsKilledAndWhenItEnds) {
  MqttBroker broker;
  broker.start();
  const MqttReader reader(broker);
  const std::string config = mqtt_config(broker.address());
  start_robot();
  for (const int signal : {SIGKILL, SIGTERM}) {
    start_heeld(config);
    ASSERT_TRUE(reader.hears(kOnline, "online")) << logs();
    daemon_->signal(signal);
    EXPECT_TRUE(reader.hears(kOnline, "offline")) << signal << logs();
    EXPECT_EQ(daemon_->wait(), signal == SIGTERM ? 0 : -SIGKILL);
  }
}

TEST_F(PublishedHeeld, TakesNoCommandFromTheBroker) {
  MqttBroker broker;
  broker.start();
  get_ready(mqtt_config(broker.address()));
  const MqttReader reader(broker);
  ASSERT_TRUE(reader.hears(kOnline, "online")) << logs();
  for (const char* topic :
       {"site/robot", "site/robot/start", "site/robot/command", "site/robot/set", kStatus})
    EXPECT_EQ(
        test::run_program(broker.client("mosquitto_pub", {"-q", "1", "-t", topic, "-m", R"({"do":"start"})"}))
            .status,
        0);
  const std::size_t before = reader.of(kStatus).size();
  ASSERT_TRUE(eventually([&] { return reader.of(kStatus).size() > before + 2; })) << logs();
  EXPECT_EQ(reader.newest_json(kStatus)["state"], "idle");
  EXPECT_EQ(speed(), 0.0);
  const std::string log = broker.log();
  EXPECT_GT(test::occurrences(log, "Received PUBLISH from site/robot "), 0) << log;
  EXPECT_EQ(test::occurrences(log, "Received SUBSCRIBE from site/robot"), 0) << log;
}

TEST_F(PublishedHeeld, AWrongPasswordIsNamedOnceAndItDrivesOn) {
  MqttBroker broker({"robot", "right"});
  broker.start();
  test::write_text(scene_.path("pw"), "wrong\n");
  std::filesystem::permissions(scene_.path("pw"), std::filesystem::perms::owner_read);
  drive(mqtt_config(broker.address(), "user = \"robot\"\npassword_file = \"pw\"\n"));
  ASSERT_TRUE(eventually([&] { return test::occurrences(broker.log(), "not authorised") >= 3; })) << logs();
  EXPECT_EQ(logged_once("the broker refuses this user or password"), "");
  EXPECT_TRUE(drives_on()) << logs();
}

TEST_F(PublishedHeeld, UserAndPasswordLetItIn) {
  MqttBroker broker({"robot", "right"});
  broker.start();
  test::write_text(scene_.path("pw"), "right\n");
  std::filesystem::permissions(scene_.path("pw"), std::filesystem::perms::owner_read);
  get_ready(mqtt_config(broker.address(), "user = \"robot\"\npassword_file = \"pw\"\n"));
  EXPECT_TRUE(MqttReader(broker).hears(kOnline, "online")) << logs();
}

TEST_F(PublishedHeeld, FindsABrokerThatStartsLaterAndOneThatStartsAgain) {
  MqttBroker broker;
  drive(mqtt_config(broker.address()));
  ASSERT_TRUE(daemon_->says("cannot be reached: Connection refused")) << logs();
  for (int round = 0; round < 3; ++round) {
    broker.start();
    const MqttReader reader(broker);
    EXPECT_TRUE(reader.hears(kOnline, "online")) << round << logs();
    EXPECT_TRUE(state_becomes(reader, "following")) << round << logs();
    broker.kill();
  }
  EXPECT_EQ(logged_once("cannot be reached: Connection refused"), "");
  EXPECT_EQ(logged_once("the connection is lost"), "");
  EXPECT_TRUE(drives_on()) << logs();
}

/// The kernel still takes what heeld sends.
TEST_F(PublishedHeeld, ABrokerThatHangsIsGivenUpAndFoundAgain) {
  MqttBroker broker;
  broker.start();
  drive(mqtt_config(broker.address()));
  ASSERT_TRUE(daemon_->says("mqtt: connected to")) << logs();
  broker.signal(SIGSTOP);
  ASSERT_TRUE(daemon_->says("the connection is lost")) << logs();
  EXPECT_TRUE(daemon_->says("does not answer as an MQTT broker")) << logs();
  EXPECT_TRUE(drives_on()) << logs();
  broker.signal(SIGCONT);
  const MqttReader reader(broker);
  EXPECT_TRUE(reader.hears(kOnline, "online")) << logs();
}

TEST_F(PublishedHeeld, EndsInTimeWhileTheBrokerHangsWhichSaysLaterThatItIsGone) {
  MqttBroker broker;
  broker.start();
  const MqttReader reader(broker);
  drive(mqtt_config(broker.address(), "period_s = 0.1\n"));
  ASSERT_TRUE(reader.hears(kOnline, "online")) << logs();
  broker.signal(SIGSTOP);
  test::sleep_s(0.5);  // a status is on its way
  const double begin_s = monotonic_s();
  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(), 0) << logs();
  EXPECT_LT(monotonic_s() - begin_s, 5.0) << "systemd kills it then (TimeoutStopSec)";
  broker.signal(SIGCONT);
  EXPECT_TRUE(reader.hears(kOnline, "offline")) << logs();
}

/// Connections are taken by the kernel, and nobody answers.
TEST_F(PublishedHeeld, APeerThatNeverAnswersIsNamedAndItDrivesOnAndEndsInTime) {
  const int listener = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof(address);
  ASSERT_EQ(::bind(listener, reinterpret_cast<sockaddr*>(&address), size), 0);
  ASSERT_EQ(::listen(listener, 64), 0);
  ASSERT_EQ(::getsockname(listener, reinterpret_cast<sockaddr*>(&address), &size), 0);
  drive(mqtt_config("tcp://127.0.0.1:" + std::to_string(ntohs(address.sin_port))));
  EXPECT_TRUE(daemon_->says("does not answer as an MQTT broker within 3 s")) << logs();
  EXPECT_TRUE(drives_on()) << logs();
  const double begin_s = monotonic_s();
  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(), 0) << logs();
  EXPECT_LT(monotonic_s() - begin_s, 5.0) << "systemd kills it then (TimeoutStopSec)";
  ::close(listener);
}

TEST_F(PublishedHeeld, TlsNeedsACertificateOfTheAuthority) {
  MqttBroker broker({.user = "", .password = "", .tls = true});
  broker.start();
  get_ready(mqtt_config(broker.address(), "ca_file = \"" + broker.ca_file() + "\"\n"));
  EXPECT_TRUE(MqttReader(broker).hears(kOnline, "online")) << logs();
  EXPECT_THAT(daemon_->output(), HasSubstr("over TLS"));
  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(), 0) << logs();
  start_heeld(mqtt_config(broker.address()));  // of the system's authorities none is ours
  EXPECT_TRUE(daemon_->says("no TLS connection: ")) << logs();
  EXPECT_THAT(daemon_->output(), HasSubstr("certificate verify failed"));
}

}  // namespace
}  // namespace heel
