"""Who works for the Navigator: a planner, a controller, costmaps, and an eye on what moves."""

from typing import Optional, Sequence, Tuple

import numpy as np

from move_base_lite.config import NavigatorSettings
from move_base_lite.control import LOCAL_PLANNERS, Controller, Situation
from move_base_lite.costmap import Sighting
from move_base_lite.navigator.costmaps import Costmaps
from move_base_lite.navigator.foresight import motion_ahead
from move_base_lite.navigator.pursuit import Moment
from move_base_lite.navigator.zones import Zones
from move_base_lite.people import Movers
from move_base_lite.planning import GLOBAL_PLANNERS
from planar import OccupancyGrid, Pose2, Twist2


class Crew:
    """Made from settings, and changed with them; ``zones`` may be switched by others.

    ``latency``: seconds until a command takes effect; ``in_force``: the one that the robot obeys meanwhile.
    """

    def __init__(self, settings: NavigatorSettings, grid: Optional[OccupancyGrid], zones: Zones):
        self.settings, self.zones = settings, zones
        self.latency, self.in_force = 0.0, Twist2()
        self.planner = GLOBAL_PLANNERS.make(settings.planner)
        self.set_map(grid)
        self.begin_anew()

    def set_map(self, grid: Optional[OccupancyGrid]) -> None:
        """Another map, and nothing has been seen yet."""
        self.costmaps = Costmaps(self.settings, grid, self.zones)
        self._movers = Movers()

    def begin_anew(self) -> None:
        """Forgets how the last goal was pursued."""
        settings = self.settings.controller
        self.controller = Controller(settings, self.period, LOCAL_PLANNERS.make(settings, self.period))

    def change(self, settings: NavigatorSettings) -> None:
        """Goes on with other settings, plan included."""
        before, self.settings = (self.settings.controller, self.period), settings
        self.planner = GLOBAL_PLANNERS.make(settings.planner)
        if (settings.controller, self.period) != before:
            planner = LOCAL_PLANNERS.make(settings.controller, self.period)
            self.controller.change(settings.controller, self.period, planner)
        self.costmaps.change(settings)

    @property
    def period(self) -> float:
        """Of control, seconds."""
        return 1.0 / self.settings.move_base.controller_frequency

    def look(self, moment: Moment, sightings: Sequence[Sighting]) -> None:
        """Takes in what is seen; a plan does not have to lead around people who walk."""
        lasting = [self._lasting(moment.base_in_odom, sighting) for sighting in sightings]
        self.costmaps.look(moment.now, moment.base_in_map, moment.base_in_odom, sightings, lasting)

    def _lasting(self, base_in_odom: Pose2, sighting: Sighting) -> Sighting:
        """What is seen without what moves."""
        lookout = self.settings.controller.lookout
        if lookout is None or sighting.topic != self.settings.scan_topic:
            return sighting
        return self._movers.look(base_in_odom, sighting, lookout)

    def plan(self, start_in_map: Pose2, goal_in_map: Pose2, tolerance: float = 0.0) -> np.ndarray:
        """Path (N, 2) in the map between any two places. Raises PlanningError."""
        costmap = self.costmaps.whole
        start_xy: Tuple[float, float] = (start_in_map.x, start_in_map.y)
        return self.planner.plan(
            costmap.costs, costmap.window, start_xy, (goal_in_map.x, goal_in_map.y), tolerance
        )

    def situation(self, moment: Moment) -> Situation:
        """What a velocity is to be chosen from: how things will stand when it takes effect."""
        controller = self.settings.controller
        acceleration = Twist2(controller.acc_lim_x, controller.acc_lim_theta)
        moved, twist = motion_ahead(moment.twist, self.in_force, self.latency, acceleration)
        return Situation(
            moment.base_in_map @ moved,
            moment.base_in_odom @ moved,
            twist,
            self.costmaps.near,
            self._movers.at(moment.now + self.latency),
            self.costmaps.whole,
        )
