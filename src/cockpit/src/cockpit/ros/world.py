"""The simulated world and the robots of the graph: found by their parameters, kept where they are."""

from functools import partial
from typing import Callable, Dict, List, Optional

import numpy as np

from cockpit.errors import CockpitError
from cockpit.frames import FrameTree
from cockpit.page.world_view import RobotView, WorldView
from cockpit.ros.graph import Graph
from cockpit.ros.looks import ROBOT, WORLD, read_aside
from cockpit.scene.look import Look

# Of the simulator under its own name and under that of Gazebo.
WORLD_PARAMETERS = ("/sim_bridge/world", "/gazebo/world")
DESCRIPTION, PREFIX = "robot_description", "tf_prefix"
# The frame of a world file; a map made or rendered of that world coincides with it.
WORLD_FRAME, MAP_FRAME = "world", "map"


class World:
    """Looks for worlds and robots, and draws them once they have been read."""

    def __init__(self, graph: Graph, scene, tell: Callable[[str], None]):
        self._graph, self._scene, self._tell = graph, scene, tell
        self.view = WorldView(scene)
        self.robots: Dict[str, RobotView] = {}
        self._asked: Dict[str, str] = {}
        self._arrived: List[Callable[[], None]] = []

    def look_for(self) -> None:
        """Reads, in the background, what has come since the last call. Raises CockpitError."""
        names = self._graph.parameter_names()
        for name in WORLD_PARAMETERS:
            if name in names:
                self._read(WORLD, name, self._show_world)
        for name in names:
            if name.rpartition("/")[2] == DESCRIPTION:
                self._read(ROBOT, name, partial(self._show_robot, name))

    def update(self, frames: FrameTree, fixed: str, shows_world: bool, shows_robots: bool) -> None:
        while self._arrived:
            self._arrived.pop(0)()
        self.view.is_shown = shows_world
        self.view.update(world_in(frames, fixed))
        for robot in self.robots.values():
            robot.update(frames, fixed, shows_robots)

    def _read(self, kind: str, parameter: str, show: Callable[[Look], None]) -> None:
        if parameter in self._asked:
            return
        value = self._graph.parameter(parameter)
        self._asked[parameter] = str(value)

        def take(look: Optional[Look], why: str) -> None:
            if look is None:
                self._tell(f"{parameter}: {why}")
            else:
                self._arrived.append(lambda: show(look))

        read_aside(kind, str(value), take)

    def _show_world(self, look: Look) -> None:
        self.view.show(look)
        for warning in look.warnings[:3]:
            self._tell(warning)

    def _show_robot(self, parameter: str, look: Look) -> None:
        namespace = parameter.rpartition("/")[0]
        try:
            prefix = str(self._graph.parameter(f"{namespace}/{PREFIX}", ""))
        except CockpitError:
            prefix = ""
        self.robots[parameter] = RobotView(self._scene, namespace, look, prefix)
        for warning in look.warnings[:3]:
            self._tell(warning)


def world_in(frames: FrameTree, fixed: str) -> Optional[np.ndarray]:
    """Where the world's frame is, (4, 4): tf's, or else that of the map, or the fixed frame itself."""
    known = set(frames.names())
    for frame in (WORLD_FRAME, MAP_FRAME):
        if frame in known and frames.pose(frame, fixed) is not None:
            return frames.pose(frame, fixed)
    return np.eye(4)
