"""The start pose on the parameter server, where a restarted node finds where it was.

The official parameters say where the robot was; it has driven on meanwhile. So after a crash, where odometry
goes on, the place of odometry's origin counts instead.
"""

import math
from dataclasses import asdict
from typing import Optional

import rospy

from amcl_lite.config import InitialPose, NodeSettings
from amcl_lite.localizer import can_start_from
from planar import Pose2
from planar.config.parameters import official_names
from planar_ros.node.keepsake import Keepsake
from planar_ros.node.parameters import ParameterWriter, read_settings
from planar_ros.node.reconfigure import RESTORE


def read_start_pose() -> InitialPose:
    """The ``~initial_pose_*`` and ``~initial_cov_*`` of now; NaN is ignored, with a warning."""
    names = official_names(InitialPose)
    for name in names:
        value = rospy.get_param("~" + name, 0.0)
        if isinstance(value, float) and math.isnan(value):
            rospy.logwarn("ignoring NAN in %s", name)
            rospy.delete_param("~" + name)
    return read_settings(InitialPose, names, ignore=(*official_names(NodeSettings), RESTORE))


class PoseKeeper:
    """Writes the pose to the parameter server, no more often than the rate says."""

    def __init__(self):
        self._kept_at = rospy.Time(0)
        self._writer = ParameterWriter()
        self._keepsake = Keepsake()

    @property
    def odom_in_map(self) -> Optional[Pose2]:
        """As a node of this name has left it that has crashed; None without such a one."""
        found = self._keepsake.found
        return None if found is None else Pose2(**found)

    def keep_if_due(self, rate: float, odom_in_map: Pose2, base_in_odom: Pose2, covariance) -> None:
        """``rate``: Hz, 0 or less for never."""
        now = rospy.Time.now()
        if rate > 0.0 and abs((now - self._kept_at).to_sec()) >= 1.0 / rate:
            self._kept_at = now
            self.keep(odom_in_map @ base_in_odom, covariance)
            self._keepsake.keep(asdict(odom_in_map))

    def keep(self, base_in_map: Pose2, covariance) -> None:
        """``covariance``: (3, 3); its diagonal is kept. A pose that no node could start from is not."""
        if not can_start_from(base_in_map, covariance):
            return
        variances = (float(covariance[i, i]) for i in range(3))
        kept = InitialPose(base_in_map.x, base_in_map.y, base_in_map.yaw, *variances)
        names = official_names(InitialPose)
        self._writer.write({"~" + name: getattr(kept, field) for name, field in names.items()})
