"""Pausing, stepping and resetting a scene, and how fast its time passes."""

import time
from concurrent.futures import CancelledError, Future
from dataclasses import dataclass
from typing import List

import rospy
from sim_bridge_msgs.srv import Step, StepResponse
from std_msgs.msg import Header

from planar_ros.messages.conversion import time_of
from planar_ros.node.progress import TOPIC as PROGRESS_TOPIC
from planar_ros.node.reconfigure import SettingsReconfigureServer
from planar_ros.node.waiting import ReadinessMonitor, StallReporter
from planar_ros.step import transport
from sim_bridge.config import RunTimeSettings
from sim_bridge.pacing import Pacer
from sim_bridge.ros.orders import Orders
from sim_bridge.ros.timing.lock_step import LockStep
from sim_bridge.scene import Scene

# So that a shutdown is noticed soon.
LONGEST_WAIT_SECONDS = 0.05


@dataclass
class _Grant:
    """Steps that a paused simulation may take; ``done`` gets the time after the last of them."""

    steps_left: int
    done: Future


class TimeControl:
    """Says when the next step is due; its methods are called in the thread that owns the scene."""

    def __init__(self, scene: Scene, pacer: Pacer, step: LockStep, orders: Orders):
        self.is_paused = False
        self._step = step
        self._scene = scene
        self._pacer = pacer
        self._orders = orders
        self._grants: List[_Grant] = []
        rospy.Subscriber(PROGRESS_TOPIC, Header, self._on_progress, queue_size=100, tcp_nodelay=True)
        rospy.Service("~step", Step, self._on_step)
        self._hold_up = StallReporter()
        ReadinessMonitor({f"{name} on {PROGRESS_TOPIC}": self._follows(name) for name in pacer.wait_for})

    @property
    def speed(self) -> float:
        return self._pacer.speed

    def set_speed(self, speed: float) -> None:
        """``speed``: times real time, 0 for as fast as possible."""
        self._pacer.speed = speed

    def offer_speed(self) -> None:
        """Lets dynamic_reconfigure change the speed, below the node's own name."""
        SettingsReconfigureServer(RunTimeSettings(self.speed), self._on_reconfigure)

    def expect_odometry(self, seconds: float) -> None:
        """Each robot tells its odometry at least every ``seconds``."""
        self._pacer.odometry_delay = max(0.0, seconds - self._scene.step_seconds)

    def wait_for_turn(self) -> bool:
        """Waits until the next step may be taken, or something else is to be done first (then False)."""
        may_go = self._may_go()
        self._hold_up.look([] if may_go else self._waits_for())
        return may_go

    def _may_go(self) -> bool:
        if self.is_paused and not self._grants:
            return self._wait(LONGEST_WAIT_SECONDS)
        if not self._step.may_pass(self._scene.stamp):
            return self._wait(LONGEST_WAIT_SECONDS)
        if self._orders.are_waiting:  # what has just taken effect
            return self._wait(0.0)
        self._pacer.synchronised_nodes = self._step.names
        wall, stamp = time.monotonic(), self._scene.stamp + self._scene.step_seconds
        delay = self._pacer.delay(stamp, wall, is_limited=not self.is_paused)
        if delay <= 0.0:
            return True
        for name in self._pacer.give_up(stamp, wall):
            rospy.logwarn("no progress of %s: the simulation goes on without it in real time", name)
        return self._wait(min(delay, LONGEST_WAIT_SECONDS))

    def _wait(self, seconds: float) -> bool:
        """False, when orders have come or after ``seconds``; before, all that was published is sent."""
        transport.flush()
        self._orders.wait(seconds)
        return False

    def _waits_for(self) -> List[str]:
        if self.is_paused and not self._grants:
            return []
        return [
            *self._step.waits_for(),
            *self._pacer.lagging_nodes(self._scene.stamp + self._scene.step_seconds),
        ]

    def count_step(self) -> None:
        """A step has been taken."""
        if self._grants:
            grant = self._grants[0]
            grant.steps_left -= 1
            self._end_grants()

    def pause(self) -> None:
        self.is_paused = True

    def unpause(self) -> None:
        self.is_paused = False

    def reset_world(self) -> None:
        self._scene.reset_poses()
        rospy.loginfo("all models are back where they started")

    def reset_simulation(self) -> None:
        self._scene.reset()
        self._pacer.restart()
        self._step.restart()
        rospy.loginfo("the simulation starts again at time 0")

    def close(self) -> None:
        """Lets go those who wait for steps."""
        for grant in self._grants:
            grant.done.cancel()

    def _on_step(self, request) -> StepResponse:
        """Pauses, and steps as fast as possible, but leaves no node behind that is waited for."""
        grant = _Grant(request.steps, Future())
        self._orders.ask(lambda: self._allow(grant))
        try:
            return StepResponse(time_of(grant.done.result()))
        except CancelledError:
            raise rospy.ServiceException("the simulation is shutting down") from None

    def _on_reconfigure(self, values):
        self._orders.leave(lambda: self.set_speed(values["speed"]))
        return values

    def _allow(self, grant: _Grant) -> None:
        self.is_paused = True
        self._grants.append(grant)
        self._end_grants()

    def _end_grants(self) -> None:
        while self._grants and self._grants[0].steps_left == 0:
            self._grants.pop(0).done.set_result(self._scene.stamp)

    def _on_progress(self, message):
        name, stamp = message.frame_id.lstrip("/"), message.stamp.to_sec()
        self._orders.leave(lambda: self._pacer.report(name, stamp))

    def _follows(self, name):
        return lambda: name in self._step.names or not self._pacer.is_missing(name)
