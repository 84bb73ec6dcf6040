"""Textures and materials of a MuJoCo model, made when first asked for."""

from dataclasses import dataclass, field
from pathlib import Path

import mujoco

from tapreach.resources import resource_path


@dataclass
class Palette:
    """Hands out material names for a model under construction."""

    spec: mujoco.MjSpec
    folder: Path = field(default_factory=lambda: resource_path("models") / "assets")

    def flat(self, colour: str, emission: float = 0.0) -> str:
        """Return a material of one colour, "#rrggbb" or "#rrggbbaa"."""
        name = f"flat{colour}{emission:g}"
        if self.spec.material(name) is None:
            digits = [int(colour[i : i + 2], 16) / 255 for i in range(1, len(colour), 2)]
            rgba = [*digits, 1.0][:4]
            self.spec.add_material(name=name, rgba=rgba, specular=0.1, shininess=0.2, emission=emission)
        return name

    def surface(self, texture: str, repeat: tuple[float, float] = (1.0, 1.0), per_metre: bool = False) -> str:
        """Return a material with a flat texture, laid along the geom's z; `repeat` per metre or per geom."""
        return self._textured(texture, mujoco.mjtTexture.mjTEXTURE_2D, repeat, per_metre)

    def cube(self, texture: str) -> str:
        """Return a material that shows the whole texture on each face of a box."""
        return self._textured(texture, mujoco.mjtTexture.mjTEXTURE_CUBE, (1.0, 1.0), False)

    def glowing(self, texture: str, emission: float) -> str:
        """Return a material that shines by itself, as a window does."""
        return self._textured(texture, mujoco.mjtTexture.mjTEXTURE_2D, (1.0, 1.0), False, emission)

    def mesh(self, name: str, file: str, scale: tuple[float, float, float]) -> str:
        """Add the mesh `file` in a size of its own and return its name; it is seen, never touched."""
        shell = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
        self.spec.add_mesh(name=name, file=str(self.folder / f"{file}.obj"), scale=scale, inertia=shell)
        return name

    def _textured(
        self,
        texture: str,
        kind: mujoco.mjtTexture,
        repeat: tuple[float, float],
        per_metre: bool,
        emission: float = 0.0,
    ) -> str:
        texture_name = f"{texture}_{int(kind)}"
        if self.spec.texture(texture_name) is None:
            self.spec.add_texture(name=texture_name, type=kind, file=str(self.folder / f"{texture}.png"))
        name = f"{texture_name}_{repeat[0]:g}_{repeat[1]:g}_{per_metre}_{emission:g}"
        if self.spec.material(name) is None:
            material = self.spec.add_material(
                name=name,
                texrepeat=repeat,
                texuniform=per_metre,
                specular=0.08,
                shininess=0.3,
                emission=emission,
            )
            material.textures[mujoco.mjtTextureRole.mjTEXROLE_RGB] = texture_name
        return name
