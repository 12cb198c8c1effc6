"""Odometry history and plausibility checks of a headless simulation."""

import math
from collections import deque
from dataclasses import replace
from typing import Deque, Optional, Tuple

from move_base_lite.plausibility import SensorMonitor
from planar import Pose2, Scan, Twist2
from sim_bridge import StepResult
from sim_bridge.sensors.odometry import Odometer

# Simulation steps for which odometry is kept, as in tf.
HISTORY_STEPS = 500


class SensorBuffer:
    """Stores odometry as tf does, and checks the sensors as move_base does.

    Args:
        patience: Time after which a goal is given up if a sensor stays implausible [s].

    Attributes:
        diagnosis: First implausibility; empty if there was none.
    """

    def __init__(self, patience: float):
        self.diagnosis = ""
        self._patience = patience
        self._watch = SensorMonitor()
        self._odometry: Deque[Tuple[float, Pose2]] = deque(maxlen=HISTORY_STEPS)
        self._implausible_since: Optional[float] = None
        self._commanded = Twist2()

    def update(self, observation: StepResult, command: Twist2) -> None:
        """Add a simulation step.

        A robot that is stopped because of a sensor is still checked against the last command before that.
        """
        if self._implausible_since is None:
            self._commanded = command
        if Odometer.name in observation.readings or not self._odometry:
            self._odometry.append((observation.stamp, observation.odometry.base_in_odom))
            self._watch.add_odometry(observation.stamp, observation.odometry.base_in_odom, self._commanded)
        if observation.scan is not None:
            scan = observation.scan
            span = scan.angle_increment * (len(scan.ranges) - 1)
            self._watch.add_scan(scan.ranges, scan.range_min, scan.range_max, span)

    def base_in_odom_at(self, stamp: float) -> Pose2:
        """Return the odometry pose that is closest to a stamp."""
        nearest, base_in_odom = math.inf, self._odometry[-1][1]
        for stamp_of, known in reversed(self._odometry):
            if abs(stamp_of - stamp) >= nearest:
                break  # stamps increase, so all earlier ones are farther away
            nearest, base_in_odom = abs(stamp_of - stamp), known
        return base_in_odom

    def move_to_present(self, scan: Scan, now: float, base_in_odom: Pose2) -> Scan:
        """Transform a delayed scan to the present pose, as move_base does."""
        if scan.stamp == now:
            return scan
        moved = base_in_odom.inverse() @ self.base_in_odom_at(scan.stamp)
        return replace(scan, laser_in_base=moved @ scan.laser_in_base)

    def implausibility(self, now: float) -> Optional[str]:
        """Return which sensor is implausible, and why; None if all are plausible."""
        implausibility = self._watch.fault(now)
        if implausibility is None:
            self._implausible_since = None
        elif self._implausible_since is None:
            self._implausible_since = now
        self.diagnosis = self.diagnosis or implausibility or ""
        return implausibility

    def is_patience_exceeded(self, now: float) -> bool:
        """Whether a sensor has been implausible for too long; restarts the interval if so."""
        if self._implausible_since is None or now - self._implausible_since <= self._patience:
            return False
        self._implausible_since = now
        return True
