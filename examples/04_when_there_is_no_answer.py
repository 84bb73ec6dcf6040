"""No answer is an answer: driving straight at a thing gives no parallax, and the estimate says so."""

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
ahead = PlanarPose().after(PlanarStep(turn=0.0, advance=0.20))
views = [
    Observation(Pixel(319.5, 239.5), 1.0, camera, pose.to_rigid(), camera_mount((0.10, 0.0, 0.15)))
    for pose in (PlanarPose(), ahead)
]
estimate = estimate_point(views, OdometryNoise())
print(estimate.status, "because of", estimate.reason)
print("advice:", estimate.advice)
