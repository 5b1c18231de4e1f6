// Command lines that are printed to be copied.
#pragma once

#include <string>

namespace heel::cli {

/// The text as one word of a POSIX shell: in single quotes where it has spaces or other characters that a
/// shell would not leave as they are.
std::string shell_word(const std::string& text);

}  // namespace heel::cli
