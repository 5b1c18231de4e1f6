// What the daemon sends, as types for the editor and the checker. Lengths in metres, angles in radians, as in docs/operator.md.

/** @typedef {number | null} Known null: not known, or not finite */

/**
 * One message of the control loop, at most 20 a second.
 * @typedef {object} Tick
 * @property {number} t_s time of the daemon's clock
 * @property {number} wall_ms time of the clock on the wall
 * @property {string} state
 * @property {string} sentence
 * @property {string} reason
 * @property {string} hold
 * @property {string[]} limited_by
 * @property {{x_m: number, y_m: number, heading_rad: number, v_m_s: number, yaw_rate_rad_s: number, battery_v: Known,
 *   link: string, motors: boolean, stop_button: boolean, bumpers: boolean, stall: boolean}} robot
 * @property {{known: boolean, x_m?: Known, y_m?: Known, yaw_rad?: Known, travel_yaw_rad?: Known,
 *   travel_yaw_sigma_rad?: Known, certainty?: Known, walk_m_s?: Known,
 *   body_odom?: {x_m: Known, y_m: Known, sigma_m: Known}}} target in the robot frame, but body_odom
 * @property {{x_m: Known, y_m: Known} | null} goal in the robot frame
 * @property {Velocity | null} wanted
 * @property {Velocity} command
 * @property {Known} person_m
 * @property {Known} free_distance_m
 * @property {{angle_rad: number, x_m: number, y_m: number, range_m: number, age_s: number}[]} sonar
 * @property {number} lateness_us
 */

/** @typedef {{v_m_s: number, yaw_rate_rad_s: number}} Velocity */

/**
 * What vision found in one frame; places in pixels of the whole picture.
 * @typedef {object} Pose
 * @property {number} frame
 * @property {number} t_s
 * @property {boolean} found
 * @property {string} reason
 * @property {number} certainty
 * @property {number} inliers
 * @property {number} template
 * @property {number} yaw_rad
 * @property {number} yaw_sigma_rad
 * @property {[number, number, number] | null} position_m camera frame
 * @property {[number, number][] | null} quad
 * @property {[number, number, number, number] | null} predicted
 * @property {[number, number][] | null} inlier_px
 * @property {{capture_to_vision: Known, to_command: Known}} latency_ms from the exposure to the pose
 *   alone, and from the exposure to the command
 */

/** @typedef {{t_s: number, wall: string, severity: string, part: string, text: string}} LogEvent */

/**
 * A picture as it came: its head, and the JPEG.
 * @typedef {object} Picture
 * @property {{frame: number, t_s: number, width: number, height: number, full_width: number, full_height: number, age_ms: number}} head
 * @property {Blob} jpeg
 * @property {number} received_ms of performance.now()
 */

/**
 * @typedef {object} Info
 * @property {string} version
 * @property {string} robot
 * @property {boolean} has_token whether there is a token, without which nothing can be changed
 * @property {boolean} recording
 * @property {{width: number, height: number, hfov_rad: number}} camera
 * @property {{front_m: number, rear_m: number, width_m: number}} robot_outline
 * @property {number} set_distance_m
 */

/**
 * One key of the configuration.
 * @typedef {object} Setting
 * @property {string} key
 * @property {string} section
 * @property {"number" | "integer" | "boolean" | "string" | "list"} type
 * @property {any} value in use
 * @property {any} file_value
 * @property {any} default
 * @property {number | null} min
 * @property {number | null} max
 * @property {string} unit
 * @property {boolean} live whether a new value is in use at once
 * @property {string | null} limit tighter-only or file-only
 * @property {string} [safer] smaller or larger
 * @property {string[]} [choices]
 * @property {string} effect
 */

export {};
