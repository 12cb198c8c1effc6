"""Which of several sources of velocity drives a robot (yocs_cmd_vel_mux), and how fast it may change."""

import math
from dataclasses import dataclass
from typing import Dict, Mapping, Optional, Sequence, Tuple

from planar import SettingsError, Twist2
from planar.config.yaml_table import Table, parse_table, read_table

IDLE = "idle"
# Seconds without a command after which the smoother brakes.
SILENCE = 0.5


@dataclass(frozen=True)
class MuxInput:
    """A source; the one with the highest ``priority`` drives, until it is silent for ``timeout`` seconds."""

    name: str
    topic: str
    timeout: float
    priority: int


# turtlebot_bringup's mux.yaml.
TURTLEBOT_INPUTS: Tuple[MuxInput, ...] = (
    MuxInput("Safe reactive controller", "input/safety_controller", 0.2, 10),
    MuxInput("Teleoperation", "input/teleop", 1.0, 7),
    MuxInput("Switch", "input/switch", 1.0, 6),
    MuxInput("Navigation", "input/navi", 1.0, 5),
)


def read_inputs(path) -> Tuple[MuxInput, ...]:
    """The inputs of a file in the format of yocs_cmd_vel_mux. Raises SettingsError naming file and line."""
    return _inputs_of(read_table(path), str(path))


def parse_inputs(text: str, source: str) -> Tuple[MuxInput, ...]:
    """The same of a text, which errors call ``source``."""
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
    """Passes on what the most important source says that is not silent."""

    def __init__(self, inputs: Sequence[MuxInput]):
        self.inputs = tuple(sorted(inputs, key=lambda one: -one.priority))
        self._heard: Dict[str, float] = {}

    def choose(self, now: float, arrived: Mapping[str, Twist2]) -> Optional[Twist2]:
        """``arrived``: the newest command of each source by its name, since the last call."""
        self._heard.update(dict.fromkeys(arrived, now))
        return arrived.get(self.active(now))

    def active(self, now: float) -> str:
        """The name of the source that drives, or ``idle``."""
        for one in self.inputs:
            heard = self._heard.get(one.name)
            if heard is not None and 0.0 <= now - heard < one.timeout:
                return one.name
        return IDLE


@dataclass(frozen=True)
class VelocityLimits:
    """Of speeds, m/s and rad/s, and accelerations; to brake, ``decel_factor`` times as much is allowed.

    The defaults are those of turtlebot_bringup.
    """

    speed_lim_v: float = 0.8
    speed_lim_w: float = 5.4
    accel_lim_v: float = 1.0
    accel_lim_w: float = 2.0
    decel_factor: float = 1.5


class VelocitySmoother:
    """Leads to the commands that it hears within limits, and to rest after the last (yocs_velocity_smoother).

    Asked at every step of time, so that also after a pause between two commands no velocity jumps.
    """

    def __init__(self, limits: VelocityLimits = VelocityLimits()):
        self._limits = limits
        self._last = Twist2()
        self._target: Optional[Twist2] = None
        self._heard_at = self._now = math.inf

    def set_target(self, command: Twist2, now: float) -> None:
        self._target, self._heard_at = command, now

    def command(self, now: float) -> Optional[Twist2]:
        """What is commanded now; None once nothing is. One that is not finite is passed on."""
        seconds, self._now = now - self._now, now
        if self._target is None:
            return None
        if not self._target.is_finite():
            told, self._target, self._last = self._target, None, Twist2()
            return told
        if seconds < 0.0:  # time has begun anew
            self._last, self._heard_at, seconds = Twist2(), now, 0.0
        is_silent = now - self._heard_at > SILENCE
        target, limits = Twist2() if is_silent else self._target, self._limits
        self._last = Twist2(
            self._approach(self._last.v, target.v, limits.speed_lim_v, limits.accel_lim_v * seconds),
            self._approach(self._last.omega, target.omega, limits.speed_lim_w, limits.accel_lim_w * seconds),
        )
        if is_silent and self._last == Twist2():
            self._target = None
        return self._last

    def _approach(self, last: float, target: float, limit: float, step: float) -> float:
        target = max(-limit, min(limit, target))
        if abs(target) < abs(last) or target * last < 0.0:
            step *= self._limits.decel_factor
        return last + max(-step, min(step, target - last))
