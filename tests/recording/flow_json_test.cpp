// Flow structs as JSON: any value comes back to the bit, and what cannot be read is named.
#include "recording/flow_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "recording/flow_compare.h"
#include "recording/flow_fields.h"
#include "support/complaint.h"

namespace heel {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// Fills every field with any value it can have.
class Filler {
 public:
  explicit Filler(unsigned seed) : random_(seed) {}

  void operator()(const char* /*name*/, auto& field) { fill(field); }
  template <typename C, typename B>
  void operator()(const char* /*name*/, CountedBytes<C, B> field) {
    field.count = static_cast<std::uint8_t>(random_() % (field.bytes.size() + 1));
    for (std::size_t i = 0; i < field.count; ++i) field.bytes[i] = static_cast<std::uint8_t>(random_());
  }

 private:
  template <typename Field>
  void fill(Field& field) {
    if constexpr (std::same_as<Field, bool>) {
      field = random_() % 2 == 0;
    } else if constexpr (std::same_as<Field, double>) {
      field = any_double();
    } else if constexpr (std::is_enum_v<Field>) {
      int count = 0;
      while (std::string_view(to_string(static_cast<Field>(count))) != "?") ++count;
      field = static_cast<Field>(random_() % static_cast<unsigned>(count));
    } else if constexpr (std::integral<Field>) {
      field = static_cast<Field>(random_() % 3 == 0 ? random_() % 10 : random_());
    } else if constexpr (requires { requires std::same_as<typename Field::value_type, char>; }) {
      for (std::size_t i = 0; i < random_() % field.size(); ++i)
        field[i] = static_cast<char>(' ' + random_() % 95);
    } else if constexpr (requires { field.begin(); }) {
      for (auto& element : field) fill(element);
    } else {
      fields(*this, field);
    }
  }
  double any_double() {
    switch (random_() % 8) {
      case 0:
        return std::bit_cast<double>(random_());  // any bits
      case 1:
        return -0.0;
      case 2:
        return std::numeric_limits<double>::infinity();
      case 3:
        return -std::numeric_limits<double>::infinity();
      case 4:
        return std::numeric_limits<double>::quiet_NaN();
      case 5:
        return static_cast<double>(static_cast<std::int64_t>(random_()));
      case 6:
        return std::numeric_limits<double>::denorm_min();
      default:
        return std::normal_distribution<double>()(random_);
    }
  }
  std::mt19937_64 random_;
};

template <typename Flow>
Flow filled(unsigned seed) {
  Flow record{};
  Filler filler(seed);
  fields(filler, record);
  return record;
}

template <typename Flow>
std::string json_of(const Flow& record) {
  std::string json;
  append_flow_json(json, record);
  return json;
}

template <typename Flow>
class FlowJson : public testing::Test {};
using Flows = testing::Types<TickRecord, PoseEstimate, CaptureCounters, Event, WireBytes, FrameTiming>;
TYPED_TEST_SUITE(FlowJson, Flows);

TYPED_TEST(FlowJson, AnyValueComesBackToTheBit) {
  int different = 0;
  for (unsigned seed = 0; seed < 300; ++seed) {
    const TypeParam record = filled<TypeParam>(seed);
    const std::string json = json_of(record);
    std::set<std::string> other_version;
    const auto again = flow_from_json<TypeParam>(json, other_version);
    ASSERT_EQ(json_of(again), json) << seed;
    ASSERT_THAT(other_version, IsEmpty());
    if constexpr (std::same_as<TypeParam, TickRecord> || std::same_as<TypeParam, PoseEstimate>) {
      ASSERT_TRUE(same_flow(record, again)) << json;
    }
    different += json != json_of(TypeParam{});
  }
  EXPECT_EQ(different, 300);
}

/// The value is of the schema's type, and all that is required is there.
void expect_fits(const nlohmann::json& value, const nlohmann::json& schema, const std::string& path) {
  const std::string type = schema["type"];
  const bool fits = type == "object"    ? value.is_object()
                    : type == "array"   ? value.is_array()
                    : type == "string"  ? value.is_string()
                    : type == "boolean" ? value.is_boolean()
                    : type == "integer" ? value.is_number_integer()
                                        : value.is_number();
  ASSERT_TRUE(fits) << path << " is no " << type << ": " << value;
  if (schema.contains("enum")) {
    EXPECT_THAT(schema["enum"], testing::Contains(value)) << path;
  }
  if (type == "array") {
    for (const auto& element : value) expect_fits(element, schema["items"], path + "[]");
  }
  if (type != "object" || path.ends_with(".not_finite")) return;
  for (const auto& [name, member] : value.items()) {
    ASSERT_TRUE(schema["properties"].contains(name)) << path << '.' << name;
    expect_fits(member, schema["properties"][name], path + '.' + name);
  }
  if (!schema.contains("required")) return;
  for (const std::string name : schema["required"]) EXPECT_TRUE(value.contains(name)) << path << '.' << name;
}

TYPED_TEST(FlowJson, TheSchemaDescribesEveryValue) {
  const auto schema = nlohmann::json::parse(flow_json_schema<TypeParam>("heel.X"));
  EXPECT_EQ(schema["title"], "heel.X");
  for (unsigned seed = 0; seed < 50; ++seed)
    expect_fits(nlohmann::json::parse(json_of(filled<TypeParam>(seed))), schema, "");
}

TEST(FlowJson, WhatIsNotFiniteIsLeftOutAndNamed) {
  TickRecord tick;
  tick.person_m = std::numeric_limits<double>::infinity();
  tick.input.pose.t_over_d = {1.0, std::nan(""), -0.0};
  const auto json = nlohmann::json::parse(json_of(tick));
  EXPECT_FALSE(json.contains("person_m"));
  EXPECT_EQ(json["not_finite"]["person_m"], "inf");
  EXPECT_EQ(json["input"]["pose"]["not_finite"]["t_over_d"], "1 nan -0");
}

TEST(FlowJson, BadValuesAreNamed) {
  const std::string good = json_of(CaptureCounters{.t_ns = 5, .captured = 7});
  struct Row {
    std::string from, to, names;
  };
  const Row rows[] = {
      {"\"captured\":7", "\"captured\":-7", ".captured: -7 (expected a whole number in range)"},
      {"\"captured\":7", "\"captured\":7.5", ".captured: 7.5 (expected a whole number"},
      {"\"captured\":7", "\"captured\":\"x\"", ".captured: \"x\""},
      {"{", "[", "no JSON text"},
  };
  for (const Row& row : rows) {
    std::string bad = good;
    bad.replace(bad.find(row.from), row.from.size(), row.to);
    std::set<std::string> names;
    EXPECT_THAT(test::complaint_of([&] { flow_from_json<CaptureCounters>(bad, names); }),
                HasSubstr(row.names));
  }
  std::set<std::string> names;
  std::string event = json_of(Event{});
  event.replace(event.find("note"), 4, "song");
  EXPECT_THAT(test::complaint_of([&] { flow_from_json<Event>(event, names); }),
              HasSubstr("\"song\" (expected a name that this version knows)"));
}

TEST(FlowJson, FieldsOfAnotherVersionAreNamedAndLeftAtTheirDefaults) {
  std::set<std::string> names;
  const auto counters = flow_from_json<CaptureCounters>(R"({"t_ns":5,"captured":7,"colour":1})", names);
  EXPECT_EQ(counters.captured, 7u);
  EXPECT_EQ(counters.reopened, 0u);
  EXPECT_THAT(names,
              testing::UnorderedElementsAre(".dropped_by_driver", ".dropped_unread", ".reopened", ".colour"));
}

TEST(FlowCompare, NamesWhatDiffers) {
  TickRecord a, b;
  a.free_distance_m = b.free_distance_m = std::nan("");
  EXPECT_TRUE(same_flow(a, b));
  b.free_distance_m = -std::nan("");
  EXPECT_TRUE(same_flow(a, b)) << "one NaN is like another";
  b.command.v_m_s = -0.0;
  b.input.robot.sonar[3].range_m = 2.0;
  b.state = SupervisorState::Armed;
  const auto differences = flow_differences(a, b);
  EXPECT_FALSE(same_flow(a, b));
  ASSERT_EQ(differences.size(), 3u);
  EXPECT_EQ(differences[0].name, "input.robot.sonar_3.range_m");
  EXPECT_EQ(differences[0].distance, 2.0);
  EXPECT_EQ(differences[1].name, "state");
  EXPECT_EQ(differences[1].b, "armed");
  EXPECT_EQ(differences[2].name, "command.v_m_s");
}

}  // namespace
}  // namespace heel
