"""The two costmaps of a robot, and what they were shown."""

import math
from typing import Dict, List, Optional, Sequence, Tuple

from move_base_lite.config import NavigatorSettings
from move_base_lite.costmap import INSCRIBED, LETHAL, UNKNOWN, LayeredCostmap, Observation, Polygon
from move_base_lite.errors import GoalBlocked, OutOfMap
from move_base_lite.navigator.zones import NavigationZone, Zones
from planar import OccupancyGrid, Pose2

TIME_TOLERANCE = 1e-6


class Costmaps:
    """``whole``: of the map, to plan on. ``near``: of the robot's surroundings, in odom, to drive on."""

    def __init__(self, settings: NavigatorSettings, grid: Optional[OccupancyGrid], zones: Zones):
        self._settings = settings
        self._zones = zones
        self._zones_drawn: Tuple[List[NavigationZone], List[NavigationZone]] = ([], [])
        self._next_updates = [-math.inf, -math.inf]
        self._last_seen: Dict[str, float] = {}
        self.global_costmap = LayeredCostmap(settings.global_costmap, grid)
        self.local_costmap = LayeredCostmap(settings.local_costmap, grid)

    def update_settings(self, settings: NavigatorSettings) -> None:
        """Goes on with other settings; what was seen stays where it can."""
        self._settings = settings
        self.global_costmap = self.global_costmap.with_settings(settings.global_costmap)
        self.local_costmap = self.local_costmap.with_settings(settings.local_costmap)

    def clear(self) -> None:
        """Forgets all obstacles that are not in the map."""
        self.local_costmap.reset()
        self.global_costmap.reset()

    def update(
        self,
        now: float,
        base_in_map: Pose2,
        base_in_odom: Pose2,
        observations: Sequence[Observation],
        lasting: Sequence[Observation],
    ) -> None:
        """Has the costmaps note what is seen, and brings those up to date that are due.

        ``lasting``: the same without what will soon have gone, for the costmap to plan on.
        """
        map_in_odom = base_in_odom @ base_in_map.inverse()
        self._draw_zones(base_in_map)
        for observation in observations:
            self._last_seen[observation.topic] = observation.stamp
        views = (
            (self.local_costmap, base_in_odom, map_in_odom, observations),
            (self.global_costmap, base_in_map, Pose2(), lasting),
        )
        for number, (costmap, base_in_frame, map_in_frame, seen) in enumerate(views):
            for observation in seen:
                costmap.add_observation(observation, base_in_frame)
            if now >= self._next_updates[number] - TIME_TOLERANCE:
                costmap.update(base_in_frame, map_in_frame)
                frequency = costmap.settings.update_frequency
                self._next_updates[number] = now + (1.0 / frequency if frequency > 0.0 else math.inf)

    def last_stamp(self, topic: str) -> float:
        """When the newest data of a sensor were taken, seconds; -inf if there were none."""
        return self._last_seen.get(topic, -math.inf)

    def stale_source(self, now: float) -> Optional[str]:
        """The topic of a sensor whose newest data are older than a costmap allows, if there is one."""
        for costmap in (self._settings.local_costmap, self._settings.global_costmap):
            for source in costmap.obstacles.sources if costmap.obstacles.enabled else ():
                if 0.0 < source.expected_update_rate < now - self.last_stamp(source.topic):
                    return source.topic
        return None

    def check_goal(self, goal: Pose2) -> None:
        """Says at once what no recovery can change: a goal off the map, or in the map's own obstacles.

        Raises OutOfMap or GoalBlocked.
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

    def _draw_zones(self, base_in_map: Pose2) -> None:
        """Bars the keep-out zones but those that the robot stands in, which it is to leave."""
        barred, inside = self._zones.keep_out_of(base_in_map)
        if (barred, inside) == self._zones_drawn:
            return
        self._zones_drawn = (barred, inside)
        for costmap in (self.global_costmap, self.local_costmap):
            costmap.set_keep_out(_polygons(barred), _polygons(inside))


def _polygons(zones: List[NavigationZone]) -> List[Polygon]:
    return [zone.polygon for zone in zones]
