"""The ROS node of the keyboard teleop: publishes velocities from the keys of a terminal or script."""

import argparse
import sys
import threading
import time
from dataclasses import dataclass
from typing import Callable, Collection, Optional, Protocol

import rospy
from geometry_msgs.msg import Twist

from planar import PlanarError, Twist2
from planar_ros.lockstep.ticker import ProgressPublisher
from planar_ros.node.parameters import read_settings
from planar_ros.node.readiness import ReadinessMonitor
from planar_ros.node.runner import run
from planar_ros.node.topics import flush_and_close
from supervision.interruption import ignore_further_signals, on_signals
from teleop_lite.config import TeleopSettings
from teleop_lite.key_script import KEYS, KeyScript, parse
from teleop_lite.teleop import TICK_SECONDS, Teleop
from teleop_lite.terminal import CTRL_C, NoKeysError, Pipe, Terminal

BANNER = """
Control Your Turtlebot!
---------------------------
Moving around:
   u    i    o
   j    k    l
   m    ,    .

q/z : increase/decrease max speeds by 10%
w/x : increase/decrease only linear speed by 10%
e/c : increase/decrease only angular speed by 10%
space key, k : force stop
anything else : stop smoothly

CTRL-C to quit
"""
CHANGES_PER_BANNER = 15
SUBSCRIBER_TIMEOUT = 60.0
POLL_SECONDS = 0.02
DELIVERY_TIMEOUT = 2.0


class TeleopDriver(Protocol):
    """Computes velocity commands from keys.

    Attributes:
        full: Full speed and turn rate, printed when they change [m/s, rad/s].
    """

    full: Twist2

    def press(self, key: str) -> None:
        """Process a key."""

    def tick(self, now: float) -> Twist2:
        """Return the velocity command for the next TICK_SECONDS.

        Args:
            now: Time of a monotonic clock [s].
        """


@dataclass(frozen=True)
class TeleopVariant:
    """An official teleop program that this node can stand in for.

    Attributes:
        program: Name of the executable.
        node_name: Name of the node.
        topic: Topic of the velocity commands.
        banner: Text printed at the start.
        keys: Valid keys of a script.
        make_driver: Constructs the driver.
        speeds: Format of the line that reports the full speeds.
    """

    program: str
    node_name: str
    topic: str
    banner: str
    keys: Collection[str]
    make_driver: Callable[[], TeleopDriver]
    speeds: str = "currently:\tspeed {v:.4g}\tturn {omega:.4g}"


TURTLEBOT = TeleopVariant(
    program="turtlebot_teleop_key",
    node_name="turtlebot_teleop_keyboard",
    topic="~cmd_vel",
    banner=BANNER,
    keys=KEYS,
    make_driver=lambda: Teleop(read_settings(TeleopSettings)),
)


class KeyboardTeleop:
    """Publishes velocities every TICK_SECONDS until the keys end; stops the robot however it ends."""

    def __init__(self, variant: TeleopVariant):
        self._variant = variant
        self._teleop = variant.make_driver()
        self._changes = 0
        self._is_stopped = False
        self._lock = threading.Lock()
        self._publisher = rospy.Publisher(variant.topic, Twist, queue_size=5, tcp_nodelay=True)
        rospy.on_shutdown(self.stop)

    def run_keyboard(self, terminal: Terminal) -> None:
        """Drive by the keys of a terminal until Ctrl-C, in wall time."""
        print(self._variant.banner)
        self._print_speeds()
        next_tick = time.monotonic()
        while not rospy.is_shutdown():
            for key in terminal.read(max(0.0, next_tick - time.monotonic())):
                if key == CTRL_C:
                    return
                self._press(key)
            now = time.monotonic()
            if now >= next_tick:
                next_tick = now + TICK_SECONDS
                self._publish(self._teleop.tick(now))

    def run_script(self, script: KeyScript, pipe: Optional[Pipe]) -> None:
        """Drive by a script in ROS time until the script and the pipe end.

        Args:
            script: Keys to press.
            pipe: Further parts of the script; None for none.

        Raises:
            PlanarError: ROS time jumped back.
            KeyScriptError: A part of the pipe's text is not a key with a duration.
        """
        self._wait_for_subscriber()
        progress = ProgressPublisher()
        rate = rospy.Rate(1.0 / TICK_SECONDS)
        while not rospy.is_shutdown():
            if pipe is not None:
                script.add(parse(pipe.read(), self._variant.keys))
            now = rospy.get_rostime()
            for key in script.keys_at(now.to_sec()):
                self._press(key)
            if script.is_over and (pipe is None or pipe.is_at_end):
                return
            self._publish(self._teleop.tick(now.to_sec()))
            progress.report(now)
            try:
                rate.sleep()
            except rospy.ROSTimeMovedBackwardsException:
                raise PlanarError("ROS time jumped back: the rest of the script is dropped") from None

    def stop(self) -> None:
        """Stop the robot and publish nothing after that."""
        with self._lock:
            if self._is_stopped:
                return
            self._is_stopped = True
            self._publisher.publish(Twist())
            flush_and_close(self._publisher, patience=DELIVERY_TIMEOUT)

    def _wait_for_subscriber(self):
        conditions = {
            f"a subscriber of {self._publisher.resolved_name}": lambda: (
                self._publisher.get_num_connections() > 0
            ),
            "the clock": lambda: not rospy.get_rostime().is_zero(),
        }
        ReadinessMonitor(conditions)
        deadline = time.monotonic() + SUBSCRIBER_TIMEOUT
        while not rospy.is_shutdown():
            missing = [name for name, is_met in conditions.items() if not is_met()]
            if not missing:
                return
            if time.monotonic() > deadline:
                raise PlanarError(f"waited for {' and '.join(missing)} for {SUBSCRIBER_TIMEOUT:g} s")
            time.sleep(POLL_SECONDS)

    def _press(self, key):
        full = self._teleop.full
        self._teleop.press(key)
        if self._teleop.full != full:
            self._changes += 1
            self._print_speeds()
            if self._changes % CHANGES_PER_BANNER == 0:
                print(self._variant.banner)

    def _print_speeds(self):
        full = self._teleop.full
        print(self._variant.speeds.format(v=full.v, omega=full.omega), flush=True)

    def _publish(self, velocity: Twist2):
        message = Twist()
        message.linear.x, message.angular.z = velocity.v, velocity.omega
        with self._lock:
            if not self._is_stopped:
                self._publisher.publish(message)


def main(variant: TeleopVariant = TURTLEBOT):
    keys = _parse_arguments(variant).keys
    try:
        if not keys and sys.stdin is not None and sys.stdin.isatty():
            terminal = Terminal(sys.stdin.fileno())
            run(variant.node_name, lambda: _drive(variant, lambda node: _run_in(terminal, node)))
        else:
            script, pipe = _open_script(" ".join(keys), variant.keys)
            run(variant.node_name, lambda: _drive(variant, lambda node: node.run_script(script, pipe)))
    except PlanarError as error:
        print(f"[/{variant.node_name}] error: {error}", file=sys.stderr)
        sys.exit(2)


def _run_in(terminal, node):
    with terminal:
        node.run_keyboard(terminal)


def _open_script(text, known_keys):
    """The script and the pipe that may deliver more of it; what is available is parsed at once."""
    if text:
        return KeyScript(parse(text, known_keys)), None
    if sys.stdin is None:
        raise NoKeysError(NO_KEYS)
    pipe = Pipe(sys.stdin.fileno())
    script = KeyScript(parse(pipe.read(), known_keys))
    if pipe.is_at_end and script.is_over:
        raise NoKeysError(NO_KEYS)
    return script, pipe


NO_KEYS = (
    "no keys: standard input is neither a terminal nor a script; "
    "try: echo i:2.0 j:1.5 | rosrun teleop_lite turtlebot_teleop_key"
)


def _drive(variant, follow):
    on_signals(_end)
    node = KeyboardTeleop(variant)
    try:
        follow(node)
    finally:
        node.stop()
    rospy.signal_shutdown("no more keys")


def _end(number, _frame):
    ignore_further_signals()
    sys.exit(128 + number)


def _parse_arguments(variant):
    parser = argparse.ArgumentParser(
        prog=variant.program,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Drives the robot with the keys of a terminal, or with a script of keys.\n"
        + variant.banner,
        epilog="A script comes as arguments or on a pipe:  echo 'i:2.0 j:1.5, ,:1' | turtlebot_teleop_key\n"
        "Times are seconds of ROS time; without a time a key is pressed once. The robot stops at the end.",
    )
    parser.add_argument("keys", nargs="*", metavar="KEY:SECONDS", help="keys to hold one after the other")
    return parser.parse_args(rospy.myargv()[1:])
