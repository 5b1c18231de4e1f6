// The newest recording of a folder as CSV files.
#pragma once

#include <string>

#include "recording/csv_export.h"

namespace heel::test {

/// Writes ticks.csv, poses.csv, capture.csv and events.log beside the recording. Returns the folder.
inline std::string exported(const std::string& folder) {
  export_csv(recording_in(folder), folder);
  return folder;
}

}  // namespace heel::test
