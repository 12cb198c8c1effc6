"""The facade: turtles that are told to move, and what they draw."""

import math
from dataclasses import dataclass
from typing import Dict, List, Optional, Tuple

from planar import PlanarError
from planar.geometry.limits import MAX_ANGLE, MAX_COORDINATE, MAX_SPEED, check_within, is_within
from turtle_world.canvas import BACKGROUND, SIDE, Canvas, Color, Pen
from turtle_world.physics import PERIOD, Physics, Place

# A command holds for this long, seconds.
COMMAND_SECONDS = 1.0
FIRST_NAME = "turtle1"


class TurtleError(PlanarError):
    """There is no such turtle, or there is one already."""


@dataclass(frozen=True)
class Command:
    """Speeds as in cmd_vel: forward and to the left in m/s, to the left in rad/s."""

    forward: float = 0.0
    leftward: float = 0.0
    turn: float = 0.0

    def is_in_range(self) -> bool:
        """Whether it is finite, and no faster than anything moves."""
        return is_within(MAX_SPEED, self.forward, self.leftward, self.turn)


@dataclass(frozen=True)
class TurtleState:
    """After a step: where a turtle is and how fast it is told to be, and the colour of the floor under it.

    ``stopped_at``: where it would have got to, had there been no wall; None if none was in its way.
    """

    place: Place
    speed: float
    turn: float
    color: Color
    stopped_at: Optional[Tuple[float, float]]


class _Turtle:
    def __init__(self, body: int):
        self.body = body
        self.pen = Pen()
        self.command = Command()
        self.steps_left = 0


class TurtleWorld:
    """turtlesim's world: its floor, its turtle in the middle, its time-out of commands.

    Turtles have bodies in a physics engine. ``step`` moves on by one period, 16 ms.
    """

    def __init__(self):
        self._physics = Physics()
        self._turtles: Dict[str, _Turtle] = {}
        self._made_up = 0
        self.canvas = Canvas(BACKGROUND)
        self.spawn("", 0.5 * SIDE, 0.5 * SIDE, 0.0)

    @property
    def names(self) -> List[str]:
        return list(self._turtles)

    def spawn(self, name: str, x: float, y: float, theta: float) -> str:
        """A new turtle; returns its name, which is made up if ``name`` is empty.

        Raises TurtleError, or OutOfRangeError for a place that means nothing, as all that moves turtles.
        """
        place = _on_floor(Place(x, y, theta))
        if name in self._turtles:
            raise TurtleError(f"A turtle named [{name}] already exists")
        while not name or name in self._turtles:
            self._made_up += 1
            name = f"turtle{self._made_up}"
        self._turtles[name] = _Turtle(self._physics.add(place))
        return name

    def kill(self, name: str) -> None:
        """Removes a turtle; what it has drawn stays. Raises TurtleError."""
        self._physics.remove(self._turtle(name).body)
        del self._turtles[name]

    def reset(self, background: Color) -> None:
        """Back to one turtle in the middle of an empty floor."""
        for name in self.names:
            self.kill(name)
        self._made_up = 0
        self.canvas.clear(background)
        self.spawn("", 0.5 * SIDE, 0.5 * SIDE, 0.0)

    def command(self, name: str, command: Command) -> None:
        """Tells a turtle how to move from now on, until the command's time-out. Raises TurtleError."""
        if not command.is_in_range():
            raise TurtleError(f"[{name}] is told to move at a speed that is not finite, or no speed")
        turtle = self._turtle(name)
        turtle.command, turtle.steps_left = command, round(COMMAND_SECONDS / PERIOD)

    def set_pen(self, name: str, pen: Pen) -> None:
        """Raises TurtleError."""
        self._turtle(name).pen = pen

    def pen_of(self, name: str) -> Pen:
        """Raises TurtleError."""
        return self._turtle(name).pen

    def place_of(self, name: str) -> Place:
        """Raises TurtleError."""
        return self._physics.place_of(self._turtle(name).body)

    def teleport(self, name: str, x: float, y: float, theta: float) -> None:
        """Moves a turtle at once, drawing a line if its pen is on. Raises TurtleError."""
        start, end = self.place_of(name), _on_floor(Place(x, y, theta))
        self._physics.move(self._turtle(name).body, end)
        self._draw(name, start)

    def teleport_by(self, name: str, distance: float, angle: float) -> None:
        """Turns a turtle, then moves it ahead, at once. Raises TurtleError."""
        place = self.place_of(name)
        check_within(MAX_ANGLE, "a turtle's turn", angle=angle)
        theta = place.theta + angle
        self.teleport(name, place.x + distance * math.cos(theta), place.y + distance * math.sin(theta), theta)

    def step(self) -> Dict[str, TurtleState]:
        """Moves on by one period; returns what has become of each turtle."""
        starts, wishes = {}, {}
        for name, turtle in self._turtles.items():
            starts[name] = start = self._physics.place_of(turtle.body)
            wishes[name] = self._push(turtle, start)
        self._physics.step()
        return {name: self._state(name, starts[name], wishes[name]) for name in self._turtles}

    def picture(self) -> bytes:
        """A PNG of the floor and the turtles."""
        return self.canvas.picture([self.place_of(name) for name in self._turtles])

    def _turtle(self, name: str) -> _Turtle:
        if name not in self._turtles:
            raise TurtleError(f"there is no turtle [{name}]")
        return self._turtles[name]

    def _push(self, turtle: _Turtle, start: Place) -> Tuple[float, float]:
        """Sets a body in motion; returns where it wants to."""
        if turtle.steps_left == 0:
            turtle.command = Command()
        turtle.steps_left = max(0, turtle.steps_left - 1)
        command = turtle.command
        theta = start.theta + command.turn * PERIOD
        c, s = math.cos(theta), math.sin(theta)
        velocity_x = c * command.forward - s * command.leftward
        velocity_y = s * command.forward + c * command.leftward
        self._physics.push(turtle.body, velocity_x, velocity_y, command.turn)
        return start.x + velocity_x * PERIOD, start.y + velocity_y * PERIOD

    def _state(self, name: str, start: Place, wish: Tuple[float, float]) -> TurtleState:
        turtle = self._turtles[name]
        place = self._physics.place_of(turtle.body)
        if _on_floor(place) != place:
            place = _on_floor(place)
            self._physics.move(turtle.body, place)
        self._draw(name, start)
        has_hit = not (0.0 <= wish[0] <= SIDE and 0.0 <= wish[1] <= SIDE)
        speed = math.hypot(turtle.command.forward, turtle.command.leftward)
        return TurtleState(
            place,
            speed,
            turtle.command.turn,
            self.canvas.color_at(place.x, place.y),
            wish if has_hit else None,
        )

    def _draw(self, name: str, start: Place) -> None:
        turtle, end = self._turtles[name], self.place_of(name)
        if turtle.pen.is_on and start[:2] != end[:2]:
            self.canvas.draw(name, turtle.pen, start[:2], end[:2])


def _on_floor(place: Place) -> Place:
    check_within(MAX_COORDINATE, "a turtle's place", x=place.x, y=place.y)
    check_within(MAX_ANGLE, "a turtle's place", theta=place.theta)
    return Place(min(max(place.x, 0.0), SIDE), min(max(place.y, 0.0), SIDE), place.theta)
