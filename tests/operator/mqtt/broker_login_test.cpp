// What the section [mqtt] means, and what is wrong with its files.
#include "operator/mqtt/broker_login.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>

#include "support/complaint.h"
#include "support/environment.h"
#include "support/temporary_folder.h"

namespace heel {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

MqttConfig config_of(const std::string& address) {
  MqttConfig config;
  config.address = address;
  return config;
}

TEST(BrokerLogin, TheTopicHasThisComputersNameForHost) {
  std::array<char, 256> name{};
  ASSERT_EQ(gethostname(name.data(), name.size() - 1), 0);
  EXPECT_EQ(mqtt_topic(MqttConfig{}), "heel/" + std::string(name.data()));
  MqttConfig config;
  config.topic = "site/robot-1";
  EXPECT_EQ(mqtt_topic(config), "site/robot-1");
  const BrokerLogin login = broker_login(config);
  EXPECT_EQ(login.will_topic, "site/robot-1/online");
  EXPECT_EQ(login.will, "offline");
  EXPECT_EQ(login.client, "site/robot-1") << "a broker has one client of a name: the robot that came back";
}

TEST(BrokerLogin, ThePasswordIsThatOfTheFileOrTheCredential) {
  const test::TemporaryFolder folder;
  test::write_text(folder.file("mqtt-password"), "from the credential\n");
  test::write_text(folder.file("file"), "from the file\n");
  for (const char* name : {"mqtt-password", "file"})
    fs::permissions(folder.file(name), fs::perms::owner_read);
  const test::ScopedEnvironment credentials("CREDENTIALS_DIRECTORY", folder.path().string());
  MqttConfig config = config_of("tcp://broker:1883");
  EXPECT_EQ(broker_login(config).password, "") << "of no user";
  config.user = "robot-1";
  EXPECT_EQ(broker_login(config).password, "from the credential");
  config.password_file = folder.file("file");
  EXPECT_EQ(broker_login(config).password, "from the file");
}

TEST(BrokerLogin, FilesThatCannotBeUsedAreNamedWithTheirKey) {
  const test::TemporaryFolder folder;
  MqttConfig config = config_of("ssl://broker:8883");
  config.ca_file = folder.file("ca.pem");
  EXPECT_THAT(test::complaint_of([&] { broker_login(config); }),
              AllOf(HasSubstr("mqtt.ca_file: "), HasSubstr("ca.pem: cannot be read: No such file")));
  config.ca_file.clear();
  config.user = "robot-1";
  config.password_file = folder.file("pw");
  const auto complaint = [&] { return test::complaint_of([&] { broker_login(config); }); };
  EXPECT_THAT(complaint(), AllOf(HasSubstr("mqtt.password_file: "), HasSubstr("pw: cannot be read")));
  test::write_text(folder.file("pw"), "\n");
  fs::permissions(folder.file("pw"), fs::perms::owner_read);
  EXPECT_THAT(complaint(), HasSubstr("pw: 0 bytes (expected 1 to 512)"));
}

TEST(BrokerLogin, SaysWhoCanReadTheStatusOnItsWay) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(mqtt_exposure(config_of("")), "");
  EXPECT_THAT(mqtt_exposure(config_of("ssl://broker:8883")), HasSubstr("over TLS"));
  EXPECT_THAT(mqtt_exposure(config_of("tcp://127.0.0.1:1883")), HasSubstr("on this computer"));
  MqttConfig config = config_of("tcp://broker:1883");
  EXPECT_THAT(mqtt_exposure(config), AllOf(HasSubstr("without encryption"), Not(HasSubstr("password"))));
  config.user = "robot-1";
  config.password_file = test::write_text(folder.file("pw"), "secret");
  fs::permissions(config.password_file, fs::perms::owner_read);
  EXPECT_THAT(mqtt_exposure(config), AllOf(HasSubstr("and the password"), Not(HasSubstr("secret"))));
}

}  // namespace
}  // namespace heel
