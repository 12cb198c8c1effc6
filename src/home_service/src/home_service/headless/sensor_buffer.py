"""What a rehearsed robot feels, and whether it can be so."""

import math
from collections import deque
from dataclasses import replace
from typing import Deque, Optional, Tuple

from move_base_lite.plausibility import SensorMonitor
from planar import Pose2, Scan, Twist2
from sim_bridge import StepResult
from sim_bridge.sensors.odometry import Odometer

# Steps of the simulation for which odometry is remembered, as tf does.
HISTORY_STEPS = 500


class SensorBuffer:
    """Keeps odometry, as tf does, and watches over the sensors, as move_base does.

    ``patience``: seconds of a sensor that cannot be trusted, after which a goal is given up.
    ``diagnosis``: the first complaint.
    """

    def __init__(self, patience: float):
        self.diagnosis = ""
        self._patience = patience
        self._watch = SensorMonitor()
        self._odometry: Deque[Tuple[float, Pose2]] = deque(maxlen=HISTORY_STEPS)
        self._implausible_since: Optional[float] = None
        self._commanded = Twist2()

    def update(self, observation: StepResult, command: Twist2) -> None:
        """Takes in a step; a robot that is stopped for a sensor is still told to go on."""
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
        """Where odometry had the robot at a time, or as near to it as is remembered."""
        nearest, base_in_odom = math.inf, self._odometry[-1][1]
        for stamp_of, known in reversed(self._odometry):
            if abs(stamp_of - stamp) >= nearest:
                break  # stamps rise, so that all before are farther off
            nearest, base_in_odom = abs(stamp_of - stamp), known
        return base_in_odom

    def move_to_present(self, scan: Scan, now: float, base_in_odom: Pose2) -> Scan:
        """A scan that comes late, as if taken from the present pose: what move_base makes of it."""
        if scan.stamp == now:
            return scan
        moved = base_in_odom.inverse() @ self.base_in_odom_at(scan.stamp)
        return replace(scan, laser_in_base=moved @ scan.laser_in_base)

    def implausibility(self, now: float) -> Optional[str]:
        """Which sensor cannot be trusted; None if all can."""
        complaint = self._watch.fault(now)
        if complaint is None:
            self._implausible_since = None
        elif self._implausible_since is None:
            self._implausible_since = now
        self.diagnosis = self.diagnosis or complaint or ""
        return complaint

    def is_patience_exceeded(self, now: float) -> bool:
        """Whether a sensor has been wrong for too long; asked anew afterwards."""
        if self._implausible_since is None or now - self._implausible_since <= self._patience:
            return False
        self._implausible_since = now
        return True
