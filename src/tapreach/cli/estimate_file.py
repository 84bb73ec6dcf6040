"""The file of `tapreach estimate`, validated: cameras, views, and what is known of the motion.

Lengths in metres, angles in radians, pixels with (0, 0) in the centre of the top-left pixel.
"""

from typing import Annotated, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, model_validator
from scipy.spatial.transform import RigidTransform

from tapreach.errors import InputError
from tapreach.estimation.motion_prior import Motion, MountNoise
from tapreach.estimation.nuisances import NuisancePriors
from tapreach.estimation.observation import Observation
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.range_posterior import RangePrior
from tapreach.estimation.tap_noise import TapNoise
from tapreach.geometry.camera import Camera
from tapreach.geometry.pixel import ImageSize, Pixel
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.geometry.pose import camera_mount, pose_from_matrix

Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]
Row = tuple[float, float, float, float]
Matrix = tuple[Row, Row, Row, Row]


class Part(BaseModel):
    """A part of the file: unknown keys and numbers that are not finite are errors."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class CameraPart(Part):
    """A camera: size of its pictures and intrinsics [px]; distortion k1, k2, p1, p2, k3 of OpenCV."""

    width: int = Field(gt=0)
    height: int = Field(gt=0)
    fx: Positive
    fy: Positive
    cx: float
    cy: float
    distortion: tuple[float, float, float, float, float] = (0.0, 0.0, 0.0, 0.0, 0.0)

    def camera(self) -> Camera:
        """Return the camera."""
        return Camera(ImageSize(self.width, self.height), self.fx, self.fy, self.cx, self.cy, self.distortion)


class MountPart(Part):
    """Where the camera sits on the base [m, rad]: pitch positive looks down, yaw left, roll leans right."""

    position: tuple[float, float, float]
    pitch: float = 0.0
    yaw: float = 0.0
    roll: float = 0.0


class StepPart(Part):
    """From the view before to this one: turn on the spot [rad, left], then advance [m]."""

    turn: float
    advance: float


class ViewPart(Part):
    """One sighting. Its pose is one of: world_from_camera, world_from_base (4 × 4), or step.

    The first view needs none when the others are steps: it then stands at the origin.
    """

    camera: str
    pixel: tuple[float, float]
    sigma_px: Positive = 1.0
    world_from_camera: Matrix | None = None
    world_from_base: Matrix | None = None
    step: StepPart | None = None

    @model_validator(mode="after")
    def _one_pose(self) -> Self:
        given = [self.world_from_camera, self.world_from_base, self.step]
        if sum(pose is not None for pose in given) > 1:
            raise ValueError("give only one of world_from_camera, world_from_base and step")
        return self


class OdometryPart(Part):
    """Standard deviations of wheel odometry; see docs/estimation.md, section 3."""

    advance_per_sqrt_m: NotNegative = 0.0
    turn_per_sqrt_rad: NotNegative = 0.0
    turn_per_sqrt_m: NotNegative = 0.0
    slip_per_sqrt_m: NotNegative = 0.0
    advance_fraction: NotNegative = 0.0
    turn_fraction: NotNegative = 0.0
    advance_scale: NotNegative = 0.0
    turn_scale: NotNegative = 0.0


class MountNoisePart(Part):
    """One sigma of the mount's position [m] and angles [rad], one error for all views."""

    position_sigma: NotNegative = 0.0
    angle_sigma: NotNegative = 0.0


class NuisancesPart(Part):
    """One sigma of what is taken as known and is not quite, one error for all views; docs/estimation.md, 3.

    focal_scale, turn_scale, distance_scale are fractions; lever [m] of each coordinate of the camera on the
    base; yaw, pitch, roll [rad] of the camera on the base.
    """

    focal_scale: NotNegative = 0.0
    turn_scale: NotNegative = 0.0
    distance_scale: NotNegative = 0.0
    lever: NotNegative = 0.0
    yaw: NotNegative = 0.0
    pitch: NotNegative = 0.0
    roll: NotNegative = 0.0


class TapNoisePart(Part):
    """How the errors of the taps hang together: correlation of each with the one before, and one sigma of an
    error that all share [px].
    """

    correlation: float = Field(0.0, gt=-1.0, lt=1.0)
    shared_bias_px: NotNegative = 0.0


class RangePriorPart(Part):
    """Ranges [m] that are possible at all; the odds over their logarithm go as range^-falloff: 1 for even
    odds over the inverse range, 0 for even odds over the logarithm.
    """

    nearest: Positive = 0.05
    farthest: Positive = 100.0
    falloff: NotNegative = 1.0


class EstimateFile(Part):
    """Cameras by name, views in the order of time, and at most one of odometry and pose_covariance.

    pose_covariance: 6n × 6n, of the poses given (base or camera), tangent order (translation, rotation),
    right perturbation. Without either the poses are taken as exact.
    """

    cameras: dict[str, CameraPart] = Field(min_length=1)
    views: list[ViewPart] = Field(min_length=1)
    mount: MountPart | None = None
    odometry: OdometryPart | None = None
    pose_covariance: list[list[float]] | None = None
    mount_noise: MountNoisePart | None = None
    nuisances: NuisancesPart | None = None
    tap_noise: TapNoisePart | None = None
    range_prior: RangePriorPart = RangePriorPart()

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        if self.odometry is not None and self.pose_covariance is not None:
            raise ValueError("give only one of odometry and pose_covariance")
        if self.odometry is not None and any(view.world_from_camera is not None for view in self.views):
            raise ValueError("odometry moves the base: give world_from_base or step, not world_from_camera")
        for view in self.views:
            if view.camera not in self.cameras:
                raise ValueError(
                    f"unknown camera {view.camera!r}; known are {', '.join(sorted(self.cameras))}"
                )
        return self

    def observations(self) -> list[Observation]:
        """Return the views as observations. Raises InputError for poses and pixels that cannot be."""
        cameras = {name: part.camera() for name, part in self.cameras.items()}
        mount = self._base_from_camera()
        observations, base = [], PlanarPose()
        for index, view in enumerate(self.views):
            base = base.after(PlanarStep(view.step.turn, view.step.advance)) if view.step else base
            try:
                world_from_base, base_from_camera = self._pose(index, view, base, mount)
                observations.append(
                    Observation(
                        Pixel(*view.pixel),
                        view.sigma_px,
                        cameras[view.camera],
                        world_from_base,
                        base_from_camera,
                    )
                )
            except InputError as error:
                raise InputError(f"views.{index}: {error}") from None
        return observations

    def motion(self) -> Motion:
        """Return what is known of the motion, as `estimate_point` takes it."""
        if self.odometry is not None:
            return OdometryNoise(**self.odometry.model_dump())
        if self.pose_covariance is None:
            return None
        size = 6 * len(self.views)
        if [len(row) for row in self.pose_covariance] != [size] * size:
            raise InputError(
                f"pose_covariance must have {size} rows of {size} numbers for {len(self.views)} views"
            )
        return self.pose_covariance

    def mount_sigmas(self) -> MountNoise | None:
        """Return the mount's noise."""
        return MountNoise(**self.mount_noise.model_dump()) if self.mount_noise is not None else None

    def nuisance_priors(self) -> NuisancePriors | None:
        """Return the further things that may be off."""
        return NuisancePriors(**self.nuisances.model_dump()) if self.nuisances is not None else None

    def taps(self) -> TapNoise | None:
        """Return how the errors of the taps hang together."""
        return TapNoise(**self.tap_noise.model_dump()) if self.tap_noise is not None else None

    def prior(self) -> RangePrior:
        """Return the ranges that are possible."""
        return RangePrior(**self.range_prior.model_dump())

    def _base_from_camera(self) -> RigidTransform:
        if self.mount is None:
            return RigidTransform.identity()
        return camera_mount(self.mount.position, self.mount.pitch, self.mount.yaw, self.mount.roll)

    def _pose(
        self, index: int, view: ViewPart, base: PlanarPose, mount: RigidTransform
    ) -> tuple[RigidTransform, RigidTransform]:
        if view.world_from_camera is not None:
            return pose_from_matrix(view.world_from_camera), RigidTransform.identity()
        if self.mount is None:
            raise InputError(
                "a pose of the base needs the mount of the camera; give mount, or world_from_camera"
            )
        if view.world_from_base is not None:
            return pose_from_matrix(view.world_from_base), mount
        if view.step is None and index > 0:
            raise InputError("no pose; give world_from_camera, world_from_base or step")
        return base.to_rigid(), mount


def read_estimate_file(name: str, text: str) -> EstimateFile:
    """Return the validated file. Raises InputError, one paragraph naming the place and what is right."""
    try:
        return EstimateFile.model_validate_json(text)
    except ValidationError as error:
        problems = [
            f"{'.'.join(str(part) for part in each['loc']) or 'file'}: {each['msg']}"
            for each in error.errors()
        ]
        shown = "; ".join(problems[:4]) + (f"; and {len(problems) - 4} more" if len(problems) > 4 else "")
        raise InputError(f"{name}: {shown}. See docs/estimate-file.md or --schema") from None
