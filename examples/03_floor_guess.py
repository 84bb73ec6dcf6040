"""One tap on the foot of a thing: where it stands, if it stands on the floor."""

import math

from tapreach import Camera, ImageSize, Pixel, camera_mount, floor_guess

camera = Camera(ImageSize(640, 480), fx=600, fy=600, cx=319.5, cy=239.5)
guess = floor_guess(Pixel(350, 300), camera, camera_mount((0.10, 0.0, 0.15), pitch=math.radians(10)))
print(guess.status, guess.reason, guess.point_in_base)
