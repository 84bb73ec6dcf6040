"""Two views of one thing, before and after the robot turned 5 degrees left and drove 30 cm. Where is it?"""

import numpy as np

from tapreach import (
    Camera,
    ImageSize,
    Observation,
    OdometryNoise,
    Pixel,
    PlanarPose,
    PlanarStep,
    camera_mount,
    estimate_point,
)

camera = Camera(ImageSize(640, 480), fx=600.0, fy=600.0, cx=319.5, cy=239.5)
base_from_camera = camera_mount((0.10, 0.0, 0.25), pitch=np.radians(10.0))

start = PlanarPose()
end = start.after(PlanarStep(turn=np.radians(5.0), advance=0.30))
views = [
    Observation(Pixel(319.5, 198.8), 0.5, camera, start.to_rigid(), base_from_camera),
    Observation(Pixel(390.6, 216.5), 0.5, camera, end.to_rigid(), base_from_camera),
]

estimate = estimate_point(views, OdometryNoise())
print(estimate.status, estimate.reason)
print("from the first camera [m]:", estimate.range, "95 %:", estimate.range_interval_95)
print("in the world [m]:", estimate.point_in_world)
print(estimate.advice)
