// What monitoring reads of heeld, in the text format of Prometheus.
#pragma once

#include <cstdint>
#include <string>

#include "operator/web/lateness_counts.h"
#include "telemetry/telemetry.h"

namespace heel {

struct MetricsInput {
  TelemetrySnapshot records;
  LatenessCounts::Values lateness;
  std::uint64_t missed_periods = 0;
  std::uint64_t viewers = 0;
  std::uint64_t pictures = 0;
  TimeNs now_ns = 0;
};

std::string metrics_text(const MetricsInput& input);

}  // namespace heel
