"""The command spawn_model: spawns a model from a file, a parameter or stdin."""

import argparse
import contextlib
import math
import signal
import sys
import time
from pathlib import Path
from typing import Dict, Iterator, List, Tuple

import rospy
from gazebo_msgs.msg import ModelStates
from gazebo_msgs.srv import DeleteModel
from geometry_msgs.msg import Point, Pose, Quaternion
from std_srvs.srv import Empty

from gazebo_ros.ros.services import (
    SERVICE_SECONDS,
    set_model_configuration_client,
    spawn_sdf_model_client,
    spawn_urdf_model_client,
)
from gazebo_ros.spawn_options import parse
from planar_ros.node.entry import warn_unknown
from planar_ros.node.runner import init_node
from supervision.interruption import handling_signals, on_signals

PARAMETER_SECONDS = 30.0


class SpawnError(Exception):
    """The model cannot be spawned; the text states why."""


def quaternion(roll: float, pitch: float, yaw: float) -> Tuple[float, float, float, float]:
    """Quaternion x, y, z, w of rotations about the fixed axes x, y, z, in this order [rad]."""
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(a / 2), math.cos(a / 2)) for a in (roll, pitch, yaw))
    return (
        sr * cp * cy - cr * sp * sy,
        cr * sp * cy + sr * cp * sy,
        cr * cp * sy - sr * sp * cy,
        cr * cp * cy + sr * sp * sy,
    )


def spawn(options: argparse.Namespace) -> None:
    """Spawn the model of the command line. Raises SpawnError."""
    pose = Pose(
        Point(options.x, options.y, options.z), Quaternion(*quaternion(options.R, options.P, options.Y))
    )
    xml = _model_xml(options)
    client = spawn_urdf_model_client if options.urdf else spawn_sdf_model_client
    namespace, joints = options.gazebo_namespace, _joints(options)
    if options.wait:
        _wait_for_model(options.wait, namespace)
    rospy.wait_for_service(f"{namespace}/spawn_{'urdf' if options.urdf else 'sdf'}_model", SERVICE_SECONDS)
    with _deferring_interrupts():
        if not client(options.model, xml, options.robot_namespace, pose, options.reference_frame, namespace):
            raise SpawnError(f"{options.model} was not spawned")
        if options.b:
            rospy.on_shutdown(lambda: _delete(options.model, namespace))
    if joints and not set_model_configuration_client(
        options.model, options.param or "", list(joints), list(joints.values()), namespace
    ):
        raise SpawnError(f"the joint positions of {options.model} were not set")
    if options.unpause:
        rospy.ServiceProxy(f"{namespace}/unpause_physics", Empty)()
    if options.b:
        rospy.spin()


@contextlib.contextmanager
def _deferring_interrupts() -> Iterator[None]:
    """Defer interrupts while a model is spawned, so that ``-b`` can delete it."""
    signals: List[int] = []
    with handling_signals(lambda number, _frame: signals.append(number)):
        yield
    if signals:
        raise KeyboardInterrupt


def _joints(options) -> Dict[str, float]:
    """Joint name -> position."""
    try:
        return {name: float(position) for name, position in options.J}
    except ValueError as error:
        raise SpawnError(f"-J: {error}") from None


def _delete(model: str, namespace: str) -> None:
    with contextlib.suppress(rospy.ServiceException):  # the simulator may have ended
        rospy.ServiceProxy(f"{namespace}/delete_model", DeleteModel)(model)


def _model_xml(options) -> str:
    if options.stdin:
        return sys.stdin.read()
    if options.param:
        return _parameter(options.param)
    if options.database:
        uri = f"<uri>model://{options.database}</uri>"
        return f'<sdf version="1.5"><world name="default"><include>{uri}</include></world></sdf>'
    try:
        return Path(options.file).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise SpawnError(f"{options.file}: cannot be read ({error})") from None


def _parameter(name: str) -> str:
    deadline = time.monotonic() + PARAMETER_SECONDS
    while not rospy.has_param(name):
        if time.monotonic() > deadline:
            raise SpawnError(f"no parameter {name} within {PARAMETER_SECONDS:g} s")
        time.sleep(0.1)
    return rospy.get_param(name)


def _wait_for_model(name: str, namespace: str) -> None:
    while name not in rospy.wait_for_message(f"{namespace}/model_states", ModelStates, 60.0).name:
        pass


def main() -> None:
    """Exit code 0 if the model was spawned, 1 if not, 130 if interrupted before that."""
    options, unknown = parse(rospy.myargv()[1:], rospy.get_namespace())
    warn_unknown("spawn_model", unknown)
    # rospy's handler could deadlock on a lock that is held by the interrupted code.
    init_node("spawn_model", anonymous=True)
    on_signals(signal.default_int_handler)
    try:
        spawn(options)
    except KeyboardInterrupt:
        rospy.signal_shutdown("interrupted")
        sys.exit(130)
    except (SpawnError, rospy.ROSException, rospy.ServiceException) as error:
        print(f"[spawn_model] error: {error}", file=sys.stderr)
        sys.exit(1)
