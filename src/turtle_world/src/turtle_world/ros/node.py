"""The node ``turtlesim``: a TurtleWorld with turtlesim's topics, services, parameters and texts.

turtlesim_node [--picture PNG]
"""

import argparse
import threading
import time
from pathlib import Path
from typing import Dict

import rospy
from std_srvs.srv import Empty, EmptyResponse
from turtlesim.srv import Kill, KillResponse, Spawn, SpawnResponse

from planar import FileWriteError, PlanarError, write_atomically
from planar_ros.node.runner import run
from turtle_world.canvas import BACKGROUND, Color
from turtle_world.physics import PERIOD
from turtle_world.ros.markers import TurtleMarkers
from turtle_world.ros.turtle_topics import TurtleTopics
from turtle_world.world import TurtleWorld

BACKGROUND_PARAMETERS = ("~background_r", "~background_g", "~background_b")
# Delay that the node makes up for when it was not scheduled in time [s].
MAX_DELAY = 0.5
# Periods of writing the image and of publishing the markers [s].
PICTURE_PERIOD, MARKERS_PERIOD = 1.0, 0.1


class TurtleWorldNode:
    """Steps the world at turtlesim's rate in a thread; one lock guards the world."""

    def __init__(self, picture: str):
        self._picture = picture
        for name, value in zip(BACKGROUND_PARAMETERS, BACKGROUND):
            if not rospy.has_param(name):
                rospy.set_param(name, value)
        rospy.loginfo("Starting turtlesim with node name %s", rospy.get_name())
        self._lock = threading.RLock()
        self._world = TurtleWorld()
        self._world.canvas.clear(_background())
        self._write_picture()
        self._topics: Dict[str, TurtleTopics] = {}
        self._markers = TurtleMarkers()
        self._update_turtle_topics()
        rospy.Service("clear", Empty, self._on_clear)
        rospy.Service("reset", Empty, self._on_reset)
        rospy.Service("spawn", Spawn, self._on_spawn)
        rospy.Service("kill", Kill, self._on_kill)
        rospy.on_shutdown(self._write_picture)
        threading.Thread(target=self._work, daemon=True).start()

    def _work(self):
        due = time.monotonic()
        image_due = markers_due = due
        while not rospy.is_shutdown():
            due = max(due + PERIOD, time.monotonic() - MAX_DELAY)
            time.sleep(max(0.0, due - time.monotonic()))
            with self._lock:
                for name, state in self._world.step().items():
                    self._topics[name].publish(state)
                if due >= markers_due:
                    markers_due = due + MARKERS_PERIOD
                    self._markers.publish(self._world)
            if due >= image_due:
                image_due = due + PICTURE_PERIOD
                try:
                    self._write_picture()
                except FileWriteError as error:
                    rospy.logerr_throttle(60.0, f"cannot write the image: {error}")

    def _update_turtle_topics(self):
        """Advertise topics and services of new turtles, and close those of removed ones."""
        for name in set(self._topics) - set(self._world.names):
            self._topics.pop(name).close()
        for name in self._world.names:
            if name not in self._topics:
                self._topics[name] = TurtleTopics(name, self._world, self._lock)
                pose = self._world.pose_of(name)
                rospy.loginfo("Spawning turtle [%s] at x=[%f], y=[%f], theta=[%f]", name, *pose)

    def _on_clear(self, request):
        rospy.loginfo("Clearing turtlesim.")
        with self._lock:
            self._world.canvas.clear(_background())
        return EmptyResponse()

    def _on_reset(self, request):
        rospy.loginfo("Resetting turtlesim.")
        with self._lock:
            self._world.reset(_background())
            self._update_turtle_topics()
        return EmptyResponse()

    def _on_spawn(self, request):
        with self._lock:
            try:
                name = self._world.spawn(request.name, request.x, request.y, request.theta)
            except PlanarError as error:
                rospy.logerr("%s", error)
                return None  # a failed call, as in turtlesim
            self._update_turtle_topics()
        return SpawnResponse(name)

    def _on_kill(self, request):
        with self._lock:
            if request.name not in self._world.names:
                rospy.logerr("Tried to kill turtle [%s], which does not exist", request.name)
                return None
            self._world.kill(request.name)
            self._update_turtle_topics()
        return KillResponse()

    def _write_picture(self):
        if self._picture:
            with self._lock:
                picture = self._world.picture()
            write_atomically(Path(self._picture), picture)


def _background() -> Color:
    red, green, blue = (int(rospy.get_param(name)) % 256 for name in BACKGROUND_PARAMETERS)
    return red, green, blue


def main(node_name: str):
    parser = argparse.ArgumentParser(
        prog=f"{node_name}_node", description="turtlesim's world, without a window."
    )
    parser.add_argument(
        "--picture", metavar="PNG", default="", help="file for the image that turtlesim's window would show"
    )
    arguments = parser.parse_args(rospy.myargv()[1:])
    run(node_name, lambda: TurtleWorldNode(arguments.picture))
