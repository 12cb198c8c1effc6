"""The kind ``turned_round``."""

import math

import numpy as np

from planar import Pose2
from sim_bridge.faults.kind import FaultKind, Stage
from sim_bridge.geometry.pose3 import from_pose2
from sim_bridge.physics.kinematics import KinematicState


class TurnedRound(FaultKind):
    """The robot is turned on the spot, without its wheels."""

    strength = (45.0, -180.0, 180.0)
    unit = "degrees"

    def begin(self, stage: Stage) -> None:
        height = float(stage.scene.models.state(stage.robot).pose[2, 3])
        base = stage.base_in_world @ Pose2(yaw=math.radians(self._strength))
        stage.scene.set_model_state(
            stage.robot, KinematicState(from_pose2(base, z=height), np.zeros(3), np.zeros(3))
        )
