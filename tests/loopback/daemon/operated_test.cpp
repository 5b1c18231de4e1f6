// heeld under command over its real socket, with the simulated robot over a pty: it moves after a start only,
// stops when it is told to, an emergency stop acts in the next tick, and clients that misbehave disturb
// nobody.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "files/csv_table.h"
#include "loopback/daemon/heeld_fixture.h"
#include "recording/recording_reader.h"
#include "replay/control_replay.h"
#include "replay/vision_replay.h"
#include "support/exported.h"
#include "support/socket_client.h"

namespace heel {
namespace {

using nlohmann::json;
using test::eventually;
using test::monotonic_s;
using test::read_text;
using test::sleep_s;
using test::SocketClient;
using test::write_text;

using ::testing::HasSubstr;

class OperatedHeeld : public test::HeeldFixture {
 protected:
  std::string socket() const { return scene_.path("control.sock"); }
  std::string operated_config(const std::string& sections = "") const {
    return scene_.write_config({.sections = sections, .start = "operator"});
  }
  void get_ready(const std::string& config) {
    start_robot();
    start_heeld(config);
    ASSERT_TRUE(notify_.receives("READY=1")) << logs();
  }
  json ask(SocketClient& client, const std::string& request) {
    const std::string answer = client.ask(request);
    EXPECT_NE(answer, "") << request << logs();
    return json::parse(answer, nullptr, false);
  }
  json command(SocketClient& client, const std::string& name) {
    return ask(client, "{\"do\":\"" + name + "\"}");
  }
  /// A start is repeated: it may be refused while the first frames come, and on a busy machine late ticks are
  /// a fault, after which another start is needed.
  bool drives_after_start(SocketClient& client) {
    return eventually([&] {
      if (speed() > 0.2) return true;
      const std::string state = command(client, "status")["state"];
      if (state == "idle" || state == "stopped") command(client, "start");
      return false;
    });
  }
};

TEST_F(OperatedHeeld, MovesAfterAStartOnlyAndRestsAfterAStop) {
  get_ready(operated_config());
  SocketClient client(socket());
  EXPECT_EQ(command(client, "status")["state"], "idle");
  sleep_s(1.0);
  EXPECT_EQ(speed(), 0.0) << "nobody has started it";

  ASSERT_TRUE(drives_after_start(client)) << logs();
  EXPECT_TRUE(eventually([&] { return command(client, "start")["outcome"] == "already so"; })) << logs();

  EXPECT_EQ(command(client, "stop")["state"], "idle");
  EXPECT_TRUE(comes_to_rest()) << logs();
  sleep_s(1.0);
  EXPECT_EQ(speed(), 0.0) << "it needs a start";
  EXPECT_TRUE(drives_after_start(client)) << logs();
}

TEST_F(OperatedHeeld, AnEmergencyStopHoldsUntilAResetAndAStart) {
  get_ready(operated_config());
  SocketClient client(socket());
  ASSERT_TRUE(drives_after_start(client)) << logs();
  const json stopped = command(client, "estop");
  EXPECT_EQ(stopped["ok"], true);
  EXPECT_EQ(stopped["state"], "emergency");
  EXPECT_TRUE(comes_to_rest()) << logs();
  const json refused = command(client, "start");
  EXPECT_EQ(refused["ok"], false);
  EXPECT_EQ(refused["state"], "emergency");
  EXPECT_EQ(command(client, "stop")["state"], "emergency");
  EXPECT_EQ(command(client, "reset")["state"], "idle");
  sleep_s(0.5);
  EXPECT_EQ(speed(), 0.0) << "a reset is no start";
  EXPECT_TRUE(drives_after_start(client)) << logs();
}

/// The rows of ticks.csv from the time on until the one whose request is the emergency stop of that time.
struct EmergencyStop {
  int ticks_before = 0;  ///< that began after the request and did not have it
  bool found = false;
  std::string state;
  double v_m_s = 1.0, yaw_rate_rad_s = 1.0;
  double latency_s = 0.0;  ///< from the request's time to that of the tick
};

EmergencyStop emergency_stop_after(const CsvTable& ticks, double t_asked_s) {
  EmergencyStop stop;
  for (std::size_t row = 0; row < ticks.rows(); ++row) {
    const double t_s = ticks.number(row, "t_s");
    if (t_s < t_asked_s) continue;
    const double t_request_s = ticks.number(row, "request_t_s");
    if (ticks.text(row, "request_command") != "estop" || t_request_s < t_asked_s) {
      ++stop.ticks_before;
      continue;
    }
    // Those between the client's question and the request's time are the way to heeld, not to the wheels.
    stop = {0,
            true,
            ticks.text(row, "state"),
            ticks.number(row, "command_v_m_s"),
            ticks.number(row, "command_yaw_rate_rad_s"),
            t_s - t_request_s};
    for (std::size_t before = 0; before < row; ++before)
      stop.ticks_before += ticks.number(before, "t_s") > t_request_s;
    return stop;
  }
  return stop;
}

TEST_F(OperatedHeeld, AnEmergencyStopActsInTheNextTickByTheRecording) {
  get_ready(operated_config("[telemetry]\ndirectory = \"run\"\n"));
  SocketClient client(socket());
  std::vector<double> asked_s;
  for (int attempt = 0; attempt < 3; ++attempt) {
    ASSERT_TRUE(drives_after_start(client)) << logs();
    asked_s.push_back(monotonic_s());
    ASSERT_EQ(command(client, "estop")["state"], "emergency");
    ASSERT_TRUE(comes_to_rest());
    ASSERT_EQ(command(client, "reset")["state"], "idle");
  }
  daemon_->signal(SIGTERM);
  ASSERT_EQ(daemon_->wait(), 0) << logs();
  const CsvTable ticks(test::exported(scene_.path("run")) + "/ticks.csv");
  int at_once = 0;
  for (const double t_asked_s : asked_s) {
    const EmergencyStop stop = emergency_stop_after(ticks, t_asked_s);
    ASSERT_TRUE(stop.found);
    EXPECT_EQ(stop.state, "emergency") << "in the tick that has the request";
    EXPECT_EQ(stop.v_m_s, 0.0);
    EXPECT_EQ(stop.yaw_rate_rad_s, 0.0);
    at_once += stop.ticks_before == 0;
    // A tick that began between the request's time and its arrival cannot have it.
    EXPECT_LE(stop.ticks_before, 1) << stop.latency_s;
  }
  EXPECT_GE(at_once, 1) << "in one of three the next tick has it";
}

/// Everything of a recording that its run can be told from.
struct RecordedRun final : RecordingVisitor {
  void on_tick(const TickRecord& tick) override {
    newest_configuration = tick.configuration;
    t_last_tick_ns = tick.input.now_ns;
    ++ticks;
  }
  void on_wire(const WireBytes& wire) override {
    if (wire.to_robot) to_robot.append(reinterpret_cast<const char*>(wire.bytes.data()), wire.count);
    from_robot += wire.to_robot ? 0 : wire.count;
  }
  void on_operator(const OperatorLine& line) override {
    operators.push_back(line.request + ": " + line.answer);
  }
  void on_note(const RecordingNote& note) override { notes.push_back(note.kind + ": " + note.text); }

  std::uint64_t newest_configuration = 0, ticks = 0;
  TimeNs t_last_tick_ns = 0;
  std::string to_robot;
  std::size_t from_robot = 0;
  std::vector<std::string> operators, notes;
};

std::string hex_of(const std::string& bytes) {
  std::string hex;
  for (const char byte : bytes) {
    const auto value = static_cast<unsigned char>(byte);
    hex += "0123456789abcdef"[value >> 4];
    hex += "0123456789abcdef"[value & 15];
  }
  return hex;
}

/// Its lines are "SECONDS HEX".
std::string hex_of_wire_file(const std::string& path) {
  std::istringstream words(read_text(path));
  std::string all;
  for (std::string t_s, hex; words >> t_s >> hex;) all += hex;
  return all;
}

TEST_F(OperatedHeeld, ARecordedRunReplaysToTheBitAndHoldsTheBytesOfTheWire) {
  get_ready(operated_config("[telemetry]\ndirectory = \"run\"\npictures = \"lossless\"\nblack_box = \"\"\n"));
  SocketClient client(socket());
  ASSERT_TRUE(drives_after_start(client)) << logs();
  ASSERT_EQ(ask(client, R"({"do":"set","values":{"gate.v_max_m_s":0.2,"control.gain_yaw_1_s":0.9}})")["ok"],
            true);
  ASSERT_EQ(ask(client, R"({"do":"mark","text":"slower now"})")["ok"], true);
  ASSERT_TRUE(eventually([&] { return speed() < 0.25; })) << logs();
  command(client, "stop");
  ASSERT_TRUE(comes_to_rest());
  daemon_->signal(SIGTERM);
  ASSERT_EQ(daemon_->wait(), 0) << logs();
  robot_->signal(SIGTERM);
  ASSERT_EQ(robot_->wait(), 0) << logs();

  const std::string recording = recording_in(scene_.path("run"));
  const ReplayResult replay = replay_control(recording, {});
  EXPECT_TRUE(replay.all_same()) << replay.same << " of " << replay.ticks << replay.ended;
  EXPECT_GT(replay.ticks, 100u);
  EXPECT_TRUE(replay.report.complete);
  RecordedRun run;
  read_recording(recording, run);
  EXPECT_EQ(run.newest_configuration, 1u) << "the set";
  EXPECT_THAT(run.operators,
              testing::IsSupersetOf({HasSubstr("start: "), HasSubstr("gate.v_max_m_s: 0.7 -> 0.2"),
                                     HasSubstr("mark: done"), HasSubstr("stop: done")}));
  EXPECT_THAT(run.notes, testing::ElementsAre("begin: heeld", "mark: slower now", "end: heeld stopped"));
  // What the simulator read is what heeld recorded as written.
  EXPECT_EQ(hex_of(run.to_robot), hex_of_wire_file(scene_.path("wire.hex")));
  EXPECT_GT(run.from_robot, 500u);
  const VisionReplayResult vision = replay_vision(recording);
  EXPECT_TRUE(vision.all_same()) << vision.same << " of " << vision.frames;
  // On a busy machine a picture may be dropped: the replay ends there.
  EXPECT_GT(vision.frames, 3u) << vision.ended;
}

TEST_F(OperatedHeeld, AKilledHeeldLeavesItsLastTicksAndTheRecording) {
  const std::string config = operated_config("[telemetry]\ndirectory = \"run\"\nblack_box = \"black-box\"\n");
  get_ready(config);
  SocketClient client(socket());
  ASSERT_TRUE(drives_after_start(client)) << logs();
  daemon_->signal(SIGKILL);
  daemon_->wait();
  const double t_killed_s = monotonic_s();
  const std::string cut = recording_in(scene_.path("run"));
  RecordedRun run;
  const RecordingReport report = read_recording(cut, run);
  EXPECT_FALSE(report.complete);
  EXPECT_GT(run.ticks, 20u);

  start_heeld(config);
  ASSERT_TRUE(daemon_->says("did not end by itself: its last 30 s are in")) << logs();
  daemon_->signal(SIGTERM);
  ASSERT_EQ(daemon_->wait(), 0) << logs();
  std::string left;
  for (const auto& entry : std::filesystem::directory_iterator(scene_.path("run")))
    if (entry.path().string().ends_with("-black-box.mcap")) left = entry.path().string();
  ASSERT_NE(left, "");
  RecordedRun last;
  EXPECT_TRUE(read_recording(left, last).complete);
  EXPECT_GE(last.ticks, run.ticks) << "it is less than 30 s, and has what no chunk had yet";
  EXPECT_LT(t_killed_s - seconds_from_ns(last.t_last_tick_ns), 1.0);
  EXPECT_TRUE(replay_control(left, {}).all_same()) << "it began with the run";
}

TEST_F(OperatedHeeld, TwoEmergencyStopsDuringASaveAreServedAndTheFileIsWhole) {
  const std::string config = operated_config("[gate]\n# mine\nv_max_m_s = 0.5 # slow\n");
  get_ready(config);
  SocketClient setter(socket()), one(socket()), two(socket());
  ASSERT_TRUE(drives_after_start(one)) << logs();
  ASSERT_EQ(
      ask(setter, R"({"do":"set","values":{"gate.v_max_m_s":0.3,"control.deadband_distance_m":0.06}})")["ok"],
      true);
  setter.send("{\"id\":1,\"do\":\"save\"}\n");
  one.send("{\"do\":\"estop\"}\n");
  two.send("{\"do\":\"estop\"}\n");
  EXPECT_EQ(json::parse(one.line())["state"], "emergency");
  EXPECT_EQ(json::parse(two.line())["state"], "emergency");
  const json saved = json::parse(setter.line());
  EXPECT_EQ(saved["id"], 1);
  EXPECT_EQ(saved["changes"].size(), 2u);
  EXPECT_TRUE(comes_to_rest());
  const std::string text = read_text(config);
  EXPECT_THAT(text, HasSubstr("[gate]\n# mine\nv_max_m_s = 0.3 # slow\n"));
  EXPECT_THAT(text, HasSubstr("[control]\ndeadband_distance_m = 0.06\n"));
}

TEST_F(OperatedHeeld, ClientsThatMisbehaveDoNotStopItNorKeepOutAnEmergencyStop) {
  get_ready(operated_config());
  SocketClient client(socket());
  ASSERT_TRUE(drives_after_start(client)) << logs();

  std::vector<std::unique_ptr<SocketClient>> others;
  const auto other = [&]() -> SocketClient& {
    others.push_back(std::make_unique<SocketClient>(socket()));
    return *others.back();
  };
  for (const std::string& bytes :
       {std::string("hello\n"), std::string(100000, '{'), std::string("\0\xff\n", 3),
        std::string("{\"do\":\"set\",\"values\":{\"gate.v_max_m_s\":\"fast\"}}\n"),
        std::string("{\"do\":\"start\"")})
    other().send(bytes);
  for (int i = 0; i < 50; ++i) other().send("{\"do\":");
  SocketClient& slow = other();  // asks and does not read
  for (int i = 0; i < 90; ++i) slow.send("{\"do\":\"status\"}\n");
  other().send("{\"do\":\"watch\",\"period_s\":0.1}\n");
  sleep_s(1.0);
  SocketClient newcomer(socket());
  const std::string state = command(newcomer, "status")["state"];
  EXPECT_THAT(state, testing::AnyOf("following", "waiting", "stopped")) << "none of them has commanded it";
  EXPECT_TRUE(drives_after_start(newcomer)) << logs();
  EXPECT_EQ(command(newcomer, "estop")["state"], "emergency") << logs();
  EXPECT_TRUE(comes_to_rest());
  EXPECT_TRUE(daemon_->running());
}

TEST_F(OperatedHeeld, AtAReloadTheFileWins) {
  const std::string config = operated_config("[gate]\nv_max_m_s = 0.5\n");
  get_ready(config);
  SocketClient client(socket());
  ask(client, R"({"do":"set","values":{"gate.v_max_m_s":0.1}})");
  EXPECT_EQ(command(client, "status")["limits"]["gate.v_max_m_s"], 0.1);
  daemon_->signal(SIGHUP);
  EXPECT_TRUE(daemon_->says("the reload drops what was set and not saved: gate.v_max_m_s: 0.1 -> 0.5"))
      << logs();
  EXPECT_TRUE(eventually([&] { return command(client, "status")["limits"]["gate.v_max_m_s"] == 0.5; }));
}

TEST_F(OperatedHeeld, AValueThatIsSetIsInForceWhileDriving) {
  get_ready(operated_config());
  SocketClient client(socket());
  ASSERT_TRUE(drives_after_start(client)) << logs();
  ASSERT_EQ(ask(client, R"({"do":"set","values":{"gate.v_max_m_s":0.1}})")["ok"], true);
  EXPECT_TRUE(eventually([&] {
    if (command(client, "status")["state"] == "stopped") command(client, "start");
    return speed() > 0.05 && speed() < 0.12;
  })) << speed();
}

TEST_F(OperatedHeeld, TheSocketOfADeadHeeldIsReplacedAndThatOfALiveOneIsNot) {
  const std::string config = operated_config();
  start_heeld(config);
  ASSERT_TRUE(daemon_->says("operators are served at")) << logs();
  test::Process second({HEELD_PROGRAM, "--config", config});
  EXPECT_EQ(second.wait(), 78);
  EXPECT_THAT(second.output(), HasSubstr("operator.socket: " + socket() + ": another process serves it"));
  {
    SocketClient client(socket());
    EXPECT_EQ(command(client, "alive")["ok"], true) << "the first one goes on";
  }
  daemon_->signal(SIGKILL);
  ASSERT_EQ(daemon_->wait(), -SIGKILL);
  ASSERT_TRUE(std::filesystem::exists(socket()));
  start_heeld(config);
  ASSERT_TRUE(daemon_->says("operators are served at")) << logs();
  SocketClient client(socket());
  EXPECT_EQ(command(client, "alive")["ok"], true);

  daemon_->signal(SIGTERM);
  EXPECT_EQ(daemon_->wait(), 0);
  EXPECT_TRUE(client.closed());
  EXPECT_FALSE(std::filesystem::exists(socket()));
}

TEST_F(OperatedHeeld, ASecondHeeldDoesNotTouchTheRobotOfTheFirst) {
  const std::string config = operated_config();
  get_ready(config);
  test::Process second({HEELD_PROGRAM, "--config", config});
  EXPECT_EQ(second.wait(), 78);
  EXPECT_THAT(second.output(), HasSubstr("another process serves it"));
  EXPECT_FALSE(robot_->says("closed", 1.0)) << "the session of the first" << logs();
  SocketClient client(socket());
  EXPECT_EQ(command(client, "status")["robot"]["reconnects"], 0) << logs();
}

TEST_F(OperatedHeeld, WithoutASocketItRunsAndReloads) {
  const std::string config = scene_.write_config({.start = "operator"});
  std::string text = read_text(config);
  text.replace(text.find("control.sock"), std::string("control.sock").size(), "");
  write_text(config, text);
  start_heeld(config);
  ASSERT_TRUE(notify_.receives("STATUS=")) << logs();
  EXPECT_FALSE(std::filesystem::exists(socket()));
  daemon_->signal(SIGHUP);
  EXPECT_TRUE(daemon_->says("reloaded")) << logs();
}

}  // namespace
}  // namespace heel
