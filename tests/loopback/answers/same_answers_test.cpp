// heel pose, the lock step and heeld over a pty give the same answers on the same frames, to the bit: they
// run the same vision stage with the same configuration.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "files/camera_info.h"
#include "files/template_file.h"
#include "heel/shirt_template.h"
#include "support/exported.h"
#include "support/process.h"
#include "support/sanitized.h"
#include "support/temporary_folder.h"
#include "tools/heel/printed_shirt.h"

namespace heel {
namespace {

using nlohmann::json;
using test::kHeight_px;
using test::kWidth_px;
using test::Outcome;
using test::Process;
using test::run_program;

constexpr int kFrames = 24;
constexpr int kFirstHidden = 10, kLastHidden = 12;  // the shirt is not in these frames
// So slow that heeld drops no frame, and a multiple of a nanosecond, so that all three see the same ages.
constexpr double kRate_hz = 5.0;
constexpr double kPeriod_s = 1.0 / kRate_hz;

/// The columns of a row of poses.csv by their names, as text; numbers in it read back as the same number.
using PoseColumns = std::map<std::string, std::string>;

std::vector<PoseColumns> recorded_poses(const std::string& csv_path) {
  std::ifstream file(csv_path);
  std::string header, line;
  std::getline(file, header);
  std::vector<PoseColumns> rows;
  while (std::getline(file, line)) {
    std::istringstream names(header), values(line);
    PoseColumns& row = rows.emplace_back();
    for (std::string name, value; std::getline(names, name, ',') && std::getline(values, value, ',');)
      row[name] = value;
  }
  return rows;
}

/// What vision answered, without what belongs to the run: its clock and its count of frames.
PoseColumns answer(PoseColumns row) {
  for (const char* name : {"t_s", "done_s", "frame"}) row.erase(name);
  return row;
}

/// The numbers of a JSON line of `heel pose` under the names of poses.csv's columns.
std::map<std::string, double> numbers_of(const json& line) {
  std::map<std::string, double> numbers = {{"found", line["found"].get<bool>() ? 1.0 : 0.0},
                                           {"certainty", line["certainty"].get<double>()},
                                           {"inliers", line["inliers"].get<double>()}};
  if (!line["found"].get<bool>()) return numbers;
  for (const char* name : {"yaw_rad", "yaw_sigma_rad", "frame_yaw_rad", "frame_yaw_sigma_rad"})
    numbers[name] = line[name].get<double>();
  for (const char* name : {"t_over_d", "position_m", "H_cur_from_ref"}) {
    const auto values = line[name].get<std::vector<double>>();
    for (std::size_t i = 0; i < values.size(); ++i)
      numbers[std::string(name) + "_" + std::to_string(i)] = values[i];
  }
  return numbers;
}

class SameAnswers : public ::testing::Test {
 protected:
  void SetUp() override {
    write_camera_model(test::shirt_camera(), path("camera.yaml"));
    ShirtTemplate shirt;
    const cv::Mat reference = test::printed_plane();
    shirt.grey.assign(reference.datastart, reference.dataend);
    shirt.camera = test::shirt_camera();
    shirt.roi = {240, 140, 160, 200};
    shirt.distance_m = 1.4;
    write_template(shirt, path("shirt.heel"));
    std::filesystem::create_directory(path("frames"));
    for (int i = 0; i < kFrames; ++i)
      cv::imwrite(path("frames/" + std::to_string(i) + ".png"), picture(reference, i));
    // Values other than the defaults: a program that does not read the file gives other answers.
    test::write_text(path("heel.toml"),
                     "[camera]\nsource = \"file:frames\"\ninfo = \"camera.yaml\"\nrate_hz = 5\n"
                     "[target]\nshirt = \"shirt.heel\"\ndistance_m = 1.5\n"
                     "[vision]\nmax_features = 700\nmatch_ratio = 0.75\nback_curvature_1_m = 0.2\n"
                     "[supervisor]\nstart = \"at_once\"\n"
                     "[robot]\naddress = \"pty:robot\"\nsync_retry_s = 0.2\n"
                     "[operator]\nsocket = \"control.sock\"\n"
                     "[runtime]\nrealtime = false\n"
                     "[telemetry]\ndirectory = \"run\"\n");
  }
  std::string path(const std::string& name) const { return folder_.file(name); }

  /// A back that turns, comes nearer, is hidden for three frames and comes back at another place.
  static cv::Mat picture(const cv::Mat& reference, int frame) {
    if (frame >= kFirstHidden && frame <= kLastHidden)
      return cv::Mat(kHeight_px, kWidth_px, CV_8UC1, cv::Scalar(120));
    const double side = frame > kLastHidden ? 0.2 : -0.1;
    return test::TrueMotion{0.4 * std::sin(0.5 * frame), {side, 0.01 * frame, 0.5 - 0.02 * frame}}.picture(
        reference);
  }

  std::vector<json> poses_of_heel_pose(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> argv = {test::built_program("heel"), "pose",        "--json", "--config",
                                     path("heel.toml"),           path("frames")};
    argv.insert(argv.end(), more.begin(), more.end());
    const Outcome outcome = run_program(argv);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::vector<json> lines;
    std::istringstream in(outcome.out);
    for (std::string line; std::getline(in, line);) lines.push_back(json::parse(line));
    return lines;
  }

  std::vector<PoseColumns> poses_of_lock_step() const {
    test::write_text(path("scenario.toml"),
                     "duration_s = 10\nvision_latency_ms = 10\n"
                     "[camera]\nsource = \"file:frames\"\ninfo = \"camera.yaml\"\nrate_hz = 5\n");
    const Outcome outcome =
        run_program({test::built_program("heel"), "simulate", path("scenario.toml"), "--config",
                     path("heel.toml"), "--template", path("shirt.heel"), "--out", path("lockstep")});
    EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
    return recorded_poses(test::exported(path("lockstep")) + "/poses.csv");
  }

  /// One run of the daemon; empty when the busy machine made it drop or delay a frame.
  std::vector<PoseColumns> poses_of_heeld() const {
    std::filesystem::remove_all(path("run"));
    Process robot({test::built_program("heel-sim"), "--robot", "pty:" + path("robot")}, path("robot.log"));
    EXPECT_TRUE(robot.says("ready at")) << robot.output();
    Process daemon({test::built_program("heeld"), "--config", path("heel.toml")}, path("heeld.log"));
    EXPECT_EQ(daemon.wait(), 0) << daemon.output();
    const std::vector<PoseColumns> rows = recorded_poses(test::exported(path("run")) + "/poses.csv");
    if (rows.size() != kFrames) return {};
    for (int i = 0; i < kFrames; ++i) {
      const double t_s = std::stod(rows[static_cast<std::size_t>(i)].at("t_s"));
      if (rows[static_cast<std::size_t>(i)].at("frame") != std::to_string(i)) return {};
      if (std::abs(t_s - std::stod(rows[0].at("t_s")) - i * kPeriod_s) > 1e-6) return {};
    }
    return rows;
  }

  test::TemporaryFolder folder_;
};

TEST_F(SameAnswers, HeelPoseLockStepAndDaemon) {
  const std::vector<PoseColumns> lock_step = poses_of_lock_step();
  std::vector<PoseColumns> daemon;
  for (int attempt = 0; daemon.empty() && attempt < 5; ++attempt) daemon = poses_of_heeld();
  const std::vector<json> posed = poses_of_heel_pose();
  ASSERT_EQ(lock_step.size(), kFrames);
  ASSERT_EQ(daemon.size(), kFrames) << "heeld dropped a frame in each of five runs\n"
                                    << test::read_text(path("heeld.log"));
  ASSERT_EQ(posed.size(), kFrames);

  int found = 0, tracked = 0;
  for (std::size_t i = 0; i < kFrames; ++i) {
    SCOPED_TRACE("frame " + std::to_string(i));
    EXPECT_EQ(answer(daemon[i]), answer(lock_step[i]));
    EXPECT_EQ(posed[i]["reason"], daemon[i].at("reason"));
    for (const auto& [name, value] : numbers_of(posed[i]))
      EXPECT_EQ(value, std::stod(daemon[i].at(name))) << name;
    found += daemon[i].at("found") == "1";
    tracked += daemon[i].at("tracked") == "1";
  }
  // The comparison means nothing where vision has nothing to say, or did not track.
  // While nothing is found, every second frame is searched in one of its parts only: one frame may be lost.
  EXPECT_GE(found, kFrames - (kLastHidden - kFirstHidden + 1) - 1);
  EXPECT_GT(tracked, found / 2);
  EXPECT_LT(tracked, found);
}

TEST_F(SameAnswers, IndependentPicturesAreEachAnsweredAsASinglePicture) {
  const std::vector<json> together = poses_of_heel_pose({"--independent"});
  const std::vector<json> tracked = poses_of_heel_pose();
  ASSERT_EQ(together.size(), kFrames);
  bool differs = false;
  for (int i = 0; i < kFrames; i += test::kSanitized ? 8 : 4) {
    const std::string image = path("frames/" + std::to_string(i) + ".png");
    const Outcome alone =
        run_program({test::built_program("heel"), "pose", "--json", "--config", path("heel.toml"), image});
    ASSERT_EQ(alone.status, 0) << alone.err;
    const auto k = static_cast<std::size_t>(i);
    EXPECT_EQ(numbers_of(json::parse(alone.out)), numbers_of(together[k])) << i;
    differs |= numbers_of(together[k]) != numbers_of(tracked[k]);
  }
  EXPECT_TRUE(differs) << "tracking and searching give the same answers: the option is not tested";
}

}  // namespace
}  // namespace heel
