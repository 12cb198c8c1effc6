"""The node ``follow_me``: looks up both robots in tf and sends goals to the follower's move_base."""

from typing import Callable, Optional

import rospy

from follow_me.config import NodeSettings
from follow_me.follower import LeaderFollower
from planar import Pose2
from planar_ros.calls.move_base import MoveBaseClient
from planar_ros.lockstep import LockstepClient
from planar_ros.messages.transforms import Transforms
from planar_ros.node.parameters import read_settings
from planar_ros.node.readiness import ReadinessMonitor
from planar_ros.node.runner import run


class FollowMe:
    """Sends goals until shutdown; waits for move_base and the transforms and logs which are missing."""

    def __init__(self):
        step = LockstepClient.of_node()
        self._settings = read_settings(NodeSettings)
        self._follower = LeaderFollower(self._settings)
        self._transforms = Transforms()
        self._move_base = MoveBaseClient(self._settings.map_frame)
        self._move_base.cancel_on_shutdown()
        frames = (self._settings.leader_frame, self._settings.base_frame)
        ReadinessMonitor(
            {
                self._move_base.name: self._move_base.is_ready,
                **{
                    f"the transform {self._settings.map_frame} -> {frame}": self._is_known(frame)
                    for frame in frames
                },
            }
        )
        step.every(lambda: self._settings.goal_period, self._follow, self._reset, reports=True)
        step.join()

    def _reset(self):
        self._follower = LeaderFollower(self._settings)
        self._transforms.clear()

    def _follow(self, _now: rospy.Time):
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
