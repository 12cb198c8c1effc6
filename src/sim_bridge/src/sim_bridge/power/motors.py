"""Electrical power of wheel motors by torque and speed."""

from dataclasses import dataclass


@dataclass(frozen=True)
class MotorProfile:
    """A motor with its gear, seen at the wheel.

    Attributes:
        constant: Torque per current [N m/A], which is also voltage per speed [V s/rad].
        resistance: Resistance of the winding [Ohm].
        friction: Torque of friction and rolling resistance [N m].
        inertia: Inertia that the motor accelerates [kg m^2]: its share of the robot's mass times the square
            of the wheel's radius.
    """

    constant: float = 0.45
    resistance: float = 5.0
    friction: float = 0.08
    inertia: float = 0.004

    def current(self, speed: float, acceleration: float) -> float:
        """Return the current of the motor [A], positive if it drives.

        Args:
            speed: Speed of the wheel [rad/s].
            acceleration: Angular acceleration of the wheel [rad/s^2].
        """
        direction = (speed > 0.0) - (speed < 0.0)
        return (self.friction * direction + self.inertia * acceleration) / self.constant

    def power(self, speed: float, acceleration: float) -> float:
        """Return the electrical power of the motor [W]; braking returns none."""
        current = self.current(speed, acceleration)
        return max(self.constant * current * speed + self.resistance * current**2, 0.0)
