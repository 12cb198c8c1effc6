"""The sources of the map: service, topic, or ``set_map``."""

import time
from typing import Callable

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.srv import SetMapResponse

from amcl_lite.ros.locked_localizer import LockedLocalizer
from planar import OccupancyGrid, PlanarError
from planar_ros.messages.conversion import (
    GetMapArrays,
    OccupancyGridArrays,
    SetMapArrays,
    frame_name,
    grid_from_msg,
)

# Wall time without a map after which its lack is a warning [s], and between two requests [s].
FETCH_ALARM_SECONDS = 15.0
FETCH_RETRY_SECONDS = 0.5


class MapSource:
    """Sets the map of the Localizer from the service or the topic, or by the service ``set_map``.

    Args:
        shared: The Localizer.
        publish_likelihood_field: Called with the likelihood field of each new map.
        handle_pose: Called with the pose of a ``set_map`` request and whether to force an update.
    """

    def __init__(
        self,
        shared: LockedLocalizer,
        publish_likelihood_field: Callable[[OccupancyGrid], None],
        handle_pose: Callable[[PoseWithCovarianceStamped, bool], None],
    ):
        self._shared = shared
        self._show_field, self._handle_pose = publish_likelihood_field, handle_pose
        self._is_topic = shared.settings.use_map_topic
        rospy.Service("set_map", SetMapArrays, self._on_set_map)
        if self._is_topic:
            rospy.Subscriber("map", OccupancyGridArrays, self._on_map, queue_size=1)
            rospy.loginfo("Subscribed to map topic.")

    @property
    def name(self) -> str:
        """Name of the topic or the service, for messages."""
        if self._is_topic:
            return f"topic {rospy.resolve_name('map')}"
        return f"service {rospy.resolve_name('static_map')}"

    def fetch(self) -> None:
        """Wait for the map from the service static_map. Raises PlanarError if the map is invalid."""
        if self._is_topic:
            return
        rospy.loginfo("Requesting the map...")
        static_map = rospy.ServiceProxy("static_map", GetMapArrays)
        alarm_time = time.monotonic() + FETCH_ALARM_SECONDS  # nodes start in any order
        while not rospy.is_shutdown():
            try:
                self._install(static_map().map)
                return
            except rospy.ServiceException:
                if time.monotonic() > alarm_time:
                    rospy.logwarn_throttle(FETCH_ALARM_SECONDS, "Request for map failed; trying again...")
                time.sleep(FETCH_RETRY_SECONDS)

    def _on_map(self, message):
        if self._shared.localizer is not None and self._shared.settings.first_map_only:
            return
        try:
            self._install(message)
        except PlanarError as error:
            rospy.logerr("map refused: %s", error)

    def _on_set_map(self, request):
        try:
            self._install(request.map)
            self._handle_pose(request.initial_pose, self._shared.settings.force_update_after_set_map)
        except PlanarError as error:
            rospy.logerr("map refused: %s", error)
            return SetMapResponse(success=False)
        return SetMapResponse(success=True)

    def _install(self, message):
        info, map_frame = message.info, self._shared.settings.map_frame
        rospy.loginfo("Received a %d X %d map @ %.3f m/pix", info.width, info.height, info.resolution)
        if frame_name(message.header.frame_id) != frame_name(map_frame):
            rospy.logwarn(
                "Frame_id of map received:'%s' doesn't match global_frame_id:'%s'. "
                "This could cause issues with reading published topics",
                message.header.frame_id,
                map_frame,
            )
        localizer = self._shared.set_map(grid_from_msg(message))
        self._show_field(localizer.likelihood_grid)
