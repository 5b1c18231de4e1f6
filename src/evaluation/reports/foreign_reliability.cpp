#include "evaluation/reports/foreign_reliability.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angles.h"
#include "files/csv_file.h"

namespace heel::evaluation {
namespace {

constexpr std::array kCertaintyBounds{0.0, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 1.01};
constexpr std::size_t kSigmaBins = 6, kFewestInBin = 5;
constexpr int kDecimals = 4;

struct NamedPoses {
  const char* set;
  std::vector<StatedPose> poses;
};

}  // namespace

std::vector<StatedPose> stated_poses(const ForeignSamples& samples) {
  std::vector<StatedPose> poses;
  for (const ForeignSample* s : samples)
    if (s->found) poses.push_back({s->certainty, s->error_deg(), s->yaw_sigma_deg, !s->is_wrong()});
  return poses;
}

std::vector<StatedPose> stated_poses(const std::vector<StillSample>& samples) {
  std::vector<StatedPose> poses;
  for (const StillSample& s : samples)
    if (s.found)
      poses.push_back(
          {s.certainty, kDegPerRad * s.yaw_error_rad(), kDegPerRad * s.yaw_sigma_rad, !s.wrong()});
  return poses;
}

std::vector<CertaintyBin> certainty_bins(const std::vector<StatedPose>& poses) {
  std::vector<CertaintyBin> bins;
  for (std::size_t i = 0; i + 1 < kCertaintyBounds.size(); ++i) {
    CertaintyBin bin{.from = kCertaintyBounds[i], .to = kCertaintyBounds[i + 1]};
    for (const StatedPose& pose : poses) {
      if (pose.certainty < bin.from || pose.certainty >= bin.to) continue;
      ++bin.found;
      bin.right += pose.right;
      bin.mean += pose.certainty;
    }
    if (bin.found == 0) continue;
    bin.mean /= static_cast<double>(bin.found);
    bins.push_back(bin);
  }
  return bins;
}

std::vector<SigmaBin> sigma_bins(std::vector<StatedPose> poses) {
  std::stable_sort(poses.begin(), poses.end(),
                   [](const auto& a, const auto& b) { return a.yaw_sigma_deg < b.yaw_sigma_deg; });
  const std::size_t count = std::min(kSigmaBins, poses.size() / kFewestInBin);
  std::vector<SigmaBin> bins;
  for (std::size_t bin = 0; bin < count; ++bin) {
    const std::size_t from = poses.size() * bin / count, to = poses.size() * (bin + 1) / count;
    double sigmas = 0.0, errors = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      sigmas += poses[i].yaw_sigma_deg * poses[i].yaw_sigma_deg;
      errors += poses[i].yaw_error_deg * poses[i].yaw_error_deg;
    }
    const auto n = static_cast<double>(to - from);
    bins.push_back({to - from, std::sqrt(sigmas / n), std::sqrt(errors / n)});
  }
  return bins;
}

void write_reliability(const std::vector<ForeignSample>& foreign, const std::vector<StillSample>& own,
                       const std::string& directory) {
  const std::vector<NamedPoses> sets = {
      {"stills", stated_poses(chosen(foreign, [](const auto& s) { return s.is_person(); }))},
      {"walk", stated_poses(chosen(foreign, [](const auto& s) { return s.kind == "walk"; }))},
      {"own world", stated_poses(own)}};
  CsvFile certainty(directory + "/foreign_certainty.csv", "set,from,to,mean,found,right");
  CsvFile sigma(directory + "/foreign_sigma.csv", "set,found,sigma_deg,error_deg");
  for (const NamedPoses& set : sets) {
    for (const CertaintyBin& bin : certainty_bins(set.poses)) {
      certainty.text(set.set).number(bin.from, 2).number(bin.to, 2).number(bin.mean, kDecimals);
      certainty.count(bin.found).count(bin.right).end_row();
    }
    for (const SigmaBin& bin : sigma_bins(set.poses)) {
      sigma.text(set.set).count(bin.found).number(bin.sigma_deg, kDecimals).number(bin.error_deg, kDecimals);
      sigma.end_row();
    }
  }
  certainty.flush();
  sigma.flush();
}

}  // namespace heel::evaluation
