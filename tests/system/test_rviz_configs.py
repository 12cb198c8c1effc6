#!/usr/bin/env python3
"""Whatever an rviz configuration shows or sends is there in the graph that it is for."""

import time
import unittest
from pathlib import Path

import rosgraph
import rospy
import rostest
import yaml

FOLDER = Path(__file__).resolve().parents[2] / "rvizConfig"
WALL_DEADLINE = 60.0
SENDING = "/clicked_point"  # of a tool whose listener is the user's


class RvizConfigTest(unittest.TestCase):
    def test_every_topic_of_the_configurations_is_there(self):
        for name in rospy.get_param("~configurations").split():
            shown, sent = topics_of(FOLDER / f"{name}.rviz")
            print(f"{name}: {len(shown)} topics shown, {len(sent)} sent")
            self.assertGreater(len(shown), 5)
            self._wait_for(shown, 0, f"{name}.rviz shows topics without publishers")
            self._wait_for(sent - {SENDING}, 1, f"{name}.rviz publishes topics without subscribers")

    def test_the_model_of_the_robot_is_there(self):
        self.assertIn("<robot", rospy.get_param("/robot_description"))

    def _wait_for(self, topics, part, complaint):
        master, deadline = rosgraph.Master(rospy.get_name()), time.monotonic() + WALL_DEADLINE
        while True:
            missing = topics - {topic for topic, _ in master.getSystemState()[part]}
            if not missing:
                return
            self.assertLess(time.monotonic(), deadline, f"{complaint}: {sorted(missing)}")
            time.sleep(0.2)


def topics_of(path):
    """The topics that the displays and those that the tools of a configuration name."""
    manager = yaml.safe_load(path.read_text())["Visualization Manager"]
    displays = list(manager["Displays"])
    for display in displays:
        displays += display.get("Displays", [])
    shown = {display[key] for display in displays for key in ("Topic", "Marker Topic") if key in display}
    return shown, {tool["Topic"] for tool in manager["Tools"] if "Topic" in tool}


if __name__ == "__main__":
    rospy.init_node("test_rviz_configs")
    rostest.rosrun("home_service_tests", "rviz_configs", RvizConfigTest)
