// What `heel tune` has found, for people and for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/tuning/gain_tuner.h"
#include "evaluation/tuning/tuned_keys.h"
#include "evaluation/tuning/tuning_runs.h"

namespace heel::cli {

struct TuneReport {
  std::string law;
  std::vector<evaluation::TunedKey> keys;
  std::vector<double> before, after;  ///< values of the keys
  evaluation::TuningRuns searched;    ///< the runs that the values were sought with
  evaluation::TuningRuns aside;       ///< the same scenarios with other seeds: what judges
  evaluation::Judgement aside_before, aside_after;
  std::vector<evaluation::SearchStep> steps;
  bool interrupted = false;

  /// The values are worth a change: on the seeds kept aside the cost is smaller by kWorthIt.
  bool better() const;
};

inline constexpr double kWorthIt = 0.02;

/// Keys and figures, before and after, as tables.
std::string text_of(const TuneReport& report);

/// What the values were tuned on: lines of a comment.
std::vector<std::string> provenance_of(const TuneReport& report);

nlohmann::ordered_json to_json(const TuneReport& report);

}  // namespace heel::cli
