// Simulated faults of the robot and its line: a list of faults with times, and their effect at one moment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "heel/time.h"

namespace heel::sim {

/// The comments say what `amount` means.
enum class FaultKind : std::uint8_t {
  DropBytes,    ///< share of bytes lost on the line, both directions, 0…1
  GarbleBytes,  ///< share of bytes with one bit flipped, both directions, 0…1
  DelayBytes,   ///< delay of every byte in s, both directions
  Silence,      ///< the robot receives, but nothing it sends arrives
  Reset,        ///< the controller restarts once and loses its state; id of its notice, 254 or 255 (0: 254)
  Bumper,       ///< pressed segments: bits 0…6 front, bits 8…14 rear
  StopButton,   ///< the STOP button is held down
  Stall,        ///< blocked wheels: 0 both, 1 left, 2 right
  BadConfig,    ///< CONFIGpac has a wrong checksum
  BootBaud,     ///< the controller restarts once, at this baud rate
  LeftOpen,     ///< state after an earlier session: open, motors on, setpoint (mm/s) stopped by the watchdog
};

struct Fault {
  FaultKind kind = FaultKind::Silence;
  TimeNs t_ns = 0;         ///< when it begins
  TimeNs duration_ns = 0;  ///< 0: to the end of the run
  double amount = 0.0;
};

const char* to_string(FaultKind kind);
std::optional<FaultKind> fault_kind_from_name(std::string_view name);
/// "drop, garble, …", for error messages.
std::string fault_names();
/// Parses "KIND@START[+DURATION][=AMOUNT]", times in seconds, e.g. "drop@10+5=0.02". Throws heel::Error
/// naming the part that is wrong.
Fault parse_fault(const std::string& text);
/// The same without "@START", for a fault that begins at `now_ns`.
Fault parse_fault_now(const std::string& text, TimeNs now_ns);
/// The DURATION of such a text, whatever its kind.
TimeNs parse_fault_duration(const std::string& text);

/// The effect of all active faults at one moment.
struct FaultEffects {
  double drop_share = 0.0;
  double garble_share = 0.0;
  TimeNs delay_ns = 0;
  bool silence = false;
  bool bad_config = false;
  bool stop_button = false;
  bool blocked_left = false;
  bool blocked_right = false;
  std::uint8_t bumpers_front = 0;
  std::uint8_t bumpers_rear = 0;
};

class FaultSchedule {
 public:
  void add(const Fault& fault);
  /// Advances to `t_ns` and returns the faults that have begun since the last call, in order of time.
  std::vector<Fault> advance(TimeNs t_ns);
  const FaultEffects& effects() const { return effects_; }

 private:
  void recompute(TimeNs t_ns);

  std::vector<Fault> faults_;  ///< in order of start
  std::size_t started_ = 0;    ///< faults_[0, started_) have begun
  TimeNs next_change_ns_ = 0;  ///< nothing begins or ends before this
  FaultEffects effects_;
};

}  // namespace heel::sim
