#include "evaluation/experiments/foreign_answers.h"

#include <algorithm>
#include <map>
#include <memory>

#include "core/angles.h"
#include "files/csv_file.h"
#include "files/image_file.h"
#include "heel/pose_tracker.h"

namespace heel::evaluation {
namespace {

constexpr int kDecimals = 9;  // so many that tables made of the file are those made of the numbers

PoseFunction begin_tracker(const ShirtTemplate& shirt, const CameraModel& camera, VisionConfig vision,
                           bool in_sequence) {
  vision.tracking = vision.tracking && in_sequence;
  const auto tracker = std::make_shared<PoseTracker>(shirt, camera, vision);
  return [tracker](const cv::Mat& grey, double t_s) {
    FrameView frame = frame_view_of(grey);
    frame.header.t_capture_ns = ns_from_seconds(t_s);
    return answer_of(tracker->estimate(frame));
  };
}

using Walks = std::map<ShirtName, std::vector<const ForeignPicture*>>;

Walks walks_of(const ForeignSet& set) {
  Walks walks;
  for (const ForeignPicture& picture : set.pictures)
    if (picture.is_in_walk()) walks[shirt_of(picture)].push_back(&picture);
  for (auto& [shirt, frames] : walks)
    std::sort(frames.begin(), frames.end(), [](const auto* a, const auto* b) { return a->t_s < b->t_s; });
  return walks;
}

/// The frames' times in truth.csv are rounded; they follow each other evenly.
double even_time_s(const std::vector<const ForeignPicture*>& frames, std::size_t i) {
  if (frames.size() < 2) return 0.0;
  const double lasts_s = frames.back()->t_s - frames.front()->t_s;
  return lasts_s * static_cast<double>(i) / static_cast<double>(frames.size() - 1);
}

}  // namespace

ForeignAnswer answer_of(const PoseEstimate& pose) {
  ForeignAnswer answer;
  answer.found = pose.found();
  answer.reason = to_string(pose.reason);
  answer.certainty = pose.certainty;
  answer.inliers = pose.inliers;
  answer.yaw_rad = pose.yaw_rad;
  answer.yaw_sigma_rad = pose.yaw_sigma_rad;
  answer.position_m = Eigen::Vector3d(pose.position_m.data());
  return answer;
}

ForeignMethod heel_method(const VisionConfig& vision) {
  return {"heel", [vision](const ShirtTemplate& shirt, const CameraModel& camera, bool in_sequence) {
            return begin_tracker(shirt, camera, vision, in_sequence);
          }};
}

std::vector<ForeignRow> answer_foreign_set(const ForeignSet& set, const ForeignTemplates& templates,
                                           const ForeignMethod& method,
                                           const std::function<void(std::size_t done)>& on_progress) {
  std::vector<ForeignRow> rows;
  const auto add = [&](const ForeignPicture& picture, const PoseFunction* estimate, double t_s) {
    ForeignAnswer answer{.reason = "no template"};
    if (estimate != nullptr) answer = (*estimate)(read_grey_image(picture.path).grey, t_s);
    rows.push_back({method.name, picture, std::move(answer)});
    if (on_progress) on_progress(rows.size());
  };
  std::map<ShirtName, PoseFunction> searches;
  for (const auto& [name, shirt] : templates.usable)
    searches.emplace(name, method.begin(shirt, set.camera, /*in_sequence=*/false));
  for (const ForeignPicture& picture : set.pictures) {
    if (picture.is_taught() || picture.is_in_walk()) continue;
    const auto search = searches.find(shirt_of(picture));
    add(picture, search == searches.end() ? nullptr : &search->second, 0.0);
  }
  for (const auto& [name, frames] : walks_of(set)) {
    const auto shirt = templates.usable.find(name);
    PoseFunction track;
    if (shirt != templates.usable.end())
      track = method.begin(shirt->second, set.camera, /*in_sequence=*/true);
    for (std::size_t i = 0; i < frames.size(); ++i)
      add(*frames[i], track ? &track : nullptr, even_time_s(frames, i));
  }
  return rows;
}

void write_foreign_rows(const std::vector<ForeignRow>& rows, const std::string& path) {
  CsvFile file(path,
               "method,image,kind,build,print,pose,room,t_s,distance_m,yaw_set_deg,yaw_back_deg,yaw_walk_deg,"
               "cloth_moved_mm,found,reason,certainty,inliers,yaw_deg,yaw_sigma_deg,distance_ratio,along_m,"
               "across_m");
  for (const auto& [method, picture, answer] : rows) {
    file.text(method).text(picture.image).text(picture.kind).text(picture.build).text(picture.print);
    file.text(picture.pose).text(picture.room);
    for (const double value : {picture.t_s, picture.distance_m, picture.yaw_set_deg, picture.yaw_back_deg,
                               picture.yaw_walk_deg, picture.cloth_moved_mm})
      file.number(value, kDecimals);
    file.text(answer.found ? "1" : "0").text(answer.reason).number(answer.certainty, kDecimals);
    file.count(answer.inliers);
    const auto of_found = [&file, found = answer.found](double value) {
      file.number(found ? value : kNoValue, kDecimals);
    };
    const Eigen::Vector3d ray = picture.centre_m.normalized(), off_m = answer.position_m - picture.centre_m;
    of_found(answer.yaw_rad * kDegPerRad);
    of_found(answer.yaw_sigma_rad * kDegPerRad);
    of_found(answer.position_m.norm() / picture.centre_m.norm());
    of_found(off_m.dot(ray));
    of_found((off_m - off_m.dot(ray) * ray).norm());
    file.end_row();
  }
  file.flush();
}

}  // namespace heel::evaluation
