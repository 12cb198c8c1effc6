"""Checkpoint of pose and belief, from which a restarted node resumes.

The official ``initial_pose`` parameters hold the last saved pose, but the robot has moved since. After a
crash, with continuous odometry, the node resumes from the saved belief and the odometry instead.
"""

import math
import time
from dataclasses import asdict
from functools import partial
from typing import Optional

import rospy

from amcl_lite.belief import Belief, load_particles, save_particles
from amcl_lite.config import InitialPose, NodeSettings
from amcl_lite.localizer import is_valid_initial_pose
from planar import Pose2
from planar.config.parameters import official_names
from planar_ros.node.checkpoint import FileCheckpoint, SavedFile
from planar_ros.node.parameters import RESTORE, ParameterWriter, read_settings

# Shortest wall time between two checkpoints [s]: a fast simulation would keep the master busy.
_LEAST_SECONDS = 0.5


# Names in the official node's messages.
IN_MESSAGES = {
    "initial_pose_x": "initial pose X position",
    "initial_pose_y": "initial pose Y position",
    "initial_pose_a": "initial pose Yaw",
    "initial_cov_xx": "initial covariance XX",
    "initial_cov_yy": "initial covariance YY",
    "initial_cov_aa": "initial covariance AA",
}


def read_initial_pose() -> InitialPose:
    """Read ``~initial_pose_*`` and ``~initial_cov_*``; NaN is ignored with a warning."""
    names = official_names(InitialPose)
    for name in names:
        value = rospy.get_param("~" + name, 0.0)
        if isinstance(value, float) and math.isnan(value):
            rospy.logwarn("ignoring NAN in %s", IN_MESSAGES[name])
            rospy.delete_param("~" + name)
    return read_settings(InitialPose, names, ignore=(*official_names(NodeSettings), RESTORE))


class PoseCheckpoint:
    """Saves the pose, as amcl does, and the belief, for a restart after a crash."""

    def __init__(self):
        self._kept_at, self._kept_at_wall = rospy.Time(0), 0.0
        self._writer = ParameterWriter()
        self._checkpoint = FileCheckpoint()

    def load_belief(self) -> Optional[Belief]:
        """Return the belief of a crashed node of this name, or None."""
        return self._checkpoint.recovered(_belief)

    def save_if_due(self, rate: float, belief: Belief, base_in_odom: Pose2, covariance) -> None:
        """Save pose and belief at most at ``rate`` [Hz]; never for 0 or less."""
        now, wall = rospy.Time.now(), time.monotonic()
        is_due = rate > 0.0 and abs((now - self._kept_at).to_sec()) >= 1.0 / rate
        if is_due and wall - self._kept_at_wall >= _LEAST_SECONDS:
            self._kept_at, self._kept_at_wall = now, wall
            self.save(belief.odom_in_map @ base_in_odom, covariance)
            self._save_belief(belief)

    def save(self, base_in_map: Pose2, covariance) -> None:
        """Save a pose and the diagonal of its covariance (3, 3), if they are valid."""
        if not is_valid_initial_pose(base_in_map, covariance):
            return
        variances = (float(covariance[i, i]) for i in range(3))
        kept = InitialPose(base_in_map.x, base_in_map.y, base_in_map.yaw, *variances)
        names = official_names(InitialPose)
        self._writer.write({"~" + name: getattr(kept, field) for name, field in names.items()})

    def _save_belief(self, belief: Belief) -> None:
        poses = {"base_in_odom": asdict(belief.base_in_odom), "odom_in_map": asdict(belief.odom_in_map)}
        self._checkpoint.save(partial(save_particles, belief.particles), {**poses, "is_lost": belief.is_lost})


def _belief(saved: SavedFile) -> Belief:
    poses = {name: Pose2.from_dict(saved.value[name]) for name in ("base_in_odom", "odom_in_map")}
    return Belief(load_particles(saved.path), is_lost=bool(saved.value["is_lost"]), **poses)
