// A file that the program writes from beginning to end. Every failure is a heel::Error that names the file.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

namespace heel {

class OutputFile {
 public:
  /// Creates the file, or empties an existing one.
  explicit OutputFile(const std::string& path);

  void write(std::string_view bytes);
  /// As fmt::format.
  template <typename... Values>
  void print(fmt::format_string<Values...> format, Values&&... values) {
    write(fmt::format(format, std::forward<Values>(values)...));
  }
  /// Hands everything to the operating system. Call it at the end: a full disk is an error only here.
  void flush();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  [[noreturn]] void fail() const;

  std::string path_;
  std::unique_ptr<std::FILE, Close> file_;
};

}  // namespace heel
