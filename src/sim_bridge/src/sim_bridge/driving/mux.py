"""Velocity multiplexer (yocs_cmd_vel_mux) and velocity smoother (yocs_velocity_smoother)."""

import math
from dataclasses import dataclass
from typing import Dict, Mapping, Optional, Sequence, Tuple

from planar import SettingsError, Twist2
from planar.config.yaml_table import Table, parse_table, read_table

IDLE = "idle"
# Time without a command after which the smoother brakes [s].
INPUT_TIMEOUT = 0.5


@dataclass(frozen=True)
class MuxInput:
    """An input of the multiplexer (an entry of ``subscribers`` of yocs_cmd_vel_mux).

    Attributes:
        name: Name of the input.
        topic: Topic of its commands.
        timeout: Time without a command after which the input is inactive [s].
        priority: The active input with the highest value wins.
    """

    name: str
    topic: str
    timeout: float
    priority: int


# As in turtlebot_bringup's mux.yaml.
TURTLEBOT_INPUTS: Tuple[MuxInput, ...] = (
    MuxInput("Safe reactive controller", "input/safety_controller", 0.2, 10),
    MuxInput("Teleoperation", "input/teleop", 1.0, 7),
    MuxInput("Switch", "input/switch", 1.0, 6),
    MuxInput("Navigation", "input/navi", 1.0, 5),
)


def read_inputs(path) -> Tuple[MuxInput, ...]:
    """Read the inputs of a file in the format of yocs_cmd_vel_mux.

    Raises:
        SettingsError: The file cannot be used; the text names file and line.
    """
    return _inputs_of(read_table(path), str(path))


def parse_inputs(text: str, source: str) -> Tuple[MuxInput, ...]:
    """Read the inputs of a text in the format of yocs_cmd_vel_mux.

    Args:
        text: The YAML text.
        source: Name of the text in errors.

    Raises:
        SettingsError: The text cannot be used; the error names source and line.
    """
    return _inputs_of(parse_table(text, source), source)


def _inputs_of(table: Table, source: str) -> Tuple[MuxInput, ...]:
    inputs = tuple(
        MuxInput(one.text("name"), one.text("topic"), one.number("timeout"), round(one.number("priority")))
        for one in table.tables("subscribers")
    )
    if not inputs:
        raise SettingsError(f"{source}: subscribers is missing or empty")
    if len({one.priority for one in inputs}) < len(inputs):
        raise SettingsError(f"{source}: subscribers: two have the same priority")
    return inputs


class VelocityMux:
    """Forwards the commands of the input with the highest priority that has not timed out (yocs_cmd_vel_mux).

    Args:
        inputs: The inputs, in any order.
    """

    def __init__(self, inputs: Sequence[MuxInput]):
        self.inputs = tuple(sorted(inputs, key=lambda one: -one.priority))
        self._last_received: Dict[str, float] = {}

    def choose(self, now: float, arrived: Mapping[str, Twist2]) -> Optional[Twist2]:
        """Return the command to forward; None if there is none.

        Args:
            now: Simulated time [s].
            arrived: Newest command of each input, by name, since the last call.
        """
        self._last_received.update(dict.fromkeys(arrived, now))
        return arrived.get(self.active(now))

    def active(self, now: float) -> str:
        """Return the name of the active input at a simulated time [s], or ``idle``."""
        for one in self.inputs:
            received = self._last_received.get(one.name)
            if received is not None and 0.0 <= now - received < one.timeout:
                return one.name
        return IDLE


@dataclass(frozen=True)
class VelocityLimits:
    """Limits of the smoother, by default those of turtlebot_bringup; named as in yocs_velocity_smoother.

    Attributes:
        speed_lim_v: Speed [m/s].
        speed_lim_w: Turn rate [rad/s].
        accel_lim_v: Acceleration [m/s^2].
        accel_lim_w: Angular acceleration [rad/s^2].
        decel_factor: Ratio of the deceleration limits to the acceleration limits.
    """

    speed_lim_v: float = 0.8
    speed_lim_w: float = 5.4
    accel_lim_v: float = 1.0
    accel_lim_w: float = 2.0
    decel_factor: float = 1.5


class VelocitySmoother:
    """Limits speed and acceleration of commands, and brakes after the last one (yocs_velocity_smoother).

    Update it at every step of time, so that the velocity does not jump after a pause between two commands.

    Args:
        limits: Limits of speed and acceleration.
    """

    def __init__(self, limits: VelocityLimits = VelocityLimits()):
        self._limits = limits
        self._last = Twist2()
        self._target: Optional[Twist2] = None
        self._received_at = self._now = math.inf

    def set_target(self, command: Twist2, now: float) -> None:
        """Set the velocity to reach.

        Args:
            command: The received command.
            now: Simulated time of its arrival [s].
        """
        self._target, self._received_at = command, now

    def command(self, now: float) -> Optional[Twist2]:
        """Return the smoothed command; None after the robot has stopped.

        A target that is not finite is passed on unchanged.

        Args:
            now: Simulated time [s].
        """
        seconds, self._now = now - self._now, now
        if self._target is None:
            return None
        if not self._target.is_finite():
            target, self._target, self._last = self._target, None, Twist2()
            return target
        if seconds < 0.0:  # time was reset
            self._last, self._received_at, seconds = Twist2(), now, 0.0
        has_timed_out = now - self._received_at > INPUT_TIMEOUT
        target, limits = Twist2() if has_timed_out else self._target, self._limits
        self._last = Twist2(
            self._approach(self._last.v, target.v, limits.speed_lim_v, limits.accel_lim_v * seconds),
            self._approach(self._last.omega, target.omega, limits.speed_lim_w, limits.accel_lim_w * seconds),
        )
        if has_timed_out and self._last == Twist2():
            self._target = None
        return self._last

    def _approach(self, last: float, target: float, limit: float, step: float) -> float:
        target = max(-limit, min(limit, target))
        if abs(target) < abs(last) or target * last < 0.0:
            step *= self._limits.decel_factor
        return last + max(-step, min(step, target - last))
