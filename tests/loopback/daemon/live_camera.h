// A camera that a test holds before heeld: pictures of the scene's back through shared memory, at 25 a
// second.
#pragma once

#include <atomic>
#include <string>
#include <thread>

#include "loopback/daemon/scene.h"

namespace heel::test {

class LiveCamera {
 public:
  /// Shows the first picture of the scene.
  explicit LiveCamera(const Scene& scene);
  ~LiveCamera();
  LiveCamera(const LiveCamera&) = delete;
  LiveCamera& operator=(const LiveCamera&) = delete;

  /// Of this camera, for the configuration.
  const std::string& address() const { return address_; }
  /// False: an empty picture, until true.
  void show_person(bool shown) { shown_ = shown; }

 private:
  void run(const std::string& picture);

  std::string name_;
  std::string address_;
  std::atomic<bool> shown_{true}, stop_{false};
  std::thread thread_;
};

}  // namespace heel::test
