#include "files/video_reader.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
#include <libswscale/swscale.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <opencv2/imgproc.hpp>
#include <string_view>
#include <thread>

#include "files/orientation.h"

namespace heel {
namespace {

constexpr int kMaxDecoderThreads = 4;

template <auto Free>
struct FreeBy {
  template <typename T>
  void operator()(T* object) const {
    Free(&object);
  }
};
struct FreeScaler {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

/// "video.mp4" of a demuxer named "mov,mp4,m4a": whether `name` is one of the names.
bool is_format(const AVFormatContext& file, std::string_view name) {
  const std::string names = fmt::format(",{},", file.iformat->name);
  return names.find(fmt::format(",{},", name)) != std::string::npos;
}

double positive(AVRational ratio) {
  return ratio.num > 0 && ratio.den > 0 ? av_q2d(ratio) : 0.0;
}

/// Whether the file begins as MP4 and MOV files do.
bool is_mp4(const std::string& path) {
  std::array<char, 8> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size());
  return std::string_view(head.data() + 4, 4) == "ftyp";
}

/// "00:00:02.000000000", as Matroska files state a stream's duration; 0 when it is not that.
double seconds_of_clock(const char* text) {
  int hours = 0, minutes = 0;
  double seconds = 0.0;
  if (std::sscanf(text, "%d:%d:%lf", &hours, &minutes, &seconds) != 3) return 0.0;
  return 3600.0 * hours + 60.0 * minutes + seconds;
}

}  // namespace

struct VideoReader::Decoder {
  std::unique_ptr<AVFormatContext, FreeBy<avformat_close_input>> file;
  std::unique_ptr<AVCodecContext, FreeBy<avcodec_free_context>> codec;
  std::unique_ptr<AVPacket, FreeBy<av_packet_free>> packet{av_packet_alloc()};
  std::unique_ptr<AVFrame, FreeBy<av_frame_free>> frame{av_frame_alloc()};
  std::unique_ptr<SwsContext, FreeScaler> scaler;
  AVStream* stream = nullptr;
  cv::Mat bgr;
  int orientation = kAsStored;
  std::string problem;

  bool draining = false;
  bool cut_in_a_frame = false;  // the file ends inside a frame, or cannot be read further
  std::uint64_t packets = 0, damaged = 0, given = 0;
  double t_first_s = 0.0, t_s = 0.0;  // t_s: from t_first_s
  double longest_period_s = 0.0;

  bool fail(std::string why) {
    problem = std::move(why);
    return false;
  }
  bool open_file(const std::string& path);
  bool open_stream();
  bool open_codec();
  void read_orientation();

  void feed();
  bool next_frame();
  void stamp();
  void convert(cv::Mat& grey);

  double rate_hz() const;
  double stated_end_s() const;
  std::uint64_t missing_frames() const;
};

bool VideoReader::Decoder::open_file(const std::string& path) {
  av_log_set_level(AV_LOG_QUIET);  // an error is one line of ours
  AVFormatContext* opened = nullptr;
  AVDictionary* options = nullptr;
  // A file and nothing else: without these FFmpeg would take a name for an address or a pattern, and a list
  // of other files for a video.
  av_dict_set(&options, "protocol_whitelist", "file", 0);
  const int error = avformat_open_input(&opened, ("file:" + path).c_str(), nullptr, &options);
  av_dict_free(&options);
  if (error < 0) {
    return fail(is_mp4(path) ? "its index is missing: cut short, or still being written"
                             : "no video that FFmpeg knows");
  }
  file.reset(opened);
  for (const char* not_a_video : {"tty", "image2", "concat", "hls", "dash", "ffmetadata", "srt"}) {
    if (is_format(*file, not_a_video)) return fail("no video");
  }
  return true;
}

bool VideoReader::Decoder::open_stream() {
  if (avformat_find_stream_info(file.get(), nullptr) < 0) return fail("damaged at its beginning");
  const int index = av_find_best_stream(file.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (index < 0) return fail("no video in it");
  stream = file->streams[index];
  if ((stream->disposition & AV_DISPOSITION_ATTACHED_PIC) != 0) return fail("no video in it, only a cover");
  for (unsigned i = 0; i < file->nb_streams; ++i) {
    if (file->streams[i] != stream) file->streams[i]->discard = AVDISCARD_ALL;
  }
  return true;
}

bool VideoReader::Decoder::open_codec() {
  const AVCodec* decoder = avcodec_find_decoder(stream->codecpar->codec_id);
  const char* name = avcodec_get_name(stream->codecpar->codec_id);
  if (decoder == nullptr) return fail(fmt::format("{} video, for which there is no decoder", name));
  codec.reset(avcodec_alloc_context3(decoder));
  if (codec == nullptr || avcodec_parameters_to_context(codec.get(), stream->codecpar) < 0)
    return fail("out of memory");
  codec->pkt_timebase = stream->time_base;
  codec->thread_count =
      std::clamp(static_cast<int>(std::thread::hardware_concurrency()), 1, kMaxDecoderThreads);
  if (avcodec_open2(codec.get(), decoder, nullptr) < 0)
    return fail(fmt::format("{} video that cannot be decoded", name));
  return true;
}

void VideoReader::Decoder::read_orientation() {
  const auto* matrix = reinterpret_cast<const std::int32_t*>(
      av_stream_get_side_data(stream, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
  if (matrix != nullptr)
    orientation = orientation_of_display_matrix(std::span<const std::int32_t, 9>(matrix, 9));
}

/// Gives the decoder the next packet of the video, or tells it that there is none.
void VideoReader::Decoder::feed() {
  for (;;) {
    const int error = av_read_frame(file.get(), packet.get());
    if (error < 0) {
      cut_in_a_frame = cut_in_a_frame || error != AVERROR_EOF;
      draining = true;
      avcodec_send_packet(codec.get(), nullptr);
      return;
    }
    if (packet->stream_index != stream->index) {
      av_packet_unref(packet.get());
      continue;
    }
    break;
  }
  const bool whole = (packet->flags & AV_PKT_FLAG_CORRUPT) == 0;
  const bool usable = whole && avcodec_send_packet(codec.get(), packet.get()) >= 0;
  if (whole) ++packets;
  if (whole && !usable) ++damaged;
  cut_in_a_frame = !whole;
  av_packet_unref(packet.get());
}

/// Decodes the next frame that is whole.
bool VideoReader::Decoder::next_frame() {
  for (;;) {
    const int got = avcodec_receive_frame(codec.get(), frame.get());
    if (got == AVERROR(EAGAIN) && !draining) {
      feed();
      continue;
    }
    if (got == AVERROR_EOF || got == AVERROR(EAGAIN)) return false;
    if (got < 0 || frame->decode_error_flags != 0 || (frame->flags & AV_FRAME_FLAG_CORRUPT) != 0) {
      ++damaged;
      continue;
    }
    stamp();
    ++given;
    return true;
  }
}

void VideoReader::Decoder::stamp() {
  const double usual_period_s = rate_hz() > 0.0 ? 1.0 / rate_hz() : 0.04;
  const std::int64_t pts = frame->best_effort_timestamp;
  const double stated_s = static_cast<double>(pts) * av_q2d(stream->time_base);
  if (given == 0) {
    t_first_s = pts == AV_NOPTS_VALUE ? 0.0 : stated_s;
    t_s = 0.0;
    return;
  }
  // A stamp that is missing or goes back would stop a program that waits for it.
  const double last_s = t_s;
  const bool later = pts != AV_NOPTS_VALUE && stated_s - t_first_s > last_s;
  t_s = later ? stated_s - t_first_s : last_s + usual_period_s;
  longest_period_s = std::max(longest_period_s, t_s - last_s);
}

/// By BGR, so that grey values are those that OpenCV gives for this video.
void VideoReader::Decoder::convert(cv::Mat& grey) {
  const auto format = static_cast<AVPixelFormat>(frame->format);
  scaler.reset(sws_getCachedContext(scaler.release(), frame->width, frame->height, format, frame->width,
                                    frame->height, AV_PIX_FMT_BGR24, SWS_BICUBIC, nullptr, nullptr, nullptr));
  bgr.create(frame->height, frame->width, CV_8UC3);
  std::uint8_t* const planes[4] = {bgr.data, nullptr, nullptr, nullptr};
  const int strides[4] = {static_cast<int>(bgr.step), 0, 0, 0};
  sws_scale(scaler.get(), frame->data, frame->linesize, 0, frame->height, planes, strides);
  if (orientation == kAsStored) {
    cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
    return;
  }
  cv::Mat stored;
  cv::cvtColor(bgr, stored, cv::COLOR_BGR2GRAY);
  grey = shown_picture(stored, orientation);
}

double VideoReader::Decoder::rate_hz() const {
  const double average = positive(stream->avg_frame_rate);
  return average > 0.0 ? average : positive(stream->r_frame_rate);
}

/// When the video ends by the file's header, from its first frame; 0 when the header does not say. A file
/// with sound may go on after the video, so that its length counts for videos without sound only.
double VideoReader::Decoder::stated_end_s() const {
  if (file->duration_estimation_method != AVFMT_DURATION_FROM_STREAM) return 0.0;
  // For a cut AVI file, FFmpeg makes the duration shorter, but not the number of frames.
  if (is_format(*file, "avi") && rate_hz() > 0.0) return static_cast<double>(stream->nb_frames) / rate_hz();
  if (stream->duration > 0) return static_cast<double>(stream->duration) * av_q2d(stream->time_base);
  if (const auto* own = av_dict_get(stream->metadata, "DURATION", nullptr, 0); own != nullptr)
    return seconds_of_clock(own->value);
  const bool alone = file->nb_streams == 1 && file->duration > 0;
  return alone ? static_cast<double>(file->duration) / AV_TIME_BASE : 0.0;
}

std::uint64_t VideoReader::Decoder::missing_frames() const {
  if (is_format(*file, "mp4")) {
    const auto indexed = static_cast<std::uint64_t>(std::max(0, avformat_index_get_entries_count(stream)));
    if (indexed > packets) return indexed - packets;
  }
  if (given == 0 || rate_hz() <= 0.0) return 0;
  // Lengths in headers are rounded, and count from 0 or from the first frame.
  const double period_s = std::max(longest_period_s, 1.0 / rate_hz());
  const double missing_s = stated_end_s() - (t_s + std::max(t_first_s, 0.0) + period_s);
  return missing_s > 0.5 * period_s ? static_cast<std::uint64_t>(std::lround(missing_s * rate_hz())) : 0;
}

VideoReader::VideoReader() : decoder_(std::make_unique<Decoder>()) {}
VideoReader::~VideoReader() = default;

bool VideoReader::open(const std::string& path) {
  close();
  Decoder& d = *decoder_;
  if (d.open_file(path) && d.open_stream() && d.open_codec()) {
    d.read_orientation();
    if (d.orientation != 0) return true;
    d.fail("its display matrix turns it by no multiple of 90 degrees");
  }
  std::string problem = std::move(d.problem);
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
  if (!decoder_->next_frame()) return false;
  decoder_->convert(grey);
  return true;
}

bool VideoReader::skip() {
  return decoder_->next_frame();
}

std::string VideoReader::missing() const {
  const Decoder& d = *decoder_;
  if (!is_open() || !d.draining) return "";
  if (const std::uint64_t frames = d.missing_frames(); frames > 0)
    return fmt::format("ends after {} of {} frames", d.given, d.given + d.damaged + frames);
  if (d.cut_in_a_frame) return fmt::format("ends after {} frames, inside a frame", d.given);
  if (d.damaged > 0)
    return fmt::format("{} of {} frames are damaged and left out", d.damaged, d.given + d.damaged);
  return "";
}

double VideoReader::time_s() const {
  return decoder_->t_s;
}

double VideoReader::rate_hz() const {
  return is_open() ? decoder_->rate_hz() : 0.0;
}

std::uint64_t VideoReader::frame_count() const {
  if (!is_open()) return 0;
  const Decoder& d = *decoder_;
  if (d.stream->nb_frames > 0) return static_cast<std::uint64_t>(d.stream->nb_frames);
  const double length_s = d.file->duration > 0 ? static_cast<double>(d.file->duration) / AV_TIME_BASE : 0.0;
  return static_cast<std::uint64_t>(std::llround(length_s * d.rate_hz()));
}

cv::Size VideoReader::size_px() const {
  if (!is_open()) return {};
  const cv::Size stored(decoder_->codec->width, decoder_->codec->height);
  return decoder_->orientation >= 5 ? cv::Size(stored.height, stored.width) : stored;
}

}  // namespace heel
