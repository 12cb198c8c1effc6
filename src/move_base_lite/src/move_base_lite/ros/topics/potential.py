"""Potential of the global planner for rviz."""

from typing import Optional

import numpy as np
import rospy
from sensor_msgs.msg import PointCloud2

from move_base_lite.planning import Potential
from planar import OccupancyGrid, Pose2
from planar_ros.messages.conversion import OccupancyGridArrays, cloud_msg, grid_to_msg

CLOUD_FIELDS = ("x", "y", "z", "pot")
# Height of the goal in navfn's cloud [m].
GOAL_HEIGHT = 20.0
UNREACHED = -1


class PotentialTopic:
    """Publishes ``~<planner>/potential`` once per plan: a grid for GlobalPlanner, a cloud for navfn."""

    def __init__(self, planner: str, map_frame: str):
        """Advertise the topic.

        Args:
            planner: Name of the global planner, the namespace of the topic.
            map_frame: Frame of the potential.
        """
        self._map_frame = map_frame
        self._latest: Optional[Potential] = None
        self._is_grid = planner == "GlobalPlanner"
        kind = OccupancyGridArrays if self._is_grid else PointCloud2
        self._publisher = rospy.Publisher(f"~{planner}/potential", kind, queue_size=1)

    def publish(self, now: rospy.Time, potential: Optional[Potential], scale: int) -> None:
        """Publish the potential if it is new; call it at every tick, since services plan between them.

        Args:
            now: Stamp of the message.
            potential: Potential of the latest plan.
            scale: Highest value of a grid.
        """
        is_new, self._latest = potential is not self._latest, potential
        if not is_new or potential is None or not self._publisher.get_num_connections():
            return
        if self._is_grid:
            self._publisher.publish(grid_to_msg(_grid(potential, scale), now, self._map_frame))
        else:
            self._publisher.publish(_cloud(potential, now, self._map_frame))


def _grid(potential: Potential, scale: int) -> OccupancyGrid:
    values, window = potential.values, potential.window
    cells = np.full(values.shape, UNREACHED, np.int8)
    is_reached = np.isfinite(values)
    highest = values[is_reached].max()
    if highest > 0.0:
        cells[is_reached] = values[is_reached] / highest * scale
    return OccupancyGrid(cells, window.resolution, Pose2(window.origin_x, window.origin_y))


def _cloud(potential: Potential, stamp: rospy.Time, frame: str) -> PointCloud2:
    window = potential.window
    rows, cols = np.nonzero(np.isfinite(potential.values))
    values = potential.values[rows, cols]
    x = window.origin_x + (cols + 0.5) * window.resolution
    y = window.origin_y + (rows + 0.5) * window.resolution
    return cloud_msg((x, y, GOAL_HEIGHT * values / potential.at_goal, values), CLOUD_FIELDS, stamp, frame)
