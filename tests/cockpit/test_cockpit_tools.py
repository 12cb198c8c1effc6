#!/usr/bin/env python3
"""Each tool of the cockpit, worked as a person does: in a browser, beside a small graph."""

import os
import subprocess
import tempfile
import threading
import unittest
from pathlib import Path

import rosgraph
import rospy
import rostest
from browser import Browser
from command import Command
from sim_bridge_msgs.srv import AddFault, AddFaultResponse
from std_msgs.msg import String
from waiting import wait_until

from cockpit.process import FREE_PORT, CockpitProcess

# Where screenshots are kept, if anybody wants to look at them.
PICTURES = os.environ.get("COCKPIT_PICTURES")


class CockpitToolsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp())
        os.chdir(cls.folder)
        cls.cockpit = CockpitProcess(FREE_PORT, cls.folder / "cockpit.log")
        wait_until("the cockpit to collect the log", collects_log, 60.0)
        rospy.loginfo("logged before the page was opened")
        cls.browser = Browser()
        cls.page = cls.browser.open(cls.cockpit.url, 1400, 900)
        cls.page.wait_for("Tools", "View")
        cls.page.click("Tools")

    @classmethod
    def tearDownClass(cls):
        cls.browser.close()
        cls.cockpit.close()
        print((cls.folder / "cockpit.log").read_text())

    def setUp(self):
        self.opened = None

    def tearDown(self):
        if PICTURES and self.opened:
            self.page.screenshot(Path(PICTURES) / f"{self.opened}.png".replace("/", "_"))
        if self.opened:
            self.page.tick(self.opened)
            wait_until("the window to close", lambda: self.page.text().splitlines().count(self.opened) == 1)
        self.assertEqual(self.page.errors, [])

    def open(self, title):
        self.page.tick(title)
        self.opened = title

    def test_the_graph_is_drawn(self):
        self.open("Graph")
        self.page.choose("Show", "nodes and all topics")
        self.page.wait_for("/stage", "/sine")
        self.assertNotIn("/rosout", self.drawn())
        self.page.choose("Show", "nodes and topics that are in use")
        wait_until("a topic without listeners to vanish", lambda: "/sine" not in self.drawn())

    def drawn(self):
        found = "[...document.querySelectorAll('svg text')].map((one) => one.textContent).join(' ')"
        return self.page.evaluate(found)

    def test_topics_have_rates_and_values(self):
        self.open("Topics")
        self.page.fill_in("Filter", "sine")
        wait_until("the others to vanish", lambda: "/replies" not in self.page.text())
        self.page.choose("Watch", "/sine")
        self.page.wait_for("data: ")
        wait_until("20 Hz", lambda: any(15.0 < rate < 25.0 for rate in self.rates()))

    def rates(self):
        words = self.page.evaluate("[...document.querySelectorAll('td')].map((one) => one.innerText)")
        return [float(word) for word in words if word.replace(".", "", 1).isdigit()]

    def test_docked_tools_leave_two_thirds_of_the_width_to_the_view(self):
        self.open("Console")
        self.page.wait_for("From level")
        self.page.tick("Topics")
        self.page.wait_for("Watch")
        wait_until("two thirds", lambda: 2.0 / 3.0 <= self.share_of_view() < 1.0)
        self.page.tick("Topics")
        wait_until("its window to close", lambda: "Watch" not in self.page.text())

    def share_of_view(self):
        shown = "document.querySelector('canvas[data-engine]').getBoundingClientRect().width / innerWidth"
        return self.page.evaluate(shown)

    def test_the_console_shows_what_was_logged_before(self):
        self.open("Console")
        self.page.fill_in("Message", "logged before the page")
        self.page.wait_for("logged before the page was opened")
        self.page.fill_in("Message", "")

    def test_the_console_filters_and_sets_levels(self):
        self.open("Console")
        self.page.wait_for("<b>of the stage</b>", "/stage", "Warn")
        self.page.choose("From level", "Error")
        wait_until("warnings to vanish", lambda: "of the stage" not in self.page.text())
        self.page.choose("From level", "Debug")
        self.page.wait_for("of the stage")
        self.page.click("Logger levels")
        self.page.choose("Of node", "/stage")
        self.page.choose("Logger", "rosout")
        self.page.choose("Level", "Fatal")
        self.page.click("Set the level")
        self.page.wait_for("/stage: rosout is at Fatal")
        self.page.choose("Level", "Info")
        self.page.click("Set the level")
        self.page.wait_for("/stage: rosout is at Info")

    def test_the_tree_of_frames_has_ages(self):
        self.open("Frames (tf)")
        self.page.wait_for("odom", "base_link", "/stage")
        wait_until("20 Hz", lambda: any(15.0 < rate < 25.0 for rate in self.rates()))

    def test_a_service_is_called(self):
        self.open("Services")
        self.page.choose("Service", "/switch")
        self.page.wait_for("std_srvs/SetBool")
        wait_until("the template", lambda: "data" in (self.page.value_of("Request") or ""))
        self.page.fill_in("Request", "data: true")
        self.page.click("Call")
        self.page.wait_for("success: True", "message: switched True")
        self.page.fill_in("Request", "data: [")
        self.page.click("Call")
        self.page.wait_for("not YAML")

    def test_parameters_are_shown_and_set(self):
        self.open("Parameters")
        self.page.wait_for("/rosdistro")
        self.page.fill_in("Filter", "answ")
        wait_until("the others to vanish", lambda: "/rosdistro" not in self.page.text())
        self.page.wait_for("/answer", "42")
        self.page.fill_in("Name", "/answer")
        self.page.fill_in("Value", "[1, 2]")
        self.page.click("Set")
        wait_until("the parameter", lambda: rospy.get_param("/answer") == [1, 2])
        self.page.wait_for("[1, 2]")
        rospy.set_param("/answer", 42)

    def test_a_message_is_published_once_and_again_and_again(self):
        self.open("Publisher")
        received = []
        rospy.Subscriber("/words", String, lambda message: received.append(message.data))
        self.page.fill_in("Topic", "/words")
        self.page.click("Create the message")
        wait_until("the template", lambda: self.page.value_of("Message") == "data: ''")
        self.page.fill_in("Message", "data: hello")
        self.page.click("Publish once")
        wait_until("the message", lambda: received == ["hello"])
        self.page.fill_in("Hz", "10")
        self.page.tick("Repeat")
        wait_until("ten more", lambda: len(received) > 10)
        self.page.tick("Repeat")
        self.page.fill_in("Message", "data: [1]")
        self.page.click("Publish once")
        self.page.wait_for("not a std_msgs/String")

    def test_a_number_is_plotted(self):
        self.open("Plot")
        wait_until("a suggestion", lambda: (self.page.value_of("Number") or "").startswith("/"))
        self.page.choose("Number", "/sine/data")
        self.page.click("Add")
        self.page.wait_for("/sine/data")
        wait_until("a chart", lambda: self.page.evaluate("document.querySelectorAll('.uplot').length") == 1)
        self.page.fill_in("or type it", "/nothing")
        self.page.click("Add")
        self.page.wait_for("'/nothing' does not begin with the name of a topic")

    def test_a_server_is_reconfigured(self):
        self.open("Reconfigure")
        self.page.choose("Server", "/stage")
        self.page.wait_for("gain")
        self.page.fill_in("gain", "5")
        wait_until("the gain", lambda: rospy.get_param("/stage/gain") == 5.0)

    def test_a_picture_is_shown(self):
        self.open("Images")
        self.page.choose("Topic", "/camera/image")
        self.page.wait_for("64 x 48, rgb8")
        wait_until("a picture", lambda: self.page.evaluate("document.querySelectorAll('img').length"))

    def test_a_bag_is_recorded_and_played(self):
        self.open("Bag")
        self.page.wait_for("Stop the recording")  # before it, "Record" is the title of its folder only
        self.page.fill_in("File", "../there.bag")
        self.page.click("Record")
        self.page.wait_for("is not a valid file name")
        self.page.fill_in("File", "sine.bag")
        self.page.fill_in("Topics", "/sine")
        self.page.click("Record")
        self.page.wait_for("recording sine.bag")
        wait_until("something in it", lambda: _size(self.folder / "sine.bag.active") > 4000)
        threading.Event().wait(2.0)
        self.page.click("Stop the recording")
        self.page.wait_for("recorded sine.bag")
        self.page.choose("Found", "sine.bag")
        self.page.fill_in("Rate", "0.1")
        self.page.click("Play")
        self.page.wait_for("playing")
        wait_until("its node", lambda: any("/play" in node for node in nodes_of("/sine")))
        wait_until("its service", lambda: any(name.endswith("/pause_playback") for name in services()))
        self.page.click("Pause")
        wait_until("silence", lambda: not played_within(0.5))
        self.page.click("Resume")
        wait_until("what was recorded", lambda: played_within(2.0))
        self.page.click("Stop")
        self.page.wait_for("finished playing")
        self.page.fill_in("or its path", "nothing.bag")
        self.page.click("Play")
        self.page.wait_for("no such bag")

    def test_faults_need_a_simulator_and_the_page_waits_for_none(self):
        self.open("Faults")
        self.page.wait_for("none is running")
        over = threading.Event()
        service = rospy.Service(
            "/sim_bridge/add_fault", AddFault, lambda _: over.wait() and AddFaultResponse(True, "")
        )
        self.addCleanup(service.shutdown)
        self.addCleanup(over.set)
        wait_until("a simulator", lambda: "none is running" not in self.page.text())
        self.page.choose("Kind", "scan_nan")
        self.page.click("Inject the fault")
        self.page.wait_for("...")
        self.page.choose("Kind", "scan_inf")
        self.page.wait_for("All ranges are infinite: no beam returns.")
        self.assertNotIn("no answer", self.page.text())
        self.page.wait_for("no answer of the service /sim_bridge/add_fault within 10 s")
        self.assertNotIn("Active fault", self.page.text())

    def test_the_names_of_rqt_start_the_cockpit_at_their_tool(self):
        self.assert_shows(["rosrun", "rqt_plot", "rqt_plot", "/sine/data"], "Plot", "/sine/data")
        self.assert_shows(["rqt", "-s", "rqt_tf_tree"], "Frames (tf)", "base_link")
        done = subprocess.run(
            ["rqt", "-s", "rqt_dream"], capture_output=True, text=True, timeout=60, check=False
        )
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1))
        self.assertIn("unknown program 'rqt_dream'", done.stderr)

    def assert_shows(self, command, *texts):
        with Command(*command) as run:
            page = self.browser.open(run.url)
            page.wait_for(*texts)
            self.assertEqual(page.errors, [])
            page.close()
            self.assertEqual(run.end(), 0)


def nodes_of(topic):
    publishers, _, _ = rosgraph.Master("/test").getSystemState()
    return dict(publishers).get(topic, [])


def collects_log():
    _, subscribers, _ = rosgraph.Master("/test").getSystemState()
    return any(node.startswith("/cockpit") for node in dict(subscribers).get("/rosout", []))


def services():
    return dict(rosgraph.Master("/test").getSystemState()[2])


def played_within(seconds):
    """Whether the player sends anything."""
    received = threading.Event()

    def on_message(message):
        if "/play" in message._connection_header["callerid"]:
            received.set()

    subscriber = rospy.Subscriber("/sine", rospy.AnyMsg, on_message)
    received.wait(seconds)
    subscriber.unregister()
    return received.is_set()


def _size(path):
    return path.stat().st_size if path.exists() else 0


if __name__ == "__main__":
    rospy.init_node("test_cockpit_tools")
    rostest.rosrun("home_service_tests", "tools_in_browser", CockpitToolsTest)
