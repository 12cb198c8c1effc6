"""Go Chase It: places a white ball in the view of the robot's camera and removes it."""

import math
from functools import partial
from typing import TYPE_CHECKING, Optional, Tuple

import rospy
from gazebo_msgs.msg import ModelState, ModelStates
from gazebo_msgs.srv import SetModelState, SpawnModel
from geometry_msgs.msg import Pose
from nav_msgs.msg import Odometry
from sensor_msgs.msg import CameraInfo

from planar import Pose2
from planar_ros.messages.conversion import quaternion_of
from planar_ros.messages.transforms import Transforms
from run_project.course.checks import camera_pose

if TYPE_CHECKING:
    from run_project.ros.scripted_user.user import ScriptedUser

# Bearings of the ball from the camera's direction of view [rad].
BEARINGS = (0.0, 0.35, -0.35)
# Limits of the distance to the ball, clearance behind it [m], and the fraction of the distance to be covered.
MAX_BALL_DISTANCE, MIN_BALL_DISTANCE, BACKGROUND_CLEARANCE, DISTANCE_FRACTION = 2.0, 0.8, 0.4, 0.5
# Simulated time to approach the ball, and to stop without it [s].
CHASE_SECONDS, STOP_SECONDS = 30.0, 5.0
# Displacement in one second below which the robot counts as stopped [m].
STOPPED_DISTANCE = 0.02
SERVICE_SECONDS, FRAMES_SECONDS = 30.0, 5.0
RADIUS = 0.1
PARKING_COORDINATE = 500.0
_MATERIAL = "<material><diffuse>1 1 1 1</diffuse><emissive>1 1 1 1</emissive></material>"
_SHAPE = f"<geometry><sphere><radius>{RADIUS}</radius></sphere></geometry>"
BALL = f"""<sdf version="1.6"><model name="white_ball"><link name="link"><inertial><mass>1</mass></inertial>
<collision name="c">{_SHAPE}</collision><visual name="v">{_SHAPE}{_MATERIAL}</visual></link></model></sdf>"""


def check_ball_chasing(user: "ScriptedUser") -> None:
    """Check that the robot approaches a ball ahead, to the left and to the right, and stops without it."""
    user.wait(lambda: user.has_node("process_image"), 120.0, "no node process_image", is_wall=True)
    for service in ("set_model_state", "spawn_sdf_model"):
        rospy.wait_for_service(f"/gazebo/{service}", SERVICE_SECONDS)
    states = rospy.wait_for_message("/gazebo/model_states", ModelStates, SERVICE_SECONDS)
    robot = min(states.name, key=lambda name: _distance_to_model(states, name, user.base))
    ball = next((name for name in states.name if "ball" in name.lower() and name != robot), None)
    if ball is None:
        ball = _spawn_ball()
    _set_model_pose(ball, Pose2(PARKING_COORDINATE, PARKING_COORDINATE))
    _wait_until_stopped(user)
    stops, camera = False, _camera_on_robot(user)
    for bearing in BEARINGS:
        for is_last in (False, True):
            is_chased, description = _place_ball(user, robot, ball, camera, bearing)
            stops = _wait_until_stopped(user)
            if is_chased or is_last:
                user.add_check(is_chased, description)
                break
            user.log(f"{description}; repeated")
    user.add_check(stops, "stopped without the ball" if stops else "did not stop without the ball")


def _camera_on_robot(user: "ScriptedUser") -> Pose2:
    """Pose of the camera on the robot, x in the direction of view; that of the base if it is unknown."""
    topics = user.find_topic("sensor_msgs/CameraInfo"), user.find_topic("nav_msgs/Odometry")
    if None in topics:
        return Pose2()
    frame = rospy.wait_for_message(topics[0], CameraInfo, SERVICE_SECONDS).header.frame_id
    base = rospy.wait_for_message(topics[1], Odometry, SERVICE_SECONDS).child_frame_id
    transforms = Transforms()
    user.wait(lambda: transforms.matrix(base, frame) is not None, FRAMES_SECONDS)
    matrix = transforms.matrix(base, frame)
    return Pose2() if matrix is None else camera_pose(matrix, "optical" in frame)


def _place_ball(
    user: "ScriptedUser", robot: str, ball: str, camera: Pose2, bearing: float
) -> Tuple[bool, str]:
    """Place the ball and remove it; returns whether the robot approached it, and a description.

    Under load images arrive late and the robot may turn past the ball, so the caller repeats a failure once.
    """
    heading = camera.yaw + bearing
    _turn_towards_free_space(user, robot, heading)
    distance = max(
        min(MAX_BALL_DISTANCE, user.free_distance(heading) - BACKGROUND_CLEARANCE), MIN_BALL_DISTANCE
    )
    at = user.base @ camera @ Pose2(distance * math.cos(bearing), distance * math.sin(bearing))
    _set_model_pose(ball, at)
    is_chased = user.wait(partial(_is_near, user, at, distance * DISTANCE_FRACTION), CHASE_SECONDS)
    left = user.base.distance_to(at)
    _set_model_pose(ball, Pose2(PARKING_COORDINATE, PARKING_COORDINATE))
    result = "chased" if is_chased else "did not chase"
    return is_chased, f"{result} the ball at {math.degrees(bearing):+.0f} deg: {distance:.1f} to {left:.1f} m"


def _is_near(user: "ScriptedUser", place: Pose2, near: float) -> bool:
    return user.base.distance_to(place) < near


def _wait_until_stopped(user: "ScriptedUser") -> bool:
    """Whether the robot stops for a second within STOP_SECONDS."""
    deadline = rospy.get_time() + STOP_SECONDS
    while rospy.get_time() < deadline:
        before = user.base
        user.sleep(1.0)
        if user.base.distance_to(before) < STOPPED_DISTANCE:
            return True
    return False


def _turn_towards_free_space(user: "ScriptedUser", robot: str, bearing: float) -> None:
    """Turn a robot that faces a wall, as a user does in Gazebo's window."""
    if user.free_distance(bearing) < MIN_BALL_DISTANCE + BACKGROUND_CLEARANCE:
        turned = user.base @ Pose2(0.0, 0.0, user.bearing_with_most_space() - bearing)
        _set_model_pose(robot, turned, height=0.05)
        user.sleep(1.0)


def _distance_to_model(states: ModelStates, name: str, base: Pose2) -> float:
    position = states.pose[states.name.index(name)].position
    return math.hypot(position.x - base.x, position.y - base.y)


def _spawn_ball() -> str:
    pose = Pose()
    pose.position.x, pose.position.y, pose.position.z = PARKING_COORDINATE, PARKING_COORDINATE, RADIUS
    pose.orientation.w = 1.0
    rospy.ServiceProxy("/gazebo/spawn_sdf_model", SpawnModel)("white_ball", BALL, "", pose, "world")
    return "white_ball"


def _set_model_pose(model: str, place: Pose2, height: Optional[float] = None) -> None:
    state = ModelState(model_name=model, reference_frame="world")
    position = state.pose.position
    position.x, position.y, position.z = place.x, place.y, RADIUS if height is None else height
    state.pose.orientation = quaternion_of(place.yaw)
    rospy.ServiceProxy("/gazebo/set_model_state", SetModelState)(state)
