"""Where is it? Two tapped pixels, a turn and an advance between them, by the paper's closed form."""

import math

from tapreach import Camera, ImageSize, Pixel, PlanarStep, two_tap_from_pixels

camera = Camera.from_fov(ImageSize(960, 720), math.radians(44.6))
step = PlanarStep(turn=math.radians(12), advance=0.20)
estimate = two_tap_from_pixels(camera, Pixel(479.5, 420), Pixel(800, 425), step)
print(estimate.status, estimate.reason)
if estimate.position is not None:
    print(f"{estimate.position.distance:.3f} m away; {estimate.position.in_second.round(3)} m from here")
