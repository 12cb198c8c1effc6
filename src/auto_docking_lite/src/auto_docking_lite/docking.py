"""The task of docking: states, attempts, and the reasons for which it fails."""

import math
from typing import Callable, Dict, Iterator, List, Optional, Sequence, Tuple

import numpy as np

from auto_docking_lite.approach import MARGIN, ApproachMonitor, is_approach_free
from auto_docking_lite.attempts import STOP, RetriedTask
from auto_docking_lite.backing import BackingOff
from auto_docking_lite.config import DockingSettings
from auto_docking_lite.contract import (
    DockCode,
    DockDecision,
    DockInputs,
    DockResult,
    DockState,
    StagingPort,
)
from auto_docking_lite.detours import free_legs
from auto_docking_lite.estimator import DockEstimate, DockEstimator
from auto_docking_lite.motion import drive_to, follow_line, obstacles_in_base, turn_to
from auto_docking_lite.poses import staging_pose
from planar import Pose2, Twist2, wrap
from planar.driving import DriveResult
from planar.geometry.dock_field import NEAR, ROBOT_FRONT

ARRIVED = "Arrived on docking station successfully."
# Uncertainty with which the robot leaves the scan [m, rad].
SCAN_DEVIATION = 0.25, 0.35
# Angle of the scan after which any signal is enough [rad].
SCAN_ANGLE = 2.5
# Distance from the staging pose, or from the middle line, at which the approach begins [m].
STAGED = 0.06
# Heading error with which the approach begins [rad].
ALIGNED = 0.06
# Bearings of the staging poses of the attempts [rad]; bearings, and factors of the distance, of those that
# take their place.
BEARINGS = 0.0, 0.0, 0.3, -0.3, 0.5
FURTHER_BEARINGS, FACTORS = (0.0, 0.25, -0.25, 0.5, -0.5), (1.0, 1.4, 0.75)


class Docking(RetriedTask):
    """Docks the robot.

    Args:
        settings: Speeds, limits and expected field.
        navigation: Drives the robot to a distant dock or around obstacles; None for none.
        dock_in_map: Pose of the dock, if it is known.
        seed: Seed of the estimator.
    """

    def __init__(
        self,
        settings: DockingSettings,
        navigation: Optional[StagingPort],
        dock_in_map: Optional[Pose2],
        seed: int,
    ):
        super().__init__(settings)
        self._navigation, self._dock_in_map = navigation, dock_in_map
        self._estimator = DockEstimator(settings, np.random.default_rng(seed))
        self._turned, self._last_yaw, self._side = 0.0, 0.0, 0.0
        self._backing: Optional[BackingOff] = None
        self._is_sent = False
        self._monitor = ApproachMonitor(settings)
        self._handlers: Dict[DockState, Callable[[DockInputs], Optional[Twist2]]] = {
            DockState.IDLE: self._begin,
            DockState.STAGING: self._stage,
            DockState.SCAN: self._scan,
            DockState.FIND_STREAM: self._drive,
            DockState.GET_STREAM: self._drive,
            DockState.ALIGNED: self._align,
            DockState.ALIGNED_FAR: self._approach,
            DockState.ALIGNED_NEAR: self._approach,
            DockState.BUMPED: self._back_off,
            DockState.BUMPED_DOCK: self._approach,
            DockState.DOCKED_IN: self._approach,
        }

    def estimate(self) -> Optional[DockEstimate]:
        """Return the estimated pose of the dock in odom; None if nothing is known."""
        return self._estimator.estimate()

    def tick(self, inputs: DockInputs) -> DockDecision:
        """Advance by one control period."""
        expected = _expected(self._dock_in_map, inputs)
        if expected is not None and not self._estimator.has_signal:
            self._estimator.expect(expected)  # localization goes on, and the odometry drifts
        self._estimator.update(inputs.signals)
        self._turned += abs(wrap(inputs.base_in_odom.yaw - self._last_yaw))
        self._last_yaw = inputs.base_in_odom.yaw
        if inputs.charger:
            command: Optional[Twist2] = self._charge(inputs)
        else:
            self._since.pop("charging", None)
            if inputs.bumpers and self.state is not DockState.BUMPED:
                self._bump(inputs)
            command = self._handlers[self.state](inputs)
        if self._result is not None:
            self.stop()
            command = STOP
        return DockDecision(command, self.state, self._text, self._result)

    def stop(self) -> None:
        """Cancel the goal of navigation, if there is one."""
        if self._is_sent and self._navigation is not None:
            self._navigation.cancel()
        self._is_sent = False

    def _begin(self, inputs: DockInputs) -> Optional[Twist2]:
        expected = _expected(self._dock_in_map, inputs)
        if expected is not None:
            in_dock = expected.inverse() @ inputs.base_in_odom
            distance, bearing = math.hypot(in_dock.x, in_dock.y), abs(math.atan2(in_dock.y, in_dock.x))
            reach = self._settings.dock_far_range - self._settings.prior_deviation
            if distance > reach or bearing > self._settings.dock_side_half_angle:
                return self._enter(DockState.STAGING, "driving to the staging pose")
        return self._enter(DockState.SCAN, "searching for the dock")

    def _way(self, inputs: DockInputs) -> Tuple[Pose2, Optional[Sequence[Pose2]]]:
        """Return the staging pose of the present attempt in odom, and the positions on a free way to it.

        If there is no way to it, or none from it to the dock, another pose before the dock takes its place;
        the way is None if there is none to any of them.
        """
        estimate = self._estimator.estimate()
        assert estimate is not None
        obstacles = inputs.base_in_odom.transform_points(obstacles_in_base(inputs.scan))
        dock, settings = estimate.dock_in_odom, self._settings
        poses = _staging_poses(dock, settings, BEARINGS[self._attempt % len(BEARINGS)])
        for pose in _free_first(poses, lambda pose: is_approach_free(inputs, dock, pose, settings)):
            legs = free_legs(obstacles, inputs.base_in_odom, pose, settings.robot_radius)
            if legs is not None:
                return pose, legs
        return poses[0], None

    def _stage(self, inputs: DockInputs) -> Optional[Twist2]:
        """Drive to the staging pose: straight if possible, else by navigation."""
        if not self._is_sent:
            target, legs = self._way(inputs)
            if inputs.base_in_odom.distance_to(target) < STAGED:
                return self._enter(DockState.SCAN, "searching for the dock")
            # Beyond what the scan shows well, navigation knows better ways than around what is visible.
            is_far = inputs.base_in_odom.distance_to(target) > self._settings.dock_far_range
            if self._navigation is None or (legs is not None and (len(legs) == 1 or not is_far)):
                return self._straight(inputs, legs)
            if inputs.odom_in_map is None:
                return self._fail(DockCode.FAILED_TO_STAGE, "the robot's pose in the map is not known")
            self._navigation.send(inputs.odom_in_map @ target)
            self._is_sent = True
        assert self._navigation is not None
        outcome = self._navigation.outcome()
        if outcome is None:
            return None
        self._is_sent = False
        if outcome.result is DriveResult.REACHED:
            return self._enter(DockState.SCAN, "searching for the dock")
        return self._retry(DockCode.FAILED_TO_STAGE, outcome.text or outcome.status, DockState.STAGING)

    def _scan(self, inputs: DockInputs) -> Optional[Twist2]:
        """Turn until the pose of the dock is known well enough, at most once around."""
        estimate, is_around = self._estimator.estimate(), self._turned > 2.0 * math.pi
        if self._estimator.has_signal and estimate is not None:
            if self._turned > SCAN_ANGLE or _is_known(estimate, SCAN_DEVIATION):
                return self._enter(DockState.FIND_STREAM, "turning to the middle line")
        elif is_around:
            return self._not_found(inputs)
        if self._side == 0.0:
            bearing = 1.0 if estimate is None else _bearing(estimate.dock_in_odom, inputs.base_in_odom)
            self._side = math.copysign(1.0, bearing)
        return Twist2(0.0, self._side * self._settings.scan_rate)

    def _not_found(self, inputs: DockInputs) -> Optional[Twist2]:
        text = f"no signal of a dock within {self._settings.dock_far_range:g} m"
        if self._estimator.estimate() is None:
            return self._fail(DockCode.FAILED_TO_DETECT_DOCK, f"{text}; none is known to drive to")
        return self._retry(DockCode.FAILED_TO_DETECT_DOCK, text, DockState.STAGING)

    def _drive(self, inputs: DockInputs) -> Optional[Twist2]:
        """Drive to the middle line of the dock."""
        estimate, base = self._estimator.estimate(), inputs.base_in_odom
        assert estimate is not None
        in_dock, (target, legs) = estimate.dock_in_odom.inverse() @ base, self._way(inputs)
        is_before = 0.6 * self._settings.staging_distance < in_dock.x < 1.5 * self._settings.staging_distance
        is_on_line = self._attempt % len(BEARINGS) == 0 and is_before and abs(in_dock.y) < STAGED
        if base.distance_to(target) < STAGED or (
            is_on_line and is_approach_free(inputs, estimate.dock_in_odom, base, self._settings)
        ):
            return self._enter(DockState.ALIGNED, "turning to the dock")
        if legs is None and self._navigation is not None and inputs.odom_in_map:
            return self._enter(DockState.STAGING, "driving around an obstacle")
        return self._straight(inputs, legs)

    def _straight(self, inputs: DockInputs, legs: Optional[Sequence[Pose2]]) -> Optional[Twist2]:
        """Drive along straight legs; wait while there is no way."""
        if legs is None:
            return self._wait(inputs, DockCode.FAILED_TO_STAGE, "something is before the dock")
        self._since.pop("blocked", None)
        command = drive_to(inputs.base_in_odom, legs[0], self._settings)
        if self.state is not DockState.STAGING:
            self.state = DockState.GET_STREAM if command.v > 0.0 else DockState.FIND_STREAM
        return command

    def _align(self, inputs: DockInputs) -> Optional[Twist2]:
        """Turn to the dock."""
        estimate, base = self._estimator.estimate(), inputs.base_in_odom
        assert estimate is not None
        error = _bearing(estimate.dock_in_odom, base)
        if abs(error) > ALIGNED:
            return turn_to(error, self._settings)
        self._monitor = ApproachMonitor(self._settings)
        return self._enter(DockState.ALIGNED_FAR, "approaching along the middle line")

    def _approach(self, inputs: DockInputs) -> Optional[Twist2]:
        """Drive to the dock along its middle line."""
        estimate = self._estimator.estimate()
        assert estimate is not None
        in_dock = estimate.dock_in_odom.inverse() @ inputs.base_in_odom
        front = in_dock @ Pose2(ROBOT_FRONT)
        reason = self._monitor.error(inputs, front)
        if reason is not None:
            return self._retry(*reason)
        if not is_approach_free(inputs, estimate.dock_in_odom, inputs.base_in_odom, self._settings, MARGIN):
            self._monitor.pause()
            return self._wait(inputs, DockCode.FAILED_TO_CONTROL, "something is before the dock")
        self._since.pop("blocked", None)
        if self._monitor.is_stalled(inputs):
            return self._retry(DockCode.FAILED_TO_CHARGE, "no progress at the dock, which does not charge")
        is_near = any(signal & NEAR for _, signals in inputs.signals for signal in signals)
        self.state = DockState.ALIGNED_NEAR if is_near else DockState.ALIGNED_FAR
        return follow_line(in_dock, front.x, self._settings)

    def _charge(self, inputs: DockInputs) -> Twist2:
        """Stand still on the contacts until the robot has charged for a while."""
        self.state, self._text = DockState.DOCKED_IN, "charging"
        since = self._since.setdefault("charging", inputs.stamp)
        if inputs.stamp - since >= self._settings.charge_seconds - 1e-6:
            self.state, self._result = DockState.DONE, DockResult(DockCode.NONE, ARRIVED)
        elif inputs.bumpers:
            self.state = DockState.BUMPED_DOCK
        return STOP

    def _bump(self, inputs: DockInputs) -> None:
        """Back off from what the robot has touched; at the dock this is a failed attempt."""
        is_at_dock = self.state in (DockState.ALIGNED_FAR, DockState.ALIGNED_NEAR, DockState.DOCKED_IN)
        self.stop()
        if is_at_dock:
            self._retry(DockCode.FAILED_TO_CHARGE, "touched the dock, but it does not charge")
        else:
            self._retry(DockCode.FAILED_TO_CONTROL, "touched something on the way to the dock")
        self._backing = None

    def _back_off(self, inputs: DockInputs) -> Optional[Twist2]:
        self._backing = self._backing or BackingOff(inputs, self._settings)
        command = self._backing.command(inputs)
        if command is not None:
            return command
        self._backing = None
        if self._estimator.has_signal:
            return self._enter(DockState.FIND_STREAM, "turning to the middle line")
        return self._enter(DockState.SCAN, "searching for the dock")

    def _enter(self, state: DockState, text: str) -> Twist2:
        self._turned = self._side = 0.0
        return super()._enter(state, text)


def _staging_poses(dock: Pose2, settings: DockingSettings, bearing: float) -> List[Pose2]:
    """Return the staging pose at a bearing [rad], and those that may take its place, the best ones first."""
    bearings = (bearing, *FURTHER_BEARINGS)
    return [staging_pose(dock, settings, each, factor) for factor in FACTORS for each in bearings]


def _free_first(poses: Sequence[Pose2], is_free: Callable[[Pose2], bool]) -> Iterator[Pose2]:
    """Yield the free poses, then the others; each is only looked at when it is its turn."""
    others = []
    for pose in poses:
        if is_free(pose):
            yield pose
        else:
            others.append(pose)
    yield from others


def _is_known(estimate: DockEstimate, limits: Tuple[float, float]) -> bool:
    """Return whether the deviations of an estimate are within limits [m, rad]."""
    return estimate.position_deviation < limits[0] and estimate.yaw_deviation < limits[1]


def _bearing(dock: Pose2, base: Pose2) -> float:
    """Return the direction to a dock in the robot's frame [rad]."""
    return wrap(math.atan2(dock.y - base.y, dock.x - base.x) - base.yaw)


def _expected(dock_in_map: Optional[Pose2], inputs: DockInputs) -> Optional[Pose2]:
    """Return the pose of the known dock in odom; None if it, or the robot's in the map, is unknown."""
    if dock_in_map is None or inputs.odom_in_map is None:
        return None
    return inputs.odom_in_map.inverse() @ dock_in_map
