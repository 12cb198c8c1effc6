#!/usr/bin/env python3
"""The simulator ends within a second of SIGINT or SIGTERM, whatever it is at, and leaves nothing behind.

test_exit.py [STARTS]    starts and stops it so many times (default: once in each situation)
"""

import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path
from xmlrpc.client import ServerProxy

import psutil
import roslib.packages
import rostest

WORLD = Path(__file__).resolve().parents[2] / "map" / "home.world"
NODE = roslib.packages.find_node("sim_bridge", "sim_bridge")[0]
START_SECONDS = 60.0
# Target of EXIT_SECONDS, measured by `test_exit.py STARTS`; the test only distinguishes an end from a hang.
EXIT_SECONDS = 1.0
HANG_SECONDS = 5.0
SITUATIONS = ("running", "paused", "without master", "terminated", "as gazebo")


class Started:
    """A separate master and simulators; leaving the context ends all."""

    def __init__(self):
        self._processes = []

    def __enter__(self):
        try:
            self._start()
        except BaseException:
            self._end()
            raise
        return self

    def __exit__(self, *_):
        self._end()

    def _start(self):
        with socket.socket() as listener:
            listener.bind(("127.0.0.1", 0))
            port = listener.getsockname()[1]
        self.uri = f"http://127.0.0.1:{port}"
        environment = {**os.environ, "ROS_MASTER_URI": self.uri, "ROS_IP": "127.0.0.1"}
        self.master = self._run("rosmaster", "--core", "-p", str(port), env=environment)
        self._wait_for(lambda: ServerProxy(self.uri).getPid("/test")[0] == 1)
        ServerProxy(self.uri).setParam("/test", "/use_sim_time", True)
        self.environment = environment

    def start_simulator(self, name="sim_bridge"):
        self.simulator = self._run(
            NODE, f"__name:={name}", f"_world:={WORLD}", "_speed:=0", env=self.environment
        )
        self._wait_for(lambda: self._is_up(name))

    def failed_start(self, *parameters):
        """Return the exit code and the output of a simulator that ends at once."""
        ended = subprocess.run(
            [NODE, *parameters],
            env=self.environment,
            capture_output=True,
            text=True,
            timeout=START_SECONDS,
            check=False,
        )
        return ended.returncode, ended.stdout + ended.stderr

    def _run(self, *command, env):
        self._processes.append(subprocess.Popen(command, env=env))
        return self._processes[-1]

    def _end(self):
        for process in reversed(self._processes):
            if process.poll() is None:
                process.kill()
            process.wait()

    def pause(self):
        subprocess.run(["rosservice", "call", "/gazebo/pause_physics"], env=self.environment, check=True)

    def end_master(self):
        self.master.terminate()
        self.master.wait()

    def seconds_to_end(self, number):
        """Sends the signal; how long the simulator takes to be gone."""
        start = time.monotonic()
        self.simulator.send_signal(number)
        self.simulator.wait(20.0)
        return time.monotonic() - start

    def _is_up(self, name):
        """Whether the simulator has registered the last of its topics."""
        _, _, (_, subscribed, _) = ServerProxy(self.uri).getSystemState("/test")
        return f"/{name}/add_box" in [topic for topic, _ in subscribed]

    def _wait_for(self, is_there):
        deadline = time.monotonic() + START_SECONDS
        while True:
            try:
                if is_there():
                    return
            except OSError:
                pass
            if time.monotonic() > deadline:
                raise TimeoutError("the simulator did not start")
            time.sleep(0.05)


def exit_in(situation):
    """Seconds to the end, its exit code, and the processes it leaves behind."""
    before = {process.pid for process in psutil.process_iter()}
    with Started() as started:
        started.start_simulator("gazebo" if situation == "as gazebo" else "sim_bridge")
        if situation == "paused":
            started.pause()
        if situation == "without master":
            started.end_master()
        mine = {child.pid for child in psutil.Process(started.simulator.pid).children(recursive=True)}
        seconds = started.seconds_to_end(signal.SIGTERM if situation == "terminated" else signal.SIGINT)
    left = [pid for pid in mine - before if psutil.pid_exists(pid)]
    return seconds, started.simulator.returncode, left


class TestExit(unittest.TestCase):
    def test_the_simulator_ends_at_once(self):
        for situation in SITUATIONS:
            seconds, code, left = exit_in(situation)
            print(f"{situation}: ended in {seconds:.2f} s")
            self.assertLess(seconds, HANG_SECONDS, situation)
            self.assertEqual((code, left), (0, []), situation)

    def test_an_error_at_the_start_is_reported_in_a_line(self):
        with Started() as started, tempfile.TemporaryDirectory() as folder:
            broken, still = Path(folder) / "broken.world", Path(folder) / "still.urdf"
            broken.write_text("<sdf><world")
            still.write_text("<robot name='r'><link name='a'/></robot>")
            world = f"_world:={WORLD}"
            for parameters, reason in (
                (["_world:=/no.world"], "/no.world: cannot be read (No such file or directory)"),
                ([f"_world:={broken}"], "broken.world: not well-formed XML"),
                ([world, "_robot:=turtelbot_lidar"], 'did you mean "turtlebot_lidar"?'),
                ([world, f"_robot:={still}"], "robot r has no drive"),
                ([world, "_robot:=turtlebot_lidar", "_x:=-2.6", "_y:=4.99"], "inside wardrobe::link"),
                ([world, "_seed:=-1"], "/sim_bridge/seed must be not negative, got -1"),
            ):
                code, text = started.failed_start(*parameters)
                self.assertNotIn(code, (0, -6, -11), text)
                self.assertIn(reason, text)
                self.assertNotIn("Traceback", text)
                self.assertNotIn("unknown parameter", text)


def main():
    starts = int(sys.argv[1])
    ended = [exit_in(SITUATIONS[number % len(SITUATIONS)]) for number in range(starts)]
    times = sorted(seconds for seconds, _, _ in ended)
    left = sum(len(one[2]) for one in ended)
    failed = sum(one[1] != 0 for one in ended)
    print(
        f"{starts} starts: exit within {times[len(times) // 2]:.2f} s (median), {times[-1]:.2f} s (longest), "
        f"{failed} with an error, {left} processes left"
    )
    return int(times[-1] > EXIT_SECONDS or failed or left)


if __name__ == "__main__":
    if len(sys.argv) == 2 and sys.argv[1].isdigit():
        sys.exit(main())
    rostest.rosrun("home_service_tests", "exit", TestExit)
