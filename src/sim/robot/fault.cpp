#include "sim/robot/fault.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "heel/error.h"

namespace heel::sim {
namespace {

struct FaultName {
  FaultKind kind;
  const char* name;
};

constexpr std::array kFaultNames{
    FaultName{FaultKind::DropBytes, "drop"},
    FaultName{FaultKind::GarbleBytes, "garble"},
    FaultName{FaultKind::DelayBytes, "delay"},
    FaultName{FaultKind::Silence, "silence"},
    FaultName{FaultKind::Reset, "reset"},
    FaultName{FaultKind::Bumper, "bumper"},
    FaultName{FaultKind::StopButton, "stop_button"},
    FaultName{FaultKind::Stall, "stall"},
    FaultName{FaultKind::BadConfig, "bad_config"},
    FaultName{FaultKind::BootBaud, "boot_baud"},
    FaultName{FaultKind::LeftOpen, "left_open"},
};

constexpr TimeNs kNever_ns = std::numeric_limits<TimeNs>::max();

TimeNs end_of(const Fault& fault) {
  return fault.duration_ns > 0 ? fault.t_ns + fault.duration_ns : kNever_ns;
}

void add_effect(const Fault& fault, FaultEffects& effects) {
  switch (fault.kind) {
    case FaultKind::DropBytes:
      effects.drop_share = std::max(effects.drop_share, fault.amount);
      break;
    case FaultKind::GarbleBytes:
      effects.garble_share = std::max(effects.garble_share, fault.amount);
      break;
    case FaultKind::DelayBytes:
      effects.delay_ns = std::max(effects.delay_ns, ns_from_seconds(fault.amount));
      break;
    case FaultKind::Silence:
      effects.silence = true;
      break;
    case FaultKind::Bumper: {
      const auto mask = static_cast<unsigned>(fault.amount);
      effects.bumpers_front = static_cast<std::uint8_t>(effects.bumpers_front | (mask & 0x7F));
      effects.bumpers_rear = static_cast<std::uint8_t>(effects.bumpers_rear | ((mask >> 8) & 0x7F));
      break;
    }
    case FaultKind::StopButton:
      effects.stop_button = true;
      break;
    case FaultKind::Stall:
      effects.blocked_left = effects.blocked_left || fault.amount != 2.0;
      effects.blocked_right = effects.blocked_right || fault.amount != 1.0;
      break;
    case FaultKind::BadConfig:
      effects.bad_config = true;
      break;
    case FaultKind::Reset:
    case FaultKind::BootBaud:
    case FaultKind::LeftOpen:
      break;  // applied once, when they begin
  }
}

double number_of(const std::string& text, const std::string& fault, const char* what) {
  try {
    std::size_t used = 0;
    const double value = std::stod(text, &used);
    if (used == text.size() && std::isfinite(value) && value >= 0.0) return value;
  } catch (const std::exception&) {
  }
  throw Error(fmt::format("fault '{}': {} '{}' is not a number of 0 or more", fault, what, text));
}

FaultKind kind_of(const std::string& name, const std::string& fault) {
  if (const std::optional<FaultKind> kind = fault_kind_from_name(name)) return *kind;
  throw Error(
      fmt::format("fault '{}': '{}' is not a fault (expected one of {})", fault, name, fault_names()));
}

/// Takes "[+DURATION][=AMOUNT]" from the end of `times`.
void take_duration_and_amount(std::string& times, const std::string& text, Fault& fault) {
  if (const std::size_t equals = times.find('='); equals != std::string::npos) {
    fault.amount = number_of(times.substr(equals + 1), text, "amount");
    times.resize(equals);
  }
  if (const std::size_t plus = times.find('+'); plus != std::string::npos) {
    fault.duration_ns = ns_from_seconds(number_of(times.substr(plus + 1), text, "duration"));
    times.resize(plus);
  }
}

}  // namespace

const char* to_string(FaultKind kind) {
  for (const FaultName& entry : kFaultNames) {
    if (entry.kind == kind) return entry.name;
  }
  return "?";
}

std::optional<FaultKind> fault_kind_from_name(std::string_view name) {
  for (const FaultName& entry : kFaultNames) {
    if (name == entry.name) return entry.kind;
  }
  return std::nullopt;
}

std::string fault_names() {
  std::string names;
  for (const FaultName& entry : kFaultNames) {
    if (!names.empty()) names += ", ";
    names += entry.name;
  }
  return names;
}

Fault parse_fault(const std::string& text) {
  const std::size_t at = text.find('@');
  Fault fault{.kind = kind_of(text.substr(0, at), text), .t_ns = 0, .duration_ns = 0, .amount = 0.0};
  if (at == std::string::npos) {
    throw Error(
        fmt::format("fault '{}': no start (expected KIND@START[+DURATION][=AMOUNT], times in s)", text));
  }
  std::string times = text.substr(at + 1);
  take_duration_and_amount(times, text, fault);
  fault.t_ns = ns_from_seconds(number_of(times, text, "start"));
  return fault;
}

Fault parse_fault_now(const std::string& text, TimeNs now_ns) {
  Fault fault;
  std::string name = text;
  take_duration_and_amount(name, text, fault);
  fault.kind = kind_of(name, text);
  fault.t_ns = now_ns;
  return fault;
}

TimeNs parse_fault_duration(const std::string& text) {
  Fault fault;
  std::string name = text;
  take_duration_and_amount(name, text, fault);
  return fault.duration_ns;
}

void FaultSchedule::add(const Fault& fault) {
  const auto place = std::upper_bound(faults_.begin() + static_cast<std::ptrdiff_t>(started_), faults_.end(),
                                      fault, [](const Fault& a, const Fault& b) { return a.t_ns < b.t_ns; });
  faults_.insert(place, fault);
  next_change_ns_ = 0;
}

std::vector<Fault> FaultSchedule::advance(TimeNs t_ns) {
  std::vector<Fault> begun;
  if (t_ns < next_change_ns_) return begun;
  while (started_ < faults_.size() && faults_[started_].t_ns <= t_ns) begun.push_back(faults_[started_++]);
  recompute(t_ns);
  return begun;
}

void FaultSchedule::recompute(TimeNs t_ns) {
  effects_ = FaultEffects{};
  next_change_ns_ = started_ < faults_.size() ? faults_[started_].t_ns : kNever_ns;
  for (std::size_t i = 0; i < started_; ++i) {
    const TimeNs end_ns = end_of(faults_[i]);
    if (end_ns <= t_ns) continue;
    add_effect(faults_[i], effects_);
    next_change_ns_ = std::min(next_change_ns_, end_ns);
  }
}

}  // namespace heel::sim
