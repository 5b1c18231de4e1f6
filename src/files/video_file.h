// The video in a file: its packets as the file has them, and what its header states.
#pragma once

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

#include <cstdint>
#include <memory>
#include <string>

#include "files/matroska_length.h"
#include "files/orientation.h"

namespace heel {

/// Frees an object of FFmpeg's libraries by a function that takes its address.
template <auto Free>
struct FreeBy {
  template <typename T>
  void operator()(T* object) const {
    Free(&object);
  }
};

class VideoFile {
 public:
  /// False: problem() says why.
  bool open(const std::string& path);
  const std::string& problem() const { return problem_; }

  AVStream& stream() const { return *stream_; }
  /// The video's next packet, valid until the next call; null at the end. A packet that the end of the file
  /// cuts is left out.
  const AVPacket* next_packet();
  bool ended() const { return ended_; }
  /// At the end: whether the file ends inside a packet, or cannot be read further.
  bool cut_in_a_packet() const { return cut_in_a_packet_; }
  std::uint64_t packets() const { return packets_; }
  /// Of them, those of zeros, which are not given; and how many of these stand behind all others.
  std::uint64_t zero_packets() const { return zero_packets_; }
  std::uint64_t zero_packets_at_end() const { return zero_packets_at_end_; }
  /// The longest time that one of the packets read is shown, as the file says.
  double longest_packet_s() const { return longest_packet_s_; }

  /// 0: the display matrix means none of the eight.
  int orientation() const { return orientation_; }
  double seconds(std::int64_t stamp) const { return static_cast<double>(stamp) * av_q2d(stream_->time_base); }
  /// As the header states them; 0 when it does not.
  double rate_hz() const;
  std::uint64_t frame_count() const;
  /// How many packets the file's own index has beyond those read; 0 when it has none.
  std::uint64_t packets_left_in_index() const;
  /// When the video ends, counted from time 0 or from its first frame; 0 when the header does not say.
  double end_s() const;
  /// Of Matroska and WebM files; of others it is unknown.
  StatedLength length() const { return length_; }
  /// The number of frames of an AVI file, whose time stamps need not begin with 0; else 0.
  std::uint64_t avi_frame_count() const;

 private:
  bool fail(std::string why);
  bool open_file(const std::string& path);
  bool open_stream();
  void read_orientation();
  bool bytes_follow_the_last_frame() const;

  std::unique_ptr<AVFormatContext, FreeBy<avformat_close_input>> file_;
  std::unique_ptr<AVPacket, FreeBy<av_packet_free>> packet_{av_packet_alloc()};
  AVStream* stream_ = nullptr;
  int orientation_ = kAsStored;
  StatedLength length_ = StatedLength::Unknown;
  std::string problem_;
  bool ended_ = false;
  bool cut_in_a_packet_ = false;
  std::uint64_t packets_ = 0, zero_packets_ = 0, zero_packets_at_end_ = 0;
  double longest_packet_s_ = 0.0;
  std::int64_t raw_frames_end_ = 0;  // of a Y4M file, in bytes; 0: of another one, or no frame yet
};

}  // namespace heel
