// The Foxglove protocol over a real socket, as Foxglove and Lichtblick speak it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

#include "operator/web/foxglove_messages.h"
#include "operator/web/page_fixture.h"
#include "recording/picture.h"

namespace heel {
namespace {

using nlohmann::json;
using test::kToken;
using test::PageClient;
using ::testing::HasSubstr;

class FoxglovePage : public test::PageFixture {
 protected:
  /// Subscribed to nothing yet.
  std::unique_ptr<PageClient> viewer(const std::string& token = "") {
    auto connection = client();
    EXPECT_TRUE(connection->become_websocket("/foxglove?token=" + token,
                                             "Sec-WebSocket-Protocol: foxglove.websocket.v1\r\n"));
    info_ = connection->message_of("serverInfo", "op");
    const json advertised = connection->message_of("advertise", "op");
    for (const json& channel : advertised["channels"]) channels_[channel["topic"]] = channel;
    return connection;
  }
  void subscribe(const PageClient& connection, const std::string& topic, int subscription) {
    connection.send_text(
        json{{"op", "subscribe"},
             {"subscriptions", {{{"id", subscription}, {"channelId", channels_[topic]["id"]}}}}}
            .dump());
  }

  json info_;
  std::map<std::string, json> channels_;
};

struct Data {
  int subscription = -1;
  double t_s = 0.0;
  json message;
};

/// The next message of a topic.
Data next_data(PageClient& viewer) {
  for (std::string bytes = viewer.message(); !bytes.empty(); bytes = viewer.message()) {
    if (bytes[0] != 1 || bytes.size() < 13) continue;
    std::uint64_t t_ns = 0;
    for (int i = 7; i >= 0; --i)
      t_ns = t_ns << 8 | static_cast<std::uint8_t>(bytes[5 + static_cast<std::size_t>(i)]);
    return {bytes[1], 1e-9 * static_cast<double>(t_ns), json::parse(bytes.substr(13))};
  }
  return {};
}

TEST(FoxgloveProtocol, TheNewerOneIsChosenOfThoseThatAreOffered) {
  EXPECT_EQ(foxglove_protocol("foxglove.websocket.v1"), "foxglove.websocket.v1");
  EXPECT_EQ(foxglove_protocol("foxglove.websocket.v1, foxglove.sdk.v1"), "foxglove.sdk.v1");
  for (const char* other : {"", "foxglove.websocket.v12", "xfoxglove.sdk.v1", "chat"})
    EXPECT_EQ(foxglove_protocol(other), "") << other;
}

TEST_F(FoxglovePage, BothSubProtocolsAreSpokenAndNoOther) {
  for (const char* protocol : {"foxglove.websocket.v1", "foxglove.sdk.v1"}) {
    const auto connection = client();
    const test::HttpAnswer answer = connection->ask(
        "GET /foxglove",
        std::string("Upgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
                    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Protocol: ") +
            protocol + "\r\n");
    EXPECT_EQ(answer.status, 101);
    EXPECT_THAT(answer.head, HasSubstr(std::string("Sec-WebSocket-Protocol: ") + protocol));
  }
  EXPECT_FALSE(client()->become_websocket("/foxglove", "Sec-WebSocket-Protocol: chat\r\n"));
  EXPECT_FALSE(client()->become_websocket("/foxglove"));
  const std::string protocol = "Sec-WebSocket-Protocol: foxglove.sdk.v1\r\n";
  EXPECT_FALSE(client()->become_websocket("/foxglove", protocol + "Origin: https://evil.example\r\n"));
  EXPECT_TRUE(client()->become_websocket("/foxglove", protocol + "Origin: https://robot.local\r\n"))
      << "a viewer at a name of view.hosts";
}

TEST_F(FoxglovePage, TopicsComeAsARecordingHasThemAfterASubscription) {
  const auto connection = viewer();
  EXPECT_THAT(info_["capabilities"], testing::Contains("parameters"));
  ASSERT_EQ(channels_.size(), live_topics().size());
  for (const auto& [topic, channel] : channels_) {
    EXPECT_EQ(channel["encoding"], "json") << topic;
    EXPECT_TRUE(json::parse(channel["schema"].get<std::string>(), nullptr, false).is_object()) << topic;
  }
  EXPECT_EQ(channels_["/camera"]["schemaName"], "foxglove.CompressedImage");
  subscribe(*connection, "/heel/pose", 7);
  subscribe(*connection, "/camera", 8);
  ASSERT_TRUE(test::eventually([&] { return feed_.wants_pictures(); }));
  telemetry_.drain(0);  // opens the queue of frames
  push(41);
  const Data pose = next_data(*connection);
  EXPECT_EQ(pose.subscription, 7) << "nobody has subscribed to ticks";
  EXPECT_EQ(pose.message["frame_sequence"], 41);
  EXPECT_GT(pose.t_s, 1.7e9) << "of the clock on the wall";
  const Data picture = next_data(*connection);
  EXPECT_EQ(picture.subscription, 8);
  EXPECT_EQ(picture_pixels(picture_from_json(picture.message.dump())).size(), 64u * 48u);
  connection->send_text(R"({"op":"unsubscribe","subscriptionIds":[8]})");
  EXPECT_TRUE(test::eventually([&] { return !feed_.wants_pictures(); }));
}

TEST_F(FoxglovePage, KeysAreParametersAndTheTokenIsNeededToSetThem) {
  const auto reader = viewer();
  reader->send_text(R"({"op":"getParameters","parameterNames":["gate.v_max_m_s","no.such"],"id":"a"})");
  const json values = reader->message_of("parameterValues", "op");
  EXPECT_EQ(values["id"], "a");
  EXPECT_EQ(values["parameters"], json::parse(R"([{"name":"gate.v_max_m_s","value":0.5,"type":"float64"}])"));
  reader->send_text(R"({"op":"subscribeParameterUpdates","parameterNames":["gate.v_max_m_s"]})");
  const std::string set =
      R"({"op":"setParameters","parameters":[{"name":"gate.v_max_m_s","value":0.3}],"id":"b"})";
  reader->send_text(set);
  EXPECT_THAT(reader->message_of("status", "op")["message"], HasSubstr("not allowed without the token"));
  EXPECT_EQ(reader->message_of("parameterValues", "op")["parameters"][0]["value"], 0.5) << "as it is";

  const auto writer = viewer(kToken);
  writer->send_text(set);
  const json done = writer->message_of("parameterValues", "op");
  EXPECT_EQ(done["id"], "b");
  EXPECT_EQ(done["parameters"][0]["value"], 0.3);
  EXPECT_EQ(reader->message_of("parameterValues", "op")["parameters"][0]["value"], 0.3)
      << "the others are told";
  writer->send_text(R"({"op":"setParameters","parameters":[{"name":"gate.v_max_m_s","value":5}]})");
  EXPECT_THAT(writer->message_of("status", "op")["message"], HasSubstr("gate.v_max_m_s"));
  EXPECT_EQ(settings_.view().in_use.gate.v_max_m_s, 0.3);
  const auto guesser = viewer("guess");
  EXPECT_EQ(guesser->message_of("status", "op")["message"], "not the token of this heeld");
}

TEST_F(FoxglovePage, DamagedMessagesEndTheirConnectionOnly) {
  for (const char* text :
       {"", "[]", "{", R"({"op":"subscribe"})", R"({"op":"subscribe","subscriptions":[7]})",
        R"({"op":"subscribe","subscriptions":[{"id":-1,"channelId":1}]})",
        R"({"op":"unsubscribe","subscriptionIds":{}})"}) {
    const auto connection = viewer();
    connection->send_text(text);
    EXPECT_TRUE(connection->closed()) << text;
  }
  const auto connection = viewer();
  connection->send_text(R"({"op":["x"]})");
  EXPECT_EQ(connection->message_of("status", "op")["level"], 1) << "not served, and said so";
  connection->send_text(R"({"op":"subscribe","subscriptions":[{"id":1,"channelId":999}]})");
  connection->send_text(R"({"op":"setParameters","parameters":[{"value":1}]})");
  EXPECT_THAT(connection->message_of("status", "op")["message"], HasSubstr("no parameter with a name"));
  expect_it_serves();
}

}  // namespace
}  // namespace heel
