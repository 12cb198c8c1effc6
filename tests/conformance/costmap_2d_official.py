"""The official costmap_2d_node on the cases of costmap_2d_rig; one node for each case."""

import atexit
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Dict, List, Mapping, Optional

import numpy as np
import rosgraph
import rospkg
import rospy
import tf2_ros
from costmap_2d_rig import BEAM_ANGLE, RANGE_MAX, RANGE_MIN, map_of
from geometry_msgs.msg import PolygonStamped, TransformStamped
from nav_msgs.msg import OccupancyGrid
from sensor_msgs.msg import LaserScan
from sensor_msgs.point_cloud2 import create_cloud_xyz32
from std_msgs.msg import Header

from planar import Pose2
from planar_ros.messages.conversion import OccupancyGridArrays, grid_to_msg, pose2_to_msg

NODE = "costmap_node"
START_SECONDS, STEP_SECONDS = 15.0, 0.6
_joined: List[bool] = []


def find_executable(package: str, name: str) -> Optional[Path]:
    """Return a compiled node of an installed package; None if there is none."""
    for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep):
        path = Path(prefix) / "lib" / package / name
        if path.is_file() and path.read_bytes()[:4] == b"\x7fELF":
            return path
    return None


def is_installed(package: str) -> bool:
    """Whether rospack finds a package."""
    try:
        rospkg.RosPack().get_path(package)
    except rospkg.ResourceNotFound:
        return False
    return True


def has_service(name: str) -> bool:
    """Whether a service is advertised."""
    try:
        rosgraph.Master("/conformance").lookupService(name)
    except rosgraph.MasterError:
        return False
    return True


def end(process: subprocess.Popen) -> None:
    """End a node so that it unregisters from the master."""
    process.send_signal(signal.SIGINT)
    if not wait_until(lambda: process.poll() is not None, START_SECONDS):
        process.kill()
    process.wait()


def join_master() -> None:
    """Start a master and make this process a node of it, once."""
    if _joined:
        return
    _joined.append(True)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    os.environ["ROS_MASTER_URI"] = f"http://127.0.0.1:{port}"
    os.environ["ROS_IP"] = "127.0.0.1"
    os.environ["ROS_LOG_DIR"] = tempfile.mkdtemp(prefix="conformance-")
    code = "import rosmaster, sys; rosmaster.rosmaster_main(['rosmaster', '--core', '-p', sys.argv[1]])"
    master = subprocess.Popen([sys.executable, "-c", code, str(port)], stdout=subprocess.DEVNULL)
    atexit.register(master.kill)
    wait_until(rosgraph.is_master_online, START_SECONDS)
    rospy.init_node("conformance", disable_signals=True)


def wait_until(condition: Any, seconds: float) -> bool:
    """Wait for a condition; return whether it came true."""
    deadline = time.monotonic() + seconds
    while not condition() and time.monotonic() < deadline:
        time.sleep(0.02)
    return bool(condition())


class _Costmap:
    """One run of costmap_2d_node."""

    def __init__(self, case: Mapping[str, Any]):
        join_master()
        self._case = case
        self._grid: Optional[OccupancyGrid] = None
        self._count = 0
        self._outline: List[Any] = []
        self._set_parameters()
        self._publishers = self._advertise_maps()
        self._tf = tf2_ros.StaticTransformBroadcaster()
        self._publish_transforms()
        rospy.Subscriber(f"/{NODE}/costmap/costmap", OccupancyGrid, self._on_costmap)
        rospy.Subscriber(f"/{NODE}/costmap/footprint", PolygonStamped, self._on_footprint)
        self._log = tempfile.TemporaryFile()  # noqa: SIM115  -- open as long as the node runs
        executable = find_executable("costmap_2d", "costmap_2d_node")
        self._process = subprocess.Popen([str(executable)], stdout=self._log, stderr=self._log)

    def _set_parameters(self) -> None:
        if rospy.has_param(f"/{NODE}"):
            rospy.delete_param(f"/{NODE}")
        rospy.set_param(f"/{NODE}", dict(self._case.get("outer", {})))
        costmap = {
            **self._case["costmap"],
            "update_frequency": 10.0,
            "publish_frequency": 10.0,
            "always_send_full_costmap": True,
        }
        rospy.set_param(f"/{NODE}/costmap", costmap)

    def _advertise_maps(self) -> List[rospy.Publisher]:
        publishers = []
        for topic, given in self._case.get("maps", {}).items():
            grid, frame = map_of(given)
            publishers.append(rospy.Publisher(topic, OccupancyGridArrays, queue_size=1, latch=True))
            publishers[-1].publish(grid_to_msg(grid, rospy.Time.now(), frame))
        return publishers

    def _publish_transforms(self) -> None:
        """Publish odom -> map and odom -> base_link, so that the base is where the case has it."""
        base, map_in_odom = (
            Pose2(*self._case.get("base", (1.25, 1.25, 0.0))),
            Pose2(*self._case.get("map_in_odom", ())),
        )
        if self._case["costmap"]["global_frame"] != "odom":
            base = map_in_odom @ base
        transforms = []
        for child, pose in (("map", map_in_odom), ("base_link", base)):
            transform, message = TransformStamped(), pose2_to_msg(pose)
            transform.header.frame_id, transform.child_frame_id = "odom", child
            transform.header.stamp = rospy.Time.now()
            transform.transform.translation.x = message.position.x
            transform.transform.translation.y = message.position.y
            transform.transform.rotation = message.orientation
            transforms.append(transform)
        self._tf.sendTransform(transforms)

    def _on_costmap(self, message: OccupancyGrid) -> None:
        self._grid, self._count = message, self._count + 1

    def _on_footprint(self, message: PolygonStamped) -> None:
        self._outline = [(point.x, point.y) for point in message.polygon.points]

    def run(self) -> Dict[str, Any]:
        """Return what is observed at the probes."""
        sensors: Dict[str, rospy.Publisher] = {}
        try:
            wait_until(lambda: has_service(f"/{NODE}/costmap/set_parameters"), START_SECONDS)
            for messages in self._case.get("steps", [[]]):
                for topic, data in messages:
                    self._send(sensors, topic, np.array(data, dtype=float))
                time.sleep(STEP_SECONDS)
            self._await_costmap()
            return self._observed()
        finally:
            end(self._process)
            for publisher in (*self._publishers, *sensors.values()):
                publisher.unregister()

    def _await_costmap(self) -> None:
        """Wait for the costmap of an update from now on."""
        first = self._count
        if (
            not wait_until(lambda: self._count > first + 2 or self._process.poll() is not None, START_SECONDS)
            or self._process.poll() is not None
        ):
            self._log.seek(0)
            tail = self._log.read().decode(errors="replace")[-400:]
            raise RuntimeError(f"costmap_2d_node published no costmap: {tail}")

    def _send(self, sensors: Dict[str, rospy.Publisher], topic: str, data: np.ndarray) -> None:
        header = Header(stamp=rospy.Time.now(), frame_id="base_link")
        message = create_cloud_xyz32(header, data.tolist()) if data.ndim == 2 else _scan(header, data)
        if topic not in sensors:
            sensors[topic] = rospy.Publisher(topic, type(message), queue_size=5)
            publisher = sensors[topic]
            wait_until(lambda: publisher.get_num_connections() > 0, 1.0)
        sensors[topic].publish(message)

    def _observed(self) -> Dict[str, Any]:
        assert self._grid is not None
        info, found = self._grid.info, {}
        cells = np.array(self._grid.data, dtype=np.int8).reshape(info.height, info.width)
        base = self._case.get("base", (1.25, 1.25, 0.0))
        for name, place in self._case["probes"].items():
            if name == "footprint":
                wait_until(lambda: bool(self._outline), 2.0)
                found[name] = [
                    (round(x - base[0], 3) + 0.0, round(y - base[1], 3) + 0.0) for x, y in self._outline
                ]
            elif name == "size":
                found[name] = info.width, info.height
            else:
                col = int((place[0] - info.origin.position.x) // info.resolution)
                row = int((place[1] - info.origin.position.y) // info.resolution)
                found[name] = int(cells[row, col])
        return found


def _scan(header: Header, ranges: np.ndarray) -> LaserScan:
    scan = LaserScan(header=header, angle_increment=BEAM_ANGLE, range_min=RANGE_MIN, range_max=RANGE_MAX)
    scan.angle_max = BEAM_ANGLE * (len(ranges) - 1)
    scan.ranges = ranges.tolist()
    return scan


def run_official(case: Mapping[str, Any]) -> Dict[str, Any]:
    """Run the official node on a case of costmap_2d_rig."""
    return _Costmap(case).run()
