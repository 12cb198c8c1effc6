"""The tab in which a person drives: its panel, the mouse over the floor, and what both make the graph do."""

import math
import threading
from typing import Callable, Optional, Tuple

import rospy
from home_service_msgs.msg import MissionState
from std_msgs.msg import String

from cockpit.errors import CockpitError
from cockpit.frames import FrameTree
from cockpit.models.mission import is_running, mission_html
from cockpit.models.tables import table
from cockpit.page.drive_panel import BOX, GOAL, LOOK, MOVE, NOBODY, NOTHING, NOWHERE, POINT, POSE, DrivePanel
from cockpit.page.pointer import FloorPointer
from cockpit.ros.graph import GraphClient, TopicFeed
from cockpit.ros.graph_commands import GraphCommands
from cockpit.ros.teleop import PageTeleop
from cockpit.ros.world.world import WorldTracker, world_in

BASE_FRAMES = ("base_footprint", "base_link")
MISSION, ERRAND = "/pick_objects/mission_state", "/pick_objects/state"


class DriveTab:
    """Implements what the panel asks for (cockpit.page.drive_panel.Driver)."""

    def __init__(
        self,
        graph: GraphClient,
        frames: FrameTree,
        pointer: FloorPointer,
        world: WorldTracker,
        notify: Callable[[str], None],
        fixed: Callable[[], str],
    ):
        """``fixed``: tells the fixed frame."""
        self._graph, self._frames, self._pointer, self._world = graph, frames, pointer, world
        self._notify, self._fixed = notify, fixed
        self._orders, self.teleop = GraphCommands(graph), PageTeleop()
        self._feeds: dict = {}
        self._is_on_mission = False
        self._swung: Optional[Tuple[str, str, float]] = None
        self._ordering = threading.Lock()
        self._panel: Optional[DrivePanel] = None

    def build(self, gui, tab, guarded) -> None:
        self._panel = DrivePanel(gui, tab, self, guarded)

    def refresh(self) -> None:
        """Raises CockpitError."""
        assert self._panel is not None
        orders, view = self._orders, self._world.view
        self._panel.offer(orders.robots(), orders.velocity_topics(), orders.places())
        self._panel.offer_world(view.models, sorted(view.joints))
        types = self._graph.topics()
        for topic, kind in ((MISSION, MissionState), (ERRAND, String)):
            if topic in types and topic not in self._feeds:
                self._feeds[topic] = TopicFeed(topic, kind._type)

    def update(self) -> None:
        """Raises CockpitError."""
        assert self._panel is not None
        for topic in (MISSION, ERRAND):
            for message in self._feeds[topic].messages() if topic in self._feeds else ():
                if topic == MISSION:
                    self._is_on_mission = is_running(message)
                    self._panel.mission.content = mission_html(message)
                elif MISSION not in self._feeds:
                    self._panel.mission.content = table(("Errand",), [(message.data,)])

    def rest(self) -> None:
        for feed in self._feeds.values():
            feed.close()
        self._feeds.clear()

    def base_frame(self) -> Optional[str]:
        """That of the robot which is chosen."""
        assert self._panel is not None
        prefix, known = self._panel.robot.value.strip("/"), set(self._frames.names())
        names = [f"{prefix}/{base}".lstrip("/") for base in BASE_FRAMES]
        return next((name for name in names if name in known), None)

    # -- what the panel asks for

    def set_mode(self, mode: str) -> None:
        self._pointer.aim(None if mode == LOOK else self._pointed)

    def press(self, key: str, client: int) -> None:
        assert self._panel is not None
        if self._panel.topic.value == NOBODY:
            raise CockpitError("nobody takes velocities")
        self.teleop.press(key, client, self._panel.topic.value)

    def pause(self, is_paused: bool) -> None:
        self._alone(lambda: self._orders.pause(is_paused))

    def step(self) -> None:
        self._alone(self._orders.step)

    def reset(self) -> None:
        self._alone(self._orders.reset)

    def set_speed(self, factor: float) -> None:
        self._alone(lambda: self._orders.set_speed(factor))

    def cancel(self) -> None:
        assert self._panel is not None
        self._orders.cancel(self._panel.robot.value)

    def deliver(self) -> None:
        assert self._panel is not None
        thing, ends = (
            self._panel.object.value.strip(),
            (self._panel.source.value, self._panel.destination.value),
        )
        if NOWHERE in ends:
            raise CockpitError("nobody has told of places to deliver between")
        self._alone(lambda: self._orders.deliver(thing, *ends, joins=self._is_on_mission))
        self._notify(f"{thing}: from {ends[0]} to {ends[1]}")

    def cancel_mission(self) -> None:
        self._alone(self._orders.cancel_mission)
        self._notify("the mission is cancelled")

    def _alone(self, order: Callable[[], None]) -> None:
        """One order at a time: those that a node leaves unanswered must not hold up who drives."""
        if not self._ordering.acquire(blocking=False):
            raise CockpitError("the answer before is still awaited")
        try:
            order()
        finally:
            self._ordering.release()

    def swing(self) -> None:
        """To where the slider is now; where it passes by during an answer is left out."""
        while self._swung != self._wanted_swing() and self._ordering.acquire(blocking=False):
            try:
                wanted = self._wanted_swing()
                self._orders.swing(*wanted)
                self._swung = wanted
            finally:
                self._ordering.release()

    def _wanted_swing(self) -> Tuple[str, str, float]:
        """Model, joint and position. Raises CockpitError."""
        assert self._panel is not None
        joint = self._world.view.joints.get(self._panel.joint.value)
        if joint is None:
            raise CockpitError("there is nothing to open")
        return joint.model, joint.name, joint.opened(self._panel.opened.value / 100.0)

    def _pointed(self, x: float, y: float, yaw: Optional[float], _client: int) -> None:
        assert self._panel is not None
        mode, robot, fixed = self._panel.mode.value, self._panel.robot.value, self._fixed()
        self._panel.reset_mode()
        self._pointer.aim(None)
        try:
            if mode == GOAL:
                self._orders.goal(robot, fixed, x, y, self._yaw_to(x, y) if yaw is None else yaw)
                self._notify(f"goal sent: {x:.2f}, {y:.2f} in {fixed}")
            elif mode == POSE:
                self._orders.estimate(robot, fixed, x, y, yaw or 0.0)
                self._notify(f"pose estimate sent: {x:.2f}, {y:.2f} in {fixed}")
            elif mode == POINT:
                self._orders.point(fixed, x, y)
                self._notify(f"point published: {x:.2f}, {y:.2f} in {fixed}")
            elif mode == BOX:
                self._drop(*self._in_world(x, y, 0.0)[:2])
            elif mode == MOVE:
                self._move(*self._in_world(x, y, yaw))
        except (CockpitError, rospy.ROSException) as error:
            self._notify(str(error))

    def _yaw_to(self, x: float, y: float) -> float:
        """The direction from the robot to a place: a goal that is only clicked is reached looking ahead."""
        base = self.base_frame()
        pose = None if base is None else self._frames.pose(base, self._fixed())
        return 0.0 if pose is None else math.atan2(y - pose[1, 3], x - pose[0, 3])

    def _in_world(self, x: float, y: float, yaw: Optional[float]) -> Tuple[float, float, Optional[float]]:
        """Of the fixed frame. Raises CockpitError."""
        world = world_in(self._frames, self._fixed())
        if world is None:
            raise CockpitError("where the world is in the fixed frame is not known")
        at = world[:2, :2].T @ (x - world[0, 3], y - world[1, 3])
        return float(at[0]), float(at[1]), None if yaw is None else yaw - math.atan2(world[1, 0], world[0, 0])

    def _drop(self, x: float, y: float) -> None:
        name = self._orders.drop_box(x, y)
        self._notify(f"{name} dropped")

    def _move(self, x: float, y: float, yaw: Optional[float]) -> None:
        assert self._panel is not None
        model = self._panel.thing.value
        if model == NOTHING:
            raise CockpitError("there is nothing to move")
        self._world.view.move(model, self._orders.move_model(model, x, y, yaw))
        self._notify(f"{model} moved to {x:.2f}, {y:.2f}")
