#!/usr/bin/env python3
"""Judge runs with which another node interferes, by ground truth and apart from their own verdicts.

python3 tests/benchmarks/interferences.py [--runs 100] [--seed 0] [--busy 4]

Each run is a delivery that is disturbed once, by one kind of interference in one of the stages of the
delivery. A verdict is false if the run succeeded although the robot was not at the place when it picked up or
set down, or failed although it was at both and touched nothing. Exit code 1 if a verdict is false.
"""

import argparse
import itertools
import json
import multiprocessing
import sys
import tempfile
import time
from collections import deque
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable, Deque, Dict, List, Optional, Tuple

from helpers.busy_loops import busy_loops
from killed_nodes import join_graph, wait_for_end
from soak import RUNS, Graph, Leftovers

from evaluation.verdict import ARRIVAL_TOLERANCE
from pick_objects.job import DeliveryStage
from planar import Pose2

KITCHEN, HALL = Pose2(2.0, 3.0), Pose2(2.0, 0.3)
MISSION = """\
places:
  kitchen: {x: 2.0, y: 3.0}
  hall: {x: 2.0, y: 0.3}
settings: {pickup_seconds: 4.0, dropoff_seconds: 4.0, retry_seconds: 0.5}
deliveries:
  - {name: cup, object: cup, from: kitchen, to: hall}
"""
# Slow enough to interfere in a stage of four simulated seconds.
SPEED, RUN_TIMEOUT, WALL_DEADLINE = "5", "120", 150.0
STAGES = (
    DeliveryStage.FETCHING,
    DeliveryStage.PICKING_UP,
    DeliveryStage.CARRYING,
    DeliveryStage.SETTING_DOWN,
)
# Distance beyond the tolerance within which a verdict is not called false, as states arrive between two
# true poses [m].
MARGIN = 0.02
TRUTH_HISTORY = 100
PUSH_SECONDS, MESSAGE_SECONDS = 1.0, 0.05
MODEL = "mobile_base"


@dataclass
class Track:
    """What was truly done.

    Attributes:
        recent: Latest true poses with their times [s]; a reset makes time jump back.
        stage: Latest stage of the delivery.
        pickup_error: True distance from the place when the object was last picked up [m].
        dropoff_error: True distance from the place when it was set down [m].
    """

    recent: Deque[Tuple[float, Pose2]] = field(default_factory=lambda: deque(maxlen=TRUTH_HISTORY))
    stage: Optional[DeliveryStage] = None
    pickup_error: Optional[float] = None
    dropoff_error: Optional[float] = None

    def add_stage(self, stamp: float, stage: DeliveryStage) -> None:
        """Add a stage of the delivery, published at a time [s]."""
        if stage is not self.stage and self.recent:
            truth = min(self.recent, key=lambda each: abs(each[0] - stamp))[1]
            if stage is DeliveryStage.CARRYING and self.stage is DeliveryStage.PICKING_UP:
                self.pickup_error = truth.distance_to(KITCHEN)
            elif stage is DeliveryStage.DELIVERED:
                self.dropoff_error = truth.distance_to(HALL)
        self.stage = stage


@dataclass(frozen=True)
class DisturbedRun:
    """Outcome of a run and what was true."""

    kind: str
    stage: str
    seed: int
    success: bool
    reason: str
    touched: bool
    errors: Tuple[Optional[float], Optional[float]]

    @property
    def is_false(self) -> bool:
        """Whether the verdict contradicts ground truth."""
        if self.success:
            return any(error is None or error > ARRIVAL_TOLERANCE + MARGIN for error in self.errors)
        done = all(error is not None and error < ARRIVAL_TOLERANCE - MARGIN for error in self.errors)
        return done and not self.touched

    def __str__(self) -> str:
        errors = " ".join("   --" if error is None else f"{error:5.2f}" for error in self.errors)
        verdict = ("FALSE " if self.is_false else "") + ("SUCCESS" if self.success else "FAILURE")
        return f"{self.seed:4}  {self.kind:16} {self.stage:12} {errors}  {verdict}: {self.reason}"


def call(service: str) -> Callable[[Pose2], None]:
    """Return a function that calls a service of Gazebo without arguments."""

    def interfere(truth: Pose2) -> None:
        import rospy
        from std_srvs.srv import Empty

        rospy.ServiceProxy(f"/gazebo/{service}", Empty)()

    return interfere


def move_model(truth: Pose2) -> None:
    import rospy
    from gazebo_msgs.msg import ModelState
    from gazebo_msgs.srv import SetModelState

    state = ModelState(model_name=MODEL)
    state.pose.orientation.w = 1.0
    rospy.ServiceProxy("/gazebo/set_model_state", SetModelState)(state)


def drive(topic: str, v: float, omega: float) -> Callable[[Pose2], None]:
    """Return a function that publishes a velocity for a while."""

    def interfere(truth: Pose2) -> None:
        import rospy
        from geometry_msgs.msg import Twist

        publisher = rospy.Publisher(topic, Twist, queue_size=1)
        command, end = Twist(), time.monotonic() + PUSH_SECONDS
        command.linear.x, command.angular.z = v, omega
        while time.monotonic() < end:
            publisher.publish(command)
            time.sleep(MESSAGE_SECONDS)

    return interfere


def publish(topic: str, message_of: Callable[[Pose2], Any]) -> Callable[[Pose2], None]:
    """Return a function that publishes one message, made of the robot's true pose."""

    def interfere(truth: Pose2) -> None:
        import rospy

        message = message_of(truth)
        publisher, end = rospy.Publisher(topic, type(message), queue_size=1), time.monotonic() + PUSH_SECONDS
        while not publisher.get_num_connections() and time.monotonic() < end:
            time.sleep(0.01)
        publisher.publish(message)
        time.sleep(MESSAGE_SECONDS)

    return interfere


def estimate_at(shift: float) -> Callable[[Pose2], Any]:
    """Return a function that makes an initial pose beside the true one."""

    def message_of(truth: Pose2) -> Any:
        from geometry_msgs.msg import PoseWithCovarianceStamped

        message = PoseWithCovarianceStamped()
        message.header.frame_id = "map"
        message.pose.pose.position.x, message.pose.pose.position.y = truth.x + shift, truth.y
        message.pose.pose.orientation.w = 1.0
        message.pose.covariance[0] = message.pose.covariance[7] = 0.25
        message.pose.covariance[35] = 0.07
        return message

    return message_of


def goal_at_start(truth: Pose2) -> Any:
    from geometry_msgs.msg import PoseStamped

    message = PoseStamped()
    message.header.frame_id = "map"
    message.pose.orientation.w = 1.0
    return message


def cancel_all(truth: Pose2) -> Any:
    from actionlib_msgs.msg import GoalID

    return GoalID()


KINDS: Dict[str, Callable[[Pose2], None]] = {
    "reset_simulation": call("reset_simulation"),
    "reset_world": call("reset_world"),
    "set_model_state": move_model,
    "backward": drive("mobile_base/commands/velocity", -0.4, 0.0),
    "spin": drive("mobile_base/commands/velocity", 0.0, 1.5),
    "teleop": drive("cmd_vel_mux/input/teleop", 0.3, 0.5),
    "wrong_pose": publish("initialpose", estimate_at(-1.5)),
    "right_pose": publish("initialpose", estimate_at(0.05)),
    "goal": publish("move_base_simple/goal", goal_at_start),
    "cancel": publish("move_base/cancel", cancel_all),
}


def disturbed_run(kind: str, stage: DeliveryStage, seed: int) -> DisturbedRun:
    """Run in a separate process, because rospy connects to one master."""
    import rospy
    from home_service_msgs.msg import MissionState
    from nav_msgs.msg import Odometry

    from planar_ros.messages.conversion import pose2_from_msg

    leftovers, track = Leftovers(), Track()
    with tempfile.TemporaryDirectory() as folder:
        mission = Path(folder) / "mission.yaml"
        mission.write_text(MISSION, encoding="utf-8")
        options = ("--mission", str(mission), "--speed", SPEED, "--seed", str(seed), "--timeout", RUN_TIMEOUT)
        graph = Graph(leftovers, "home_service.sh", *options)
        graph.wait_for("(driving to)")
        run_folder = next((Path(leftovers.environment["TMPDIR"]) / RUNS).iterdir())
        join_graph(run_folder)

        def on_truth(message: Any) -> None:
            track.recent.append((message.header.stamp.to_sec(), pose2_from_msg(message.pose.pose)))

        def on_mission(message: Any) -> None:
            for delivery in message.deliveries:
                track.add_stage(message.header.stamp.to_sec(), DeliveryStage(delivery.state))

        rospy.Subscriber("base_pose_ground_truth", Odometry, on_truth)
        rospy.Subscriber("pick_objects/mission_state", MissionState, on_mission)
        deadline = time.monotonic() + WALL_DEADLINE
        while not (track.stage is stage and track.recent) and time.monotonic() < deadline:
            if graph.process.poll() is not None:
                break
            time.sleep(0.01)
        KINDS[kind](track.recent[-1][1])
        wait_for_end(graph)
        result = json.loads((run_folder / "result.json").read_text(encoding="utf-8"))
    errors = track.pickup_error, track.dropoff_error
    touched = bool(result.get("collisions"))
    return DisturbedRun(kind, stage.name.lower(), seed, result["success"], result["reason"], touched, errors)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=100, help="default: 100")
    parser.add_argument("--seed", type=int, default=0, help="seed of the first run (default: 0)")
    parser.add_argument("--busy", type=int, default=0, help="busy loops beside the runs (default: 0)")
    parser.add_argument("--only", nargs="+", default=list(KINDS), choices=list(KINDS), metavar="KIND")
    options = parser.parse_args()
    cases = itertools.cycle(itertools.product(options.only, STAGES))
    results: List[DisturbedRun] = []
    print("seed  interference     stage        error at pick-up, set-down [m]  verdict")
    with busy_loops(options.busy):
        for seed in range(options.seed, options.seed + options.runs):
            with multiprocessing.Pool(1) as pool:
                results.append(pool.apply(disturbed_run, (*next(cases), seed)))
            print(results[-1], flush=True)
    false = sum(result.is_false for result in results)
    successes = sum(result.success for result in results)
    print(f"{false} of {len(results)} verdicts are false; {successes} runs succeeded")
    return 1 if false else 0


if __name__ == "__main__":
    sys.exit(main())
