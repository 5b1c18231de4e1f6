// A recording as text files for pandas, PlotJuggler and numpy: ticks.csv, poses.csv, capture.csv, events.log.
#pragma once

#include <string>

#include "recording/recording_reader.h"

namespace heel {

/// Makes the folder, and replaces files of these names in it. Throws heel::Error.
RecordingReport export_csv(const std::string& recording, const std::string& folder);

}  // namespace heel
