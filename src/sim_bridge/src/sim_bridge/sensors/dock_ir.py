"""The infrared receivers of a Kobuki, which sense the signals of docks (kobuki_msgs/DockInfraRed)."""

import math
from dataclasses import dataclass
from typing import List, Tuple

import numpy as np

from planar import Pose2
from planar.geometry.dock_field import DockField
from sim_bridge.config import SimulationSettings
from sim_bridge.sensors.base import Mounting, Schedule, SensorContext, every
from sim_bridge.views.section import cast_beams

# Height of receivers and docks' windows above the floor [m].
HEIGHT = 0.06
# The emitters are behind a window, so much before the front of the housing [m].
WINDOW = 0.005
DockSignals = Tuple[int, int, int]


@dataclass(frozen=True)
class DockIrProfile:
    """Receivers of a Kobuki; their geometry is that of SimulationSettings."""

    topic: str = "mobile_base/sensors/dock_ir"
    frame: str = "dock_ir_link"

    def build(self, mounting: Mounting) -> "DockIrSensor":
        return DockIrSensor(mounting.settings, self.frame)


class DockIrSensor:
    """Receives the signals of all docks that nothing hides; those of several docks add up.

    Args:
        field: Geometry of fans and receivers.
        frame: Frame of the measurements.
    """

    name, on_demand = "dock_ir", True

    def __init__(self, field: DockField, frame: str):
        self._field, self.frame = field, frame

    def schedule(self, settings: SimulationSettings) -> Schedule:
        return every(None, settings)

    def measure(self, context: SensorContext) -> DockSignals:
        bits, base = [0, 0, 0], context.base.pose2
        for dock in context.docks():
            self._add(bits, dock, base, context)
        return bits[0], bits[1], bits[2]

    def _add(self, bits: List[int], dock: Pose2, base: Pose2, context: SensorContext) -> None:
        """Add the signals of one dock to the bytes of the receivers."""
        if dock.distance_to(base) > self._field.dock_far_range + 2.0 * self._field.dock_receiver_radius:
            return
        emitter = dock @ Pose2(WINDOW)
        in_dock = emitter.inverse() @ base
        for number, receiver in enumerate(self._field.receivers(in_dock)):
            signal = self._field.signal(receiver)
            if signal and not _is_hidden(emitter @ receiver, emitter, context):
                bits[number] |= signal


def _is_hidden(receiver: Pose2, emitter: Pose2, context: SensorContext) -> bool:
    """Return whether something is between an emitter and a receiver."""
    segments, _ = context.section(HEIGHT)
    bearing = math.atan2(emitter.y - receiver.y, emitter.x - receiver.x)
    distance = receiver.distance_to(emitter)
    ranges, _ = cast_beams(np.asarray(segments), receiver.x, receiver.y, bearing, 1.0, 1, distance)
    return bool(ranges[0] < distance - WINDOW / 2.0)
