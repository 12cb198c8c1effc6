#!/usr/bin/env python3
"""Missions sent to a running robot, judged against ground truth: a blocked place, cancellation, bad input."""

import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import actionlib
import rosnode
import rospy
import rostest
from actionlib_msgs.msg import GoalStatus, GoalStatusArray
from gazebo_msgs.msg import ModelStates
from home_service_msgs.msg import DeliverAction, DeliverGoal, Delivery, DeliveryState
from home_service_msgs.srv import AddDelivery, CancelDelivery
from nav_msgs.msg import Odometry
from recording import MessageRecorder
from visualization_msgs.msg import Marker

from evaluation.consumers.referee import Referee
from evaluation.ros.run_topics import observe
from evaluation.verdict import ERRAND, OBJECTS, judge
from pick_objects import parse_mission
from planar import Pose2
from planar_ros.calls.actions import KILLED_TEXT, goal_is_over, server_is_ready
from planar_ros.messages.conversion import pose2_from_msg, pose2_to_msg

WALL_DEADLINE = 400.0  # on a busy machine
MISSION = """\
places:
  hall: {x: 1.2, y: 0.2}
  door: {x: 2.6, y: 0.2, yaw: 1.57}
  sofa: {x: 4.0, y: 0.4, approaches: [{x: 3.3, y: -0.1}]}
objects: {cup: {}, book: {}, letter: {solid: true}}
settings: {pickup_seconds: 1.0, dropoff_seconds: 0.5, retry_seconds: 0.5, attempts: 2, order: shortest}
deliveries:
  - {name: first, object: cup, from: hall, to: door}
  - {name: blocked, object: book, from: door, to: sofa}
  - {name: third, object: cup, from: door, to: hall}
  - {name: last, object: letter, from: hall, to: door, after: third}
"""


GIVEN_UP = {GoalStatus.PREEMPTED, GoalStatus.RECALLED}


class BoxWatch:
    """Follows a model in the simulator, seen from the robot that carries it now and then."""

    def __init__(self, name):
        self._name = name
        self.standing, self.riding = [], []
        self._subscriber = rospy.Subscriber("/gazebo/model_states", ModelStates, self._see, queue_size=10)

    def _see(self, message):
        if self._name not in message.name:
            return
        box = message.pose[message.name.index(self._name)]
        robot = pose2_from_msg(message.pose[message.name.index("mobile_base")])
        if box.position.z > 0.5:
            self.riding.append(robot.distance_to(pose2_from_msg(box)))
        else:
            self.standing.append(pose2_from_msg(box))


class MissionsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.places = dict(parse_mission(MISSION).places)
        cls.client = actionlib.SimpleActionClient("deliver", DeliverAction)
        cls.boxes = rospy.Publisher("sim_bridge/add_box", Marker, queue_size=10)

    def setUp(self):
        self.referee = Referee(self.places, print)
        observe(self.referee)
        self._wait("the robot", lambda: server_is_ready(self.client) and self.referee.truth)

    def test_1_a_mission_with_a_mistake_is_refused_naming_line_and_key(self):
        wrong = MISSION.replace("to: sofa", "to: sofaa")
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write(wrong)
            file.flush()
            command = ["rosrun", "pick_objects", "deliver", file.name]
            refused = subprocess.run(command, stderr=subprocess.PIPE, text=True, timeout=WALL_DEADLINE)
        self.assertEqual(refused.returncode, 2)
        self.assertIn(f"error: {file.name}:9: deliveries[2].to names no place: sofaa", refused.stderr)
        self.client.send_goal(DeliverGoal(mission=wrong))
        self._wait("the refusal", lambda: goal_is_over(self.client))
        self.assertEqual(self.client.get_state(), GoalStatus.ABORTED)
        self.assertIn("mission:9: deliveries[2].to names no place: sofaa", self.client.get_goal_status_text())

    def test_2_a_mission_is_cancelled_while_an_object_is_carried(self):
        goal = DeliverGoal(deliveries=[Delivery("away", "parcel", "pickup", "dropoff")])
        self.client.send_goal(goal)
        self._wait("the object on the robot", lambda: self._stage("away") == "carrying")
        self._wait("motion", lambda: self.referee.truth.distance_to(Pose2(2.0, 3.0)) > 0.5)
        self.client.cancel_goal()
        self._wait("the end", lambda: goal_is_over(self.client))
        self.assertEqual(self.client.get_state(), GoalStatus.PREEMPTED)
        self.assertEqual(self.client.get_result().deliveries[0].state, DeliveryState.CANCELLED)
        self._wait("the state", lambda: self.referee.mission_record.final_state == "cancelled")
        stopped_at = self.referee.truth
        end = self.referee.simulated_time + 3.0
        self._wait("three seconds", lambda: self.referee.simulated_time > end)
        coasted = self.referee.truth.distance_to(stopped_at)
        print(f"{coasted:.3f} m driven after the cancellation")
        self.assertLess(coasted, 0.3)
        self.assertFalse(judge(self.referee.mission_record, {ERRAND}).success)

    def test_3_a_blocked_place_is_served_from_its_alternative_and_a_delivery_is_added(self):
        self._drop_box(self.places["sofa"].pose)
        letter = BoxWatch("letter")
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "mission.yaml"
            path.write_text(MISSION)
            command = ["rosrun", "pick_objects", "deliver", str(path)]
            deliver = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
            self._wait("the first object", lambda: self._stage("first") == "carrying")
            self._assert_services()
            self._wait("the end", lambda: deliver.poll() is not None)
        output = deliver.stdout.read()
        print(output)
        self.assertEqual(deliver.returncode, 0)
        self.assertIn("blocked: book from door to sofa: delivered", output)
        self._wait("the markers", lambda: not self.referee.mission_record.objects_without_markers)
        verdict = judge(self.referee.mission_record, {ERRAND, OBJECTS})
        self.assertTrue(verdict.success, verdict.reason)
        records = {record.name: record for record in self.referee.mission_record.deliveries}
        self.assertEqual(records["blocked"].attempts, 3)
        self.assertEqual(records["extra"].state, "delivered")
        self.assertEqual(records["needless"].state, "cancelled")
        self._assert_body(letter)

    def test_4_the_robot_stops_when_the_node_of_its_mission_ends(self):
        goals, odometry = (
            MessageRecorder("move_base/status", GoalStatusArray),
            MessageRecorder("odom", Odometry),
        )
        self.client.send_goal(DeliverGoal(deliveries=[Delivery("cut short", "parcel", "pickup", "dropoff")]))
        self._wait("a robot that drives", lambda: _speed(odometry.next()) > 0.1)
        rosnode.kill_nodes(["/pick_objects"])
        self._wait("its goal to be given up", lambda: GIVEN_UP & _statuses(goals.messages))
        self._wait("a stop", lambda: _speed(odometry.next()) < 0.01)
        self._wait("the end of the mission", lambda: goal_is_over(self.client))
        outcome = self.client.get_state(), self.client.get_goal_status_text()
        self.assertEqual(outcome, (GoalStatus.ABORTED, KILLED_TEXT))

    def _assert_body(self, letter):
        """It stood in front of one place, rode on the robot, and stands in front of the other."""
        print(f"on the robot at most {max(letter.riding):.3f} m off its middle")
        for place, box in (("hall", letter.standing[0]), ("door", letter.standing[-1])):
            self.assertAlmostEqual(self.places[place].distance_to(box), 0.5, delta=0.15)
        self.assertLess(max(letter.riding), 0.05)

    def _assert_services(self):
        add = rospy.ServiceProxy("pick_objects/add_delivery", AddDelivery)
        cancel = rospy.ServiceProxy("pick_objects/cancel_delivery", CancelDelivery)
        self.assertTrue(add(Delivery("extra", "key", "door", "hall")).success)
        self.assertTrue(add(Delivery("needless", "key", "hall", "door")).success)
        self.assertIn("there is no place 'moon'", add(Delivery("x", "key", "moon", "hall")).message)
        self.assertTrue(cancel("needless").success)
        self.assertIn("there is no delivery nothing", cancel("nothing").message)

    def _stage(self, name):
        return next(
            (record.state for record in self.referee.mission_record.deliveries if record.name == name), None
        )

    def _drop_box(self, pose):
        self._wait("a subscriber of boxes", lambda: self.boxes.get_num_connections() > 0)
        box = Marker(ns="box", type=Marker.CUBE)
        box.pose = pose2_to_msg(pose)
        box.scale.x = box.scale.y = box.scale.z = 0.4
        self.boxes.publish(box)

    def _wait(self, what, is_there):
        deadline = time.monotonic() + WALL_DEADLINE
        while not is_there():
            self.assertLess(time.monotonic(), deadline, f"no {what}; state '{self.referee.state}'")
            time.sleep(0.02)


def _statuses(messages):
    return {goal.status for message in list(messages) for goal in message.status_list}


def _speed(odometry):
    return abs(odometry.twist.twist.linear.x)


if __name__ == "__main__":
    rospy.init_node("test_missions")
    rostest.rosrun("home_service_tests", "missions", MissionsTest)
