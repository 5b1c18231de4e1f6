#include "operator/web/page_fixture.h"

#include <spdlog/spdlog.h>

#include <filesystem>

#include "realtime/clock.h"

namespace heel::test {
namespace {

LoadedConfig page_config(const TemporaryFolder& folder) {
  write_text(folder.file("token"), kToken + "\n");
  std::filesystem::permissions(folder.file("token"), std::filesystem::perms::owner_read);
  const std::string text =
      "[gate]\nv_max_m_s = 0.5\n[view]\naddress = \"127.0.0.1:0\"\ntoken_file = \"token\"\n"
      "hosts = [\"robot.local\"]\n";
  write_text(folder.file("heel.toml"), text);
  return parse_config(text, folder.file("heel.toml"));
}

PageFiles page_files(const TemporaryFolder& folder) {
  std::filesystem::create_directory(folder.file("page"));
  std::filesystem::create_directory(folder.file("charts"));
  write_text(folder.file("page/index.html"), "<!doctype html><title>heel</title>");
  write_text(folder.file("page/app.js"), "export const a = 1;");
  write_text(folder.file("page/secret.txt"), "no kind of file that a page has");
  write_text(folder.file("charts/dygraph.min.js"), "var Dygraph;");
  return {folder.file("page"), folder.file("charts")};
}

ViewFacts made_facts() {
  ViewFacts facts;
  facts.camera.width_px = 64;
  facts.camera.height_px = 48;
  facts.camera.fx = facts.camera.fy = 50.0;
  facts.camera.cx = 32.0;
  facts.camera.cy = 24.0;
  ShownTemplate shirt;
  shirt.corners_px = {Eigen::Vector2d(10, 10), {30, 10}, {30, 40}, {10, 40}};
  shirt.distance_m = 2.0;
  facts.templates.push_back(shirt);
  return facts;
}

}  // namespace

PageFixture::PageFixture()
    : logger_before_(spdlog::default_logger()),
      facts_(made_facts()),
      settings_(page_config(folder_), {[](const Config&) {}, [](const Config&) {}}),
      operators_(LocalSocket(folder_.file("control.sock")), loop_, settings_, settings_loop_) {
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("page", recent_));
  const ViewParts parts{settings_, telemetry_, loop_, &operators_, feed_, *recent_, facts_};
  view_ = std::make_unique<ViewServer>(settings_.view().file.view, parts, page_files(folder_));
  telemetry_.listen(feed_);
  threads_.emplace_back([this] { operators_.run(); });
  threads_.emplace_back([this] { settings_loop_.run(); });
  threads_.emplace_back([this] { view_->run(); });
}

PageFixture::~PageFixture() {
  view_->stop();
  settings_loop_.stop();
  operators_.stop();
  for (std::thread& thread : threads_) thread.join();
  spdlog::set_default_logger(logger_before_);
}

void PageFixture::push(std::uint64_t frame) {
  const TimeNs now_ns = monotonic_now_ns();
  PoseEstimate pose;
  pose.frame_sequence = frame;
  pose.t_capture_ns = now_ns - 20 * kNsPerMs;
  pose.t_done_ns = now_ns - 10 * kNsPerMs;
  pose.reason = PoseReason::Found;
  pose.H_cur_from_ref = {1, 0, 5, 0, 1, 2, 0, 0, 1};
  ++tick_.tick;
  tick_.input.now_ns = now_ns;
  tick_.input.has_pose = true;
  tick_.input.pose = pose;
  tick_.input.lateness_ns = 30'000;
  queues_.ticks.push(tick_);
  queues_.poses.push(pose);
  const std::vector<std::uint8_t> grey(64 * 48, 100);
  pictures_.push({{frame, pose.t_capture_ns, 64, 48}, grey.data(), 64});
  telemetry_.drain(now_ns);
}

}  // namespace heel::test
