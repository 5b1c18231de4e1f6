"""Pictures of a chessboard, to calibrate from: a pinhole camera without distortion looks at a board in several poses."""
import math

COLUMNS, ROWS = 9, 6  # inner corners
SQUARE_M = 0.025
SAMPLES = 2           # a pixel's side: grey edges, as a camera has them


def _rotation(tilt_rad, turn_rad, roll_rad):
    """Rows of R_camera_from_board: about x by tilt, about y by turn, about z by roll."""
    cx, sx, cy, sy, cz, sz = (f(a) for a in (tilt_rad, turn_rad, roll_rad) for f in (math.cos, math.sin))
    return [[cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx],
            [sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx],
            [-sy, cy * sx, cy * cx]]


def _grey(x_m, y_m):
    """The brightness of the board, its white margin and the grey wall at a point; the origin is the board's middle."""
    column, row = x_m / SQUARE_M + (COLUMNS + 1) / 2, y_m / SQUARE_M + (ROWS + 1) / 2
    if 0 <= column < COLUMNS + 1 and 0 <= row < ROWS + 1:
        return 20 if (int(column) + int(row)) % 2 else 230
    near = -0.6 < column < COLUMNS + 1.6 and -0.6 < row < ROWS + 1.6
    return 230 if near else 110


def picture(width_px, height_px, focal_px, pose):
    """Returns a PGM. pose: tilt, turn, roll in rad; x, y, z of the board's middle in m."""
    R, (tx, ty, tz) = _rotation(*pose[:3]), pose[3:]
    # A ray d meets the board's plane z = 0 where R^T (s d - t) has no third component.
    normal = [R[0][2], R[1][2], R[2][2]]
    distance = normal[0] * tx + normal[1] * ty + normal[2] * tz
    pixels = bytearray()
    step = 1.0 / SAMPLES
    for row in range(height_px):
        for column in range(width_px):
            total = 0
            for sample in range(SAMPLES * SAMPLES):
                dx = (column - 0.5 + step * (sample % SAMPLES + 0.5) - (width_px - 1) / 2) / focal_px
                dy = (row - 0.5 + step * (sample // SAMPLES + 0.5) - (height_px - 1) / 2) / focal_px
                s = distance / (normal[0] * dx + normal[1] * dy + normal[2])
                px, py, pz = s * dx - tx, s * dy - ty, s - tz
                total += _grey(R[0][0] * px + R[1][0] * py + R[2][0] * pz, R[0][1] * px + R[1][1] * py + R[2][1] * pz)
            pixels.append(total // (SAMPLES * SAMPLES))
    return f"P5\n{width_px} {height_px}\n255\n".encode() + bytes(pixels)


def poses():
    """Boards tilted in every direction, also in the picture's corners."""
    return [(0.0, 0.0, 0.0, 0.0, 0.0, 0.36), (0.5, 0.0, 0.05, 0.0, 0.0, 0.38), (-0.5, 0.0, -0.05, 0.0, 0.0, 0.38),
            (0.0, 0.5, 0.0, 0.0, 0.0, 0.38), (0.0, -0.5, 0.1, 0.0, 0.0, 0.38), (0.3, 0.4, 0.0, 0.08, 0.02, 0.45),
            (-0.3, 0.4, 0.0, -0.08, 0.02, 0.45), (0.3, -0.4, 0.0, 0.08, -0.02, 0.45), (-0.3, -0.4, 0.1, -0.08, -0.02, 0.45),
            (0.4, 0.3, 0.3, 0.0, 0.0, 0.42)]
