// The page's server with the operator thread, a control loop that the test plays, and records that the test
// pushes: the test's own thread is the telemetry thread.
#pragma once

#include <gtest/gtest.h>
#include <spdlog/logger.h>

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "operator/operator_server.h"
#include "operator/played_loop.h"
#include "operator/web/view_server.h"
#include "support/page_client.h"
#include "support/temporary_folder.h"

namespace heel::test {

inline const std::string kToken = "0123456789abcdef-token";

class PageFixture : public ::testing::Test {
 protected:
  PageFixture();
  ~PageFixture() override;

  std::uint16_t port() const { return view_->port(); }
  std::unique_ptr<PageClient> client() const { return std::make_unique<PageClient>(port()); }
  /// Records as of one tick with a pose and a frame; the telemetry thread takes them.
  void push(std::uint64_t frame);
  /// The server answers as ever.
  void expect_it_serves() const { EXPECT_EQ(client()->ask("GET /api/info").status, 200); }

  const TemporaryFolder folder_;
  const std::shared_ptr<RecentLog> recent_ = std::make_shared<RecentLog>();  ///< gets the log meanwhile
  const std::shared_ptr<spdlog::logger> logger_before_;
  PlayedLoop loop_;
  TelemetryQueues queues_;
  PictureQueue pictures_{8, 64, 48};
  Telemetry telemetry_{queues_, {.directory = "", .black_box = ""}, &pictures_};
  LiveFeed feed_{30.0};
  ViewFacts facts_;
  Settings settings_;
  SettingsLoop settings_loop_{settings_};
  OperatorServer operators_;
  std::unique_ptr<ViewServer> view_;
  TickRecord tick_;
  std::vector<std::thread> threads_;
};

}  // namespace heel::test
