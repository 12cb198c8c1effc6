"""The node ``follow_me``: asks tf where both robots are, and sends goals to the follower's move_base."""

import threading
from typing import Callable, Optional

import rospy

from follow_me.config import NodeSettings
from follow_me.follower import Follower
from planar import Pose2
from planar_ros.calls.move_base import MoveBase
from planar_ros.messages.transforms import Transforms
from planar_ros.node.clock import sleep_until
from planar_ros.node.parameters import read_settings
from planar_ros.node.progress import Progress
from planar_ros.node.shell import run
from planar_ros.node.waiting import Waiting


class FollowMe:
    """Sends goals for as long as it lives; without transforms it waits, and says for which."""

    def __init__(self):
        self._settings = read_settings(NodeSettings)
        self._follower = Follower(self._settings)
        self._transforms = Transforms()
        self._progress = Progress()
        self._move_base = MoveBase(self._settings.map_frame)
        frames = (self._settings.leader_frame, self._settings.base_frame)
        Waiting(
            {
                self._move_base.name: self._move_base.is_ready,
                **{
                    f"the transform {self._settings.map_frame} -> {frame}": self._is_known(frame)
                    for frame in frames
                },
            }
        )
        threading.Thread(target=self._work, daemon=True).start()

    def _work(self):
        period, now = rospy.Duration(self._settings.goal_period), rospy.Time.now()
        while not rospy.is_shutdown():
            try:
                # Of the two only a jump back of time makes the second the earlier one.
                now = sleep_until(min(now, rospy.Time.now()) + period)
                self._follow()
                self._progress.report(now)
            except rospy.ROSTimeMovedBackwardsException:
                now = rospy.Time.now()
                self._follower = Follower(self._settings)
                self._transforms.clear()
            except rospy.ROSInterruptException:
                return

    def _follow(self):
        leader, follower = self._in_map(self._settings.leader_frame), self._in_map(self._settings.base_frame)
        if leader is None or follower is None or not self._move_base.is_ready():
            return
        goal = self._follower.goal(leader, follower)
        if goal is not None:
            self._move_base.send(goal)

    def _is_known(self, frame: str) -> Callable[[], bool]:
        return lambda: self._in_map(frame) is not None

    def _in_map(self, frame: str) -> Optional[Pose2]:
        return self._transforms.lookup(self._settings.map_frame, frame)


def main():
    run("follow_me", FollowMe)
