"""Writes a small dataset folder for tests of the programs."""

import cv2
import numpy as np

WIDTH, HEIGHT = 48, 32

CALIBRATION = """image_width: {width}
image_height: {height}
camera_name: {name}
camera_matrix: {{rows: 3, cols: 3, data: [50, 0, 24, 0, 51, 16, 0, 0, 1]}}
distortion_model: plumb_bob
distortion_coefficients: {{rows: 1, cols: 5, data: [-0.1, 0.01, 0.001, -0.001, 0.002]}}
rectification_matrix: {{rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}}
projection_matrix: {{rows: 3, cols: 4, data: [50, 0, 24, {shift}, 0, 50, 16, 0, 0, 0, 1, 0]}}
"""

HEADER = ("stamp_s,left,right,height_m,approach_angle_deg,foe_u_px,foe_v_px,speed_m_s,pitch_deg,roll_deg,yaw_deg,"
          "x_m,y_m")
ROWS = ["1700000000.123456789,a.png,a.png,12.5,,,,,-5,1.5,-2,-100,0.25",
        "1700000000.2,b.png,b.png,12.25,3,26,18.5,20,,1,-2,-99,0.5"]


def picture(seed):
    return np.random.RandomState(seed).randint(0, 256, (HEIGHT, WIDTH)).astype(np.uint8)


def write_dataset(folder, header=HEADER, rows=tuple(ROWS)):
    """Writes two frames. left/a.png is picture(0), left/b.png picture(1), right/a.png picture(2), right/b.png picture(3)."""
    for number, side in enumerate(("left", "right")):
        (folder / side).mkdir(parents=True, exist_ok=True)
        (folder / f"{side}.yaml").write_text(
            CALIBRATION.format(width=WIDTH, height=HEIGHT, name=side, shift=-25 * number))
        for i, name in enumerate("ab"):
            cv2.imwrite(str(folder / side / f"{name}.png"), picture(2 * number + i))
    (folder / "frames.csv").write_text("\n".join([header, *rows]) + "\n")
