#include "loopback/daemon/scene.h"

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "files/camera_info.h"
#include "files/template_file.h"
#include "heel/shirt_template.h"
#include "support/sanitized.h"

namespace heel::test {
namespace {

namespace fs = std::filesystem;

constexpr int kWidth_px = 640, kHeight_px = 480;
constexpr double kFocal_px = 600.0;
constexpr double kTemplateDistance_m = 2.0;
const cv::Rect kBack(220, 120, 200, 240);  // in the reference view, about its centre

/// Spots of many sizes on grey: features at every scale.
cv::Mat reference_view() {
  cv::Mat view(kHeight_px, kWidth_px, CV_8U, cv::Scalar(128));
  cv::RNG random(42);
  for (int i = 0; i < 260; ++i) {
    const cv::Point centre(random.uniform(kBack.x, kBack.x + kBack.width),
                           random.uniform(kBack.y, kBack.y + kBack.height));
    cv::circle(view, centre, random.uniform(3, 13), cv::Scalar(random.uniform(0, 255)), cv::FILLED,
               cv::LINE_AA);
  }
  cv::GaussianBlur(view, view, {}, 1.2);
  return view;
}

/// The same back farther away: the plane z = d, seen from a camera moved back along z.
cv::Mat seen_from(const cv::Mat& reference, double distance_m) {
  const double s = kTemplateDistance_m / distance_m;
  const double cx = (kWidth_px - 1) / 2.0, cy = (kHeight_px - 1) / 2.0;
  const cv::Mat H = (cv::Mat_<double>(2, 3) << s, 0, cx - s * cx, 0, s, cy - s * cy);
  cv::Mat view;
  cv::warpAffine(reference, view, H, reference.size(), cv::INTER_AREA, cv::BORDER_CONSTANT, cv::Scalar(128));
  return view;
}

}  // namespace

Scene::Scene(int frames, double distance_m) {
  write_pictures(frames, distance_m);
  CameraModel camera;
  camera.width_px = kWidth_px;
  camera.height_px = kHeight_px;
  camera.fx = camera.fy = kFocal_px;
  camera.cx = (kWidth_px - 1) / 2.0;
  camera.cy = (kHeight_px - 1) / 2.0;
  write_camera_model(camera, path("camera.yaml"));

  ShirtTemplate shirt;
  const cv::Mat view = reference_view();
  shirt.grey.assign(view.datastart, view.dataend);
  shirt.camera = camera;
  shirt.roi = {kBack.x, kBack.y, kBack.width, kBack.height};
  shirt.distance_m = kTemplateDistance_m;
  write_template(shirt, path("shirt.heel"));
}

void Scene::write_pictures(int frames, double distance_m) const {
  fs::create_directory(path("frames"));
  const std::string first = path("frame.png");
  cv::imwrite(first, seen_from(reference_view(), distance_m));
  for (int i = 0; i < frames; ++i) fs::create_symlink(first, path("frames/" + std::to_string(i) + ".png"));
}

// Under sanitizers vision is ten times slower: frames come more slowly then, and count as fresh for longer.
constexpr const char* kRate = kSanitized ? "rate_hz = 5\n" : "rate_hz = 25\n";
constexpr const char* kTimeouts = kSanitized ? "frame_timeout_s = 3\ntarget_timeout_s = 3\n" : "";

std::string Scene::write_config(const MoreConfig& more) const {
  // Every key that is not named here has its default.
  return write_text(path("heel.toml"),
                    "[camera]\nsource = \"file:frames\"\ninfo = \"camera.yaml\"\n" + std::string(kRate) +
                        more.camera + "[supervisor]\nstart = \"" + more.start + "\"\n" + kTimeouts +
                        "[target]\nshirt = \"shirt.heel\"\n"
                        "[robot]\naddress = \"pty:robot\"\nsync_retry_s = 0.2\nreconnect_s = 0.2\n" +
                        more.robot +
                        "[operator]\nsocket = \"control.sock\"\n"
                        "[runtime]\nrealtime = false\n" +
                        more.runtime + more.sections);
}

namespace {

Truth row_of(const std::string& header, const std::string& row) {
  std::istringstream names(header), values(row);
  Truth truth;
  for (std::string name, value; std::getline(names, name, ',') && std::getline(values, value, ',');) {
    if (name == "t_s") truth.t_s = std::stod(value);
    if (name == "robot_v_m_s") truth.v_m_s = std::stod(value);
  }
  return truth;
}

}  // namespace

std::vector<Truth> all_truth(const std::string& csv_path) {
  std::istringstream rows(read_text(csv_path));
  std::string header, row;
  std::getline(rows, header);
  std::vector<Truth> truth;
  // The last line may be incomplete: a complete line ends with a newline.
  while (std::getline(rows, row) && !rows.eof()) truth.push_back(row_of(header, row));
  return truth;
}

Truth newest_truth(const std::string& csv_path) {
  constexpr std::streamoff kTail_bytes = 2000;  // several rows
  std::ifstream file(csv_path, std::ios::binary);
  std::string header, row, last;
  std::getline(file, header);
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  if (size > kTail_bytes) {
    file.seekg(size - kTail_bytes);
    std::getline(file, row);  // the first row is incomplete
  } else {
    file.seekg(static_cast<std::streamoff>(header.size()) + 1);
  }
  while (std::getline(file, row) && !file.eof()) last = row;
  return row_of(header, last);
}

double last_received_s(const std::string& wire_path) {
  std::istringstream lines(read_text(wire_path));
  double t_s = 0.0;
  for (std::string line; std::getline(lines, line) && !lines.eof();) t_s = std::stod(line);
  return t_s;
}

double event_time_s(const std::string& log, const std::string& event) {
  const std::size_t at = log.find(event);
  if (at == std::string::npos) throw std::runtime_error("no '" + event + "' in " + log);
  return std::stod(log.substr(log.rfind('\n', at) + 1));  // npos + 1 is the first line's start
}

}  // namespace heel::test
