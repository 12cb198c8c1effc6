"""Map My World: drives the robot around and saves its map."""

import math
import subprocess
from typing import TYPE_CHECKING

import rospy

from planar import FREE, PlanarError
from planar.maps.map_file import load_map
from turtlebot3_gazebo.wandering import Wanderer

if TYPE_CHECKING:
    from run_project.ros.scripted_user.user import ScriptedUser

# Simulated driving time [s], and the required free area of the map [m²].
DRIVE_SECONDS, MIN_FREE_AREA = 90.0, 4.0
SIDE = math.radians(30.0)
SAVE_SECONDS = 60.0


def check_mapping(user: "ScriptedUser") -> None:
    """Check the map after driving around by the laser scan; it is saved into the run folder."""
    user.wait(lambda: _map_topic(user) is not None, 120.0, "no node publishes a map", is_wall=True)
    wanderer, since = Wanderer(), rospy.get_time()
    while not user.wait(lambda: rospy.get_time() - since > DRIVE_SECONDS, 0.1):
        ahead, left, right = (user.free_distance(bearing) for bearing in (0.0, SIDE, -SIDE))
        velocity = wanderer.advance(ahead, left, right, user.base.yaw)
        user.drive(velocity.v, velocity.omega)
    user.drive(0.0, 0.0)
    stem = user.folder / "map"
    command = ["rosrun", "map_server", "map_saver", "-f", str(stem), f"map:={_map_topic(user)}"]
    try:
        subprocess.run(command, timeout=SAVE_SECONDS, check=True, capture_output=True)
        grid = load_map(stem.with_suffix(".yaml"))
    except (subprocess.SubprocessError, PlanarError) as error:
        user.add_check(False, f"no map saved: {error}")
        return
    free = float((grid.cells == FREE).sum()) * grid.resolution**2
    user.add_check(free > MIN_FREE_AREA, f"map saved: {free:.0f} m² free, {stem.with_suffix('.pgm')}")


def _map_topic(user: "ScriptedUser"):
    return user.find_topic("nav_msgs/OccupancyGrid", without="costmap")
