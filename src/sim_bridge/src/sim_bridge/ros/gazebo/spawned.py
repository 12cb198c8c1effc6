"""What has been spawned, for those who show the world."""

from typing import Dict

import numpy as np
import rospy
from sim_bridge_msgs.msg import SpawnedModel, SpawnedModels

from sim_bridge.ros.messages import pose3_to_msg


class Spawned:
    """Tells of the models that are not in the world's file."""

    def __init__(self) -> None:
        self._models: Dict[str, SpawnedModel] = {}
        self._publisher = rospy.Publisher("~spawned", SpawnedModels, queue_size=1, latch=True)

    def add(self, name: str, xml: str, pose: np.ndarray) -> None:
        """``pose``: (4, 4) in the world."""
        self._models[name] = SpawnedModel(name, xml, pose3_to_msg(pose))
        self._tell()

    def remove(self, name: str) -> None:
        """If it is one of them."""
        if self._models.pop(name, None) is not None:
            self._tell()

    def _tell(self) -> None:
        self._publisher.publish(SpawnedModels(list(self._models.values())))
