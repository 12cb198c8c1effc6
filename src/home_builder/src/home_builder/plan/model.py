"""The plan of a home, as it is drawn: frozen values in metres and radians, in the frame of the plan."""

import math
from dataclasses import dataclass
from typing import Optional, Tuple

Point = Tuple[float, float]

DOOR, WINDOW = "door", "window"
OPENING_KINDS = (DOOR, WINDOW)
KEEP_OUT, SPEED = "keep_out", "speed"
# Lower and upper edge of an opening above the floor [m].
EDGES = {DOOR: (0.0, 2.0), WINDOW: (0.9, 2.1)}
WALL_THICKNESS, WALL_HEIGHT = 0.12, 2.5
DOOR_WIDTH = 0.9
PLACE_RADIUS = 0.35


@dataclass(frozen=True)
class Opening:
    """A door or a window in a wall.

    Attributes:
        kind: ``door`` or ``window``; a door has no leaf, the robot drives through it.
        at: Distance of its middle from the start of the wall [m].
        width: Clear width [m].
        bottom: Height of its lower edge [m].
        top: Height of its upper edge [m].
    """

    kind: str
    at: float
    width: float = DOOR_WIDTH
    bottom: float = EDGES[DOOR][0]
    top: float = EDGES[DOOR][1]

    @property
    def first(self) -> float:
        """Distance of its near edge from the start of the wall [m]."""
        return self.at - self.width / 2.0

    @property
    def last(self) -> float:
        """Distance of its far edge from the start of the wall [m]."""
        return self.at + self.width / 2.0


@dataclass(frozen=True)
class Wall:
    """A straight wall.

    Attributes:
        start: One end of its centre line [m].
        end: The other end [m].
        thickness: Thickness [m].
        height: Height [m].
        openings: Doors and windows.
    """

    start: Point
    end: Point
    thickness: float = WALL_THICKNESS
    height: float = WALL_HEIGHT
    openings: Tuple[Opening, ...] = ()

    @property
    def length(self) -> float:
        """Length of its centre line [m]."""
        return math.dist(self.start, self.end)

    @property
    def yaw(self) -> float:
        """Direction from start to end [rad]."""
        return math.atan2(self.end[1] - self.start[1], self.end[0] - self.start[0])

    def point_at(self, distance: float) -> Point:
        """Return the point of the centre line at a distance from its start [m]."""
        yaw = self.yaw
        return self.start[0] + distance * math.cos(yaw), self.start[1] + distance * math.sin(yaw)


@dataclass(frozen=True)
class FurniturePiece:
    """A piece of furniture on the floor.

    Attributes:
        kind: Kind of the palette (home_builder.palette), or ``outline``.
        x: Position of its middle [m].
        y: Position of its middle [m].
        yaw: Rotation [rad].
        size: Width along its x axis, depth along its y axis, height [m].
        name: Name as a place for missions; empty: none but what the kind gives it.
        corners: Outline in its own frame [m]; only of the kind ``outline``.
    """

    kind: str
    x: float
    y: float
    yaw: float
    size: Tuple[float, float, float]
    name: str = ""
    corners: Tuple[Point, ...] = ()


@dataclass(frozen=True)
class Room:
    """The name of a room: that of the closed face of walls around a point.

    Attributes:
        name: Name, also of its place for missions.
        x: A point in the room [m].
        y: A point in the room [m].
    """

    name: str
    x: float
    y: float


@dataclass(frozen=True)
class Place:
    """A named place where the robot stops.

    Attributes:
        name: Name; ``pickup``, ``dropoff`` and ``dock`` have the meaning of the zones file.
        x: Position [m].
        y: Position [m].
        yaw: Heading of the robot there [rad].
        radius: Distance within which the robot is there [m].
    """

    name: str
    x: float
    y: float
    yaw: float = 0.0
    radius: float = PLACE_RADIUS


@dataclass(frozen=True)
class Zone:
    """A keep-out or speed zone of navigation.

    Attributes:
        name: Name.
        kind: ``keep_out`` or ``speed``.
        corners: At least 3 points [m].
        max_speed: Highest speed in a speed zone [m/s].
    """

    name: str
    kind: str
    corners: Tuple[Point, ...]
    max_speed: float = math.inf


@dataclass(frozen=True)
class Template:
    """A picture below the drawing, to be traced; no part of the home.

    Attributes:
        file: Name of the picture in the folder of the home.
        x: Position of its lower left corner [m].
        y: Position of that corner [m].
        scale: Size of a pixel [m].
        width: Width, in pixels.
        height: Height, in pixels.
    """

    file: str
    x: float
    y: float
    scale: float
    width: int
    height: int


@dataclass(frozen=True)
class HomePlan:
    """The plan of a home.

    Attributes:
        name: Name of the home.
        walls: Walls.
        furniture: FurniturePiece.
        rooms: Names of rooms.
        places: Named places in addition to those of rooms and furniture.
        zones: Keep-out and speed zones.
        start: Where the robot starts [m].
        start_yaw: Its heading there [rad]; this pose is the origin of world and map.
        template: Picture that is traced; None: none.
    """

    name: str = "home"
    walls: Tuple[Wall, ...] = ()
    furniture: Tuple[FurniturePiece, ...] = ()
    rooms: Tuple[Room, ...] = ()
    places: Tuple[Place, ...] = ()
    zones: Tuple[Zone, ...] = ()
    start: Point = (0.0, 0.0)
    start_yaw: float = 0.0
    template: Optional[Template] = None
