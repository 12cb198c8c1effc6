"""MoveBase: what the node move_base does between its messages and the Navigator."""

import math
from dataclasses import dataclass
from typing import Callable, FrozenSet, Optional, Sequence

from move_base_lite.config import NavigatorSettings
from move_base_lite.costmap import Maps, StaticMap, StaticMaps, StaticMapSource
from move_base_lite.errors import NavigationError, RobotLost
from move_base_lite.move_base.observation_buffer import Measurement
from move_base_lite.move_base.robot_poses import RobotPoses
from move_base_lite.move_base.sensor_inputs import SensorInputs
from move_base_lite.navigator import Navigator
from move_base_lite.navigator.costmaps import TIME_TOLERANCE
from move_base_lite.navigator.decision import Decision, GoalOutcome, RecoveryTrigger, Status, with_reason
from move_base_lite.navigator.inputs import NavigatorInputs, RobotState
from move_base_lite.navigator.zones import Zones
from planar import OccupancyGrid, Pose2, Scan, Twist2

# Longest time between two ticks without a goal [s], whatever the costmaps' update_frequency.
MAX_IDLE_PERIOD = 1.0


@dataclass(frozen=True, eq=False)
class TickResult:
    """Result of a control tick.

    Attributes:
        decision: Command and state of the goal. Without usable inputs its text is the complaint, and the
            robot stands.
        state: State of the robot; None without usable inputs.
        fault: Sensor that cannot be trusted, and why; None if there is none.
        complaints: Descriptions of sensor data that could not be used.
    """

    decision: Decision
    state: Optional[RobotState] = None
    fault: Optional[str] = None
    complaints: Sequence[str] = ()


class MoveBase:
    """Drives to goals on sensor inputs that it checks, the same way over ROS and without it.

    Store inputs with ``add_*`` as they arrive and call ``tick`` once a control period. While a pose is
    missing or too old, or a sensor cannot be trusted, the robot stands; after ~sensor_patience its goal is
    aborted.

    Args:
        settings: Parameters of move_base, its costmaps, planners and recovery behaviours.
        poses: Poses of the robot: tf, or a PoseHistory.
        grid: Static map, or those of several static layers, as far as they are known; ticks before the last
            of them do nothing.
        zones: Keep-out and speed zones.
        full_name: Returns the name of a topic for messages to people.

    Attributes:
        inputs: Sensor inputs.
    """

    def __init__(
        self,
        settings: NavigatorSettings,
        poses: RobotPoses,
        grid: Maps = None,
        zones: Zones = Zones(),
        full_name: Callable[[str], str] = lambda topic: topic,
    ):
        self.inputs = SensorInputs(settings, poses, full_name)
        self._settings, self._poses, self._zones = settings, poses, zones
        self._scan_topic = settings.scan_topic
        self._navigator: Optional[Navigator] = None
        self._commanded, self._usable_at = Twist2(), None  # type: Twist2, Optional[float]
        self._ticked_at = -math.inf
        self._maps = StaticMaps.of(grid)
        self._start_navigator()

    @property
    def navigator(self) -> Navigator:
        """The Navigator.

        Raises:
            NavigationError: There is no map yet.
        """
        if self._navigator is None:
            raise NavigationError("there is no map yet")
        return self._navigator

    @property
    def is_ready(self) -> bool:
        """Whether there is a map, or none is expected."""
        return self._navigator is not None

    @property
    def is_active(self) -> bool:
        """Whether there is a goal."""
        return self._navigator is not None and self._navigator.is_active

    def add_odometry(self, stamp: float, base_in_odom: Pose2, twist: Twist2) -> None:
        """Add odometry; any thread may call this.

        Args:
            stamp: Time of the measurement [s].
            base_in_odom: Pose of the base in the odometry frame.
            twist: Velocity.
        """
        self.inputs.add_odometry(stamp, base_in_odom, twist)

    def add_scan(self, scan: Scan, height: float = 0.0) -> None:
        """Add a scan of the first laser among the observation sources.

        Args:
            scan: The scan, with the mounting pose of its laser.
            height: Height of the laser above the floor [m].
        """
        self.inputs.add(Measurement(self._scan_topic, scan.stamp, lambda: scan, None, scan, height))

    def set_goal(self, goal_in_map: Pose2) -> None:
        """Set the goal, from the next tick on; it preempts a goal in progress.

        Args:
            goal_in_map: Goal pose in the map frame.

        Raises:
            NavigationError: There is no map yet.
            OutOfRangeError: The coordinates are too large.
        """
        self.navigator.set_goal(goal_in_map)

    def cancel(self, now: float) -> Decision:
        """Cancel the goal, if there is one; return the decision that stops the robot.

        Args:
            now: Time [s].
        """
        return self.navigator.cancel(now)

    def abort(self, text: str, error: NavigationError) -> Decision:
        """Drop the goal; return the decision that stops the robot and reports the failure.

        Args:
            text: Text of the action's result.
            error: Reason of the failure.
        """
        self.navigator.clear_goal()
        return Decision(Status.ABORTED, Twist2(), text, outcome=GoalOutcome(error.outcome, error.code, text))

    @property
    def map_sources(self) -> FrozenSet[StaticMapSource]:
        """Where the static layers of both costmaps have their maps from."""
        costmaps = self._settings.global_costmap, self._settings.local_costmap
        return frozenset(layer.source for costmap in costmaps for layer in costmap.static_layers)

    def _start_navigator(self) -> None:
        """Create the Navigator once the maps of all static layers are known."""
        if None not in [self._maps.find(source) for source in self.map_sources]:
            self._navigator = Navigator(self._settings, self._maps, self._zones)

    def set_map(self, grid: OccupancyGrid) -> None:
        """Set or replace the map of all static layers; a costmap whose cells change drops its observations.

        Args:
            grid: Static map.
        """
        self._set_maps(StaticMaps.of(grid))

    def set_layer_map(self, source: StaticMapSource, static_map: StaticMap) -> None:
        """Set or replace the map of the static layers with one source (see set_map).

        Args:
            source: Where these layers have their map from.
            static_map: Their map.
        """
        self._set_maps(self._maps.with_map(source, static_map))

    def _set_maps(self, maps: StaticMaps) -> None:
        self._maps = maps
        if self._navigator is None:
            self._start_navigator()
        else:
            self._navigator.set_map(maps)

    def update_settings(self, settings: NavigatorSettings) -> None:
        """Apply other settings; goal and plan stay."""
        self._settings = settings
        self.inputs.update_settings(settings)
        if self._navigator is not None:
            self._navigator.update_settings(settings)

    def reset(self) -> None:
        """Drop the goal, poses and all inputs, as after a jump of time."""
        self.inputs.reset()
        self._poses.reset()
        self._commanded, self._usable_at, self._ticked_at = Twist2(), None, -math.inf
        if self._navigator is not None:
            self._navigator.reset()

    def is_due(self, now: float) -> bool:
        """Return whether a tick has anything to do: always with a goal, else when a costmap is to be updated.

        Args:
            now: Time [s].
        """
        if self._navigator is None or self._navigator.is_active:
            return True
        return now >= min(self._navigator.next_update, self._ticked_at + MAX_IDLE_PERIOD) - TIME_TOLERANCE

    def tick(self, now: float, latency: float = 0.0) -> TickResult:
        """Run one control period; it may be left out where ``is_due`` is False.

        Args:
            now: Time [s].
            latency: Time until the command takes effect [s].
        """
        if self._navigator is None:
            return TickResult(Decision(Status.IDLE, text="waiting for a map"))
        self._ticked_at = now
        self.inputs.check_new(self._commanded)
        fault = self.inputs.fault(now)
        missing = self.inputs.missing(now) if fault is None else f"a trustworthy sensor ({fault})"
        state = self.inputs.state(now) if missing is None else None
        if state is None:
            decision = self._wait(now, f"waiting for {missing or 'a transform'}")
        else:
            self._usable_at = now
            inputs = NavigatorInputs(self.inputs.observations(state), latency)
            decision = self._navigator.tick(state, inputs)
        if fault is None:  # a robot that stands because of a fault is checked against the command before it
            self._commanded = decision.command or Twist2()
        return TickResult(decision, state, fault, self.inputs.complaints(now))

    def _wait(self, now: float, complaint: str) -> Decision:
        """Stand; abort the goal after ~sensor_patience."""
        if not self.is_active:
            self._usable_at = now
            return Decision(Status.IDLE, text=complaint)
        self._usable_at = now if self._usable_at is None else self._usable_at
        if now - self._usable_at <= self._settings.move_base.sensor_patience:
            return Decision(Status.WAITING, Twist2(), complaint)
        self._usable_at = now
        lost = RobotLost(complaint)
        return self.abort(with_reason(RecoveryTrigger.CONTROLLING.value, lost), lost)
