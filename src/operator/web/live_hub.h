// Who looks at the live data, and what each of them gets. One picture is on its way to each viewer: the next
// one goes when the browser has shown it, so that pictures never queue up.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "logging/recent_log.h"
#include "operator/web/live_feed.h"
#include "operator/web/view_facts.h"

namespace heel {

/// A message that several viewers get.
struct LiveMessage {
  bool binary = false;
  std::string bytes;
};
using SharedMessage = std::shared_ptr<const LiveMessage>;

class LiveViewer {
 public:
  virtual ~LiveViewer() = default;
  /// Does not wait.
  virtual void send(SharedMessage message) = 0;

  // Kept by the hub:
  bool wants_pictures = false;
  bool picture_on_its_way = false;
};

/// A viewer that makes messages of its own.
class RecordViewer {
 public:
  virtual ~RecordViewer() = default;
  /// It asks for pictures, and can take one now.
  virtual bool wants_pictures() const = 0;
  virtual bool ready_for_picture() const = 0;
  /// `jpeg`: of news.picture; empty: there is none. Does not wait.
  virtual void see(const LiveNews& news, const std::string& jpeg, const std::vector<LoggedLine>& lines) = 0;
};

class LiveHub {
 public:
  /// Everything is borrowed. `robot_model` is the value of robot.model.
  LiveHub(LiveFeed& feed, RecentLog& log, const ViewFacts& facts, std::string robot_model,
          int picture_quality)
      : feed_(feed),
        log_(log),
        facts_(facts),
        robot_model_(std::move(robot_model)),
        quality_(picture_quality) {}

  /// False: too many look already. Viewers are borrowed until remove().
  bool add(LiveViewer& viewer);
  void remove(LiveViewer& viewer);
  bool add(RecordViewer& viewer);
  void remove(RecordViewer& viewer);
  /// What a viewer asks for has changed.
  void asked() { tell_feed(); }
  /// A message of a viewer: {"type":"want","picture":true}, {"type":"picture_shown","frame":7}. False: it is
  /// none that is known.
  bool heard(LiveViewer& viewer, const std::string& text);
  /// Sends what has come since the last time.
  void send_news();
  std::size_t viewers() const { return viewers_.size() + record_viewers_.size(); }
  /// Pictures that were encoded so far.
  std::uint64_t pictures() const { return pictures_; }

 private:
  void forget_lines();
  void tell_feed();
  void send_to_all(std::string text);
  bool picture_awaited() const;
  void send_picture(const FrameHeader& header, const std::string& jpeg);

  LiveFeed& feed_;
  RecentLog& log_;
  const ViewFacts& facts_;
  const std::string robot_model_;
  const int quality_;
  std::vector<LiveViewer*> viewers_;
  std::vector<RecordViewer*> record_viewers_;
  std::uint64_t lines_sent_ = 0;
  std::uint64_t pictures_ = 0;
};

}  // namespace heel
