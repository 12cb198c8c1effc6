"""A goal in the odometry frame, without a map, as in BARN and DynaBARN."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any, Mapping, Optional, Sequence, Tuple

import numpy as np

from evaluation.verdict import collision
from headless_mission import NAVIGATION_CONFIG, EpisodeConditions
from headless_mission.navigation import NavigationHooks
from headless_mission.observers import ContactObserver
from laboratory.tasks.task import COLLISION, FAILURE, SUCCESS, TIMEOUT, RunConditions, RunTrace
from laboratory.worlds.barn import score
from laboratory.worlds.source import Arena
from move_base_lite import Status
from planar import Pose2, SettingsError
from planar.config.yaml_table import Table
from planar.maps.places import parse_pose
from sim_bridge import Episode, EpisodeHooks, Simulation, StepResult, robot_named
from sim_bridge.faults import FaultInjector


@dataclass(frozen=True)
class OdomGoalTask:
    """Reach a goal without a map.

    Attributes:
        goal: Goal pose in the frame of the start pose.
        radius: Distance to the goal at which it counts as reached [m].
    """

    goal: Pose2
    radius: float = 1.0

    def run(self, scenario: RunConditions, arena: Arena, seed: int) -> RunTrace:
        conditions = EpisodeConditions(scenario.planner, scenario.parameters)
        settings = conditions.navigation(navigation_config(scenario.robot))
        faults = FaultInjector(scenario.faults, seed)
        robot, start = robot_named(scenario.robot), scenario.start
        simulation = Simulation(arena.world, robot, scenario.simulation, seed, start, faults.wrappers)
        drive = OdomGoalDrive(simulation, NavigationHooks(settings), self, start, faults)
        try:
            outcome, reason = drive.run(scenario.seconds)
        finally:
            simulation.close()
        track, collisions = np.array(drive.observer.trajectory), sorted(set(drive.observer.collisions))
        benchmark_score = None
        if arena.reference_length is not None:
            benchmark_score = (
                score(float(track[-1, 0]), arena.reference_length) if outcome == SUCCESS else 0.0
            )
        return RunTrace(
            outcome,
            reason,
            track,
            np.zeros(0),
            collisions,
            arena.reference_length,
            benchmark_score,
            drive.observer.contacts.track,
            drive.observer.contacts.people_at_fault,
        )

    def required_poses(self, arena: Arena) -> Sequence[Pose2]:
        return ()

    def reference_length(self, scenario: RunConditions, arena: Arena) -> Optional[float]:
        return arena.reference_length

    def files(self) -> Tuple[Path, ...]:
        return ()

    def launch_files(self, arena: Arena, seed: int, folder: Path) -> Mapping[str, Any]:
        raise SettingsError("the task reach runs in one process only, not over ROS")


class OdomGoalDrive(EpisodeHooks):
    """One run: it ends at the goal, at the first collision, or when navigation fails.

    Args:
        simulation: Simulation of the robot.
        navigation: move_base in the episode.
        task: The goal.
        start: Start pose in the world.
        faults: Faults of the run.

    Attributes:
        observer: Collisions and true poses, from the first scan on.
        start_stamp: Simulated time at which the goal was sent [s].
    """

    def __init__(
        self,
        simulation: Simulation,
        navigation: NavigationHooks,
        task: OdomGoalTask,
        start: Pose2,
        faults: Optional[FaultInjector] = None,
    ):
        self.observer, self._navigation = ContactObserver(simulation), navigation
        hooks = self.observer, self, navigation
        self._episode = Episode(simulation, navigation.period, faults=faults, hooks=hooks)
        self._task, self._goal = task, start @ task.goal
        self.start_stamp = 0.0
        self._end: Optional[Tuple[str, str]] = None

    def run(self, seconds: float) -> Tuple[str, str]:
        """Drive to the goal; return outcome and reason. The time limit [s] starts with the goal."""
        step = self._episode.step()
        while step.scan is None:
            step = self._episode.step()
        self.start_stamp = step.stamp
        self.observer.record(0.0, step.base_in_world)
        self._navigation.move_base.set_goal(self._task.goal)
        self._navigation.at_tick(self._episode, step)
        while self._end is None:
            decision = self._navigation.result.decision
            if decision.status.is_final and decision.status is not Status.SUCCEEDED:
                return FAILURE, decision.text
            stamp = self._episode.advance().stamp
            if self._end is None and stamp - self.start_stamp >= seconds:
                return TIMEOUT, f"not done within {seconds:g} simulated seconds"
        return self._end

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        """Record and judge a control period; its hooks precede those of navigation."""
        truth = step.base_in_world
        self.observer.record(step.stamp - self.start_stamp, truth)
        cause = collision(sorted(set(self.observer.collisions)))
        if cause:
            self._end = COLLISION, f"{cause} at {truth.x:.2f}, {truth.y:.2f}"
        elif truth.distance_to(self._goal) <= self._task.radius:
            self._end = SUCCESS, "reached the goal"


def navigation_config(robot: str) -> Path:
    """Return the move_base parameter file of a robot; the TurtleBot's if it has none."""
    config = NAVIGATION_CONFIG.with_name(f"{robot}.yaml")
    return config if config.exists() else NAVIGATION_CONFIG


def read_reach(table: Table, folder: Path) -> OdomGoalTask:
    """Read ``reach``: x, y and radius in the frame of the start pose."""
    table.allow_only("reach")
    goal = table.table("reach")
    goal.allow_only("x", "y", "yaw", "radius")
    radius = goal.number("radius", OdomGoalTask.radius)
    goal.check(radius > 0.0, "radius", "positive")
    return OdomGoalTask(parse_pose(goal), radius)
