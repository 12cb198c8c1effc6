"""Observer of amcl: a robot that stands or moves in a map, and what amcl publishes of each scan."""

import math
import sys
from pathlib import Path

import numpy as np
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from dynamic_reconfigure.msg import ConfigDescription
from geometry_msgs.msg import PoseArray, PoseWithCovarianceStamped
from nav_msgs.srv import SetMap
from observed_node import ObservedNode, report
from std_srvs.srv import Empty
from tf2_msgs.msg import TFMessage

from planar import OccupancyGrid as Grid
from planar import Pose2
from planar_ros.messages.conversion import OccupancyGridArrays, grid_to_msg, pose2_from_msg, pose2_to_msg

sys.path.append(str(Path(__file__).parents[1] / "amcl_lite"))
from simple_robot import SimpleRobot, room  # noqa: E402

START = Pose2(1.2, 1.5, 0.0)
# Longest time for the answer to a scan, and time after its transform for its other messages [s].
ANSWER, REST = 3.0, 0.25


class Observer:
    """Executes the steps of a case and collects what amcl publishes."""

    def __init__(self):
        self.node = ObservedNode("amcl")
        given = self.node.given
        self.poses, self.clouds, self.transforms, self.diagnostics, self.senses = [], [], [], [], []
        self.values = {}
        self.robot = SimpleRobot(Pose2(*given.get("start", START.as_array())), **given.get("frames", {}))
        if "origin" in given:
            self.robot.grid = Grid(room().cells, room().resolution, Pose2(*given["origin"]))
        self.robot.map_message = self._map(given.get("map_frame", "map"), given.get("free_value", 0))
        self.mounting = Pose2()
        for topic, kind, kept in (
            ("amcl_pose", PoseWithCovarianceStamped, self.poses),
            ("particlecloud", rospy.AnyMsg, self.clouds),  # decoded late, as that takes long
            ("/diagnostics", DiagnosticArray, self.diagnostics),
        ):
            rospy.Subscriber(topic, kind, kept.append)
        rospy.Subscriber("/tf", TFMessage, self._on_tf)
        self.initial_pose = rospy.Publisher(
            "initialpose", PoseWithCovarianceStamped, queue_size=2, latch=True
        )
        self.node.start()
        self.is_up = self.node.wait_until(lambda: "/amcl/set_parameters" in self.node.services())
        rospy.sleep(0.5)

    def _map(self, frame, free_value):
        """The robot's map; cells of its right half that are free have ``free_value``."""
        grid = self.robot.grid
        cells = grid.cells.copy()
        right = cells[:, grid.cols // 2 :]
        right[right == 0] = free_value
        return grid_to_msg(Grid(cells, grid.resolution, grid.origin), rospy.Time.now(), frame)

    def _on_tf(self, message):
        self.transforms += [t for t in message.transforms if "amcl" in message._connection_header["callerid"]]

    def sense(self, **changed):
        """Publish a scan and keep the answer to it."""
        before = len(self.poses), len(self.clouds), len(self.transforms)
        stamp = self.robot.sense(changed=changed)
        self.node.wait_until(lambda: len(self.transforms) > before[2], ANSWER)
        rospy.sleep(REST)
        answer = {"pose": None, "cloud": None, "tf": None}
        if len(self.poses) > before[0]:
            pose = self.poses[-1]
            found = pose2_from_msg(pose.pose.pose)
            answer["pose"] = found.as_array().round(3).tolist()
            answer["error"] = round(found.distance_to(self.robot.base_in_map), 3)
            answer["pose_frame"], answer["has_scan_stamp"] = pose.header.frame_id, pose.header.stamp == stamp
            answer["covariance"] = [i for i, value in enumerate(pose.pose.covariance) if value != 0.0]
            answer["deviations"] = [round(math.sqrt(pose.pose.covariance[i]), 2) for i in (0, 7, 35)]
        if len(self.clouds) > before[1]:
            cloud = PoseArray().deserialize(self.clouds[-1]._buff)
            poses = np.array([[p.position.x, p.position.y] for p in cloud.poses])
            answer["cloud"], answer["cloud_frame"] = len(poses), cloud.header.frame_id
            answer["right_half"] = round(float(np.mean(poses[:, 0] > 4.0)), 2)
            answer["spread"] = round(float(poses.std(axis=0).max()), 1)
        if len(self.transforms) > before[2]:
            sent = self.transforms[-1]
            delay = round((sent.header.stamp - stamp).to_sec(), 3)
            answer["tf"] = [sent.header.frame_id, sent.child_frame_id, delay]
        self.senses.append(answer)

    def move(self, x, y, yaw):
        """Move the robot."""
        self.robot.move(Pose2(x, y, yaw))

    def turn_mount(self, yaw):
        """Turn the mount of the laser, whose scans keep their beams by turning with it."""
        robot = self.robot
        self.mounting = Pose2(0.0, 0.0, yaw)
        send, laser = robot.transforms.send, robot.laser_frame

        def send_turned(child_in_parent, parent, child, stamp):
            send(self.mounting if child == laser else child_in_parent, parent, child, stamp)

        if not hasattr(robot, "is_turned"):
            robot.is_turned = True
            robot.transforms.send = send_turned
            ranges = robot.ranges
            robot.ranges = lambda: np.roll(ranges(), -round(self.mounting.yaw / (2.0 * math.pi / 360)))

    def initialpose(self, frame, x, y, yaw, deviation=0.1):
        """Publish an initial pose."""
        message = PoseWithCovarianceStamped()
        message.header.frame_id, message.pose.pose = frame, pose2_to_msg(Pose2(x, y, yaw))
        message.pose.covariance = np.diag([deviation**2] * 6).ravel().tolist()
        self.initial_pose.publish(message)
        rospy.sleep(1.0)

    def call(self, service):
        """Call a service without arguments."""
        rospy.ServiceProxy(service, Empty)()

    def set_map(self, frame, x, y, yaw):
        """Call set_map with the map and a pose."""
        pose = PoseWithCovarianceStamped()
        pose.header.frame_id, pose.pose.pose = frame, pose2_to_msg(Pose2(x, y, yaw))
        pose.pose.covariance = np.diag([0.01] * 6).ravel().tolist()
        rospy.wait_for_service("set_map", 5.0)
        self.robot.map_message.data = list(self.robot.map_message.data)
        self.values["set_map"] = rospy.ServiceProxy("set_map", SetMap)(self.robot.map_message, pose).success

    def publish_map(self, frame):
        """Publish the map on its topic."""
        publisher = rospy.Publisher("map", OccupancyGridArrays, queue_size=1, latch=True)
        self.robot.map_message.header.frame_id = frame
        publisher.publish(self.robot.map_message)
        rospy.sleep(2.0)

    def wait(self, seconds):
        """Wait."""
        rospy.sleep(seconds)

    def note(self, name, parameter):
        """Keep the value of a parameter of amcl."""
        self.values[name] = rospy.get_param(f"/amcl/{parameter}", None)

    def late(self):
        """Keep which topics have a message for a new subscriber."""
        for topic, kind in (("amcl_pose", PoseWithCovarianceStamped), ("particlecloud", PoseArray)):
            try:
                rospy.wait_for_message(topic, kind, 2.0)
                self.values[f"latched_{topic}"] = True
            except rospy.ROSException:
                self.values[f"latched_{topic}"] = False

    def described(self):
        """Type, default, least and greatest value of each parameter of dynamic_reconfigure."""
        description = rospy.wait_for_message("/amcl/parameter_descriptions", ConfigDescription, 5.0)
        limits = []
        for config in (description.dflt, description.min, description.max):
            kinds = (config.bools, config.ints, config.strs, config.doubles)
            limits.append({each.name: each.value for kind in kinds for each in kind})
        parameters = [each for group in description.groups for each in group.parameters]
        return {each.name: [each.type, *(limit[each.name] for limit in limits)] for each in parameters}

    def run(self):
        """Execute the steps and report."""
        for step, *arguments in self.node.given.get("steps", []):
            getattr(self, step)(*arguments) if step != "scan" else self.sense(**arguments[0])
        observed = {"senses": self.senses, "values": self.values, "is_up": self.is_up}
        observed["publishes"], observed["subscribes"] = self.node.topics(), self.node.topics(published=False)
        observed["services"] = self.node.services()
        if self.is_up:
            observed["parameters"] = self.described()
        statuses = [status for message in self.diagnostics for status in message.status]
        observed["diagnostics"] = sorted({status.name for status in statuses})
        observed["diagnosis"] = [
            [status.hardware_id, sorted(each.key for each in status.values)]
            for status in statuses
            if status.name == "amcl: Standard deviation"
        ][-1:]
        self.node.end()
        for name in (
            "initial_pose_x",
            "initial_pose_y",
            "initial_pose_a",
            "initial_cov_xx",
            "initial_cov_aa",
        ):
            observed["values"][f"saved_{name}"] = rospy.get_param(f"/amcl/{name}", None)
        observed["log"], observed["exit_code"] = self.node.log, self.node.exit_code
        report(observed)


if __name__ == "__main__":
    Observer().run()
