#include "files/video_file.h"

extern "C" {
#include <libavutil/display.h>
}

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <span>
#include <string_view>
#include <utility>

#include "files/other_file_kind.h"

namespace heel {
namespace {

/// Whether `name` is one of the names of the demuxer, "mov,mp4,m4a".
bool is_format(const AVFormatContext& file, std::string_view name) {
  const std::string names = fmt::format(",{},", file.iformat->name);
  return names.find(fmt::format(",{},", name)) != std::string::npos;
}

double positive(AVRational ratio) {
  return ratio.num > 0 && ratio.den > 0 ? av_q2d(ratio) : 0.0;
}

/// Whether the file begins as MP4 and MOV files do.
bool begins_as_mp4(const std::string& path) {
  std::array<char, 8> head{};
  std::ifstream(path, std::ios::binary).read(head.data(), head.size());
  const std::string_view kind(head.data() + 4, 4);
  return kind == "ftyp" || kind == "mdat" || kind == "wide";
}

/// A frame that was never written. One that is not coded may be black.
bool is_zeros(const AVPacket& packet, AVCodecID codec) {
  return codec != AV_CODEC_ID_RAWVIDEO && packet.size > 0 &&
         std::all_of(packet.data, packet.data + packet.size, [](std::uint8_t byte) { return byte == 0; });
}

/// "00:00:02.000000000", as Matroska files state a stream's duration; 0 when it is not that.
double seconds_of_clock(const char* text) {
  int hours = 0, minutes = 0;
  double seconds = 0.0;
  if (std::sscanf(text, "%d:%d:%lf", &hours, &minutes, &seconds) != 3) return 0.0;
  return 3600.0 * hours + 60.0 * minutes + seconds;
}

}  // namespace

bool VideoFile::open(const std::string& path) {
  if (!open_file(path) || !open_stream()) return false;
  read_orientation();
  return orientation_ != 0 || fail("its display matrix turns it by no multiple of 90 degrees");
}

bool VideoFile::fail(std::string why) {
  problem_ = std::move(why);
  return false;
}

bool VideoFile::open_file(const std::string& path) {
  if (std::error_code none; !std::filesystem::is_regular_file(path, none)) return fail("no regular file");
  av_log_set_level(AV_LOG_QUIET);  // an error is one line of ours
  AVFormatContext* opened = nullptr;
  AVDictionary* options = nullptr;
  // A file and nothing else: without these FFmpeg would take a name for an address or a pattern, and a list
  // of other files for a video.
  av_dict_set(&options, "protocol_whitelist", "file", 0);
  const int error = avformat_open_input(&opened, ("file:" + path).c_str(), nullptr, &options);
  av_dict_free(&options);
  if (error < 0) {
    if (std::string other = other_file_kind_of(path); !other.empty()) return fail(std::move(other));
    return fail(begins_as_mp4(path) ? "its index is missing: cut short, or still being written"
                                    : "no video that FFmpeg knows");
  }
  file_.reset(opened);
  for (const char* not_a_video : {"tty", "image2", "concat", "hls", "dash", "ffmetadata", "srt"}) {
    if (is_format(*file_, not_a_video)) return fail("no video");
  }
  if (is_format(*file_, "matroska")) length_ = matroska_length(path);
  return true;
}

bool VideoFile::open_stream() {
  if (avformat_find_stream_info(file_.get(), nullptr) < 0) return fail("damaged at its beginning");
  const int index = av_find_best_stream(file_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  if (index < 0) return fail("no video in it");
  stream_ = file_->streams[index];
  if ((stream_->disposition & AV_DISPOSITION_ATTACHED_PIC) != 0) return fail("no video in it, only a cover");
  for (unsigned i = 0; i < file_->nb_streams; ++i) {
    if (file_->streams[i] != stream_) file_->streams[i]->discard = AVDISCARD_ALL;
  }
  return true;
}

void VideoFile::read_orientation() {
  const auto* matrix = reinterpret_cast<const std::int32_t*>(
      av_stream_get_side_data(stream_, AV_PKT_DATA_DISPLAYMATRIX, nullptr));
  if (matrix != nullptr)
    orientation_ = orientation_of_display_matrix(std::span<const std::int32_t, 9>(matrix, 9));
}

const AVPacket* VideoFile::next_packet() {
  while (!ended_) {
    av_packet_unref(packet_.get());
    const int error = av_read_frame(file_.get(), packet_.get());
    if (error < 0) {
      ended_ = true;
      cut_in_a_packet_ = cut_in_a_packet_ || error != AVERROR_EOF || bytes_follow_the_last_frame();
      break;
    }
    if (packet_->stream_index != stream_->index) continue;
    cut_in_a_packet_ = (packet_->flags & AV_PKT_FLAG_CORRUPT) != 0;
    if (cut_in_a_packet_) continue;
    ++packets_;
    if (is_format(*file_, "yuv4mpegpipe")) raw_frames_end_ = avio_tell(file_->pb);
    longest_packet_s_ = std::max(longest_packet_s_, seconds(packet_->duration));
    if (is_zeros(*packet_, stream_->codecpar->codec_id)) {
      ++zero_packets_;
      ++zero_packets_at_end_;
      continue;
    }
    zero_packets_at_end_ = 0;
    return packet_.get();
  }
  return nullptr;
}

/// FFmpeg drops a part of a frame at the end of a Y4M file without a word.
bool VideoFile::bytes_follow_the_last_frame() const {
  return raw_frames_end_ > 0 && avio_size(file_->pb) > raw_frames_end_;
}

double VideoFile::rate_hz() const {
  const double average = positive(stream_->avg_frame_rate);
  return average > 0.0 ? average : positive(stream_->r_frame_rate);
}

std::uint64_t VideoFile::frame_count() const {
  if (stream_->nb_frames > 0) return static_cast<std::uint64_t>(stream_->nb_frames);
  const double whole_s = file_->duration > 0 ? static_cast<double>(file_->duration) / AV_TIME_BASE : 0.0;
  return static_cast<std::uint64_t>(std::llround((end_s() > 0.0 ? end_s() : whole_s) * rate_hz()));
}

std::uint64_t VideoFile::packets_left_in_index() const {
  if (!is_format(*file_, "mp4")) return 0;
  const auto indexed = static_cast<std::uint64_t>(std::max(0, avformat_index_get_entries_count(stream_)));
  return indexed > packets_ ? indexed - packets_ : 0;
}

// A file with sound may go on after the video: its length counts for a video without sound only.
double VideoFile::end_s() const {
  if (file_->duration_estimation_method != AVFMT_DURATION_FROM_STREAM) return 0.0;
  // For a cut AVI file, FFmpeg makes the duration shorter, but not the number of frames.
  if (avi_frame_count() > 0 && rate_hz() > 0.0) return static_cast<double>(avi_frame_count()) / rate_hz();
  if (stream_->duration > 0) return seconds(stream_->duration);
  if (const auto* own = av_dict_get(stream_->metadata, "DURATION", nullptr, 0); own != nullptr)
    return seconds_of_clock(own->value);
  const bool alone = file_->nb_streams == 1 && file_->duration > 0;
  return alone ? static_cast<double>(file_->duration) / AV_TIME_BASE : 0.0;
}

std::uint64_t VideoFile::avi_frame_count() const {
  return is_format(*file_, "avi") ? static_cast<std::uint64_t>(std::max<std::int64_t>(stream_->nb_frames, 0))
                                  : 0;
}

}  // namespace heel
