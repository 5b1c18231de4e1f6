#include "files/video_reader.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <thread>

#include "files/jpeg_decoder.h"
#include "files/one_field.h"
#include "files/orientation.h"
#include "files/video_file.h"

namespace heel {
namespace {

constexpr int kMaxDecoderThreads = 4;
constexpr double kUsualPeriod_s = 0.04;

std::string unconvertible_text(AVPixelFormat format) {
  const char* name = av_get_pix_fmt_name(format);
  return fmt::format("pixel format {}, which heel cannot convert", name == nullptr ? "unknown" : name);
}

void use_one_field(cv::Mat& picture) {
  keep_one_field(picture.data, static_cast<std::uint32_t>(picture.cols),
                 static_cast<std::uint32_t>(picture.rows), picture.step);
}

struct FreeScaler {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

}  // namespace

struct VideoReader::Decoder {
  VideoFile file;
  std::unique_ptr<AVCodecContext, FreeBy<avcodec_free_context>> codec;
  std::unique_ptr<AVFrame, FreeBy<av_frame_free>> frame{av_frame_alloc()};
  std::unique_ptr<SwsContext, FreeScaler> scaler;
  JpegDecoder jpeg;
  bool is_jpeg = false;        // Motion-JPEG, of which FFmpeg gives damaged frames without saying so
  cv::Mat bgr, stored, field;  // stored, field: of Motion-JPEG
  bool interlaced = false;     // of a frame so far, or as the header says: frames of some kinds cannot say so
  std::string problem;
  std::string unconvertible;  // why a frame that was decoded could not be given; empty: none

  std::uint64_t damaged = 0, given = 0;
  double t_first_s = 0.0, t_s = 0.0;  // t_s: from t_first_s
  double longest_period_s = 0.0;

  bool open_codec();
  bool next_frame();
  bool next_decoded_frame();
  bool next_jpeg_frame();
  bool decode_jpeg(const AVPacket& packet, std::uint32_t width_px, std::uint32_t height_px);
  void feed();
  void stamp(std::int64_t pts);
  bool convert(cv::Mat& grey);
  std::uint64_t missing_frames() const;
};

bool VideoReader::Decoder::open_codec() {
  const AVStream& stream = file.stream();
  const AVCodec* decoder = avcodec_find_decoder(stream.codecpar->codec_id);
  const char* name = avcodec_get_name(stream.codecpar->codec_id);
  if (decoder == nullptr) {
    problem = fmt::format("{} video, for which there is no decoder", name);
    return false;
  }
  problem = fmt::format("{} video that cannot be decoded", name);
  codec.reset(avcodec_alloc_context3(decoder));
  if (codec == nullptr || avcodec_parameters_to_context(codec.get(), stream.codecpar) < 0) return false;
  codec->pkt_timebase = stream.time_base;
  codec->thread_type = FF_THREAD_SLICE;  // with whole frames in parallel, damage is reported by chance
  codec->thread_count =
      std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMaxDecoderThreads);
  is_jpeg = codec->codec_id == AV_CODEC_ID_MJPEG;
  const AVFieldOrder order = stream.codecpar->field_order;
  interlaced = order != AV_FIELD_UNKNOWN && order != AV_FIELD_PROGRESSIVE;
  if (avcodec_open2(codec.get(), decoder, nullptr) < 0) return false;
  // Some streams name their format only with the first frame.
  if (is_jpeg || codec->pix_fmt == AV_PIX_FMT_NONE || sws_isSupportedInput(codec->pix_fmt) != 0) return true;
  problem = unconvertible_text(codec->pix_fmt);
  return false;
}

/// Decodes the next frame that is whole.
bool VideoReader::Decoder::next_frame() {
  return is_jpeg ? next_jpeg_frame() : next_decoded_frame();
}

bool VideoReader::Decoder::next_jpeg_frame() {
  while (const AVPacket* const packet = file.next_packet()) {
    const auto bytes = static_cast<std::size_t>(packet->size);
    std::uint32_t width_px = 0, height_px = 0;
    const bool has_size = jpeg.read_size(packet->data, bytes, width_px, height_px) &&
                          std::int64_t{width_px} * height_px <= std::int64_t{codec->width} * codec->height;
    if (has_size && decode_jpeg(*packet, width_px, height_px)) {
      stamp(packet->pts != AV_NOPTS_VALUE ? packet->pts : packet->dts);
      return true;
    }
    ++damaged;
  }
  return false;
}

/// Some capture cards write each field of a frame as a JPEG, both in one packet: the first is taken.
bool VideoReader::Decoder::decode_jpeg(const AVPacket& packet, std::uint32_t width_px,
                                       std::uint32_t height_px) {
  const auto bytes = static_cast<std::size_t>(packet.size);
  const auto frame_px = static_cast<std::uint32_t>(codec->height);
  const bool is_field = width_px == static_cast<std::uint32_t>(codec->width) &&
                        (height_px == frame_px / 2 || height_px == (frame_px + 1) / 2);
  cv::Mat& picture = is_field ? field : stored;
  picture.create(static_cast<int>(height_px), static_cast<int>(width_px), CV_8U);
  if (!jpeg.decode(packet.data, bytes, width_px, height_px, picture.data)) return false;
  if (!is_field) return true;
  interlaced = true;
  stored.create(codec->height, static_cast<int>(width_px), CV_8U);
  for (int y = 0; y < stored.rows; ++y) field.row(std::min(y / 2, field.rows - 1)).copyTo(stored.row(y));
  return true;
}

/// Gives the decoder the next packet of the video, or tells it that there is none.
void VideoReader::Decoder::feed() {
  const AVPacket* const packet = file.next_packet();
  if (avcodec_send_packet(codec.get(), packet) < 0 && packet != nullptr) ++damaged;
}

bool VideoReader::Decoder::next_decoded_frame() {
  for (;;) {
    const int got = avcodec_receive_frame(codec.get(), frame.get());
    if (got == AVERROR(EAGAIN) && !file.ended()) {
      feed();
      continue;
    }
    if (got == AVERROR_EOF || got == AVERROR(EAGAIN)) return false;
    if (got < 0 || frame->decode_error_flags != 0 || (frame->flags & AV_FRAME_FLAG_CORRUPT) != 0) {
      ++damaged;
      continue;
    }
    interlaced = interlaced || frame->interlaced_frame != 0;
    stamp(frame->best_effort_timestamp);
    return true;
  }
}

void VideoReader::Decoder::stamp(std::int64_t pts) {
  const double stated_s = pts != AV_NOPTS_VALUE ? file.seconds(pts) : 0.0;
  if (given++ == 0) {
    t_first_s = stated_s;
    t_s = 0.0;
    return;
  }
  // A stamp that is missing or goes back would stop a program that waits for it.
  const double last_s = t_s;
  const bool later = pts != AV_NOPTS_VALUE && stated_s - t_first_s > last_s;
  t_s =
      later ? stated_s - t_first_s : last_s + (file.rate_hz() > 0.0 ? 1.0 / file.rate_hz() : kUsualPeriod_s);
  longest_period_s = std::max(longest_period_s, t_s - last_s);
}

/// By BGR, so that grey values are those that OpenCV gives for this video.
bool VideoReader::Decoder::convert(cv::Mat& grey) {
  if (is_jpeg) {
    if (interlaced) use_one_field(stored);
    shown_picture(stored, file.orientation()).copyTo(grey);
    return true;
  }
  const auto format = static_cast<AVPixelFormat>(frame->format);
  scaler.reset(sws_getCachedContext(scaler.release(), frame->width, frame->height, format, frame->width,
                                    frame->height, AV_PIX_FMT_BGR24, SWS_BICUBIC, nullptr, nullptr, nullptr));
  if (scaler == nullptr) {
    unconvertible = unconvertible_text(format);
    return false;
  }
  bgr.create(frame->height, frame->width, CV_8UC3);
  std::uint8_t* const planes[4] = {bgr.data, nullptr, nullptr, nullptr};
  const int strides[4] = {static_cast<int>(bgr.step), 0, 0, 0};
  sws_scale(scaler.get(), frame->data, frame->linesize, 0, frame->height, planes, strides);
  const bool as_stored = file.orientation() == kAsStored;
  cv::Mat& picture = as_stored ? grey : stored;
  cv::cvtColor(bgr, picture, cv::COLOR_BGR2GRAY);
  if (interlaced) use_one_field(picture);
  if (!as_stored) grey = shown_picture(stored, file.orientation());
  return true;
}

std::uint64_t VideoReader::Decoder::missing_frames() const {
  if (file.length() == StatedLength::Complete) return 0;  // its last frame may be shown for seconds
  if (const std::uint64_t left = file.packets_left_in_index(); left > 0) return left;
  const double rate_hz = file.rate_hz();
  if (given == 0 || rate_hz <= 0.0) return 0;
  // Lengths in headers are rounded, and count from 0 or from the first frame.
  const double period_s = std::max({longest_period_s, file.longest_packet_s(), 1.0 / rate_hz});
  const double missing_s = file.end_s() - (t_s + std::max(t_first_s, 0.0) + period_s);
  return missing_s > 0.5 * period_s ? static_cast<std::uint64_t>(std::lround(missing_s * rate_hz)) : 0;
}

VideoReader::VideoReader() : decoder_(std::make_unique<Decoder>()) {}
VideoReader::~VideoReader() = default;

bool VideoReader::open(const std::string& path) {
  close();
  Decoder& d = *decoder_;
  const bool is_file = d.file.open(path);
  if (is_file && d.open_codec()) return true;
  std::string problem = is_file ? d.problem : d.file.problem();
  close();
  decoder_->problem = std::move(problem);
  return false;
}

bool VideoReader::is_open() const {
  return decoder_->codec != nullptr;
}

void VideoReader::close() {
  decoder_ = std::make_unique<Decoder>();
}

const std::string& VideoReader::problem() const {
  return decoder_->problem;
}

bool VideoReader::read(cv::Mat& grey) {
  return decoder_->next_frame() && decoder_->convert(grey);
}

std::string VideoReader::note() const {
  return decoder_->interlaced ? "interlaced: every second row is used" : "";
}

bool VideoReader::skip() {
  return decoder_->next_frame();
}

std::string VideoReader::missing() const {
  const Decoder& d = *decoder_;
  if (!d.unconvertible.empty()) return d.unconvertible;
  if (!is_open() || !d.file.ended()) return "";
  const std::uint64_t damaged = d.damaged + d.file.zero_packets() - d.file.zero_packets_at_end();
  if (const std::uint64_t zeros = d.file.zero_packets_at_end(); zeros > 0)
    return fmt::format("ends after {} of {} frames: the rest is zeros, as of a copy that was interrupted",
                       d.given, d.given + damaged + zeros + d.file.packets_left_in_index());
  if (const std::uint64_t frames = d.missing_frames(); frames > 0)
    return fmt::format("ends after {} of {} frames", d.given,
                       std::max(d.given + damaged + frames, d.file.avi_frame_count()));
  if (d.file.cut_in_a_packet()) return fmt::format("ends after {} frames, inside a frame", d.given);
  if (d.file.length() == StatedLength::Short)
    return fmt::format("ends after {} frames, before the end that it states", d.given);
  if (damaged > 0) return fmt::format("{} of {} frames are damaged and left out", damaged, d.given + damaged);
  return d.given > 0 ? "" : "no frame of it can be decoded";
}

double VideoReader::time_s() const {
  return decoder_->t_s;
}

double VideoReader::rate_hz() const {
  return is_open() ? decoder_->file.rate_hz() : 0.0;
}

std::uint64_t VideoReader::frame_count() const {
  return is_open() ? decoder_->file.frame_count() : 0;
}

cv::Size VideoReader::size_px() const {
  if (!is_open()) return {};
  const cv::Size stored(decoder_->codec->width, decoder_->codec->height);
  return decoder_->file.orientation() >= 5 ? cv::Size(stored.height, stored.width) : stored;
}

}  // namespace heel
