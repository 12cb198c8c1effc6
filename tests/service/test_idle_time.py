#!/usr/bin/env python3
"""Idle time of a service over ROS: hours pass in few steps, unless another node listens."""

import shutil
import subprocess
import unittest
from pathlib import Path

import rospy
import rostest
from nav_msgs.msg import Odometry
from processes import marked_environment
from sim_bridge_msgs.srv import AddFault
from std_msgs.msg import Float64
from waiting import wait_until

from evaluation.consumers.referee import Referee
from evaluation.ros.run_topics import observe
from evaluation.verdict import ARRIVAL_TOLERANCE
from planar import Pose2
from planar.maps.places import load_places
from planar_ros.lockstep.client import OBSERVERS_PARAMETER
from planar_ros.messages.conversion import pose2_from_msg
from service.http.client import ServiceClient

ROOT = Path(__file__).resolve().parents[2]
# Wall-clock time for a request, on a busy machine [s].
PATIENCE = 200.0
HOUR, MINUTE = 3600.0, 60.0
# Simulated time that has been skipped when the robot counts as idle again [s].
IDLE = 10.0 * MINUTE
# Steps that are taken in each simulated second while none are skipped.
STEPS = 50


class IdleTimeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.places = load_places(ROOT / "map" / "zones.yaml")
        cls.referee, cls.skipped, cls.steps = Referee(cls.places, print), 0.0, []
        rospy.Subscriber("sim_bridge/skipped_seconds", Float64, cls._on_skipped)
        rospy.Subscriber("base_pose_ground_truth", Odometry, cls._on_truth, tcp_nodelay=True)
        observe(cls.referee)
        rospy.set_param(OBSERVERS_PARAMETER, [rospy.get_name()])
        cls.folder = Path(rospy.get_param("/service/state_folder"))
        wait_until("the service", lambda: (cls.folder / "service.json").exists(), PATIENCE)
        cls.client = ServiceClient(cls.folder)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder, ignore_errors=True)

    @classmethod
    def _on_skipped(cls, message):
        cls.skipped = message.data

    @classmethod
    def _on_truth(cls, message):
        cls.steps.append((message.header.stamp.to_sec(), pose2_from_msg(message.pose.pose)))

    def test_idle_time(self):
        self.requests_an_hour_apart_are_done_in_time()
        self.a_request_that_comes_meanwhile_is_done()
        self.no_step_is_skipped_while_another_node_listens()
        self.no_step_is_skipped_while_a_fault_is_active()

    def requests_an_hour_apart_are_done_in_time(self):
        now = self.now()
        self.submit("early", "deliver cup from pickup to dropoff", now + 0.5 * HOUR)
        self.submit("late", "go pickup", now + 1.5 * HOUR)
        begin = len(self.steps)
        late = self.end_of("late")
        for task in (self.end_of("early"), late):
            self.assertEqual(task["status"], "completed")
            self.assertLess(task["unix_millis_finish_time"], task["unix_millis_deadline"])
        delivery = self.referee.mission_record.deliveries[0]
        self.assertLess(delivery.pickup_error, ARRIVAL_TOLERANCE)
        self.assertLess(delivery.dropoff_error, ARRIVAL_TOLERANCE)
        self.assertTrue(self.stood_at("pickup", late))
        self.assertEqual(self.referee.mission_record.collisions, [])
        seconds = late["unix_millis_finish_time"] / 1000.0 - now
        self.assertLess((len(self.steps) - begin) / STEPS, 0.1 * seconds)
        self.assertGreater(self.skipped, 0.9 * seconds)

    def a_request_that_comes_meanwhile_is_done(self):
        skipped = self.skipped
        wait_until("idle time", lambda: self.skipped > skipped + IDLE, PATIENCE)
        command = [str(ROOT / "scripts" / "request.sh"), "--state", str(self.folder), "go dropoff", "--wait"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertTrue(self.stood_at("dropoff", self.task(done.stdout.partition(":")[0])))

    def no_step_is_skipped_while_another_node_listens(self):
        skipped = self.skipped
        wait_until("idle time", lambda: self.skipped > skipped + IDLE, PATIENCE)
        command = ["rostopic", "echo", "-p", "/odom/header/stamp"]
        _, environment = marked_environment()
        listener = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment)
        lines = [listener.stdout.readline() for _ in range(1000)]
        listener.terminate()
        listener.communicate()
        stamps = [float(line.rpartition(",")[2]) for line in lines[1:]]
        gaps = [1e-9 * (after - before) for before, after in zip(stamps, stamps[1:])]
        self.assertLess(max(gaps), 1.5 / STEPS)
        skipped = self.skipped
        wait_until("idle time", lambda: self.skipped > skipped + IDLE, PATIENCE)

    def no_step_is_skipped_while_a_fault_is_active(self):
        begin, skipped = len(self.steps), self.skipped
        self.assertTrue(rospy.ServiceProxy("sim_bridge/add_fault", AddFault)("scan_noisy", 30.0, 0.0).success)
        wait_until("idle time", lambda: self.skipped > skipped + IDLE, PATIENCE)
        stamps = [stamp for stamp, _ in self.steps[begin:]]
        gaps = [0, *(n for n in range(1, len(stamps)) if stamps[n] - stamps[n - 1] > 1.5 / STEPS)]
        self.assertGreaterEqual(max(after - before for before, after in zip(gaps, gaps[1:])), 30 * STEPS)

    def submit(self, name, text, start):
        times = {"unix_millis_earliest_start_time": start, "unix_millis_deadline": start + 5.0 * MINUTE}
        millis = {key: round(1000.0 * value) for key, value in times.items()}
        self.client.submit({"text": text, "id": name, **millis})

    def now(self):
        """Return the service's time [s]."""
        return self.client.call("GET", "/state")["unix_millis_time"] / 1000.0

    def end_of(self, name):
        """Return a request once it has ended."""
        is_open = ("queued", "underway")
        wait_until(f"the end of {name}", lambda: self.task(name)["status"] not in is_open, PATIENCE, 0.1)
        return self.task(name)

    def task(self, name):
        return self.client.call("GET", f"/tasks/{name}")

    def stood_at(self, place, task):
        """Return whether the robot truly stood at a place in the ten seconds before the end of a task."""
        last = task["unix_millis_finish_time"] / 1000.0 - rospy.get_param("/service/origin")
        wait_until("the current ground truth", lambda: self.steps[-1][0] >= last, PATIENCE)
        poses = [pose for stamp, pose in self.steps[-30_000:] if last - 10.0 <= stamp <= last]
        at = self.places[place].pose
        return any(Pose2(at.x, at.y).distance_to(pose) < ARRIVAL_TOLERANCE for pose in poses)


if __name__ == "__main__":
    rospy.init_node("test_idle_time")
    rostest.rosrun("home_service_tests", "idle_time", IdleTimeTest)
