"""The facade: a world of turtles that execute velocity commands and draw."""

import math
from dataclasses import dataclass
from typing import Dict, List, Optional, Tuple

from planar import PlanarError
from planar.geometry.limits import MAX_ANGLE, MAX_COORDINATE, MAX_SPEED, check_within, is_within
from turtle_world.canvas import BACKGROUND, FLOOR_SIDE, Canvas, Color, Pen
from turtle_world.physics import PERIOD, TurtlePhysics, TurtlePose

# Time-out of a velocity command [s].
COMMAND_SECONDS = 1.0
FIRST_NAME = "turtle1"


class TurtleError(PlanarError):
    """The turtle does not exist, exists already, or the command is invalid."""


@dataclass(frozen=True)
class TurtleVelocity:
    """Velocity command in the turtle's frame.

    Attributes:
        forward: Along x [m/s].
        leftward: Along y [m/s].
        turn: About z, counterclockwise [rad/s].
    """

    forward: float = 0.0
    leftward: float = 0.0
    turn: float = 0.0

    def is_in_range(self) -> bool:
        """Whether all components are finite and at most MAX_SPEED."""
        return is_within(MAX_SPEED, self.forward, self.leftward, self.turn)


@dataclass(frozen=True)
class TurtleState:
    """State of a turtle after a step.

    Attributes:
        pose: Pose in the world.
        speed: Commanded linear speed [m/s].
        turn: Commanded angular velocity [rad/s].
        color: Colour of the floor below the turtle.
        blocked_target: Position x, y that it would have reached without a wall [m]; else None.
    """

    pose: TurtlePose
    speed: float
    turn: float
    color: Color
    blocked_target: Optional[Tuple[float, float]]


class _Turtle:
    def __init__(self, body: int):
        self.body = body
        self.pen = Pen()
        self.command = TurtleVelocity()
        self.steps_left = 0


class TurtleWorld:
    """turtlesim's world on a physics engine: one turtle in the middle of the floor, commands with a time-out.

    Attributes:
        canvas: The floor with the turtles' strokes.
    """

    def __init__(self):
        self._physics = TurtlePhysics()
        self._turtles: Dict[str, _Turtle] = {}
        self._generated_names = 0
        self.canvas = Canvas(BACKGROUND)
        self.spawn("", 0.5 * FLOOR_SIDE, 0.5 * FLOOR_SIDE, 0.0)

    @property
    def names(self) -> List[str]:
        return list(self._turtles)

    def spawn(self, name: str, x: float, y: float, theta: float) -> str:
        """Add a turtle; a pose beyond the floor is clamped to its edge.

        Args:
            name: Its name; if empty, the next free ``turtleN``.
            x: Position [m].
            y: Position [m].
            theta: Heading [rad].

        Returns:
            The name of the turtle.

        Raises:
            TurtleError: A turtle of this name exists.
            OutOfRangeError: The pose is not finite or out of range.
        """
        pose = _clamp_to_floor(TurtlePose(x, y, theta))
        if name in self._turtles:
            raise TurtleError(f"A turtle named [{name}] already exists")
        while not name or name in self._turtles:
            self._generated_names += 1
            name = f"turtle{self._generated_names}"
        self._turtles[name] = _Turtle(self._physics.add(pose))
        return name

    def kill(self, name: str) -> None:
        """Remove a turtle; its strokes remain. Raises TurtleError."""
        self._physics.remove(self._turtle(name).body)
        del self._turtles[name]

    def reset(self, background: Color) -> None:
        """Restore the initial state: one turtle in the middle of an empty floor."""
        for name in self.names:
            self.kill(name)
        self._generated_names = 0
        self.canvas.clear(background)
        self.spawn("", 0.5 * FLOOR_SIDE, 0.5 * FLOOR_SIDE, 0.0)

    def command(self, name: str, command: TurtleVelocity) -> None:
        """Set the velocity of a turtle until the time-out. Raises TurtleError."""
        if not command.is_in_range():
            raise TurtleError(
                f"[{name}] velocity command is not finite, or exceeds {MAX_SPEED:g} m/s or rad/s: ignored"
            )
        turtle = self._turtle(name)
        turtle.command, turtle.steps_left = command, round(COMMAND_SECONDS / PERIOD)

    def set_pen(self, name: str, pen: Pen) -> None:
        """Set the pen of a turtle. Raises TurtleError."""
        self._turtle(name).pen = pen

    def pen_of(self, name: str) -> Pen:
        """The pen of a turtle. Raises TurtleError."""
        return self._turtle(name).pen

    def pose_of(self, name: str) -> TurtlePose:
        """The pose of a turtle. Raises TurtleError."""
        return self._physics.pose_of(self._turtle(name).body)

    def teleport(self, name: str, x: float, y: float, theta: float) -> None:
        """Set the pose of a turtle, drawing a line if its pen is on.

        Raises:
            TurtleError: There is no such turtle.
            OutOfRangeError: The pose is not finite or out of range.
        """
        start, end = self.pose_of(name), _clamp_to_floor(TurtlePose(x, y, theta))
        self._physics.set_pose(self._turtle(name).body, end)
        self._draw(name, start)

    def teleport_by(self, name: str, distance: float, angle: float) -> None:
        """Rotate a turtle [rad], then move it ahead [m]; raises as ``teleport``."""
        pose = self.pose_of(name)
        check_within(MAX_ANGLE, "a turtle's turn", angle=angle)
        theta = pose.theta + angle
        self.teleport(name, pose.x + distance * math.cos(theta), pose.y + distance * math.sin(theta), theta)

    def step(self) -> Dict[str, TurtleState]:
        """Advance by one period of 16 ms; returns the state of each turtle by name."""
        starts, targets = {}, {}
        for name, turtle in self._turtles.items():
            starts[name] = start = self._physics.pose_of(turtle.body)
            targets[name] = self._apply_command(turtle, start)
        self._physics.step()
        return {name: self._state(name, starts[name], targets[name]) for name in self._turtles}

    def picture(self) -> bytes:
        """Render the floor and the turtles; returns a PNG."""
        return self.canvas.picture([self.pose_of(name) for name in self._turtles])

    def _turtle(self, name: str) -> _Turtle:
        if name not in self._turtles:
            raise TurtleError(f"there is no turtle named [{name}]")
        return self._turtles[name]

    def _apply_command(self, turtle: _Turtle, start: TurtlePose) -> Tuple[float, float]:
        """Set the velocity of a body; returns the position that it reaches without walls."""
        if turtle.steps_left == 0:
            turtle.command = TurtleVelocity()
        turtle.steps_left = max(0, turtle.steps_left - 1)
        command = turtle.command
        theta = start.theta + command.turn * PERIOD
        c, s = math.cos(theta), math.sin(theta)
        velocity_x = c * command.forward - s * command.leftward
        velocity_y = s * command.forward + c * command.leftward
        self._physics.set_velocity(turtle.body, velocity_x, velocity_y, command.turn)
        return start.x + velocity_x * PERIOD, start.y + velocity_y * PERIOD

    def _state(self, name: str, start: TurtlePose, target: Tuple[float, float]) -> TurtleState:
        turtle = self._turtles[name]
        pose = self._physics.pose_of(turtle.body)
        if _clamp_to_floor(pose) != pose:
            pose = _clamp_to_floor(pose)
            self._physics.set_pose(turtle.body, pose)
        self._draw(name, start)
        has_hit = not (0.0 <= target[0] <= FLOOR_SIDE and 0.0 <= target[1] <= FLOOR_SIDE)
        speed = math.hypot(turtle.command.forward, turtle.command.leftward)
        return TurtleState(
            pose,
            speed,
            turtle.command.turn,
            self.canvas.color_at(pose.x, pose.y),
            target if has_hit else None,
        )

    def _draw(self, name: str, start: TurtlePose) -> None:
        turtle, end = self._turtles[name], self.pose_of(name)
        if turtle.pen.is_on and start[:2] != end[:2]:
            self.canvas.draw(name, turtle.pen, start[:2], end[:2])


def _clamp_to_floor(pose: TurtlePose) -> TurtlePose:
    check_within(MAX_COORDINATE, "a turtle's place", x=pose.x, y=pose.y)
    check_within(MAX_ANGLE, "a turtle's place", theta=pose.theta)
    return TurtlePose(min(max(pose.x, 0.0), FLOOR_SIDE), min(max(pose.y, 0.0), FLOOR_SIDE), pose.theta)
