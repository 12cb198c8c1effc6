"""Static friction of a vehicle at rest."""

from typing import NamedTuple, Optional, Tuple

import numpy as np

from sim_bridge.driving.drive import REST_SECONDS
from sim_bridge.physics.engine import Engine
from sim_bridge.physics.joints import Motors
from sim_bridge.physics.kinematics import at_rest

# Speed [m/s and rad/s] below which friction holds a vehicle, and displacement [m] from where it was held
# above which it has been moved; a robot that stands on Bullet's floor creeps at 1e-5.
MAX_HELD_SPEED, MAX_DISPLACEMENT = 1e-3, 1e-4


class _HeldState(NamedTuple):
    """Pose (4, 4) of the base and angles [rad] of the wheels of a held vehicle."""

    pose: np.ndarray
    wheel_angles: Tuple[float, ...]


class Standstill:
    """Holds a vehicle that has stood for a while, unless something moves it.

    Bullet solves friction iteratively up to a residual velocity, with which a standing robot creeps by some
    decimetres a day.

    Args:
        engine: The physics engine.
        base: Name of the vehicle's base link.
        motors: The motors of its wheels.
    """

    def __init__(self, engine: Engine, base: str, motors: Motors):
        self._engine, self._base, self._motors = engine, base, motors
        self.release()

    @property
    def is_held(self) -> bool:
        """Whether the vehicle stands and is held."""
        return self._held is not None

    def release(self) -> None:
        """Let the vehicle move, because it drives or was moved."""
        self._seconds = 0.0
        self._held: Optional[_HeldState] = None

    def update(self, seconds: float) -> None:
        """Hold the vehicle, if it has stood for long enough.

        Args:
            seconds: Time since the last call [s], in which the motors were at rest.
        """
        self._seconds += seconds
        if self._seconds < REST_SECONDS:
            return
        state = self._engine.state_of(self._base)
        if state.is_moving(MAX_HELD_SPEED):
            self.release()
        elif self._held is None:
            self._held = _HeldState(state.pose, self._motors.states()[0])
        elif np.abs(state.pose - self._held.pose).max() > MAX_DISPLACEMENT:
            self.release()
        else:
            self._engine.set_state(self._base, at_rest(self._held.pose))
            self._motors.reset(self._held.wheel_angles)
