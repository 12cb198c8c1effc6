"""The kind ``kidnapped``."""

import numpy as np

from planar import Pose2
from sim_bridge.faults.kind import FaultKind, Stage
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.physics.kinematics import KinematicState

# Shares of the way after which it is set down: the first at which it stands in nothing.
SHARES = (1.0, 0.8, 0.6, 0.4, 0.2, 0.0)


class Kidnapped(FaultKind):
    """The robot is carried away sideways.

    It is set down where it stands in nothing, before a wall if need be.
    """

    strength = (0.5, -10.0, 10.0)
    unit = "m"

    def begin(self, stage: Stage) -> None:
        height = float(stage.scene.models.state(stage.robot).pose[2, 3])
        for share in SHARES:
            base = stage.base_in_world @ Pose2(0.0, share * self._strength)
            still = KinematicState(from_pose2(base, z=height), np.zeros(3), np.zeros(3))
            stage.scene.set_model_state(stage.robot, still)
            if stage.scene.robot(stage.robot).vehicle.overlap() is None:
                return
