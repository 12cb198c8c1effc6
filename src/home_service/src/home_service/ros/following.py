"""Watches one robot follow another, by ground truth."""

import threading
from collections import OrderedDict
from typing import Any, Dict, List, Mapping, Optional

import rospy
from nav_msgs.msg import Odometry
from std_msgs.msg import String

from home_service.judging.verdict import ERRAND, Verdict
from home_service.options import LaunchPlan, RunOptions
from home_service.ros.hearing import hear
from home_service.ros.referee import Referee
from home_service.ros.run import Run
from home_service.ros.run_recorder import RunRecorder
from planar import Pose2
from planar.maps.places import NamedPlace
from planar_ros.messages.conversion import pose2_from_msg
from supervision.display import Display

# A follower is with its leader within this distance, metres, and must be for this share of the time.
WITH_LEADER, REQUIRED_SHARE = 1.5, 0.9
# The time begins when the leader has gone so far, metres.
SET_OFF = 0.05
# So many messages the truth about one robot may come before that about the other.
UNPAIRED = 500


class FollowWatch:
    """How far the robot below ``namespace`` truly is from the one without, at each moment told of both.

    From when the leader sets off.
    """

    def __init__(self, namespace: str):
        self.collisions: List[str] = []
        self._start: Optional[Pose2] = None
        self._has_set_off = False
        self._unpaired: OrderedDict[rospy.Time, Pose2] = OrderedDict()
        self._seen, self._near, self._farthest = 0, 0, 0.0
        self._lock = threading.Lock()
        hear("base_pose_ground_truth", Odometry, self._see_leader)
        hear(f"{namespace}/base_pose_ground_truth", Odometry, self._see_truth)
        hear(f"{namespace}/contacts", String, self._see_contacts)

    @property
    def share(self) -> float:
        """Of the time, in which the follower was with its leader."""
        return self._near / max(self._seen, 1)

    @property
    def complaint(self) -> Optional[str]:
        """Why this was no following; None if it was."""
        if self.collisions:
            return f"the follower collided with {', '.join(sorted(set(self.collisions)))}"
        return None if self.share >= REQUIRED_SHARE else f"{self.praise} only"

    @property
    def praise(self) -> str:
        return f"the follower was within {WITH_LEADER} m for {100.0 * self.share:.0f} % of the time"

    def findings(self) -> Dict[str, Any]:
        """What belongs into result.json; metres."""
        return {
            "follower_share_near": round(self.share, 4),
            "follower_farthest": round(self._farthest, 3),
            "follower_collisions": self.collisions,
        }

    def _see_leader(self, message):
        pose = pose2_from_msg(message.pose.pose)
        self._start = self._start or pose
        self._has_set_off = self._has_set_off or pose.distance_to(self._start) > SET_OFF
        if self._has_set_off:
            self._see_truth(message)

    def _see_truth(self, message):
        stamp, pose = message.header.stamp, pose2_from_msg(message.pose.pose)
        with self._lock:
            other = self._unpaired.pop(stamp, None)
            if other is None:
                self._unpaired[stamp] = pose
                if len(self._unpaired) > UNPAIRED:
                    self._unpaired.popitem(last=False)
                return
            distance = pose.distance_to(other)
            self._seen += 1
            self._near += distance <= WITH_LEADER
            self._farthest = max(self._farthest, distance)

    def _see_contacts(self, message):
        self.collisions += message.data.splitlines()


def let_follow(options: RunOptions, launch: LaunchPlan, places: Mapping[str, NamedPlace]) -> int:
    """Runs an errand that another robot follows; returns the exit code."""
    display = Display()
    referee = Referee(places, display.say)
    with Run(options, launch, referee, RunRecorder(places), display) as run:
        following = FollowWatch("follower")
        failure = run.watch(lambda: referee.has_seen({ERRAND}))
        verdict = referee.verdict({ERRAND}, failure)
        if verdict.success:
            complaint = following.complaint
            verdict = Verdict(complaint is None, complaint or f"{verdict.reason}; {following.praise}")
        return run.conclude(verdict, **following.findings())
