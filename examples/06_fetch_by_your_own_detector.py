"""Bring your own detector: the reddest spot of the newest picture, and whether the robot could fetch it.

Start a robot first with `tapreach run`; the address it prints may be given. With mode="go" it is fetched.
"""

import sys

import cv2

from tapreach.client.sync import connect

with connect(*sys.argv[1:]) as robot:
    shot = robot.snapshot()
    blue, green, red = cv2.split(cv2.GaussianBlur(shot.picture().astype("float32"), (0, 0), 4))
    _, _, _, (u, v) = cv2.minMaxLoc(red - cv2.max(green, blue))
    print(f"reddest in frame {shot.frame_id}: {u}, {v}")
    result = robot.fetch(shot.frame_id, u, v, mode="plan", on_phase=lambda at: print(at.phase, at.why))
    print(result.status, result.reason)
