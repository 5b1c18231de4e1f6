#include "vision/picture/picture_monitor.h"

#include <bit>
#include <cmath>
#include <numbers>

namespace heel {
namespace {

constexpr TimeNs kOff_ns = 500 * kNsPerMs;
constexpr TimeNs kLongestGap_ns = kNsPerS;

// A covered lens lets some light through; a dark room may have a lamp in it, but hardly any detail.
constexpr double kDarkMean = 16.0, kDarkDetail = 0.05;
constexpr double kBrightMean = 235.0, kBrightDarkest = 200.0;
constexpr double kLeastDetail = 0.015;
constexpr double kLargestBlur_px = 2.5;
constexpr double kLeastComb = 0.12;

constexpr double kLeastFlicker = 0.03;     // amplitude, of the brightness
constexpr double kLeastBandedShare = 0.6;  // of what differs between two pictures
constexpr int kFewestHalfBands = 3, kMostHalfBands = 24;
constexpr int kFlickeringOf16 = 8;
constexpr int kCombedOf32 = 6;
constexpr int kEdgesEvery = 3;

constexpr double kHuntingSwing = 0.18;  // logarithm of the brightness: 20 %
constexpr TimeNs kHuntingTime_ns = 4 * kNsPerS;

double log_grey(double grey) {
  return std::log(grey + 1.0);
}

}  // namespace

bool LastingCondition::update(bool raw, TimeNs t_ns) {
  if (!any_ || raw != raw_) t_change_ns_ = t_ns;
  any_ = true;
  raw_ = raw;
  if (t_ns - t_change_ns_ >= (raw ? on_ns_ : kOff_ns)) active_ = raw;
  return active_;
}

FlickerDetector::FlickerDetector() {
  for (int half_bands = kFewestHalfBands; half_bands <= kMostHalfBands; ++half_bands) {
    const double bands = 0.5 * half_bands;
    Bands sine{}, cosine{};
    for (std::size_t i = 0; i < sine.size(); ++i) {
      const double angle =
          2.0 * std::numbers::pi * bands * static_cast<double>(i) / static_cast<double>(sine.size());
      sine[i] = static_cast<float>(std::sin(angle));
      cosine[i] = static_cast<float>(std::cos(angle));
    }
    sines_.push_back(sine);
    sines_.push_back(cosine);
  }
}

/// The largest share of the variance of `difference` that one sine explains.
double FlickerDetector::banded_share(const Bands& difference) const {
  double power = 0.0;
  for (const float d : difference) power += d * d;
  if (power <= 0.0) return 0.0;
  double best = 0.0;
  for (std::size_t i = 0; i < sines_.size(); i += 2) {
    double sine = 0.0, cosine = 0.0;
    for (std::size_t k = 0; k < difference.size(); ++k) {
      sine += difference[k] * sines_[i][k];
      cosine += difference[k] * sines_[i + 1][k];
    }
    best = std::max(best, 2.0 * (sine * sine + cosine * cosine) / static_cast<double>(difference.size()));
  }
  return best / power;
}

bool FlickerDetector::update(const PictureBrightness& now) {
  std::array<Bands, 2> differences{};
  bool banded = any_;
  for (std::size_t half = 0; half < 2; ++half) {
    double mean = 0.0;
    for (std::size_t i = 0; i < PictureBrightness::kBands; ++i) {
      const float brightness = std::log(now.bands[half][i] + 1.f);
      differences[half][i] = brightness - before_[half][i];
      before_[half][i] = brightness;
      mean += differences[half][i] / static_cast<double>(PictureBrightness::kBands);
    }
    for (float& d : differences[half]) d -= static_cast<float>(mean);
  }
  any_ = true;
  if (!banded) return false;
  double product = 0.0, left = 0.0, right = 0.0;
  for (std::size_t i = 0; i < PictureBrightness::kBands; ++i) {
    product += differences[0][i] * differences[1][i];
    left += differences[0][i] * differences[0][i];
    right += differences[1][i] * differences[1][i];
  }
  const double least = kLeastFlicker * kLeastFlicker / 2.0 * static_cast<double>(PictureBrightness::kBands);
  constexpr double kLeastCorrelation = 0.8;
  if (left < least || right < least || product < kLeastCorrelation * std::sqrt(left * right)) return false;
  return banded_share(differences[0]) > kLeastBandedShare && banded_share(differences[1]) > kLeastBandedShare;
}

bool HuntingDetector::update(double mean, TimeNs t_ns) {
  const double brightness = log_grey(mean);
  if (!any_) extreme_ = brightness;
  any_ = true;
  const double change = brightness - extreme_;
  const int direction = change > 0.0 ? 1 : -1;
  if (direction == direction_) {
    extreme_ = brightness;  // goes on in its direction
  } else if (std::abs(change) > kHuntingSwing) {
    t_turns_ns_[turns_++ % kTurns] = t_ns;
    direction_ = direction;
    extreme_ = brightness;
  }
  return turns_ >= kTurns && t_ns - t_turns_ns_[turns_ % kTurns] < kHuntingTime_ns;
}

void PictureMonitor::reset() {
  for (LastingCondition* condition :
       {&dark_, &too_bright_, &no_detail_, &out_of_focus_, &flicker_, &interlaced_, &hunting_})
    condition->reset();
  flicker_detector_.reset();
  hunting_detector_.reset();
  flickering_ = combed_ = 0;
  pictures_to_edges_ = 0;
}

PictureFault PictureMonitor::update(const FrameView& frame) {
  const FrameHeader& header = frame.header;
  const TimeNs t_ns = header.t_capture_ns;
  const TimeNs gap_ns = t_ns - last_.t_capture_ns;
  if (gap_ns < 0 || gap_ns > kLongestGap_ns || header.width_px != last_.width_px ||
      header.height_px != last_.height_px)
    reset();
  last_ = header;

  const PictureBrightness now = picture_brightness(frame);
  if (pictures_to_edges_-- == 0) {
    pictures_to_edges_ = kEdgesEvery - 1;
    edges_ = picture_edges(frame);
    combed_ = combed_ << 1 | static_cast<std::uint32_t>(edges_.comb > kLeastComb);
  }
  const bool is_dark = now.mean < kDarkMean && edges_.detail < kDarkDetail;
  const bool is_too_bright = now.mean > kBrightMean && now.darkest > kBrightDarkest;
  flickering_ = flickering_ << 1 | static_cast<std::uint32_t>(flicker_detector_.update(now));

  // Each is updated with every picture; the first that lasts is named.
  struct Named {
    bool active;
    PictureFault fault;
  };
  const std::array<Named, 7> all = {{
      {dark_.update(is_dark, t_ns), PictureFault::Dark},
      {too_bright_.update(is_too_bright, t_ns), PictureFault::TooBright},
      {no_detail_.update(edges_.detail < kLeastDetail, t_ns), PictureFault::NoDetail},
      {out_of_focus_.update(edges_.edge_blur_px > kLargestBlur_px, t_ns), PictureFault::OutOfFocus},
      {interlaced_.update(std::popcount(combed_) >= kCombedOf32, t_ns), PictureFault::Interlaced},
      {flicker_.update(std::popcount(flickering_ & 0xffffu) >= kFlickeringOf16, t_ns), PictureFault::Flicker},
      {hunting_.update(hunting_detector_.update(now.mean, t_ns), t_ns), PictureFault::ExposureHunting},
  }};
  for (const Named& named : all)
    if (named.active) return named.fault;
  return PictureFault::None;
}

}  // namespace heel
