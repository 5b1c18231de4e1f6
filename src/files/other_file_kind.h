// Files that stand in a picture's or video's place: what remains of a download that failed, a pointer to
// data that were not fetched, recordings of other programs.
#pragma once

#include <string>

#include "files/byte_view.h"

namespace heel {

/// What the file is, and what to do, "a Git LFS pointer, not the file itself (git lfs pull fetches it)", by
/// its first 64 bytes; empty when it is none of these.
std::string other_file_kind(ByteView head);
/// The same of the file at `path`; empty also when it cannot be read.
std::string other_file_kind_of(const std::string& path);

}  // namespace heel
