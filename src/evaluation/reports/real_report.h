// Real pictures: DIR/real_pairs.csv and DIR/real_video.csv in words.
#pragma once

#include <string>

namespace heel::evaluation {

/// Markdown; says what was skipped where a file is absent.
std::string real_text(const std::string& directory);

}  // namespace heel::evaluation
