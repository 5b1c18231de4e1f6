// Text by printf's rules.
#pragma once

#include <cstdarg>
#include <cstdio>
#include <string>

namespace heel::evaluation {

/// One line of at most 255 characters.
__attribute__((format(printf, 1, 2))) inline std::string printed(const char* format, ...) {
  char text[256];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  return text;
}

}  // namespace heel::evaluation
