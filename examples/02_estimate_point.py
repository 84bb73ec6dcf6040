"""The same with a pitched camera ahead of the axis and wheels that slip: a position with an honest region."""

import math

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

camera = Camera(ImageSize(640, 480), fx=600, fy=600, cx=319.5, cy=239.5)
base_from_camera = camera_mount((0.10, 0.0, 0.15), pitch=math.radians(10))
start = PlanarPose()
end = start.after(PlanarStep(turn=math.radians(12), advance=0.20))
views = [
    Observation(Pixel(319.5, 269.5), 1.0, camera, start.to_rigid(), base_from_camera),
    Observation(Pixel(491.6, 307.8), 1.0, camera, end.to_rigid(), base_from_camera),
]
estimate = estimate_point(views, OdometryNoise())
print(estimate.status, estimate.reason)
print("in the world:", estimate.point_in_world, "95 % range:", estimate.range_interval_95)
print("advice:", estimate.advice)
