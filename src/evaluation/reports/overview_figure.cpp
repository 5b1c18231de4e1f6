#include "evaluation/reports/overview_figure.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace heel::evaluation {
namespace {

constexpr int kBandWidth_px = 1510, kTitle_px = 46, kPictures_px = 220;

/// The row of the contact sheet nearest its middle.
cv::Mat middle_frames(const cv::Mat& sheet) {
  // Four frames of 4 : 3 fill a row, whatever the number of rows.
  const int rows = std::max(1, static_cast<int>(std::lround(16.0 / 3.0 * sheet.rows / sheet.cols)));
  const int height = sheet.rows / rows;
  const int top = height * (rows / 2);
  return sheet.rowRange(top, top + height);
}

void put(const cv::Mat& picture, cv::Mat& band, int x_px) {
  if (picture.empty()) return;
  const double scale = static_cast<double>(kPictures_px) / picture.rows;
  cv::Mat small;
  cv::resize(picture, small, {}, scale, scale, cv::INTER_AREA);
  const int width = std::min(small.cols, band.cols - x_px);
  if (width <= 0) return;
  const int height = std::min(small.rows, kPictures_px);
  small(cv::Rect(0, 0, width, height)).copyTo(band(cv::Rect(x_px, kTitle_px, width, height)));
}

cv::Mat band_of(const OverviewBand& in) {
  cv::Mat band(kTitle_px + (in.path.empty() ? 0 : kPictures_px) + 8, kBandWidth_px, CV_8UC3,
               cv::Scalar::all(255));
  const cv::Scalar ink = cv::Scalar::all(40);
  cv::putText(band, in.title, {8, 18}, cv::FONT_HERSHEY_SIMPLEX, 0.55, ink, 2, cv::LINE_AA);
  cv::putText(band, in.text, {8, 38}, cv::FONT_HERSHEY_SIMPLEX, 0.45, ink, 1, cv::LINE_AA);
  if (in.path.empty()) return band;
  put(in.path, band, 0);
  if (!in.frames.empty()) put(middle_frames(in.frames), band, in.path.cols * kPictures_px / in.path.rows + 4);
  return band;
}

}  // namespace

cv::Mat overview_figure(const std::vector<OverviewBand>& bands) {
  std::vector<cv::Mat> pictures;
  for (const OverviewBand& band : bands) pictures.push_back(band_of(band));
  cv::Mat all;
  if (!pictures.empty()) cv::vconcat(pictures, all);
  return all;
}

}  // namespace heel::evaluation
