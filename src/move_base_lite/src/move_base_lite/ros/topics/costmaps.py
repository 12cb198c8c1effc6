"""Costmap topics for rviz: costmap, costmap_updates, footprint (costmap_2d: Costmap2DPublisher)."""

import numpy as np
import rospy
from geometry_msgs.msg import Point32, PolygonStamped
from map_msgs.msg import OccupancyGridUpdate
from rospy.numpy_msg import numpy_msg

from move_base_lite.costmap import LayeredCostmap, occupancy_of
from planar import OccupancyGrid, Pose2
from planar_ros.messages.conversion import OccupancyGridArrays, frame_name, grid_to_msg

OccupancyGridUpdateArrays = numpy_msg(OccupancyGridUpdate)


class CostmapTopics(rospy.SubscribeListener):
    """Publishes a costmap while there are subscribers; a new subscriber gets the full costmap."""

    def __init__(self, name: str):
        """Advertise the topics.

        Args:
            name: Name of the costmap, the namespace of its topics.
        """
        super().__init__()
        self._send_full = False
        self._next_stamp = rospy.Time(0)
        self._last_window = None
        self._costmap = rospy.Publisher(
            f"~{name}/costmap", OccupancyGridArrays, subscriber_listener=self, queue_size=1
        )
        self._updates = rospy.Publisher(f"~{name}/costmap_updates", OccupancyGridUpdateArrays, queue_size=1)
        self._footprint = rospy.Publisher(f"~{name}/footprint", PolygonStamped, queue_size=1)

    def peer_subscribe(self, topic_name, topic_publish, peer_publish):
        self._send_full = True

    def reset_time(self) -> None:
        """Publish at the next tick, since time has jumped back."""
        self._next_stamp = rospy.Time(0)

    def publish(self, now: rospy.Time, costmap: LayeredCostmap, base_in_frame: Pose2) -> None:
        """Publish the costmap if it is due; call it at every tick.

        Args:
            now: Stamp of the messages.
            costmap: Costmap to publish.
            base_in_frame: Robot pose in the costmap's frame, for the footprint.
        """
        settings = costmap.settings
        is_due = settings.publish_frequency > 0.0 and now >= self._next_stamp
        if not (is_due or self._send_full):
            return
        if is_due:
            self._next_stamp = now + rospy.Duration(1.0 / settings.publish_frequency)
        frame = frame_name(settings.global_frame)
        if self._costmap.get_num_connections():
            is_moved = costmap.window != self._last_window
            if self._send_full or is_moved or settings.always_send_full_costmap:
                self._publish_full(now, costmap, frame)
            else:
                self._publish_update(now, costmap, frame)
        if self._footprint.get_num_connections():
            corners_xy = base_in_frame.transform_points(costmap.footprint.corners_xy)
            self._footprint.publish(_polygon(corners_xy, now, frame))

    def _publish_full(self, now, costmap, frame):
        self._send_full = False
        self._last_window = window = costmap.window
        costmap.pop_changed_bounds()
        origin = Pose2(window.origin_x, window.origin_y)
        grid = OccupancyGrid(occupancy_of(costmap.costs), window.resolution, origin)
        self._costmap.publish(grid_to_msg(grid, now, frame))

    def _publish_update(self, now, costmap, frame):
        block = costmap.pop_changed_bounds()
        rows, cols = slice(block.row_min, block.row_max), slice(block.col_min, block.col_max)
        update = OccupancyGridUpdateArrays(x=block.col_min, y=block.row_min)
        update.width, update.height = block.col_max - block.col_min, block.row_max - block.row_min
        if not (self._updates.get_num_connections() and update.width and update.height):
            return
        update.header.stamp, update.header.frame_id = now, frame
        update.data = np.ascontiguousarray(occupancy_of(costmap.costs[rows, cols])).ravel()
        self._updates.publish(update)


def _polygon(corners_xy: np.ndarray, now: rospy.Time, frame: str) -> PolygonStamped:
    message = PolygonStamped()
    message.header.stamp, message.header.frame_id = now, frame
    message.polygon.points = [Point32(x, y, 0.0) for x, y in corners_xy]
    return message
