/// \file
/// Everything that travels between threads, in the order it flows:
/// \verbatim
///   camera → FrameHeader → PoseEstimate → TargetState → StopReason → VelocityCommand → P3-AT
///                                 RobotState (odometry, bumpers, flags) ← SIP ┘
/// \endverbatim
/// - Convention: all of it is trivially copyable. Frames of reference:
///   - camera: x right, y down, z forward
///   - robot: x forward, y left, z up; origin between the wheels, on the floor
///   - odom: the robot frame at the moment the session began; drifts as odometry does
/// - Units: SI and radians; pixels in names that end in _px.
/// - Errors: named reasons (PoseReason, LinkPhase, StopReason).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "heel/time.h"

namespace heel {

// ── capture → vision ────────────────────────────────────────────────────────────────────────────

/// A frame without its pixels. Pixels are 8-bit grey (luma), row-major.
struct FrameHeader {
  std::uint64_t sequence = 0;  ///< counts every frame the camera made, dropped ones included
  TimeNs t_capture_ns = 0;     ///< when the exposure happened, as near as the driver tells
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
};

/// A frame whose pixels belong to somebody else: valid only during the call it is passed to.
struct FrameView {
  FrameHeader header;
  const std::uint8_t* grey = nullptr;  ///< first pixel of the first row
  std::uint32_t stride_bytes = 0;
};

// ── vision → control ────────────────────────────────────────────────────────────────────────────

/// Why a frame gave a pose, or why it did not.
enum class PoseReason : std::uint8_t {
  Found,
  TooFewFeatures,    ///< the frame holds fewer than four features in the scale range
  TooFewMatches,     ///< fewer than four pairs survived sign, ratio and mutual check
  NoHomography,      ///< no sample of four pairs has more support than itself
  TooFewInliers,     ///< certainty or inlier count below the floor
  ImplausibleShape,  ///< the template's outline lands mirrored, folded, or absurdly large or small
  NoValidMotion,     ///< no decomposition puts the shirt in front of both cameras, facing the camera
  WrongFrameSize,    ///< the frame is not of the size the camera was calibrated at
};

/// The shirt as one frame saw it. Conventions of the reference view: the plane z = d, normal (0,0,1);
/// X_cur = R_cur_from_ref X_ref + t;  H_cur_from_ref = K_cur (R + (t/d) nᵀ) K_ref⁻¹;  x_cur ~ H x_ref.
struct PoseEstimate {
  std::uint64_t frame_sequence = 0;
  TimeNs t_capture_ns = 0;  ///< of the frame
  TimeNs t_done_ns = 0;     ///< when vision finished
  PoseReason reason = PoseReason::TooFewFeatures;

  bool tracked = false;  ///< found where the last pose predicted it; only that region was searched
  std::uint32_t frame_features = 0;
  std::uint32_t template_features = 0;
  std::uint32_t matches = 0;
  std::uint32_t inliers = 0;
  double certainty = 0.0;  ///< inliers / template_features, 0…1

  double yaw_rad = 0.0;  ///< R about camera y; positive turns the walking direction to the image's right
  double yaw_sigma_rad = 0.0;              ///< one standard deviation
  std::array<double, 3> t_over_d{};        ///< camera frame, in units of the template distance
  std::array<double, 3> t_over_d_sigma{};  ///< one standard deviation each
  std::array<double, 9> R_cur_from_ref{};  ///< row-major
  bool has_distance = false;               ///< the template's distance is known: metres below are valid
  std::array<double, 3> position_m{};      ///< template centre in the current camera frame
  std::array<double, 9> H_cur_from_ref{};  ///< row-major, undistorted pixels, H[8] = 1

  bool found() const { return reason == PoseReason::Found; }
};

// ── robot → control ─────────────────────────────────────────────────────────────────────────────

/// Where the session with the robot's controller stands.
enum class LinkPhase : std::uint8_t {
  Closed,    ///< no line, or not yet tried
  Syncing,   ///< SYNC0…SYNC2, baud sweep
  Opening,   ///< OPEN sent, first SIP awaited; CONFIG asked
  Enabling,  ///< zero velocity sent, ENABLE awaiting its flag
  Running,   ///< SIPs arrive, motors are enabled
  Disabled,  ///< SIPs arrive, motors went off (STOP button, E-stall): off until heeld is restarted
  Lost,      ///< SIPs stopped or the line broke; reconnecting
};

/// Pose of the robot frame in odom, unwrapped, SI.
struct Odometry {
  TimeNs t_ns = 0;  ///< first byte of the SIP
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;  ///< continuous, not wrapped
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;
};

/// What one sonar heard last. A sonar that hears nothing reports 5 m.
struct SonarEcho {
  TimeNs t_ns = 0;  ///< first byte of the SIP that reported it; 0: none yet
  double range_m = 0.0;
};
inline constexpr std::size_t kSonars = 16;  ///< 0…7 front from left to right, 8…15 rear from right to left

/// The newest standard information packet in SI units, and the state of the line.
struct RobotState {
  LinkPhase phase = LinkPhase::Closed;
  bool has_sip = false;
  Odometry odometry;
  bool motors_enabled = false;
  bool stop_button = false;
  bool e_stall = false;
  bool stall_left = false;
  bool stall_right = false;
  std::uint8_t bumpers_front = 0;  ///< bit i: segment i pressed
  std::uint8_t bumpers_rear = 0;
  std::array<SonarEcho, kSonars> sonar{};
  double battery_v = 0.0;
  std::uint64_t sips = 0;
  std::uint64_t checksum_errors = 0;
  std::uint64_t bytes_discarded = 0;
  std::uint64_t reconnects = 0;
};

// ── control ─────────────────────────────────────────────────────────────────────────────────────

/// Everything one control tick decides on. The inputs since the start and the configuration give every tick's
/// decisions again, to the bit.
struct ControlInput {
  TimeNs now_ns = 0;  ///< when the tick ran
  RobotState robot;
  bool has_pose = false;  ///< a frame has been processed since the start
  PoseEstimate pose;      ///< the newest; the same as in the tick before when no frame has come since
  bool shutdown = false;  ///< this is the last tick
};

/// The target in the odometry frame, carried from the frame's capture time to now.
struct TargetState {
  bool known = false;
  TimeNs t_capture_ns = 0;  ///< of the frame it is computed from
  double certainty = 0.0;
  // In the robot frame at `now`:
  double x_m = 0.0;  ///< centre of the back
  double y_m = 0.0;
  double yaw_rad = 0.0;  ///< walking direction against the robot's heading, counter-clockwise + (robot frame)
  // Where the reference view is recreated (the pose the robot is to take), robot frame at `now`:
  double goal_x_m = 0.0;
  double goal_y_m = 0.0;
};

/// What became of the newest pose in a tick.
enum class MeasurementStatus : std::uint8_t {
  None,      ///< no new frame
  Accepted,  ///< the estimator took it
  Rejected,  ///< not found, or an outlier
};

/// What may keep the robot at rest, as bits of Conditions.
enum Condition : std::uint16_t {
  kShutdown = 1 << 0,
  kLinkDown = 1 << 1,
  kStaleSip = 1 << 2,  ///< no packet from the robot for the timeout
  kStopButton = 1 << 3,
  kMotorsOff = 1 << 4,
  kBumper = 1 << 5,        ///< pressed, or released less than the hold time ago
  kStall = 1 << 6,         ///< wheels stalled, or free again for less than the hold time
  kSonarSilent = 1 << 7,   ///< no reading from any front sonar for the timeout, though they are on
  kStaleFrame = 1 << 8,    ///< no frame for the timeout, or none yet
  kLowCertainty = 1 << 9,  ///< not following; the shirt is found, but with too little certainty
  kTargetLost = 1 << 10,   ///< not following, having followed before
  kNoTargetYet = 1 << 11,  ///< not following, never followed
};
/// Condition bits.
using Conditions = std::uint16_t;
inline constexpr Conditions kAllConditions = (1 << 12) - 1;

/// Why the robot is at rest. One value for each row of the supervisor's table; None: following.
enum class StopReason : std::uint8_t {
  None,
  Shutdown,
  LinkDown,
  StaleSip,
  StopButton,
  MotorsOff,
  Bumper,
  Stall,
  SonarSilent,
  NoTargetYet,
  StaleFrame,
  TargetLost,
  LowCertainty,
};

/// What the gate holds back, as bits of VelocityCommand::limited_by.
enum GateLimit : std::uint8_t {
  kGateSpeed = 1,
  kGateAcceleration = 2,
  kGateAge = 4,
  kGateNotFinite = 8,
  kGateSeparation = 16,  ///< the person is too near
  kGateObstacle = 32,    ///< something the sonars hear is in the way
};

/// What goes to the wire, once a tick. Expires by itself.
struct VelocityCommand {
  TimeNs t_issued_ns = 0;
  TimeNs t_expires_ns = 0;  ///< after this it counts as zero
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;  ///< counter-clockwise +
  std::uint8_t limited_by = 0;  ///< GateLimit bits
};

// ── everything → telemetry ──────────────────────────────────────────────────────────────────────

/// One control tick: what it decided on, and what it decided.
struct TickRecord {
  std::uint64_t tick = 0;
  TimeNs lateness_ns = 0;  ///< after its absolute deadline
  ControlInput input;
  MeasurementStatus measurement = MeasurementStatus::None;  ///< what became of input.pose
  TargetState target;
  Conditions conditions = 0;
  StopReason stop_reason = StopReason::NoTargetYet;
  VelocityCommand wanted;  ///< from the control law
  /// Bumper to the nearest sonar obstacle in the way; infinite: none; NaN: not needed, the robot stops at
  /// once.
  double free_distance_m = 0.0;
  VelocityCommand command;  ///< after the gate, as sent
};

/// What a real-time thread reports to people. It pushes the record; the telemetry thread makes it text, logs
/// it and writes it to events.log. (Changes of stop reason, link phase and target need no event: telemetry
/// sees them in the ticks and poses.)
enum class EventKind : std::uint8_t {
  CameraOpened,       ///< text: what was agreed with the device
  CameraUnavailable,  ///< text: why it does not open
  CameraLost,         ///< text: why; it will be opened again
  CameraEnded,        ///< a file's last frame has been given
  FrameRefused,       ///< a: width_px, b: height_px; not the size the ring was made for
  FrameCorrupt,       ///< a: corrupt frames so far
  Overrun,            ///< a: periods missed so far, b: lateness_ns of this one
  Note,               ///< text: anything else, with "{}" in place of the number a
  Warning,            ///< as Note, and a person should know about it
};

/// A report of a real-time thread; `a` and `b` mean what its kind says.
struct Event {
  TimeNs t_ns = 0;
  EventKind kind = EventKind::Note;
  std::int64_t a = 0;
  std::int64_t b = 0;
  std::array<char, 128> text{};  ///< ends with a zero
};

/// Counters of the frame path since the start; capture pushes them whenever they have changed.
struct CaptureCounters {
  TimeNs t_ns = 0;  ///< when they were read
  std::uint64_t captured = 0;
  std::uint64_t dropped_by_driver = 0;  ///< gaps in the driver's sequence, buffers with the error flag
  std::uint64_t dropped_unread = 0;     ///< overtaken by a fresher frame
  std::uint64_t reopened = 0;           ///< openings of the camera after the first
  bool operator==(const CaptureCounters&) const = default;
};

/// What threads exchange is copied byte by byte.
template <typename... T>
inline constexpr bool kAllTriviallyCopyable = (std::is_trivially_copyable_v<T> && ...);
static_assert(kAllTriviallyCopyable<FrameHeader, FrameView, PoseEstimate, RobotState, TargetState,
                                    VelocityCommand, ControlInput, TickRecord, Event, CaptureCounters>);

/// The reasons and phases as people read them in logs, records and status lines.
const char* to_string(PoseReason reason);
const char* to_string(LinkPhase phase);
const char* to_string(MeasurementStatus status);
const char* to_string(StopReason reason);
const char* to_string(EventKind kind);

}  // namespace heel
