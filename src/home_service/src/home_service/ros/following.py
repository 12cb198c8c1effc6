"""Judge by ground truth whether one robot follows another."""

import threading
from collections import OrderedDict
from typing import Any, Dict, List, Mapping, Optional

import rospy
from nav_msgs.msg import Odometry
from std_msgs.msg import String

from evaluation.options import LaunchPlan, RunOptions
from evaluation.ros.referee import Referee
from evaluation.ros.run import Run
from evaluation.ros.run_recorder import RunRecorder
from evaluation.ros.subscriptions import subscribe
from evaluation.verdict import ERRAND, Verdict
from planar import Pose2
from planar.maps.places import NamedPlace
from planar_ros.messages.conversion import pose2_from_msg
from supervision.display import Display

# Distance within which a follower is close to its leader [m], and share of the time in which it must be.
MAX_DISTANCE, REQUIRED_SHARE = 1.5, 0.9
# Distance from its start at which the leader has departed [m].
DEPARTURE_DISTANCE = 0.05
# Messages by which the true poses of one robot may be ahead of the other's.
MAX_UNPAIRED = 500


class FollowMonitor:
    """Distance of a follower from its leader, from the leader's departure on.

    Only stamps with the true poses of both robots count.

    Args:
        namespace: Namespace of the follower; the leader has none.

    Attributes:
        collisions: What the follower touched.
    """

    def __init__(self, namespace: str):
        self.collisions: List[str] = []
        self._start: Optional[Pose2] = None
        self._has_departed = False
        self._unpaired: OrderedDict[rospy.Time, Pose2] = OrderedDict()
        self._seen, self._near, self._farthest = 0, 0, 0.0
        self._lock = threading.Lock()
        subscribe("base_pose_ground_truth", Odometry, self._on_leader)
        subscribe(f"{namespace}/base_pose_ground_truth", Odometry, self._on_truth)
        subscribe(f"{namespace}/contacts", String, self._on_contacts)

    @property
    def share(self) -> float:
        """Share of the time in which the follower was close to its leader."""
        return self._near / max(self._seen, 1)

    @property
    def failure(self) -> Optional[str]:
        """Why the follower has failed; None if it has not."""
        if self.collisions:
            return f"the follower collided with {', '.join(sorted(set(self.collisions)))}"
        return None if self.share >= REQUIRED_SHARE else f"{self.description} only"

    @property
    def description(self) -> str:
        """How well it followed, in words."""
        return f"the follower was within {MAX_DISTANCE} m for {100.0 * self.share:.0f} % of the time"

    def result_fields(self) -> Dict[str, Any]:
        """Return fields of result.json."""
        return {
            "follower_share_near": round(self.share, 4),
            "follower_farthest": round(self._farthest, 3),
            "follower_collisions": self.collisions,
        }

    def _on_leader(self, message):
        pose = pose2_from_msg(message.pose.pose)
        self._start = self._start or pose
        self._has_departed = self._has_departed or pose.distance_to(self._start) > DEPARTURE_DISTANCE
        if self._has_departed:
            self._on_truth(message)

    def _on_truth(self, message):
        stamp, pose = message.header.stamp, pose2_from_msg(message.pose.pose)
        with self._lock:
            other = self._unpaired.pop(stamp, None)
            if other is None:
                self._unpaired[stamp] = pose
                if len(self._unpaired) > MAX_UNPAIRED:
                    self._unpaired.popitem(last=False)
                return
            distance = pose.distance_to(other)
            self._seen += 1
            self._near += distance <= MAX_DISTANCE
            self._farthest = max(self._farthest, distance)

    def _on_contacts(self, message):
        self.collisions += message.data.splitlines()


def run_follow(options: RunOptions, launch: LaunchPlan, places: Mapping[str, NamedPlace]) -> int:
    """Run an errand that another robot follows; return the exit code."""
    display = Display()
    referee = Referee(places, display.print)
    with Run(options, launch, referee, RunRecorder(places), display) as run:
        following = FollowMonitor("follower")
        failure = run.watch(lambda: referee.has_seen({ERRAND}))
        verdict = referee.verdict({ERRAND}, failure)
        if verdict.success:
            failure = following.failure
            verdict = Verdict(failure is None, failure or f"{verdict.reason}; {following.description}")
        return run.conclude(verdict, **following.result_fields())
