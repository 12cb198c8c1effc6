"""The nodes of turtle_tf and turtle_tf2: where a turtle is, and one that follows another by tf."""

import math

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped, Twist
from turtlesim.msg import Pose
from turtlesim.srv import Spawn

from planar import PlanarError
from planar_ros.node.shell import run

LEADER, FOLLOWER = "turtle1", "turtle2"
SPAWN_POSE = (4.0, 2.0, 0.0)  # x (m), y (m), theta (rad)
# Speeds by how far away the leader is (1/s) and by the angle to it (1/s).
LINEAR_GAIN, ANGULAR_GAIN = 0.5, 4.0
SERVICE_SECONDS = 30.0


def broadcast() -> None:
    """The node that tells where the turtle of its parameter ``~turtle`` is in ``world``."""
    run("turtle_tf_broadcaster", _broadcast)


def follow() -> None:
    """The node that spawns a turtle, the parameter ``turtle``, and makes it follow turtle1."""
    run("turtle_tf_listener", _follow)


def _broadcast():
    turtle = rospy.get_param("~turtle", None)
    if not turtle:
        raise PlanarError(f"whose pose to tell is not set: {rospy.resolve_name('~turtle')}, as turtle1")
    broadcaster = tf2_ros.TransformBroadcaster()
    rospy.Subscriber(
        f"/{turtle}/pose", Pose, lambda pose: broadcaster.sendTransform(_transform(turtle, pose))
    )
    rospy.spin()


def _transform(turtle: str, pose: Pose) -> TransformStamped:
    transform = TransformStamped()
    transform.header.frame_id, transform.child_frame_id = "world", turtle
    transform.header.stamp = rospy.Time.now()
    transform.transform.translation.x, transform.transform.translation.y = pose.x, pose.y
    transform.transform.rotation.z = math.sin(pose.theta / 2.0)
    transform.transform.rotation.w = math.cos(pose.theta / 2.0)
    return transform


def _follow():
    follower = rospy.get_param("turtle", FOLLOWER)
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)  # noqa: F841 -- listens as long as it lives
    _spawn(follower)
    publisher = rospy.Publisher(f"{follower}/cmd_vel", Twist, queue_size=1)
    rate = rospy.Rate(10.0)
    while not rospy.is_shutdown():
        rate.sleep()
        try:
            seen = buffer.lookup_transform(follower, LEADER, rospy.Time()).transform.translation
        except tf2_ros.TransformException:
            continue  # one of them has not told yet where it is
        twist = Twist()
        twist.linear.x = LINEAR_GAIN * math.hypot(seen.x, seen.y)
        twist.angular.z = ANGULAR_GAIN * math.atan2(seen.y, seen.x)
        publisher.publish(twist)


def _spawn(turtle: str) -> None:
    try:
        rospy.wait_for_service("spawn", SERVICE_SECONDS)
        rospy.ServiceProxy("spawn", Spawn)(*SPAWN_POSE, turtle)
    except rospy.ROSInterruptException:
        raise
    except rospy.ROSException as error:
        raise PlanarError(f"nobody spawns turtles, is turtlesim_node running? {error}") from None
    except rospy.ServiceException:
        rospy.loginfo("there is a %s already", turtle)
