// heel status, start, stop, estop, reset, set, save, watch: with an operator thread whose control loop the
// test plays, and without heeld.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>
#include <vector>

#include "operator/operator_server.h"
#include "operator/played_loop.h"
#include "tools/heel/refusals.h"
#include "tools/heel/run_heel.h"

namespace heel {
namespace {

using test::Outcome;
using test::run_heel;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class HeelOperator : public ::testing::Test {
 protected:
  HeelOperator()
      : settings_(load_config(test::write_text(config_, "# mine\n[gate]\nv_max_m_s = 0.5 # slow\n")),
                  {[](const Config&) {}, [](const Config&) {}}),
        settings_loop_(settings_),
        server_(LocalSocket(socket_), loop_, settings_, settings_loop_),
        thread_([this] { server_.run(); }),
        settings_thread_([this] { settings_loop_.run(); }) {}
  ~HeelOperator() override {
    settings_loop_.stop();
    settings_thread_.join();
    server_.stop();
    thread_.join();
  }

  Outcome heel(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--socket", socket_});
    return run_heel(arguments);
  }

  const test::TemporaryFolder folder_;
  const std::string socket_ = folder_.file("control.sock"), config_ = folder_.file("heel.toml");
  test::PlayedLoop loop_;
  Settings settings_;
  SettingsLoop settings_loop_;
  OperatorServer server_;
  std::thread thread_, settings_thread_;
};

TEST_F(HeelOperator, CommandsPrintTheStateTheyLeadTo) {
  EXPECT_THAT(heel({"start"}).out, StartsWith("ARMED: "));
  EXPECT_THAT(heel({"stop"}).out, StartsWith("IDLE: "));
  const Outcome estop = heel({"estop"});
  EXPECT_EQ(estop.status, 0);
  EXPECT_THAT(estop.out, StartsWith("EMERGENCY: "));
  const Outcome refused = heel({"start"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_EQ(refused.out, "");
  EXPECT_THAT(refused.err,
              AllOf(StartsWith("heel start: refused: emergency stop\n"), HasSubstr("EMERGENCY: ")));
  EXPECT_THAT(heel({"reset"}).out, StartsWith("IDLE: "));
}

TEST_F(HeelOperator, TheStatusIsForPeopleOrForPrograms) {
  const Outcome people = heel({"status"});
  EXPECT_EQ(people.status, 0);
  EXPECT_THAT(people.out, StartsWith("IDLE\n"));
  for (const char* part : {"\nrobot ", "\ncamera ", "\nperson ", "\nlimits ", "speed 0.50 m/s", "battery"})
    EXPECT_THAT(people.out, HasSubstr(part));
  const nlohmann::json status = nlohmann::json::parse(heel({"status", "--json"}).out);
  EXPECT_EQ(status["state"], "idle");
  EXPECT_EQ(status["limits"]["gate.v_max_m_s"], 0.5);
}

TEST_F(HeelOperator, WithJsonEachCommandPrintsTheAnswerOfHeeldAndNothingElse) {
  int answers = 0;
  for (const std::vector<std::string>& command : {std::vector<std::string>{"start"},
                                                  {"stop"},
                                                  {"set", "gate.v_max_m_s=0.25"},
                                                  {"save"},
                                                  {"estop"},
                                                  {"reset"},
                                                  {"status"}}) {
    std::vector<std::string> arguments = command;
    arguments.emplace_back("--json");
    const Outcome outcome = heel(arguments);
    const auto answer = nlohmann::json::parse(outcome.out, nullptr, /*allow_exceptions=*/false);
    ASSERT_TRUE(answer.is_object()) << command.front() << ": " << outcome.out;
    EXPECT_EQ(answer["ok"], true) << command.front();
    ++answers;
  }
  EXPECT_EQ(answers, 7);
  EXPECT_EQ(nlohmann::json::parse(heel({"estop", "--json"}).out)["state"], "emergency");
  const Outcome refused = heel({"start", "--json"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_EQ(nlohmann::json::parse(refused.out)["ok"], false);
  EXPECT_THAT(refused.err, StartsWith("heel start: refused: emergency stop\n"));
}

TEST_F(HeelOperator, SetAndSaveShowTheDifference) {
  const Outcome set = heel({"set", "gate.v_max_m_s=0.25", "runtime.log_level=warn", "control.reverse=false"});
  EXPECT_EQ(set.status, 0) << set.err;
  EXPECT_THAT(set.out, StartsWith("gate.v_max_m_s: 0.5 -> 0.25\nruntime.log_level: \"info\" -> \"warn\"\n"));
  EXPECT_THAT(heel({"status"}).out, HasSubstr("gate.v_max_m_s = 0.25 (in the file 0.5; not saved)"));
  const Outcome saved = heel({"save"});
  EXPECT_EQ(saved.out, "gate.v_max_m_s: 0.5 -> 0.25\nruntime.log_level: \"info\" -> \"warn\"\n");
  EXPECT_EQ(test::read_text(config_),
            "# mine\n[gate]\nv_max_m_s = 0.25 # slow\n\n[runtime]\nlog_level = \"warn\"\n");
  EXPECT_EQ(heel({"save"}).out, "nothing to save: no value was set\n");

  const Outcome refused = heel({"set", "gate.v_max_m_s=fast"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_EQ(refused.err, "heel set: gate.v_max_m_s: 'fast' (expected a number 0…1.2 m/s)\n");
}

TEST_F(HeelOperator, WatchPrintsALineAtEachChange) {
  const test::Process watch(
      {test::built_program("heel"), "watch", "--socket", socket_, "--period", "60", "--alive"});
  const auto says = [&](const char* text) {
    return test::eventually([&] { return watch.output().find(text) != std::string::npos; });
  };
  ASSERT_TRUE(says("IDLE: ")) << watch.output();
  EXPECT_EQ(heel({"start"}).status, 0);
  EXPECT_TRUE(says("ARMED: ")) << watch.output();
  EXPECT_TRUE(test::eventually([&] { return loop_.signs_of_life() > 5; })) << "--alive";
}

/// `heel watch` on a terminal of 80 columns and 24 rows.
class WatchOnATerminal {
 public:
  explicit WatchOnATerminal(const std::string& socket, const std::string& variable = "HEEL_TEST=1") {
    const winsize size{24, 80, 0, 0};
    // Made before the fork: between it and exec nothing may allocate, because other threads run.
    std::string program = test::built_program("heel"), watch = "watch", option = "--socket", name = socket,
                kind = "TERM=xterm", more = variable;
    std::vector<char*> arguments{program.data(), watch.data(), option.data(), name.data(), nullptr};
    std::vector<char*> environment{kind.data(), more.data()};
    for (char** one = environ; *one != nullptr; ++one)
      if (!std::string_view(*one).starts_with("TERM=") && !std::string_view(*one).starts_with("NO_COLOR="))
        environment.push_back(*one);
    environment.push_back(nullptr);
    pid_ = forkpty(&terminal_, nullptr, nullptr, &size);
    if (pid_ == 0) {
      execve(program.data(), arguments.data(), environment.data());
      _exit(127);
    }
    fcntl(terminal_, F_SETFL, O_NONBLOCK);
  }
  ~WatchOnATerminal() {
    if (!ended_) kill(pid_, SIGKILL);
    wait();
    close(terminal_);
  }
  WatchOnATerminal(const WatchOnATerminal&) = delete;
  WatchOnATerminal& operator=(const WatchOnATerminal&) = delete;

  void press(char key) const { ASSERT_EQ(write(terminal_, &key, 1), 1); }
  bool shows(const std::string& text) {
    return test::eventually([&] {
      read_more();
      // The newest view begins where the cursor went home last.
      const std::size_t newest = out_.rfind("\x1b[H");
      return newest != std::string::npos && out_.find(text, newest) != std::string::npos;
    });
  }
  int wait() {
    if (ended_) return status_;
    const bool ended = test::eventually([&] {
      read_more();
      return waitpid(pid_, &status_, WNOHANG) == pid_;
    });
    ended_ = true;
    read_more();
    return ended ? status_ : -1000;
  }
  const std::string& output() const { return out_; }

 private:
  void read_more() {
    std::array<char, 4096> bytes;
    for (ssize_t count; (count = read(terminal_, bytes.data(), bytes.size())) > 0;)
      out_.append(bytes.data(), static_cast<std::size_t>(count));
  }

  pid_t pid_ = -1;
  int terminal_ = -1, status_ = -1;
  bool ended_ = false;
  std::string out_;
};

TEST_F(HeelOperator, OnATerminalWatchIsAViewWhoseSpaceBarIsAnEmergencyStop) {
  WatchOnATerminal watch(socket_);
  ASSERT_TRUE(watch.shows("  IDLE  ")) << watch.output();
  for (const char* row : {"speed", "person", "shirt", "battery", "space: emergency stop"})
    EXPECT_TRUE(watch.shows(row)) << row;
  EXPECT_EQ(heel({"start"}).status, 0);
  EXPECT_TRUE(watch.shows("  ARMED  ")) << watch.output();
  EXPECT_EQ(heel({"set", "gate.v_max_m_s=0.25"}).status, 0);
  EXPECT_TRUE(watch.shows("gate.v_max_m_s 0.5 -> 0.25")) << watch.output();
  watch.press('x');
  watch.press(' ');
  EXPECT_TRUE(watch.shows("  EMERGENCY  ")) << watch.output();
  EXPECT_TRUE(watch.shows("emergency stop: done")) << watch.output();
  watch.press('q');
  EXPECT_EQ(watch.wait(), 0);
  EXPECT_THAT(watch.output(), ::testing::EndsWith("\x1b[?25h")) << "the cursor is shown again";
}

TEST_F(HeelOperator, TheViewHasColourExceptWithNoColor) {
  const std::string kColour = "\x1b[30;47m";  // the state on grey
  WatchOnATerminal coloured(socket_), plain(socket_, "NO_COLOR=1");
  ASSERT_TRUE(coloured.shows("IDLE")) << coloured.output();
  ASSERT_TRUE(plain.shows("IDLE")) << plain.output();
  EXPECT_THAT(coloured.output(), HasSubstr(kColour));
  EXPECT_THAT(plain.output(), Not(HasSubstr(kColour)));
}

TEST_F(HeelOperator, ASignalEndsTheViewAndLeavesTheTerminalAsItWas) {
  WatchOnATerminal watch(socket_);
  ASSERT_TRUE(watch.shows("  IDLE  ")) << watch.output();
  watch.press('\x03');  // Ctrl-C
  EXPECT_EQ(watch.wait(), 0);
  EXPECT_THAT(watch.output(), ::testing::EndsWith("\x1b[?25h"));
}

TEST_F(HeelOperator, TheSocketIsNamedByAVariable) {
  test::Process heel({test::built_program("heel"), "status"}, "", {{"HEEL_SOCKET", socket_}});
  EXPECT_EQ(heel.wait(), 0);
  EXPECT_THAT(heel.output(), StartsWith("IDLE\n"));
}

TEST(HeelOperatorWithoutHeeld, TheLikelyCauseIsNamedWithStatus69) {
  const test::TemporaryFolder folder;
  const std::string missing = folder.file("no.sock"), dead = folder.file("dead.sock");
  {
    const LocalSocket left(dead + ".then");
    ASSERT_EQ(rename((dead + ".then").c_str(), dead.c_str()), 0);
  }
  int commands = 0;
  for (const std::vector<std::string>& command :
       std::vector<std::vector<std::string>>{{"status"},
                                             {"start"},
                                             {"stop"},
                                             {"estop"},
                                             {"reset"},
                                             {"save"},
                                             {"watch"},
                                             {"set", "gate.v_max_m_s=0.3"}}) {
    ++commands;
    std::vector<std::string> arguments = command;
    arguments.insert(arguments.end(), {"--socket", missing});
    Outcome outcome = run_heel(arguments);
    EXPECT_EQ(outcome.status, 69) << command.front();
    EXPECT_EQ(outcome.err,
              "heel " + command.front() + ": " + missing +
                  ": no such socket (is heeld running? systemctl status heeld; another socket: --socket)\n");
    arguments.back() = dead;
    outcome = run_heel(arguments);
    EXPECT_EQ(outcome.status, 69);
    EXPECT_THAT(outcome.err, HasSubstr("nobody serves it (heeld is not running"));
    const Outcome help = run_heel({command.front(), "--help"});
    EXPECT_THAT(help.out, HasSubstr("Exit status: 0 done; 1 refused")) << command.front();
  }
  EXPECT_EQ(commands, 8);
}

TEST(HeelOperatorWithoutHeeld, AStartWithoutAnAnswerClosesItsConnection) {
  const test::TemporaryFolder folder;
  const LocalSocket silent(folder.file("control.sock"));
  const Outcome outcome = run_heel({"start", "--socket", silent.path()});
  EXPECT_EQ(outcome.status, 69);
  EXPECT_EQ(outcome.err, "heel start: " + silent.path() + ": heeld did not answer within 2 s\n");
  const int fd = accept(silent.fd(), nullptr, nullptr);
  ASSERT_GE(fd, 0);
  EXPECT_TRUE(Connection(fd, 1, 0).peer_gone()) << "heeld must see that nobody waits for the start";
}

TEST(HeelOperatorWithoutHeeld, WatchPrintsWhyItsConnectionIsClosed) {
  const test::TemporaryFolder folder;
  LocalSocket heeld(folder.file("control.sock"));
  test::Process watch({test::built_program("heel"), "watch", "--json", "--socket", heeld.path()});
  int fd = -1;
  ASSERT_TRUE(test::eventually([&] { return (fd = heeld.accept(monotonic_now_ns())) >= 0; }));
  {
    Connection connection(fd, 1, 0);
    connection.send_line(R"({"v":1,"ok":true,"event":"status"})");
    connection.send_line(R"({"v":1,"ok":false,"error":"closed: more than 16 clients"})");
    EXPECT_TRUE(watch.says("\nheel watch: closed: more than 16 clients\n")) << watch.output();
  }
  EXPECT_EQ(watch.wait(), 69);
}

TEST(HeelOperatorWithoutHeeld, BadUsageIsRefused) {
  test::expect_refused({
      {{"set"}, "heel set: ", "assignments"},
      {{"set", "gate.v_max_m_s"}, "heel set: ", "(expected KEY=VALUE, as gate.v_max_m_s=0.3)"},
      {{"set", "=1"}, "heel set: ", "(expected KEY=VALUE"},
      {{"set", "a.b=1", "a.b=2"}, "heel set: ", "a.b: given twice"},
      {{"watch", "--period", "0"}, "heel watch: ", "expected a number, 0.1…60"},
      {{"start", "now"}, "heel start: ", "now"},
      {{"status", "--socket", std::string(200, 'x')}, "heel status: ", "(expected at most 107)"},
  });
}

}  // namespace
}  // namespace heel
