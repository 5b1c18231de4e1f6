#include "files/output_file.h"

#include <cerrno>
#include <cstring>

#include "heel/error.h"

namespace heel {

OutputFile::OutputFile(const std::string& path) : path_(path), file_(std::fopen(path.c_str(), "wb")) {
  if (!file_) fail();
}

void OutputFile::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size()) fail();
}

void OutputFile::flush() {
  if (std::fflush(file_.get()) != 0) fail();
}

void OutputFile::fail() const {
  throw Error(fmt::format("{}: cannot write: {} (expected a folder and a disk that can be written)", path_,
                          std::strerror(errno)));
}

}  // namespace heel
