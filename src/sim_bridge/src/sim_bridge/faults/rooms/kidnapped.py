"""The kind ``kidnapped``."""

import numpy as np

from planar import Pose2
from sim_bridge.faults.kind import FaultKind, Stage
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.physics.motion import Motion


class Kidnapped(FaultKind):
    """The robot is carried away sideways."""

    strength = (0.5, -10.0, 10.0)
    unit = "m"

    def begin(self, stage: Stage) -> None:
        height = float(stage.scene.models.motion(stage.robot).pose[2, 3])
        base = stage.base_in_world @ Pose2(0.0, self._strength)
        stage.scene.set_model_motion(
            stage.robot, Motion(from_pose2(base, z=height), np.zeros(3), np.zeros(3))
        )
