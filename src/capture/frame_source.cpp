#include "capture/frame_source.h"

namespace heel {

const char* to_string(FrameResult result) {
  switch (result) {
    case FrameResult::Frame:
      return "frame";
    case FrameResult::Timeout:
      return "timeout";
    case FrameResult::Error:
      return "unusable frame";
    case FrameResult::EndOfStream:
      return "end of stream";
    case FrameResult::Lost:
      return "lost";
  }
  return "?";
}

}  // namespace heel
