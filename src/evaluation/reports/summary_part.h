// A part of summary.md: tools/experiments-page copies it into the page of experiments, by its name.
#pragma once

#include <string>

namespace heel::evaluation {

struct SummaryPart {
  std::string name;     ///< "goals"
  std::string heading;  ///< "Goals of the design"
  std::string text;     ///< Markdown, with a line end at its end
};

}  // namespace heel::evaluation
