"""Tap a thing in a robot's live picture and get its 3D position with an honest error bar."""

from tapreach.errors import InputError, TapreachError
from tapreach.estimation.box_extent import BoxExtent, NoExtent, box_extent
from tapreach.estimation.floor_guess import FloorGuess, FloorStatus, floor_guess
from tapreach.estimation.map_estimator import estimate_point
from tapreach.estimation.motion_prior import MountNoise
from tapreach.estimation.nuisances import NuisancePriors
from tapreach.estimation.observation import Observation
from tapreach.estimation.odometry_noise import OdometryNoise
from tapreach.estimation.point_estimate import PointEstimate, Status
from tapreach.estimation.range_posterior import RangePrior
from tapreach.estimation.tap_noise import TapNoise
from tapreach.estimation.two_tap import TwoTapEstimate, TwoTapStatus, two_tap_from_pixels
from tapreach.geometry.camera import Camera
from tapreach.geometry.pixel import ImageSize, Pixel
from tapreach.geometry.pixel_box import PixelBox
from tapreach.geometry.planar_motion import PlanarPose, PlanarStep
from tapreach.geometry.pose import camera_mount

__all__ = [
    "BoxExtent",
    "Camera",
    "FloorGuess",
    "FloorStatus",
    "ImageSize",
    "InputError",
    "MountNoise",
    "NoExtent",
    "NuisancePriors",
    "Observation",
    "OdometryNoise",
    "Pixel",
    "PixelBox",
    "PlanarPose",
    "PlanarStep",
    "PointEstimate",
    "RangePrior",
    "Status",
    "TapNoise",
    "TapreachError",
    "TwoTapEstimate",
    "TwoTapStatus",
    "box_extent",
    "camera_mount",
    "estimate_point",
    "floor_guess",
    "two_tap_from_pixels",
]
