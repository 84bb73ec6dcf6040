"""Bodies of revolution as OBJ with texture coordinates and normals: radius 1, height 1, on their foot."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Profile = list[tuple[float, float, float]]
"""Points (radius, height, v) from the bottom centre to the top; v is the row of the texture, 0 below."""


def _sphere(rings: int = 12) -> Profile:
    angles = np.linspace(-np.pi / 2, np.pi / 2, rings + 1)
    return [(float(np.cos(a)), float(0.5 + 0.5 * np.sin(a)), float((a / np.pi) + 0.5)) for a in angles]


MESHES: dict[str, Profile] = {
    "can": [
        (0, 0.012, 0.01), (0.72, 0.012, 0.01), (0.78, 0, 0.01), (0.84, 0, 0.02), (1, 0.05, 0.05),
        (1, 0.93, 0.95), (0.87, 0.985, 0.97), (0.87, 1, 0.98), (0.82, 1, 0.98), (0.80, 0.975, 0.99),
        (0, 0.975, 0.99),
    ],
    "bottle": [
        (0, 0.01, 0.01), (0.85, 0, 0.01), (1, 0.03, 0.04), (1, 0.60, 0.66), (0.96, 0.66, 0.70),
        (0.70, 0.76, 0.78), (0.42, 0.84, 0.86), (0.36, 0.90, 0.91), (0.36, 0.915, 0.915), (0.44, 0.92, 0.925),
        (0.44, 0.995, 0.99), (0.40, 1, 0.99), (0, 1, 0.99),
    ],
    "cup": [
        (0, 0, 0.01), (0.74, 0, 0.01), (0.80, 0.03, 0.03), (1, 0.97, 0.44), (0.985, 1, 0.46),
        (0.95, 0.985, 0.50), (0.74, 0.08, 0.60), (0, 0.06, 0.62),
    ],
    "ball": _sphere(),
}  # fmt: skip

SEGMENTS = 28


def write_obj(path: Path, profile: Profile) -> None:
    """Turn `profile` about z and write it; edges sharper than 40° stay sharp."""
    strips = [_strip(profile, index) for index in range(len(profile) - 1)]
    with path.open("w", encoding="ascii", newline="\n") as file:
        for ends, normals in strips:
            for (radius, height, v), (along, up) in zip(ends, normals, strict=True):
                for step in range(SEGMENTS + 1):
                    angle = 2 * np.pi * step / SEGMENTS
                    c, s = np.cos(angle), np.sin(angle)
                    file.write(f"v {radius * c:.5f} {radius * s:.5f} {height:.5f}\n")
                    file.write(f"vt {step / SEGMENTS + 0.25:.5f} {v:.5f}\n")  # the front looks along -x
                    file.write(f"vn {along * c:.4f} {along * s:.4f} {up:.4f}\n")
        for index, (ends, _) in enumerate(strips):
            _write_faces(file.write, index * 2 * (SEGMENTS + 1) + 1, ends[0][0] > 0, ends[1][0] > 0)


def _strip(profile: Profile, index: int) -> tuple[Profile, list[NDArray[np.float64]]]:
    own = _normal(profile, index)
    normals = []
    for neighbour in (index - 1, index + 1):
        other = _normal(profile, neighbour) if 0 <= neighbour < len(profile) - 1 else own
        blended = own + other if float(own @ other) > np.cos(np.radians(40)) else own
        normals.append(blended / np.linalg.norm(blended))
    return profile[index : index + 2], normals


def _normal(profile: Profile, index: int) -> NDArray[np.float64]:
    (r0, h0, _), (r1, h1, _) = profile[index], profile[index + 1]
    outward = np.array([h1 - h0, r0 - r1])
    return np.asarray(outward / np.linalg.norm(outward))


def _write_faces(write: Callable[[str], object], first: int, has_bottom: bool, has_top: bool) -> None:
    for step in range(SEGMENTS):
        a, b = first + step, first + step + 1
        c, d = b + SEGMENTS + 1, a + SEGMENTS + 1
        for needed, corners in ((has_bottom, (a, b, c)), (has_top, (a, c, d))):
            if needed:
                write("f " + " ".join(f"{k}/{k}/{k}" for k in corners) + "\n")


def write_box(path: Path) -> None:
    """Write a cube of edge 2 about the origin whose texture stands upright on all four sides."""
    up = np.array([0.0, 0.0, 1.0])
    faces = [(np.array(side, dtype=float), up) for side in ((-1, 0, 0), (0, 1, 0), (1, 0, 0), (0, -1, 0))]
    faces += [(up, np.array([1.0, 0, 0])), (-up, np.array([1.0, 0, 0]))]
    with path.open("w", encoding="ascii", newline="\n") as file:
        for outward, top in faces:
            right = np.cross(top, outward)
            for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                x, y, z = outward + s * right + t * top
                file.write(f"v {x:g} {y:g} {z:g}\nvt {(s + 1) / 2:g} {(t + 1) / 2:g}\n")
                file.write(f"vn {outward[0]:g} {outward[1]:g} {outward[2]:g}\n")
        for face in range(6):
            a, b, c, d = (4 * face + k for k in (1, 2, 3, 4))
            file.write(f"f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}\nf {a}/{a}/{a} {c}/{c}/{c} {d}/{d}/{d}\n")
