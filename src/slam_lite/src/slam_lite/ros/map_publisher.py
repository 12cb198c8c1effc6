"""Publisher of the map: topics and a service."""

import math
import threading
import time
from typing import Optional

import numpy as np
import rospy
from nav_msgs.msg import MapMetaData
from std_msgs.msg import Float64

from planar import OccupancyGrid
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.conversion import GetMapArrays, OccupancyGridArrays, frame_name, grid_to_msg
from slam_lite.config import NodeSettings
from slam_lite.ros.thread_safe_mapper import ThreadSafeMapper

# Resolution of the pose of which the entropy is published: 1 cm, 1 cm and 0.01 rad.
ENTROPY_CELL = 1e-6
# Wall seconds between two checks whether the node is still synchronised.
IN_STEP_SECONDS = 0.2


class MapPublisher:
    """Renders and publishes the map in its own thread, so that scans do not wait for it.

    In a synchronised node it does so when the callbacks of a tick are done.
    """

    def __init__(self, settings: NodeSettings, mapper: ThreadSafeMapper):
        """Advertise the topics and the service, and start the thread.

        Args:
            settings: ``map_update_interval``, extent and frame of the map.
            mapper: Source of the keyframes to render.
        """
        self._settings = settings
        self._mapper = mapper
        self._rendering = threading.Lock()
        self._is_due = threading.Event()
        self._stamp = -math.inf
        self._message: Optional[OccupancyGridArrays] = None
        self._map_publisher = rospy.Publisher("map", OccupancyGridArrays, queue_size=1, latch=True)
        self._metadata_publisher = rospy.Publisher("map_metadata", MapMetaData, queue_size=1, latch=True)
        self._entropy_publisher = rospy.Publisher("~entropy", Float64, queue_size=1, latch=True)
        rospy.Service("dynamic_map", GetMapArrays, self._on_dynamic_map)
        threading.Thread(target=self._publish_maps, daemon=True).start()
        rospy.on_shutdown(self._is_due.set)

    def on_scan(self, stamp: float) -> None:
        """Mark the next map as due, ``map_update_interval`` after the last one.

        Args:
            stamp: Time of the inserted scan [s].
        """
        if not 0.0 <= stamp - self._stamp < self._settings.map_update_interval:
            self._stamp = stamp
            self._is_due.set()

    def grid(self) -> Optional[OccupancyGrid]:
        """Render the present map; returns None before the first scan."""
        renderer, evidence, _ = self._mapper.render_job()
        with self._rendering:
            renderer.update(evidence)
            grid = renderer.grid()
        return grid if len(evidence.poses) else None

    def publish_if_due(self) -> None:
        """Render and publish the map if it is due."""
        if self._is_due.is_set() and not rospy.is_shutdown():
            self._is_due.clear()
            self._publish()

    def _publish_maps(self) -> None:
        step = LockstepClient.of_node()
        while not rospy.is_shutdown():
            self._is_due.wait()
            if step.is_synchronized:
                time.sleep(IN_STEP_SECONDS)
            else:
                self.publish_if_due()

    def _publish(self) -> None:
        settings = self._settings
        renderer, evidence, information = self._mapper.render_job()
        with self._rendering:
            renderer.update(evidence)
            grid = renderer.grid(settings.extent)
        message = grid_to_msg(grid, rospy.Time.now(), frame_name(settings.map_frame))
        self._message = message
        self._map_publisher.publish(message)
        self._metadata_publisher.publish(message.info)
        entropy = _entropy(information)
        if entropy > 0.0:
            self._entropy_publisher.publish(entropy)

    def _on_dynamic_map(self, request):
        if self._message is None:
            raise rospy.ServiceException("there is no map yet: no scan has been received")
        response = GetMapArrays._response_class()
        response.map = self._message
        return response


def _entropy(information: Optional[np.ndarray]) -> float:
    """Entropy [nats] of a pose with this information, at a resolution of ENTROPY_CELL."""
    if information is None or np.linalg.det(information) <= 0.0:
        return 0.0
    log_volume = 1.5 * math.log(2.0 * math.pi * math.e) - 0.5 * math.log(np.linalg.det(information))
    return log_volume - math.log(ENTROPY_CELL)
