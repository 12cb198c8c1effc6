"""The nodes of turtle_tf and turtle_tf2: broadcast a turtle's pose, and follow a turtle by tf."""

import math

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped, Twist
from turtlesim.msg import Pose
from turtlesim.srv import Spawn

from planar import PlanarError
from planar_ros.node.runner import run

LEADER, FOLLOWER = "turtle1", "turtle2"
SPAWN_POSE = (4.0, 2.0, 0.0)  # x (m), y (m), theta (rad)
# Gains from distance to linear velocity and from bearing to angular velocity [1/s].
LINEAR_GAIN, ANGULAR_GAIN = 0.5, 4.0
SERVICE_SECONDS = 30.0


def broadcast() -> None:
    """Node that broadcasts the pose of the turtle in parameter ``~turtle`` as a transform from ``world``."""
    run("turtle_tf_broadcaster", _broadcast)


def follow() -> None:
    """Node that spawns the turtle in parameter ``turtle`` and makes it follow turtle1."""
    run("turtle_tf_listener", _follow)


def _broadcast():
    turtle = rospy.get_param("~turtle", None)
    if not turtle:
        raise PlanarError(
            f"parameter {rospy.resolve_name('~turtle')} is not set: expected the name of a turtle, as turtle1"
        )
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
    listener = tf2_ros.TransformListener(buffer)  # noqa: F841 -- keeps the subscription
    _spawn(follower)
    publisher = rospy.Publisher(f"{follower}/cmd_vel", Twist, queue_size=1)
    rate = rospy.Rate(10.0)
    while not rospy.is_shutdown():
        rate.sleep()
        try:
            leader = buffer.lookup_transform(follower, LEADER, rospy.Time()).transform.translation
        except tf2_ros.TransformException:
            continue  # no transform of one of them yet
        twist = Twist()
        twist.linear.x = LINEAR_GAIN * math.hypot(leader.x, leader.y)
        twist.angular.z = ANGULAR_GAIN * math.atan2(leader.y, leader.x)
        publisher.publish(twist)


def _spawn(turtle: str) -> None:
    try:
        rospy.wait_for_service("spawn", SERVICE_SECONDS)
        rospy.ServiceProxy("spawn", Spawn)(*SPAWN_POSE, turtle)
    except rospy.ROSInterruptException:
        raise
    except rospy.ROSException as error:
        raise PlanarError(f"the service spawn is not available, is turtlesim_node running? {error}") from None
    except rospy.ServiceException:
        rospy.loginfo("%s exists already", turtle)
