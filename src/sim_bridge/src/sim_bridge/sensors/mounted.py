"""The cameras and inertial sensors of a robot, which measure when they are asked to."""

import math
from dataclasses import replace
from typing import Sequence

import numpy as np

from sim_bridge.config import SimulationSettings
from sim_bridge.description.profile import CameraProfile, ImuProfile, RobotProfile
from sim_bridge.physics.engine import Motion
from sim_bridge.sensors.camera import Camera, CameraSettings, DepthCameraSettings, Picture
from sim_bridge.sensors.imu import Imu, ImuReading, ImuSettings

# Streams of random numbers: those of odometry and range finders come before.
CAMERA_STREAM, IMU_STREAM = 100, 200


class MountedSensors:
    """``seed``: of their noise, as that of the robot's other sensors."""

    def __init__(self, profile: RobotProfile, settings: SimulationSettings, seed: Sequence[int]):
        self._profile = profile
        self._cameras = [
            Camera(_errors_of(camera, settings), np.random.default_rng([*seed, CAMERA_STREAM + number]))
            for number, camera in enumerate(profile.cameras)
        ]
        self._imus = [
            Imu(_imu_settings(imu, settings), np.random.default_rng([*seed, IMU_STREAM + number]))
            for number, imu in enumerate(profile.imus)
        ]

    def picture(
        self, number: int, triangles_xyz: np.ndarray, shades: np.ndarray, base_in_world: np.ndarray
    ) -> Picture:
        """Of the robot's camera of that number (see sim_bridge.views.drawing); ``base_in_world``: (4, 4)."""
        pose = base_in_world @ self._profile.cameras[number].pose_in_base
        return self._cameras[number].measure(triangles_xyz, shades, pose)

    def inertia(self, number: int, sensor: Motion, seconds: float, gravity: float) -> ImuReading:
        """Of the inertial sensor of that number, moving as ``sensor``, ``seconds`` after the last reading."""
        return self._imus[number].measure(sensor, seconds, gravity)


def _errors_of(camera: CameraProfile, settings: SimulationSettings) -> CameraSettings:
    if isinstance(camera.settings, DepthCameraSettings):
        return replace(camera.settings, noise=settings.colour_noise, depth_noise=settings.depth_noise)
    return replace(camera.settings, noise=settings.colour_noise)


def _imu_settings(imu: ImuProfile, settings: SimulationSettings) -> ImuSettings:
    """White noise of the turn rate is stronger the shorter it is looked at."""
    rate = imu.rate or settings.odometry_rate
    turn_noise, acceleration_noise = settings.gyro_noise * math.sqrt(rate), settings.acceleration_noise
    if imu.noise is not None and turn_noise > 0.0:  # else sensors are meant to be ideal
        turn_noise = acceleration_noise = imu.noise
    return ImuSettings(turn_noise, settings.gyro_bias, acceleration_noise)
