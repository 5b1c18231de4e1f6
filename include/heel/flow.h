/// \file
/// All data exchanged between threads, in the order in which it flows:
/// \verbatim
///   camera → FrameHeader → PoseEstimate → TargetState → SupervisorState → VelocityCommand → P3-AT
///                                  operator → OperatorRequest ┘ RobotState (odometry, flags) ← SIP ┘
/// \endverbatim
/// - Convention: all of it is trivially copyable. Frames of reference:
///   - camera: x right, y down, z forward
///   - robot: x forward, y left, z up; origin between the wheels, on the floor
///   - odom: the robot frame at the start of the session; it drifts, as odometry does
/// - Units: SI and radians; pixels in names that end in _px.
/// - Errors: named reasons (PoseReason, LinkPhase, StopReason, OperatorOutcome).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "heel/states.h"
#include "heel/time.h"

namespace heel {

// ── capture → vision ────────────────────────────────────────────────────────────────────────────

/// A frame without its pixels. Pixels are 8-bit grey (luma), row-major.
struct FrameHeader {
  std::uint64_t sequence = 0;  ///< counts every frame the camera made, dropped ones included
  TimeNs t_capture_ns = 0;     ///< time of the exposure, as far as the driver reports it
  std::uint32_t width_px = 0;
  std::uint32_t height_px = 0;
  TimeNs t_dequeued_ns = 0;  ///< when the capture thread had it from the driver; 0: not known
};

/// A frame that does not own its pixels: valid only during the call that it is passed to.
struct FrameView {
  FrameHeader header;
  const std::uint8_t* grey = nullptr;  ///< first pixel of the first row
  std::uint32_t stride_bytes = 0;
};

// ── vision → control ────────────────────────────────────────────────────────────────────────────

/// Why a frame gave a pose, or why it did not.
enum class PoseReason : std::uint8_t {
  Found,
  TooFewFeatures,    ///< the frame has fewer than four features in the scale range
  TooFewMatches,     ///< fewer than four pairs survived sign, ratio and mutual check
  NoHomography,      ///< no homography is supported by more than the four pairs it was made from
  TooFewInliers,     ///< certainty or number of inliers below the configured minimum
  ImplausibleShape,  ///< the template's outline is mirrored, folded, or far too large or small
  NoValidMotion,     ///< no decomposition puts the shirt in front of both cameras, facing the camera
  WrongFrameSize,    ///< the frame is not of the size the camera was calibrated at
  PatchesDisagree,   ///< too few patches of the print are where the pose puts them
  OutOfReach,        ///< found where the person who was tracked until now cannot have come to
  Ambiguous,         ///< the frame shows the shirt at a second place as well; the pose is that of one of them
};

/// The pose of the shirt in one frame. Conventions of the reference view: the plane z = d, normal (0,0,1);
/// X_cur = R_cur_from_ref X_ref + t;  H_cur_from_ref = K_cur (R + (t/d) nᵀ) K_ref⁻¹;  x_cur ~ H x_ref.
struct PoseEstimate {
  std::uint64_t frame_sequence = 0;
  TimeNs t_capture_ns = 0;  ///< of the frame
  TimeNs t_done_ns = 0;     ///< when vision finished
  PoseReason reason = PoseReason::TooFewFeatures;
  PictureFault picture = PictureFault::None;  ///< of the pictures up to this one

  std::uint32_t template_index = 0;  ///< whose it is: 0 target.shirt, then target.more_shirts in their order
  bool tracked = false;  ///< found where the last pose predicted it; only that region was searched
  std::uint32_t frame_features = 0;
  std::uint32_t template_features = 0;
  std::uint32_t matches = 0;
  std::uint32_t inliers = 0;
  double certainty =
      0.0;  ///< inliers / template_features, 0…1; both of the view by which the shirt was found

  /// About camera y; positive turns the walking direction to the image's right. PoseTracker filters it over
  /// the frames of a sequence.
  double yaw_rad = 0.0;
  double yaw_sigma_rad = 0.0;              ///< one standard deviation
  double frame_yaw_rad = 0.0;              ///< of this frame alone: that of R_cur_from_ref
  double frame_yaw_sigma_rad = 0.0;        ///< one standard deviation
  std::array<double, 3> t_over_d{};        ///< camera frame, in units of the template distance
  std::array<double, 3> t_over_d_sigma{};  ///< one standard deviation each
  std::array<double, 9> R_cur_from_ref{};  ///< row-major
  bool has_distance = false;               ///< the template's distance is known: metres below are valid
  std::array<double, 3> position_m{};      ///< template centre in the current camera frame
  std::array<double, 9> H_cur_from_ref{};  ///< row-major, undistorted pixels, H[8] = 1; of its own template

  bool found() const { return reason == PoseReason::Found; }
};

/// Places in a frame that show people how its pose came about. Nothing is decided by them.
struct PoseMarks {
  static constexpr std::size_t kMostInliers = 200;
  std::uint64_t frame_sequence = 0;
  bool has_region = false;  ///< the last pose predicted the shirt, and this region was searched first
  std::array<std::int32_t, 4> region_px{};  ///< left, top, right, bottom; pixels of the frame, and beyond it
  std::uint32_t inliers = 0;  ///< entries of `inlier_px`: of more pairs than it holds, every n-th
  std::array<std::array<float, 2>, kMostInliers> inlier_px{};  ///< x, y; undistorted
};

// ── robot → control ─────────────────────────────────────────────────────────────────────────────

/// The phase of the session with the robot's controller.
enum class LinkPhase : std::uint8_t {
  Closed,    ///< no line, or not yet tried
  Syncing,   ///< SYNC0…SYNC2, baud sweep
  Opening,   ///< OPEN sent, first SIP awaited; CONFIG requested
  Enabling,  ///< zero velocity and ENABLE sent, the motors' flag awaited
  Running,   ///< SIPs arrive, motors are enabled
  Disabled,  ///< SIPs arrive, motors went off (STOP button, E-stall): off until an operator's reset
  Lost,      ///< SIPs stopped or the line broke; reconnecting
  Refused,   ///< it answers, and is not a robot that may be driven: RobotKind::choice says why
};

/// Which parameters the robot that answers is driven with.
enum class ModelChoice : std::uint8_t {
  NotYet,    ///< it has not said what it is
  Chosen,    ///< those of RobotKind::model
  Unknown,   ///< refused: no parameters for its class and subclass
  Conflict,  ///< refused: it is not what robot.model says
  Nameless,  ///< refused: it does not say what it is, and robot.model does not either
};

/// What the robot says that it is (SYNC2), in printable characters and cut to fit, and what follows from it.
struct RobotKind {
  std::array<char, 24> robot_class{};  ///< "Pioneer"; ends with a zero
  std::array<char, 24> subclass{};     ///< "p3at-sh"; ends with a zero
  ModelChoice choice = ModelChoice::NotYet;
  std::uint8_t model = 0;  ///< place in the table of models; with Conflict, of the one in robot.model
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

/// The last echo of one sonar. A sonar without an echo reports 5 m.
struct SonarEcho {
  TimeNs t_ns = 0;  ///< first byte of the SIP that reported it; 0: none yet
  double range_m = 0.0;
};
/// The robot with the most has this many; its model says which are fitted, and where.
inline constexpr std::size_t kMaxSonars = 32;

/// What the robot's controller does with the accelerations that heeld asks for. CONFIGpac limits them;
/// without it the smaller values of the factory are assumed.
struct DriveLimits {
  bool known = false;  ///< from CONFIGpac
  double acceleration_m_s2 = 0.3;
  double deceleration_m_s2 = 0.3;
};

/// The newest standard information packet in SI units, and the state of the line.
struct RobotState {
  LinkPhase phase = LinkPhase::Closed;
  RobotKind kind;
  bool has_sip = false;
  Odometry odometry;
  bool motors_enabled = false;
  bool stop_button = false;
  bool e_stall = false;
  bool stall_left = false;
  bool stall_right = false;
  std::uint8_t bumpers_front = 0;  ///< bit i: segment i pressed
  std::uint8_t bumpers_rear = 0;
  std::array<SonarEcho, kMaxSonars> sonar{};
  double battery_v = 0.0;
  DriveLimits limits;
  std::uint64_t sips = 0;
  std::uint64_t checksum_errors = 0;
  std::uint64_t bytes_discarded = 0;
  std::uint64_t reconnects = 0;
};

// ── operator → control ──────────────────────────────────────────────────────────────────────────

/// What an operator may ask for.
enum class OperatorCommand : std::uint8_t {
  None,
  Start,  ///< the robot may move
  Stop,   ///< come to rest; only a start lets it move again
  EStop,  ///< rest at once; only a reset leaves this
  Reset,  ///< after an emergency stop, or after the motors went off: they may be enabled again
};

/// The newest request; `number` grows by one with each. 0: none yet.
struct OperatorRequest {
  std::uint64_t number = 0;
  TimeNs t_ns = 0;
  OperatorCommand command = OperatorCommand::None;
};

/// What became of a request.
enum class OperatorOutcome : std::uint8_t {
  None,       ///< no request yet
  Done,       ///< it has changed the state
  AlreadySo,  ///< nothing to change
  Refused,    ///< TickRecord::refused_by says why
};

// ── control ─────────────────────────────────────────────────────────────────────────────────────

/// All inputs of one control tick. The inputs since the start and the configuration give the decisions of
/// every tick again, to the bit.
struct ControlInput {
  TimeNs now_ns = 0;         ///< when the tick ran
  TimeNs lateness_ns = 0;    ///< how long after its absolute deadline it ran
  OperatorRequest request;   ///< the newest; handled in the tick in which its number is new
  TimeNs t_operator_ns = 0;  ///< newest sign of the operator: a request or a keep-alive; 0: none yet
  RobotState robot;
  bool has_pose = false;  ///< a frame has been processed since the start
  PoseEstimate pose;      ///< the newest; the same as in the last tick when no frame has come since
  bool shutdown = false;  ///< this is the last tick
};

/// The target in the odometry frame, predicted from the frame's capture time to now.
struct TargetState {
  bool known = false;
  TimeNs t_capture_ns = 0;  ///< of the frame it is computed from
  double certainty = 0.0;
  // In the robot frame at `now`:
  double x_m = 0.0;  ///< centre of the back
  double y_m = 0.0;
  // Directions against the robot's heading, counter-clockwise +; each sigma is one standard deviation.
  double yaw_rad = 0.0;         ///< of the back; it swings with each stride
  double travel_yaw_rad = 0.0;  ///< direction of travel; while the person stands, mean yaw of the back
  double travel_yaw_sigma_rad = 0.0;
  double stride_yaw_rad = 0.0;  ///< mean direction of travel over the stride before the frame
  double stride_yaw_sigma_rad = 0.0;
  // The walk without the sway and swing of the gait; odom, at the time of the frame.
  double body_odom_x_m = 0.0;  ///< axis of the body
  double body_odom_y_m = 0.0;
  double body_sigma_m = 0.0;  ///< one standard deviation, of the less certain direction
  double walk_m_s = 0.0;      ///< along the direction of travel; negative: backwards
  double walk_sigma_m_s = 0.0;
  double aside_m_s = 0.0;        ///< to the left of the direction of travel
  double walk_turn_rad_s = 0.0;  ///< rate of the direction of travel
  double walk_turn_sigma_rad_s = 0.0;
  // The goal, where the robot has the reference view again; robot frame at `now`:
  double goal_x_m = 0.0;
  double goal_y_m = 0.0;
};

/// What the estimator did with the newest pose in a tick.
enum class MeasurementStatus : std::uint8_t {
  None,        ///< no new frame
  Accepted,    ///< the estimator used it
  NotFound,    ///< PoseEstimate::reason says why
  Unusable,    ///< found, but without distance, or tilted so far that it shows no direction
  NoOdometry,  ///< the robot's pose at the time of the frame is not known
  OutOfOrder,  ///< not newer than the last frame that was used
  Outlier,     ///< farther from the prediction than estimate.outlier_sigma
};

/// The command that is sent each tick. It expires by itself.
struct VelocityCommand {
  TimeNs t_issued_ns = 0;
  TimeNs t_expires_ns = 0;  ///< after this it counts as zero
  double v_m_s = 0.0;
  double yaw_rate_rad_s = 0.0;  ///< counter-clockwise +
  std::uint8_t limited_by = 0;  ///< GateLimit bits
};

// ── everything → telemetry ──────────────────────────────────────────────────────────────────────

/// One control tick: its inputs and its decisions.
struct TickRecord {
  std::uint64_t tick = 0;
  std::uint64_t configuration = 0;  ///< in use: 0 that of the start, one more with each reconfigure()
  ControlInput input;
  MeasurementStatus measurement = MeasurementStatus::None;  ///< of input.pose
  TargetState target;
  Conditions conditions = 0;
  SupervisorState state = SupervisorState::Idle;
  TransitionCause cause = TransitionCause::Boot;  ///< of the last change of `state` …
  TimeNs t_transition_ns = 0;                     ///< … and the tick of it; 0: none yet
  StopReason stop_reason = StopReason::NotStarted;
  // The newest request that was handled, and what became of it:
  std::uint64_t request_number = 0;
  OperatorOutcome outcome = OperatorOutcome::None;
  StopReason refused_by = StopReason::None;  ///< why it was refused
  bool needs_start = false;                  ///< only an operator's start lets the robot move again
  bool enable_motors = false;                ///< this tick's reset: the session may enable the motors again
  VelocityCommand wanted;                    ///< from the control law
  double person_m = 0.0;  ///< camera to back; infinite: the person is not ahead, or not known
  /// Bumper to the nearest sonar obstacle in the way; infinite: none; NaN: not needed, the robot stops at
  /// once.
  double free_distance_m = 0.0;
  Hold hold = Hold::None;
  double planned_deceleration_m_s2 = 0.0;  ///< with which the gate plans a stop before people and obstacles
  bool brakes_are_weaker = false;  ///< … because the robot slowed down with less than its controller allows
  VelocityCommand command;         ///< after the gate, as sent
};

/// What a real-time thread reports to the user. It pushes the record; the telemetry thread formats it, logs
/// it and writes it to events.log. (Changes of stop reason, link phase and target need no event: telemetry
/// finds them in the ticks and poses.)
enum class EventKind : std::uint8_t {
  CameraOpened,       ///< text: format, size and rate
  CameraUnavailable,  ///< text: why it does not open
  CameraLost,         ///< text: why; it will be opened again
  CameraEnded,        ///< the last frame of a file was delivered
  FrameRefused,       ///< a: width_px, b: height_px; not the size of the calibration
  FrameCorrupt,       ///< a: corrupt frames so far
  Overrun,            ///< a: periods missed so far, b: lateness_ns of this one
  Note,               ///< text: any other message, with "{}" in place of the number a
  Warning,            ///< as Note, but something is wrong
};

/// A report of a real-time thread; its kind defines the meaning of `a` and `b`.
struct Event {
  TimeNs t_ns = 0;
  EventKind kind = EventKind::Note;
  std::int64_t a = 0;
  std::int64_t b = 0;
  std::array<char, 192> text{};  ///< ends with a zero
};

/// Counters of the capture thread since the start; it pushes them when they have changed.
struct CaptureCounters {
  TimeNs t_ns = 0;  ///< when they were read
  std::uint64_t captured = 0;
  std::uint64_t dropped_by_driver = 0;  ///< gaps in the driver's sequence, buffers with the error flag
  std::uint64_t dropped_unread = 0;     ///< replaced by a newer frame before vision took it
  std::uint64_t reopened = 0;           ///< openings of the camera after the first
  bool operator==(const CaptureCounters&) const = default;
};

/// When a frame reached each stage; with the tick that uses its pose and the bytes written then, its whole
/// way.
struct FrameTiming {
  std::uint64_t frame_sequence = 0;
  TimeNs t_capture_ns = 0;   ///< FrameHeader::t_capture_ns
  TimeNs t_dequeued_ns = 0;  ///< FrameHeader::t_dequeued_ns
  TimeNs t_vision_ns = 0;    ///< when vision began with it
  TimeNs t_done_ns = 0;      ///< when vision had finished
};

/// Bytes on the robot's line as they were read or written; several when there were more.
struct WireBytes {
  TimeNs t_ns = 0;        ///< when they had been read or written
  bool to_robot = false;  ///< false: from it
  std::uint8_t count = 0;
  std::array<std::uint8_t, 118> bytes{};
};

/// These structs are copied between threads byte by byte.
template <typename... T>
inline constexpr bool kAllTriviallyCopyable = (std::is_trivially_copyable_v<T> && ...);
static_assert(kAllTriviallyCopyable<FrameHeader, FrameView, PoseEstimate, PoseMarks, RobotState, TargetState,
                                    VelocityCommand, OperatorRequest, ControlInput, TickRecord, Event,
                                    CaptureCounters, FrameTiming, WireBytes>);

/// The texts of reasons and phases in logs, records and status lines.
const char* to_string(PoseReason reason);
const char* to_string(LinkPhase phase);
const char* to_string(ModelChoice choice);
const char* to_string(MeasurementStatus status);
const char* to_string(OperatorCommand command);
const char* to_string(OperatorOutcome outcome);
const char* to_string(EventKind kind);

}  // namespace heel
