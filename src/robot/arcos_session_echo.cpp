// A line that sends back what heeld sends: a loop-back plug, or local echo of a modem or terminal. A robot's
// answers to SYNC0 and SYNC1 are the same bytes as the question; its answer to SYNC2 has its names, but they
// may be lost. No robot sends back the CLOSE that comes before a repeated SYNC0.
//
// Behind an echo there may be a robot: its answer with the names is waited for, and the session goes on.
#include <algorithm>

#include "arcos/command_codec.h"
#include "robot/arcos_session.h"

namespace heel {
namespace {

using arcos::CommandId;
using Kind = SessionEventKind;

bool is_same(const arcos::Packet& packet, const arcos::Frame& frame) {
  return std::equal(packet.body.begin(), packet.body.end(), frame.body().begin(), frame.body().end());
}

}  // namespace

/// Whether the packet is one that heeld may have sent at this step, and no robot sends.
bool ArcosSession::is_echo(const arcos::Packet& packet) const {
  if (step_ == Step::TryingRate) return is_same(packet, arcos::encode_plain(CommandId::Pulse));
  return !is_connected() && is_same(packet, arcos::encode_integer(CommandId::Close, 1));
}

/// The rate is left at the next advance(): the parser that gave the packet goes on.
void ArcosSession::on_echo() {
  echo_heard_ = echo_heard_ || looks_for_robot();
}

bool ArcosSession::looks_for_robot() const {
  return step_ == Step::Listening || step_ == Step::Sync0 || step_ == Step::Sync1 || step_ == Step::Sync2;
}

/// Whether the answer to SYNC2 is the question itself, and either CLOSE, which tells, was not sent yet, or an
/// echo was heard before: one that comes late answers another attempt.
bool ArcosSession::may_be_echo_of_sync2(const arcos::Packet& packet) const {
  const bool unclear = attempts_ < kSyncAttemptsPerBaud || echo_heard_ || echo_of_sweep_ || reported_echo_;
  return unclear && is_same(packet, arcos::encode_plain(CommandId::Sync2));
}

/// At the end of a sweep: of an echo that comes late, the part that tells need not be in each sweep.
bool ArcosSession::sweep_echoed() const {
  return echo_of_sweep_ || (reported_echo_ && bytes_of_sweep_ > 0 && text_of_sweep_.text().empty());
}

/// Once until a robot, or another trouble, takes its place.
void ArcosSession::report_echo(TimeNs now_ns) {
  if (!reported_echo_) events_.push(now_ns, Kind::LineEchoes);
  repeats_.over();
  reported_echo_ = true;
  reported_text_.clear();
}

}  // namespace heel
