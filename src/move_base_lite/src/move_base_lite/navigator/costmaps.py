"""The global and the local costmap of a robot."""

import math
from typing import Dict, List, Optional, Sequence, Tuple

from move_base_lite.config import NavigatorSettings
from move_base_lite.costmap import INSCRIBED, LETHAL, UNKNOWN, LayeredCostmap, Observation, Polygon
from move_base_lite.costmap.static_maps import Maps
from move_base_lite.errors import GoalBlocked, OutOfMap
from move_base_lite.navigator.inputs import RobotState
from move_base_lite.navigator.zones import NavigationZone, Zones
from planar import Pose2

TIME_TOLERANCE = 1e-6


class Costmaps:
    """Updates both costmaps from observations.

    Attributes:
        global_costmap: Costmap for planning, in the map frame.
        local_costmap: Costmap for control, around the robot, in the odometry frame.
    """

    def __init__(self, settings: NavigatorSettings, maps: Maps, zones: Zones):
        """Create the costmaps without observations.

        Args:
            settings: Settings of both costmaps.
            maps: Maps of the static layers.
            zones: Keep-out zones to apply.
        """
        self._settings = settings
        self._zones = zones
        self._applied_zones: Tuple[List[NavigationZone], List[NavigationZone]] = ([], [])
        self._next_updates = [-math.inf, -math.inf]
        self._last_stamps: Dict[str, float] = {}
        self.global_costmap = LayeredCostmap(settings.global_costmap, maps)
        self.local_costmap = LayeredCostmap(settings.local_costmap, maps)

    def update_settings(self, settings: NavigatorSettings) -> None:
        """Apply other settings; observations stay unless the cells change."""
        self._settings = settings
        self.global_costmap = self.global_costmap.with_settings(settings.global_costmap)
        self.local_costmap = self.local_costmap.with_settings(settings.local_costmap)

    def set_maps(self, maps: Maps) -> None:
        """Replace the maps; observations stay unless the cells change."""
        self.global_costmap = self.global_costmap.with_maps(maps)
        self.local_costmap = self.local_costmap.with_maps(maps)

    def clear(self) -> None:
        """Clear all obstacles that are not in a map."""
        self.local_costmap.reset()
        self.global_costmap.reset()

    def update(
        self,
        state: RobotState,
        observations: Sequence[Observation],
        static_observations: Sequence[Observation],
    ) -> None:
        """Add observations and update the costmaps that are due.

        Args:
            state: Robot state at this control tick.
            observations: Sensor data for the local costmap.
            static_observations: The same without moving obstacles, for the global costmap.
        """
        map_in_odom = state.base_in_odom @ state.base_in_map.inverse()
        self._apply_zones(state.base_in_map)
        for observation in observations:
            self._last_stamps[observation.topic] = observation.stamp
        inputs = (
            (self.local_costmap, state.base_in_odom, map_in_odom, observations),
            (self.global_costmap, state.base_in_map, Pose2(), static_observations),
        )
        for number, (costmap, base_in_frame, map_in_frame, new_observations) in enumerate(inputs):
            for observation in new_observations:
                costmap.add_observation(observation, base_in_frame)
            if state.stamp >= self._next_updates[number] - TIME_TOLERANCE:
                costmap.update(base_in_frame, map_in_frame)
                frequency = costmap.settings.update_frequency
                self._next_updates[number] = state.stamp + (1.0 / frequency if frequency > 0.0 else math.inf)

    @property
    def next_update(self) -> float:
        """Time at which a costmap is to be updated next [s]."""
        return min(self._next_updates)

    def last_stamp(self, topic: str) -> float:
        """Stamp of the newest observation from a topic [s]; -inf if there is none."""
        return self._last_stamps.get(topic, -math.inf)

    def stale_source(self, now: float) -> Optional[str]:
        """Return the topic of a sensor whose data exceed its ``expected_update_rate``; None if there is none.

        Args:
            now: Time [s].
        """
        for costmap in (self._settings.local_costmap, self._settings.global_costmap):
            enabled = (layer for layer in costmap.obstacle_layers if layer.enabled)
            for source in (source for layer in enabled for source in layer.sources):
                if 0.0 < source.expected_update_rate < now - self.last_stamp(source.topic):
                    return source.topic
        return None

    def check_goal(self, goal: Pose2) -> None:
        """Reject a goal that no recovery behaviour can make reachable.

        Args:
            goal: Goal pose in the map frame.

        Raises:
            OutOfMap: The goal is outside of the map.
            GoalBlocked: It is in a keep-out zone, an obstacle of the map, or unknown space.
        """
        costmap, where = self.global_costmap, f"the goal at ({goal.x:.2f}, {goal.y:.2f})"
        if not costmap.window.contains(goal.x, goal.y):
            raise OutOfMap(f"{where} is outside the map")
        planner = self._settings.planner
        if planner.default_tolerance > 0.0:
            return
        for zone in self._zones.keep_out_at(goal.x, goal.y):
            raise GoalBlocked(f"{where} is in the keep-out zone {zone.name}")
        cost = costmap.map_costs[costmap.window.cell_of(goal.x, goal.y)]
        if cost == LETHAL:
            raise GoalBlocked(f"{where} is in an obstacle of the map")
        if cost == INSCRIBED:
            raise GoalBlocked(f"{where} is too close to an obstacle of the map")
        if cost == UNKNOWN and not planner.allow_unknown:
            raise GoalBlocked(f"{where} is in unknown space")

    def _apply_zones(self, base_in_map: Pose2) -> None:
        """Block the keep-out zones, except those that the robot is in and has to leave."""
        blocked, occupied = self._zones.split_keep_out(base_in_map)
        if (blocked, occupied) == self._applied_zones:
            return
        self._applied_zones = (blocked, occupied)
        for costmap in (self.global_costmap, self.local_costmap):
            costmap.set_keep_out(_polygons(blocked), _polygons(occupied))


def _polygons(zones: List[NavigationZone]) -> List[Polygon]:
    return [zone.polygon for zone in zones]
