"""The robot of a service in an episode: navigation, localization, docking, battery, without ROS."""

from typing import Optional

from auto_docking_lite import DockController
from headless_mission.docking import DockingHooks
from headless_mission.localization import LocalizationHooks
from headless_mission.navigation import EpisodeMoveBaseClient, NavigationHooks
from move_base_lite import NavigatorSettings
from move_base_lite.navigator.zones import Zones
from pick_objects import DriveToPlace, GoalDriver
from planar import OccupancyGrid, Pose2
from service.execution.robot import (
    DockingFailed,
    DockRobot,
    RobotDocked,
    RobotEvent,
    RobotInputs,
    RobotOrder,
    RobotUndocked,
    UndockRobot,
)
from sim_bridge import Episode, EpisodeHooks, StepResult


class EpisodeRobot(EpisodeHooks):
    """Carries out orders in an episode, as ``service.ros.robot_client.RobotClient`` over ROS.

    Args:
        settings: Parameters of move_base.
        grid: Map.
        seed: Seed of particles and of the dock's estimate.
        start: Start pose in the map.
        dock: Pose of the dock in the map.

    Attributes:
        navigation: move_base in the episode.
        hooks: What takes part in the episode, in the order of an instant, without the localization.
        localization: The localization, whose hooks come last.
    """

    def __init__(
        self, settings: NavigatorSettings, grid: OccupancyGrid, seed: int, start: Pose2, dock: Pose2
    ):
        self.navigation = NavigationHooks(settings, grid, zones=Zones().with_dock(dock))
        client, staging = EpisodeMoveBaseClient(self.navigation), EpisodeMoveBaseClient(self.navigation)
        self._client, self._driver, self._dock = client, GoalDriver(client), dock
        self._controller = DockController(navigation=staging, seed=seed)
        self._docking = DockingHooks(self._controller)
        self.localization = LocalizationHooks(grid, seed, start, self.navigation.poses, self._driver.add_fit)
        self.hooks = client, staging, self.navigation, self._docking, self
        self._success: Optional[RobotEvent] = None
        self._event: Optional[RobotEvent] = None
        self._inputs = RobotInputs(start)

    @property
    def is_moving(self) -> bool:
        """Whether an order is under way that moves the robot."""
        return self._success is not None or self.navigation.move_base.is_active

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        """Receive what was measured, and the outcome of docking."""
        self._docking.odom_in_map = self.navigation.poses.odom_in_map()
        self._driver.odometry = self.navigation.poses.base_in_odom()
        pose, power, result = self.navigation.base_in_map, step.power, self._docking.decision.result
        self._inputs = RobotInputs(
            self._inputs.pose if pose is None else pose,
            None if power is None else power.charge,
            power is not None and bool(power.charger),
        )
        if result is not None and self._success is not None:
            self._event = self._success if result.is_success else DockingFailed(result.text)
            self._success = None

    def inputs(self) -> RobotInputs:
        """Return what is known of the robot."""
        return self._inputs

    def event(self, now: float) -> Optional[RobotEvent]:
        """Return what happened to the last order, if there is news; ``now`` is simulated time [s]."""
        event, self._event = self._event, None
        return event or self._driver.event(now)

    def carry_out(self, order: Optional[RobotOrder], now: float) -> None:
        """Begin an order, which replaces any earlier one."""
        if order is None:
            return
        self._controller.cancel(now)
        self._success = self._event = None
        if isinstance(order, DriveToPlace):
            self._driver.carry_out(order)
            return
        self._driver.discard_order()
        self._client.cancel()
        if isinstance(order, DockRobot):
            self._controller.start(now, self._dock)
            self._success = RobotDocked()
        elif isinstance(order, UndockRobot):
            self._controller.undock(now)
            self._success = RobotUndocked()
