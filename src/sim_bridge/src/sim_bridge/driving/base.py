"""The contract of a drive: what stands between commands and the motors of the wheels."""

from typing import Protocol, Tuple

from planar import Twist2

# Times a second that a base sets its motors; Kobuki's tells its odometry as often.
BASE_RATE = 50


class Drive(Protocol):
    """A drive, or what stands before one: commanded now and then, asked each time that the motors are set."""

    def command(self, twist: Twist2) -> None:
        """Takes a new command; one that is not finite stops the robot."""

    def switch(self, on: bool) -> None:
        """Without power the motors brake and no command is heard."""

    def halt(self) -> None:
        """Forgets the command and stands still at once."""

    def wheel_speeds(self, seconds: float) -> Tuple[float, float]:
        """Speeds of the left and right wheels, rad/s, after ``seconds`` more."""
