"""ROS node of add_markers: shows the objects of an errand or a mission as cubes in rviz."""

from typing import Callable, List, Optional, Union

import rospy
from geometry_msgs.msg import PoseWithCovarianceStamped
from nav_msgs.msg import Odometry
from std_msgs.msg import String
from visualization_msgs.msg import Marker

from add_markers.boxes import RIDING_HEIGHT
from add_markers.config import MarkerSettings
from add_markers.parcel import CarriedParcel, ParcelStage, TimedParcel
from add_markers.ros.mission_markers import MissionMarkers
from add_markers.ros.zones import publish_zones
from planar import Pose2
from planar.maps.places import load_pickup_and_dropoff, load_places
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.conversion import pose2_from_msg, pose2_to_msg
from planar_ros.messages.transforms import Transforms
from planar_ros.messages.validation import subscribe
from planar_ros.node.checkpoint import ParameterCheckpoint
from planar_ros.node.parameters import read_settings
from planar_ros.node.readiness import ReadinessMonitor
from planar_ros.node.runner import run

UPDATE_SECONDS = 0.1
NOT_PUBLISHED = object()
Locate = Callable[[], Optional[Pose2]]
# States of pick_objects that determine the robot's place.
PICKING_UP, DELIVERED = "picking up", "delivered"


class AddMarkersNode:
    """Publishes the errand's marker, latched, whenever it appears, moves or disappears."""

    def __init__(self, settings: MarkerSettings):
        self._settings = settings
        self._pickup, self._dropoff = places = load_pickup_and_dropoff(settings.zones_file)
        self._robot: Optional[Pose2] = None
        self._shown_at: object = NOT_PUBLISHED
        self._publisher = rospy.Publisher("visualization_marker", Marker, queue_size=10, latch=True)
        self._zones = publish_zones(places, settings.frame_id)
        self._checkpoint: Optional[ParameterCheckpoint] = None
        self._parcel: Union[TimedParcel, CarriedParcel]
        self._locate: Locate
        if settings.mode == "demo":
            self._parcel = TimedParcel(*places, settings.show_seconds, settings.hide_seconds)
            self._locate = lambda: None
        else:
            self._checkpoint = ParameterCheckpoint() if settings.resume else None
            left = None if self._checkpoint is None else self._checkpoint.recovered(ParcelStage)
            stage = ParcelStage.WAITING if left is None else left
            self._parcel = CarriedParcel(*places, settings.pickup_seconds, stage)
            self._locate = self._locator(settings.pose_source)
        ReadinessMonitor(self._conditions())

    def work(self):
        """Update the marker until shutdown."""
        step = LockstepClient.of_node()
        step.every(lambda: UPDATE_SECONDS, self._update, lambda: None)
        step.join()

    def _update(self, now: rospy.Time) -> None:
        self._robot = self._locate()
        self._show(self._parcel.update(now.to_sec(), self._robot))
        if self._checkpoint is not None and isinstance(self._parcel, CarriedParcel):
            self._checkpoint.save(self._parcel.stage.value)

    def _locator(self, source: str) -> Locate:
        if source == "tf":
            transforms = Transforms()
            return lambda: transforms.lookup(self._settings.frame_id, self._settings.base_frame_id)
        latest: List[Optional[Pose2]] = [None]

        def on_pose(message) -> None:
            latest[0] = pose2_from_msg(message.pose.pose)

        def on_state(message) -> None:
            place = {PICKING_UP: self._pickup, DELIVERED: self._dropoff}.get(message.data)
            latest[0] = place.pose if place else None

        if source == "state":
            rospy.Subscriber("pick_objects/state", String, on_state, queue_size=10)
        elif source == "odom":
            subscribe("odom", Odometry, on_pose, queue_size=1)
        else:
            subscribe("amcl_pose", PoseWithCovarianceStamped, on_pose, queue_size=1)
        return lambda: latest[0]

    def _conditions(self):
        settings = self._settings
        if settings.mode == "demo" or settings.pose_source == "state":
            return {"the clock": lambda: rospy.get_time() > 0.0}
        if settings.pose_source == "tf":
            name = f"the transform {settings.frame_id} to {settings.base_frame_id}"
        else:
            name = f"a pose on {rospy.resolve_name(settings.pose_source)}"
        return {name: lambda: self._robot is not None}

    def _show(self, pose):
        if pose == self._shown_at:
            return
        self._shown_at = pose
        marker = Marker(ns="parcel", id=0, type=Marker.CUBE)
        marker.header.frame_id = self._settings.frame_id
        marker.pose = pose2_to_msg(pose if pose is not None else self._pickup.pose)
        marker.scale.x = marker.scale.y = marker.scale.z = self._settings.size
        marker.pose.position.z = marker.scale.z / 2.0
        if isinstance(self._parcel, CarriedParcel) and self._parcel.stage is ParcelStage.DELIVERED:
            marker.pose.position.z += RIDING_HEIGHT  # on the robot, which covers the place
        marker.color.r, marker.color.g, marker.color.b, marker.color.a = 0.9, 0.4, 0.1, 1.0
        marker.action = Marker.ADD if pose is not None else Marker.DELETE
        self._publisher.publish(marker)
        if pose is None:
            rospy.loginfo("marker hidden")
        else:
            rospy.loginfo("marker shown at (%g, %g)", pose.x, pose.y)


def main():
    def start():
        LockstepClient.of_node()
        settings = read_settings(MarkerSettings)
        if settings.mode == "mission":
            zones = publish_zones(load_places(settings.zones_file).values(), settings.frame_id)
            markers = MissionMarkers(settings)
            LockstepClient.of_node().join()
            return zones, markers
        return AddMarkersNode(settings).work()

    run("add_markers", start)
