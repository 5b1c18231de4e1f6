#include "support/made_video.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libavutil/pixdesc.h>
}

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>

namespace heel::test {
namespace {

void require(bool done, const char* what) {
  if (!done) throw std::runtime_error(std::string("made video: ") + what);
}

class Writer {
 public:
  explicit Writer(const MadeVideo& video) : video_(video) {
    avformat_alloc_output_context2(&file_, nullptr, nullptr, video.path.c_str());
    require(file_ != nullptr, "no such container");
    open_codec();
    open_stream();
    AVDictionary* options = nullptr;
    if (video.index_first) av_dict_set(&options, "movflags", "faststart", 0);
    require(avio_open(&file_->pb, video.path.c_str(), AVIO_FLAG_WRITE) >= 0, "cannot open the file");
    require(avformat_write_header(file_, &options) >= 0, "no header");
    av_dict_free(&options);
  }
  ~Writer() {
    if (file_->pb != nullptr) avio_closep(&file_->pb);
    avcodec_free_context(&codec_);
    avformat_free_context(file_);
    av_frame_free(&frame_);
    av_packet_free(&packet_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;

  void write(const cv::Mat& grey, double t_s) {
    if (video_.jpeg_fields) return write_fields(grey, t_s);
    require(av_frame_make_writable(frame_) >= 0, "no frame");
    if (video_.raw_format != nullptr) {
      std::memset(frame_->buf[0]->data, 0, static_cast<std::size_t>(frame_->buf[0]->size));
    } else {
      fill(grey);
    }
    frame_->interlaced_frame = frame_->top_field_first = video_.interlaced ? 1 : 0;
    frame_->pts = std::lround(t_s * video_.ticks_per_s);
    require(avcodec_send_frame(codec_, frame_) >= 0, "the encoder takes no frame");
    write_packets();
  }
  void end() {
    avcodec_send_frame(codec_, nullptr);
    write_packets();
    require(av_write_trailer(file_) >= 0, "no trailer");
  }

 private:
  void fill(const cv::Mat& grey) {
    for (int y = 0; y < grey.rows; ++y)
      std::memcpy(frame_->data[0] + y * frame_->linesize[0], grey.ptr(y),
                  static_cast<std::size_t>(grey.cols));
    for (int plane : {1, 2})
      std::memset(frame_->data[plane], 128,
                  static_cast<std::size_t>(frame_->linesize[plane] * grey.rows / 2));
  }
  void open_codec() {
    const bool raw = video_.raw_format != nullptr;
    const AVCodec* encoder = avcodec_find_encoder(raw           ? AV_CODEC_ID_RAWVIDEO
                                                  : video_.jpeg ? AV_CODEC_ID_MJPEG
                                                                : AV_CODEC_ID_MPEG4);
    require(encoder != nullptr, "no encoder");
    codec_ = avcodec_alloc_context3(encoder);
    codec_->width = video_.greys.front().cols;
    codec_->height = video_.greys.front().rows;
    codec_->pix_fmt = raw           ? av_get_pix_fmt(video_.raw_format)
                      : video_.jpeg ? AV_PIX_FMT_YUVJ420P
                                    : AV_PIX_FMT_YUV420P;
    codec_->time_base = {1, video_.ticks_per_s};
    codec_->max_b_frames = video_.b_frames;
    codec_->gop_size = 10;
    codec_->flags |= AV_CODEC_FLAG_QSCALE;
    if (video_.interlaced) codec_->flags |= AV_CODEC_FLAG_INTERLACED_DCT;
    codec_->global_quality = 2 * FF_QP2LAMBDA;
    if ((file_->oformat->flags & AVFMT_GLOBALHEADER) != 0) codec_->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    require(avcodec_open2(codec_, encoder, nullptr) >= 0, "the encoder does not open");
    frame_->format = codec_->pix_fmt;
    frame_->width = codec_->width;
    frame_->height = codec_->height;
    frame_->quality = codec_->global_quality;
    require(av_frame_get_buffer(frame_, 0) >= 0, "no frame");
  }
  void open_stream() {
    stream_ = avformat_new_stream(file_, nullptr);
    avcodec_parameters_from_context(stream_->codecpar, codec_);
    stream_->time_base = codec_->time_base;
    if (video_.header_interlaced) stream_->codecpar->field_order = AV_FIELD_TT;
    if (video_.display_abcd.empty()) return;
    auto* matrix = reinterpret_cast<std::int32_t*>(
        av_stream_new_side_data(stream_, AV_PKT_DATA_DISPLAYMATRIX, 9 * sizeof(std::int32_t)));
    std::memset(matrix, 0, 9 * sizeof(std::int32_t));
    for (std::size_t i = 0; i < 4; ++i)
      matrix[i < 2 ? i : i + 1] = static_cast<std::int32_t>(video_.display_abcd[i] * 65536.0);
    matrix[8] = 1 << 30;
  }
  void write_fields(const cv::Mat& grey, double t_s) {
    std::vector<std::uint8_t> packet, field;
    for (const int first : {0, 1}) {
      cv::Mat rows;
      for (int y = first; y < grey.rows; y += 2) rows.push_back(grey.row(y));
      cv::imencode(".jpg", rows, field);
      packet.insert(packet.end(), field.begin(), field.end());
    }
    require(av_new_packet(packet_, static_cast<int>(packet.size())) >= 0, "no packet");
    std::copy(packet.begin(), packet.end(), packet_->data);
    packet_->pts = packet_->dts = std::lround(t_s * video_.ticks_per_s);
    packet_->flags |= AV_PKT_FLAG_KEY;
    write_packet();
  }
  void write_packets() {
    while (avcodec_receive_packet(codec_, packet_) == 0) write_packet();
  }
  void write_packet() {
    // Without this, MP4 files would not show the last frame.
    const std::size_t frames = video_.times_s.size();
    double shown_s = frames > 1 ? video_.times_s[frames - 1] - video_.times_s[frames - 2] : 0.1;
    if (video_.last_shown_s > 0.0) shown_s = video_.last_shown_s;
    packet_->duration = std::lround(shown_s * video_.ticks_per_s);
    av_packet_rescale_ts(packet_, codec_->time_base, stream_->time_base);
    packet_->stream_index = 0;
    require(av_interleaved_write_frame(file_, packet_) >= 0, "a packet is not written");
  }

  const MadeVideo& video_;
  AVFormatContext* file_ = nullptr;
  AVCodecContext* codec_ = nullptr;
  AVStream* stream_ = nullptr;
  AVFrame* frame_ = av_frame_alloc();
  AVPacket* packet_ = av_packet_alloc();
};

}  // namespace

void write_video(const MadeVideo& video) {
  av_log_set_level(AV_LOG_QUIET);
  Writer writer(video);
  for (std::size_t i = 0; i < video.greys.size(); ++i) writer.write(video.greys[i], video.times_s[i]);
  writer.end();
}

void cut_file(const std::string& path, double share) {
  const auto bytes = static_cast<double>(std::filesystem::file_size(path));
  std::filesystem::resize_file(path, static_cast<std::uintmax_t>(bytes * share));
}

}  // namespace heel::test
