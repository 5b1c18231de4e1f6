#include "arcos/commands.h"

#include <algorithm>
#include <iterator>

namespace arcos {
namespace {

using enum ArgumentKind;

constexpr CommandInfo kCommands[] = {
    {CommandId::Pulse, "PULSE", None, true, "feed the watchdog; SYNC0 before the connection is open"},
    {CommandId::Open, "OPEN", OptionalInteger, true,
     "start the packets (SIP); SYNC1 before the connection is open"},
    {CommandId::Close, "CLOSE", OptionalInteger, true, "stop and close; SYNC2 before the connection is open"},
    {CommandId::Polling, "POLLING", Text, true, "order of the sonars, numbers from 1"},
    {CommandId::Enable, "ENABLE", Integer, true, "motors 1 on, 0 off"},
    {CommandId::SetA, "SETA", SignedInteger, true, "+ acceleration, - deceleration, mm/s^2"},
    {CommandId::SetV, "SETV", Integer, true, "largest speed, mm/s"},
    {CommandId::SetO, "SETO", None, true, "zero the odometry"},
    {CommandId::Move, "MOVE", SignedInteger, true, "translate, mm, at the SETV speed"},
    {CommandId::Rotate, "ROTATE", SignedInteger, true, "rotate, deg/s, counter-clockwise +"},
    {CommandId::SetRv, "SETRV", Integer, true, "largest rotation, deg/s"},
    {CommandId::Vel, "VEL", SignedInteger, true, "translate, mm/s"},
    {CommandId::Head, "HEAD", SignedInteger, true, "turn to an absolute heading, deg"},
    {CommandId::DHead, "DHEAD", SignedInteger, true, "turn relative to the heading, deg"},
    {CommandId::Say, "SAY", Text, true, "up to 20 pairs of duration (20 ms) and tone"},
    {CommandId::JoyRequest, "JOYREQUEST", Integer, true, "joystick packets: 0 stop, 1 once, 2 stream"},
    {CommandId::Config, "CONFIG", OptionalInteger, true, "ask for CONFIGpac"},
    {CommandId::Encoder, "ENCODER", Integer, true, "encoder packets: 0 stop, 1 once, 2 stream"},
    {CommandId::RVel, "RVEL", SignedInteger, true, "rotate, deg/s, counter-clockwise +"},
    {CommandId::DcHead, "DCHEAD", SignedInteger, true, "turn relative to the last heading asked, deg"},
    {CommandId::SetRa, "SETRA", SignedInteger, true, "+ rotational acceleration, - deceleration, deg/s^2"},
    {CommandId::Sonar, "SONAR", Integer, true, "1 on, 0 off; else bits 1-3 choose an array"},
    {CommandId::Stop, "STOP", None, true, "stop; motors stay enabled"},
    {CommandId::DigOut, "DIGOUT", TwoBytes, true, "digital outputs: high byte mask, low byte values"},
    {CommandId::Vel2, "VEL2", TwoBytes, true, "wheel speeds, 20 mm/s: high byte left, low byte right"},
    {CommandId::AdSel, "ADSEL", Integer, true, "A/D port shown in the SIP"},
    {CommandId::IoRequest, "IOREQUEST", Integer, true, "IO packets: 0 stop, 1 once, 2 stream"},
    {CommandId::Tty2, "TTY2", Text, true, "write to the auxiliary port"},
    {CommandId::GetAux, "GETAUX", Integer, true, "fetch bytes from the auxiliary port"},
    {CommandId::BumpStall, "BUMPSTALL", Integer, true, "bumpers that stall: 0 none, 1 front, 2 rear, 3 both"},
    {CommandId::SonarCycle, "SONARCYCLE", Integer, true, "time between sonar pings, ms"},
    {CommandId::HostBaud, "HOSTBAUD", Integer, true, "0-4: 9600, 19200, 38400, 57600, 115200"},
    {CommandId::EStop, "E_STOP", None, true, "stop, overriding the deceleration"},
    {CommandId::EStall, "E_STALL", Integer, true, "1: the STOP button stalls the robot"},
    {CommandId::Gyro, "GYRO", Integer, true, "gyro packets: 0 stop, 1 once, 2 stream"},
    {CommandId::BatteryInfo, "BATTERYINFO", Integer, true, "battery information"},
    {CommandId::RotKp, "ROTKP", Integer, true, "drive PID, rotation, proportional"},
    {CommandId::RotKv, "ROTKV", Integer, true, "drive PID, rotation, differential"},
    {CommandId::RotKi, "ROTKI", Integer, true, "drive PID, rotation, integral"},
    {CommandId::TransKp, "TRANSKP", Integer, true, "drive PID, translation, proportional"},
    {CommandId::TransKv, "TRANSKV", Integer, true, "drive PID, translation, differential"},
    {CommandId::TransKi, "TRANSKI", Integer, true, "drive PID, translation, integral"},
    {CommandId::RevCount, "REVCOUNT", Integer, true, "differential encoder count for a 180 degree turn"},
    {CommandId::DriftFactor, "DRIFTFACTOR", SignedInteger, true, "difference of the tyres, 1/8192"},
    {CommandId::SoundTog, "SOUNDTOG", Integer, true, "sound: 1 on, 0 off"},
    {CommandId::TicksMm, "TICKSMM", Integer, true, "encoder ticks per mm"},
    {CommandId::BatTest, "BATTEST", OptionalInteger, true, "simulate a battery voltage"},
    {CommandId::Reset, "RESET", None, false, "reset the controller"},
    {CommandId::Maintenance, "MAINTENANCE", None, false, "enter the firmware loader"},
};

constexpr bool by_id(const CommandInfo& a, const CommandInfo& b) {
  return a.id < b.id;
}
static_assert(std::is_sorted(std::begin(kCommands), std::end(kCommands), by_id));

}  // namespace

std::span<const CommandInfo> command_table() {
  return kCommands;
}

const CommandInfo* find_command(std::uint8_t id) {
  const auto* const found = std::lower_bound(std::begin(kCommands), std::end(kCommands), id,
                                             [](const CommandInfo& info, std::uint8_t wanted) {
                                               return static_cast<std::uint8_t>(info.id) < wanted;
                                             });
  const bool here = found != std::end(kCommands) && static_cast<std::uint8_t>(found->id) == id;
  return here ? found : nullptr;
}

}  // namespace arcos
