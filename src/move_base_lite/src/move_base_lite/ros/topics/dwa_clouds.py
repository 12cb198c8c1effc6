"""Samples of the dynamic window approach as point clouds for rviz."""

import numpy as np
import rospy
from sensor_msgs.msg import PointCloud2

from move_base_lite.control import TrajectorySamples
from planar_ros.messages.conversion import cloud_msg

TRAJECTORY_FIELDS = ("x", "y", "z", "theta", "cost")
COST_FIELDS = ("x", "y", "z", "path_cost", "goal_cost", "occ_cost", "total_cost")


class DwaCloudTopics:
    """Publishes ``~<planner>/trajectory_cloud`` and ``~<planner>/cost_cloud`` while there are subscribers."""

    def __init__(self, local_planner: str, odom_frame: str):
        self._odom_frame = odom_frame
        self._trajectories = rospy.Publisher(f"~{local_planner}/trajectory_cloud", PointCloud2, queue_size=1)
        self._costs = rospy.Publisher(f"~{local_planner}/cost_cloud", PointCloud2, queue_size=1)

    def publish(self, now: rospy.Time, samples: TrajectorySamples) -> None:
        """Publish the samples; call it in the control period in which they were made.

        Args:
            now: Stamp of the messages.
            samples: Samples of the local planner.
        """
        if samples.shows_trajectories and self._trajectories.get_num_connections():
            x, y, *rest = samples.trajectory_points().T
            columns = (x, y, np.zeros(len(x)), *rest)
            self._trajectories.publish(cloud_msg(columns, TRAJECTORY_FIELDS, now, self._odom_frame))
        if samples.shows_costs and self._costs.get_num_connections():
            x, y, *rest = samples.cell_costs().T
            columns = (x, y, np.zeros(len(x)), *rest)
            self._costs.publish(cloud_msg(columns, COST_FIELDS, now, self._odom_frame))
