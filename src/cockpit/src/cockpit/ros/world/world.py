"""The simulated world and the robots of the graph, found by their parameters."""

from contextlib import suppress
from functools import partial
from typing import Callable, Dict, List, Optional, Sequence, Set, Tuple

import numpy as np

from cockpit.errors import CockpitError
from cockpit.frames import FrameTree, pose_from_message
from cockpit.page.world_view import RobotView, WorldView
from cockpit.ros.graph import GraphClient, TopicFeed
from cockpit.ros.world.scene_reader import ROBOT, WORLD, SceneReader, SceneRequest, SceneResult
from cockpit.ros.world.spawned_models import SpawnedModelsView
from cockpit.scene.description import SceneDescription

# Parameters with the path of the world, the first one that exists counts: a description that
# cockpit.scene.reader has made of a world without a file, and the files of sim_bridge and of Gazebo.
WORLD_PARAMETERS = ("/cockpit/world", "/sim_bridge/world", "/gazebo/world")
DESCRIPTION, PREFIX = "robot_description", "tf_prefix"
# The frame of a world file; a map made or rendered of that world coincides with it.
WORLD_FRAME, MAP_FRAME = "world", "map"
LINK_STATES = "/gazebo/link_states"


class WorldTracker:
    """Finds worlds and robots, reads them in the background and draws them.

    Args:
        graph: Client of the ROS graph.
        scene: The scene of viser.
        reader: Reads worlds and robots in child processes.
        notify: Shows a notification on the page.

    Attributes:
        view: The displayed world.
        robots: Displayed robots by the name of their parameter.
    """

    def __init__(self, graph: GraphClient, scene, reader: SceneReader, notify: Callable[[str], None]):
        self._graph, self._scene, self._reader, self._notify = graph, scene, reader, notify
        self.view = WorldView(scene)
        self.robots: Dict[str, RobotView] = {}
        self._asked: Set[str] = set()
        self._arrived: List[Callable[[], None]] = []
        self._states: Optional[TopicFeed] = None
        self._spawned = SpawnedModelsView(graph, self.view, reader, notify)

    def poll(self) -> None:
        """Start reading new worlds and robots.

        Raises:
            CockpitError: The ROS master does not answer.
        """
        names = self._graph.parameter_names()
        worlds = [(WORLD, name, self._show_world) for name in WORLD_PARAMETERS if name in names][:1]
        robots = [
            (ROBOT, name, partial(self._show_robot, name))
            for name in names
            if name.rpartition("/")[2] == DESCRIPTION
        ]
        self._read([*worlds, *robots])
        self._reader.stop()
        self._spawned.poll()

    def update(self, frames: FrameTree, fixed: str, shows_world: bool, shows_robots: bool) -> None:
        """Draw the world and the robots at their present poses.

        Args:
            frames: Tree of frames.
            fixed: Fixed frame.
            shows_world: Whether the world is displayed.
            shows_robots: Whether the robots are displayed.
        """
        while self._arrived:
            self._arrived.pop(0)()
        self.view.is_shown = shows_world
        with suppress(CockpitError):  # the status line reports a missing master
            self._update_link_poses(shows_world)
            self._spawned.update()
        self.view.update(world_in(frames, fixed))
        for robot in self.robots.values():
            robot.update(frames, fixed, shows_robots)

    def unsubscribe(self) -> None:
        """End all subscriptions."""
        self._spawned.unsubscribe()
        self._stop_following()

    def _stop_following(self) -> None:
        if self._states is not None:
            self._states.close()
            self._states = None

    def _update_link_poses(self, wanted: bool) -> None:
        """Update links that physics moves; without any, the simulator's states are not subscribed to."""
        movable = self.view.movable
        if not wanted or not movable:
            self._stop_following()
        elif self._states is None and LINK_STATES in self._graph.publishers():
            self._states = self._graph.feed(LINK_STATES, "gazebo_msgs/LinkStates")
        for message in self._states.messages() if self._states is not None else ():
            found = dict(zip(message.name, message.pose))
            for name in set(movable) & set(found):
                pose = pose_from_message(found[name].position, found[name].orientation)
                if pose is not None:
                    self.view.place(name, pose)

    def _read(self, found: Sequence[Tuple[str, str, Callable[[SceneDescription], None]]]) -> None:
        """Read parameters that are new: (kind, parameter, function that shows the result) each."""
        new = [(kind, name, show) for kind, name, show in found if name not in self._asked]
        if not new:
            return
        values = [str(self._graph.parameter(name)) for _, name, _ in new]
        requests: List[SceneRequest] = [
            (kind, value, "") if kind == WORLD else (kind, name, value)
            for (kind, name, _), value in zip(new, values)
        ]
        self._asked.update(name for _, name, _ in new)

        def on_results(results: List[SceneResult]) -> None:
            for (_, name, show), result in zip(new, results):
                if isinstance(result, SceneDescription):
                    self._arrived.append(partial(show, result))
                else:
                    self._notify(f"{name}: {result}")

        self._reader.read_in_background(requests, on_results)

    def _show_world(self, look: SceneDescription) -> None:
        self.view.show(look)
        for warning in look.warnings[:3]:
            self._notify(warning)

    def _show_robot(self, parameter: str, look: SceneDescription) -> None:
        namespace = parameter.rpartition("/")[0]
        try:
            prefix = str(self._graph.parameter(f"{namespace}/{PREFIX}", ""))
        except CockpitError:
            prefix = ""
        self.robots[parameter] = RobotView(self._scene, namespace, look, prefix)
        for warning in look.warnings[:3]:
            self._notify(warning)


def world_in(frames: FrameTree, fixed: str) -> Optional[np.ndarray]:
    """Return the pose of the world in the fixed frame.

    Args:
        frames: Tree of frames.
        fixed: Fixed frame.

    Returns:
        Pose (4, 4) of the world frame; if it has no transform, of the map frame; else the identity.
    """
    known = set(frames.names())
    for frame in (WORLD_FRAME, MAP_FRAME):
        if frame in known and frames.pose(frame, fixed) is not None:
            return frames.pose(frame, fixed)
    return np.eye(4)
