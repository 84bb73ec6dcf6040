"""A box around a thing in one picture, and where the thing is: its width and height."""

import math

from tapreach import BoxExtent, Camera, ImageSize, PixelBox, box_extent, camera_mount

camera = Camera(ImageSize(640, 480), fx=600, fy=600, cx=319.5, cy=239.5)
world_from_camera = camera_mount((0.10, 0.0, 0.15), pitch=math.radians(10))
point, covariance = (0.92, 0.0, 0.06), [[4e-4, 0.0, 0.0], [0.0, 1e-5, 0.0], [0.0, 0.0, 1e-5]]
found = box_extent(PixelBox(294, 156, 345, 241), camera, world_from_camera, point, covariance)
if isinstance(found, BoxExtent):
    for name, size, sd in (("wide", found.width, found.width_sd), ("high", found.height, found.height_sd)):
        print(f"{100 * size:.1f} cm {name} ± {196 * sd:.1f} (95 %)")
else:
    print(found.reason)
