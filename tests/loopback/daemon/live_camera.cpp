#include "loopback/daemon/live_camera.h"

#include <unistd.h>

#include "capture/shared_memory/sim_channel.h"
#include "files/image_file.h"
#include "realtime/clock.h"

namespace heel::test {

LiveCamera::LiveCamera(const Scene& scene)
    : name_("heel-test-" + std::to_string(getpid())), address_("sim:" + name_) {
  thread_ = std::thread([this, picture = scene.path("frame.png")] { run(picture); });
}

LiveCamera::~LiveCamera() {
  stop_ = true;
  thread_.join();
}

void LiveCamera::run(const std::string& picture) {
  const cv::Mat person = read_grey_image(picture).grey;
  const cv::Mat nobody(person.rows, person.cols, CV_8U, cv::Scalar(128));
  SimChannelWriter channel(name_, static_cast<std::uint32_t>(person.cols),
                           static_cast<std::uint32_t>(person.rows));
  PeriodicDeadline deadline(40 * kNsPerMs, monotonic_now_ns());
  for (std::uint64_t sequence = 0; !stop_; ++sequence) {
    sleep_until_ns(deadline.next_ns());
    deadline.advance(monotonic_now_ns());
    FrameView frame = frame_view_of(shown_ ? person : nobody);
    frame.header.sequence = sequence;
    frame.header.t_capture_ns = monotonic_now_ns();
    channel.push(frame);
  }
}

}  // namespace heel::test
