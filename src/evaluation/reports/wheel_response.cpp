#include "evaluation/reports/wheel_response.h"

#include <algorithm>
#include <cmath>

#include "files/csv_table.h"
#include "heel/error.h"

namespace heel::evaluation {

WheelResponse::WheelResponse(const std::string& truth_csv) {
  const CsvTable table(truth_csv);
  if (!table.has("t_monotonic_s") || !table.has("wheel_left_m_s"))
    throw Error(truth_csv +
                ": no columns t_monotonic_s and wheel_left_m_s (expected what heel-sim --truth writes)");
  samples_.reserve(table.rows());
  for (std::size_t row = 0; row < table.rows(); ++row)
    samples_.push_back({static_cast<TimeNs>(std::llround(1e9 * table.number(row, "t_monotonic_s"))),
                        0.5 * (table.number(row, "wheel_left_m_s") + table.number(row, "wheel_right_m_s"))});
}

std::optional<TimeNs> WheelResponse::half_way_ns(TimeNs t_written_ns, double from_m_s, double to_m_s) const {
  if (!(std::abs(to_m_s - from_m_s) >= kLeastChange_m_s)) return std::nullopt;
  const double half_m_s = 0.5 * (from_m_s + to_m_s);
  // Positive until the wheels get there.
  const auto left_m_s = [&](const Sample& sample) {
    return to_m_s > from_m_s ? half_m_s - sample.v_m_s : sample.v_m_s - half_m_s;
  };
  auto after = std::upper_bound(samples_.begin(), samples_.end(), t_written_ns,
                                [](TimeNs t_ns, const Sample& sample) { return t_ns < sample.t_ns; });
  if (after == samples_.begin() || !(left_m_s(*(after - 1)) > 0.0)) return std::nullopt;
  for (; after != samples_.end() && after->t_ns - t_written_ns <= kLongest_ns; ++after) {
    const double left = left_m_s(*after), before = left_m_s(*(after - 1));
    if (left > 0.0) continue;
    const double share = before / (before - left);
    const TimeNs t_ns =
        (after - 1)->t_ns +
        static_cast<TimeNs>(std::llround(share * static_cast<double>(after->t_ns - (after - 1)->t_ns)));
    return std::max(t_ns, t_written_ns);
  }
  return std::nullopt;
}

}  // namespace heel::evaluation
