// Writing a file so that readers find either the whole old file or the whole new one, also after a power cut.
#pragma once

#include <string>
#include <string_view>

namespace heel {

/// Writes `bytes` beside `path`, syncs, and renames over `path`. Permissions and group of a file that was
/// there stay. Throws heel::Error naming the file; then nothing has changed and no temporary file is left.
void write_file_atomically(const std::string& path, std::string_view bytes);

/// Throws heel::Error naming the file when it is no regular file: to open a pipe would wait for its writer.
void require_regular_file(const std::string& path);

/// The whole of a regular file. Throws heel::Error naming the file, or when it is larger than `max_bytes`.
std::string read_whole_file(const std::string& path, std::size_t max_bytes);

}  // namespace heel
