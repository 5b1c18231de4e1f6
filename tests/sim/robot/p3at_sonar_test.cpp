// The sonars of the simulated P3-AT in its packets: which are read, in which order, and from where they
// measure.
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>
#include <vector>

#include "sim/robot/virtual_client.h"

namespace heel::sim {
namespace {

using arcos::CommandId;
using test::fast_exact_settings;
using test::Received;
using test::VirtualClient;

TEST(P3AtSonar, IsOnAfterOpenAndGivesAFewReadingsASip) {
  VirtualClient client(fast_exact_settings());
  client.open();
  client.run_fed_ms(2050);
  std::set<int> seen;
  std::size_t readings = 0;
  for (const Received& packet : client.sips()) {
    arcos::Sip sip;
    ASSERT_EQ(arcos::decode_sip(packet.body, sip), arcos::DecodeResult::Ok);
    EXPECT_LE(sip.sonar_count, 6) << "two arrays, three discs each, fit in 100 ms";
    readings += sip.sonar_count;
    for (int i = 0; i < sip.sonar_count; ++i) {
      seen.insert(sip.sonars[static_cast<std::size_t>(i)].number);
      EXPECT_EQ(sip.sonars[static_cast<std::size_t>(i)].range_mm, 5000);
    }
  }
  EXPECT_EQ(seen.size(), 16u);
  EXPECT_NEAR(static_cast<double>(readings), 5.0 * static_cast<double>(client.sips().size()),
              4.0);  // 2 arrays / 40 ms
  EXPECT_EQ(client.last_sip().flags & arcos::kFlagSonarArrays, 0b110);
}

struct SonarCase {
  int argument;
  int flags;
};
void PrintTo(const SonarCase& sonar, std::ostream* out) {
  *out << "flags " << sonar.flags;
}
class P3AtSonarCommand : public testing::TestWithParam<SonarCase> {};

TEST_P(P3AtSonarCommand, SwitchesArrays) {
  VirtualClient client(fast_exact_settings());
  client.open();
  if ((GetParam().argument & 1) != 0) client.command(CommandId::Sonar, 0);
  client.command(CommandId::Sonar, GetParam().argument);
  client.run_ms(150);
  client.forget();
  client.run_fed_ms(450);
  const arcos::Sip sip = client.last_sip();
  EXPECT_EQ(sip.flags & arcos::kFlagSonarArrays, GetParam().flags);
  EXPECT_EQ(sip.sonar_count > 0, GetParam().flags != 0);
  for (int i = 0; i < sip.sonar_count; ++i) {
    const int array = sip.sonars[static_cast<std::size_t>(i)].number / 8;
    EXPECT_NE(GetParam().flags & (2 << array), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Arguments, P3AtSonarCommand,
                         testing::Values(SonarCase{0, 0}, SonarCase{1, 0b110}, SonarCase{3, 0b010},
                                         SonarCase{5, 0b100}, SonarCase{2, 0b100}, SonarCase{4, 0b010}),
                         [](const auto& sonar) { return "Argument" + std::to_string(sonar.param.argument); });

TEST(P3AtSonar, MeasuresFromItsMountInTheWorld) {
  P3AtSettings settings = fast_exact_settings();
  settings.start = {1.0, 2.0, std::numbers::pi / 2.0};  // looks along +y
  VirtualClient client(settings);
  // A wall at y = 4: only the sensors that look at it hear it.
  client.robot.set_range_finder([](const Pose2& sensor) {
    const double s = std::sin(sensor.heading_rad);
    return s > 0.1 ? (4.0 - sensor.y_m) / s : std::numeric_limits<double>::infinity();
  });
  client.open();
  client.run_fed_ms(1000);
  std::array<int, 16> range_mm{};
  for (const Received& packet : client.sips()) {
    arcos::Sip sip;
    ASSERT_EQ(arcos::decode_sip(packet.body, sip), arcos::DecodeResult::Ok);
    for (int i = 0; i < sip.sonar_count; ++i) {
      const arcos::SonarReading& reading = sip.sonars[static_cast<std::size_t>(i)];
      range_mm.at(reading.number) = reading.range_mm;
    }
  }
  const double c10 = std::cos(10.0 * std::numbers::pi / 180.0),
               c50 = std::cos(50.0 * std::numbers::pi / 180.0);
  EXPECT_NEAR(range_mm[3], (2000 - 245) / c10, 1.0);
  EXPECT_NEAR(range_mm[4], (2000 - 245) / c10, 1.0);
  EXPECT_NEAR(range_mm[1], (2000 - 193) / c50, 1.0);
  EXPECT_NEAR(range_mm[6], (2000 - 193) / c50, 1.0);
  EXPECT_EQ(range_mm[11], 5000);
  EXPECT_EQ(range_mm[12], 5000);
}

TEST(P3AtSonar, PollingChoosesOrderAndSensorsFromOne) {
  VirtualClient client(fast_exact_settings());
  client.open();
  client.send(arcos::encode_text(CommandId::Polling, std::string_view("\x04\x05\x04", 3)));
  client.run_ms(150);
  client.forget();
  client.run_fed_ms(1000);
  std::vector<int> numbers;
  for (const Received& packet : client.sips()) {
    arcos::Sip sip;
    ASSERT_EQ(arcos::decode_sip(packet.body, sip), arcos::DecodeResult::Ok);
    for (int i = 0; i < sip.sonar_count; ++i)
      numbers.push_back(sip.sonars[static_cast<std::size_t>(i)].number);
  }
  ASSERT_GT(numbers.size(), 15u);
  for (std::size_t i = 3; i < numbers.size(); ++i) EXPECT_EQ(numbers[i], numbers[i - 3]);
  EXPECT_EQ((std::set<int>(numbers.begin(), numbers.end())), (std::set<int>{3, 4}));
}

TEST(P3AtSonar, MountsAreTheReferencesTable) {
  const double expected[16][3] = {{147, 136, 90},    {193, 119, 50},     {227, 79, 30},     {245, 27, 10},
                                  {245, -27, -10},   {227, -79, -30},    {193, -119, -50},  {147, -136, -90},
                                  {-144, -136, -90}, {-189, -119, -130}, {-223, -79, -150}, {-241, -27, -170},
                                  {-241, 27, 170},   {-223, 79, 150},    {-189, 119, 130},  {-144, 136, 90}};
  for (int number = 0; number < 16; ++number) {
    const Pose2 mount = P3AtSettings{}.model.geometry.sonars[static_cast<std::size_t>(number)];
    EXPECT_NEAR(mount.x_m * 1000, expected[number][0], 1e-9) << number;
    EXPECT_NEAR(mount.y_m * 1000, expected[number][1], 1e-9) << number;
    EXPECT_NEAR(mount.heading_rad * 180 / std::numbers::pi, expected[number][2], 1e-9) << number;
  }
}

}  // namespace
}  // namespace heel::sim
