"""The Drive tab: its panel, pointing on the floor, and the commands that both send to the graph."""

import math
import threading
from typing import Callable, Optional, Tuple

import rospy
from home_service_msgs.msg import DeliverActionResult, MissionState
from std_msgs.msg import String

from cockpit.errors import CockpitError
from cockpit.frames import FrameTree
from cockpit.models.mission import is_running, mission_html
from cockpit.models.tables import table
from cockpit.page.drive_panel import NO_MODEL, NO_PLACE, NO_SUBSCRIBER, DrivePanel
from cockpit.page.pointer import FloorPointer
from cockpit.page.toolbar import (
    DROP_BOX,
    MOVE_CAMERA,
    MOVE_MODEL,
    NAV_GOAL,
    POSE_ESTIMATE,
    PUBLISH_POINT,
    Toolbar,
)
from cockpit.ros.graph import GraphClient, TopicFeed
from cockpit.ros.graph_commands import GraphCommands
from cockpit.ros.teleop import PageTeleop
from cockpit.ros.world.world import WorldTracker, world_in

BASE_FRAMES = ("base_footprint", "base_link")
MISSION, ERRAND, RESULT = "/pick_objects/mission_state", "/pick_objects/state", "/deliver/result"
TYPES = {MISSION: MissionState, ERRAND: String, RESULT: DeliverActionResult}


class DriveTab:
    """Carries out the actions of the panel (cockpit.page.drive_panel.DriveCommands).

    Args:
        graph: Client of the ROS graph.
        frames: Tree of frames.
        pointer: Converts mouse clicks to poses.
        world: The displayed world.
        notify: Shows a notification on the page; called with the text and whether it reports an error.
        fixed: Returns the fixed frame.
    """

    def __init__(
        self,
        graph: GraphClient,
        frames: FrameTree,
        pointer: FloorPointer,
        world: WorldTracker,
        notify: Callable[[str, bool], None],
        fixed: Callable[[], str],
    ):
        self._graph, self._frames, self._pointer, self._world = graph, frames, pointer, world
        self._notify, self._fixed = notify, fixed
        self._commands, self.teleop = GraphCommands(graph), PageTeleop()
        self._feeds: dict = {}
        self._is_on_mission = False
        self._swung: Optional[Tuple[str, str, float]] = None
        self._command_lock = threading.Lock()
        self._panel: Optional[DrivePanel] = None
        self._toolbar: Optional[Toolbar] = None

    def build(self, gui, tab, toolbar: Toolbar, guarded) -> None:
        """Create the panel.

        Args:
            gui: The gui of viser.
            tab: The tab's context.
            toolbar: The toolbar of the page, which calls ``set_mode``.
            guarded: Wraps callbacks of controls so that exceptions are reported on the page.
        """
        self._toolbar = toolbar
        self._panel = DrivePanel(gui, tab, self, guarded)

    def refresh(self) -> None:
        """Update the choices of the panel, and subscribe to the mission's state.

        Raises:
            CockpitError: The ROS master does not answer.
        """
        assert self._panel is not None
        orders, view = self._commands, self._world.view
        self._panel.offer(orders.robots(), orders.velocity_topics(), orders.places())
        self._panel.offer_world(view.models, sorted(view.joints))
        types = self._graph.topics()
        for topic, kind in TYPES.items():
            if topic in types and topic not in self._feeds:
                self._feeds[topic] = TopicFeed(topic, kind._type, all_of_them=topic == RESULT)

    def update(self) -> None:
        """Show the new states of the mission.

        Raises:
            CockpitError: A message is malformed.
        """
        assert self._panel is not None
        for topic in TYPES:
            for message in self._feeds[topic].messages() if topic in self._feeds else ():
                if topic == MISSION:
                    self._is_on_mission = is_running(message)
                    self._panel.mission.content = mission_html(message)
                elif topic == RESULT:
                    self._show_result(message)
                elif MISSION not in self._feeds:
                    self._panel.mission.content = table(("Errand",), [(message.data,)])

    def _show_result(self, message: DeliverActionResult) -> None:
        """Report that the mission of this page was refused."""
        assert self._panel is not None
        reason = self._commands.refusal(message)
        if reason:
            self._panel.show_refusal(reason)
            self._notify(reason, True)

    def unsubscribe(self) -> None:
        for feed in self._feeds.values():
            feed.close()
        self._feeds.clear()

    def base_frame(self) -> Optional[str]:
        """Return the base frame of the selected robot; None if it has no transform."""
        assert self._panel is not None
        prefix, known = self._panel.namespace.strip("/"), set(self._frames.names())
        names = [f"{prefix}/{base}".lstrip("/") for base in BASE_FRAMES]
        return next((name for name in names if name in known), None)

    # -- actions of the panel

    def set_mode(self, mode: str) -> None:
        """Let the mouse turn the camera, or point for a tool of the toolbar or of the panel."""
        self._pointer.aim(None if mode == MOVE_CAMERA else self._pointed)

    def choose_mode(self, mode: str) -> None:
        assert self._toolbar is not None
        self._toolbar.select(mode)

    def press(self, key: str, client: int) -> None:
        """Drive the selected robot by a key.

        Args:
            key: Key of turtlebot_teleop.
            client: Client id of the page on which it is held.

        Raises:
            CockpitError: No node subscribes to a velocity topic.
        """
        assert self._panel is not None
        if self._panel.topic.value == NO_SUBSCRIBER:
            raise CockpitError(
                "no node subscribes to a velocity topic; choose one under Drive by hand > Velocities to"
            )
        self.teleop.press(key, client, self._panel.topic.value)

    def pause(self, is_paused: bool) -> None:
        self._alone(lambda: self._commands.pause(is_paused))

    def step(self) -> None:
        self._alone(self._commands.step)

    def reset(self) -> None:
        self._alone(self._commands.reset)

    def set_speed(self, factor: float) -> None:
        self._alone(lambda: self._commands.set_speed(factor))

    def cancel(self) -> None:
        assert self._panel is not None
        self._commands.cancel(self._panel.namespace)

    def deliver(self) -> None:
        assert self._panel is not None
        name, ends = (
            self._panel.object.value.strip(),
            (self._panel.source.value, self._panel.destination.value),
        )
        if NO_PLACE in ends:
            raise CockpitError(
                "no places are known: pick_objects publishes them as the parameter /pick_objects/places"
            )
        self._alone(lambda: self._commands.deliver(name, *ends, joins=self._is_on_mission))
        self._notify(f"{name}: from {ends[0]} to {ends[1]}", False)

    def cancel_mission(self) -> None:
        self._alone(self._commands.cancel_mission)
        self._notify("the mission is cancelled", False)

    def _alone(self, order: Callable[[], None]) -> None:
        """One order at a time: those that a node leaves unanswered must not hold up who drives."""
        if not self._command_lock.acquire(blocking=False):
            raise CockpitError("the answer before is still awaited")
        try:
            order()
        finally:
            self._command_lock.release()

    def swing(self) -> None:
        """To where the slider is now; where it passes by during an answer is left out."""
        while self._swung != self._wanted_swing() and self._command_lock.acquire(blocking=False):
            try:
                wanted = self._wanted_swing()
                self._commands.set_joint(*wanted)
                self._swung = wanted
            finally:
                self._command_lock.release()

    def _wanted_swing(self) -> Tuple[str, str, float]:
        """Model, joint and position. Raises CockpitError."""
        assert self._panel is not None
        joint = self._world.view.joints.get(self._panel.joint.value)
        if joint is None:
            raise CockpitError("there is nothing to open")
        return joint.model, joint.name, joint.opened(self._panel.opened.value / 100.0)

    def _pointed(self, x: float, y: float, yaw: Optional[float], _client: int) -> None:
        assert self._panel is not None and self._toolbar is not None
        mode, robot, fixed = self._toolbar.mode, self._panel.namespace, self._fixed()
        self._toolbar.select(MOVE_CAMERA)
        try:
            if mode == NAV_GOAL:
                self._commands.goal(robot, fixed, x, y, self._yaw_to(x, y) if yaw is None else yaw)
                self._notify(f"goal sent: {x:.2f}, {y:.2f} in {fixed}", False)
            elif mode == POSE_ESTIMATE:
                self._commands.estimate(robot, fixed, x, y, yaw or 0.0)
                self._notify(f"pose estimate sent: {x:.2f}, {y:.2f} in {fixed}", False)
            elif mode == PUBLISH_POINT:
                self._commands.point(fixed, x, y)
                self._notify(f"point published: {x:.2f}, {y:.2f} in {fixed}", False)
            elif mode == DROP_BOX:
                self._drop(*self._in_world(x, y, 0.0)[:2])
            elif mode == MOVE_MODEL:
                self._move(*self._in_world(x, y, yaw))
        except (CockpitError, rospy.ROSException) as error:
            self._notify(str(error), True)

    def _yaw_to(self, x: float, y: float) -> float:
        """Return the direction from the robot to a place, the default yaw of a clicked goal."""
        base = self.base_frame()
        pose = None if base is None else self._frames.pose(base, self._fixed())
        return 0.0 if pose is None else math.atan2(y - pose[1, 3], x - pose[0, 3])

    def _in_world(self, x: float, y: float, yaw: Optional[float]) -> Tuple[float, float, Optional[float]]:
        """Convert a pose from the fixed to the world frame. Raises CockpitError."""
        world = world_in(self._frames, self._fixed())
        if world is None:
            raise CockpitError("tf does not connect the world frame with the fixed frame")
        at = world[:2, :2].T @ (x - world[0, 3], y - world[1, 3])
        return float(at[0]), float(at[1]), None if yaw is None else yaw - math.atan2(world[1, 0], world[0, 0])

    def _drop(self, x: float, y: float) -> None:
        name = self._commands.drop_box(x, y)
        self._notify(f"{name} dropped", False)

    def _move(self, x: float, y: float, yaw: Optional[float]) -> None:
        assert self._panel is not None
        model = self._panel.model.value
        if model == NO_MODEL:
            raise CockpitError("the world has no model that can be moved")
        self._world.view.move(model, self._commands.move_model(model, x, y, yaw))
        self._notify(f"{model} moved to {x:.2f}, {y:.2f}", False)
