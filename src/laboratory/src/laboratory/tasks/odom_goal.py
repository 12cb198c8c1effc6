"""A goal in the odometry frame, without a map, as in BARN and DynaBARN."""

from dataclasses import dataclass
from pathlib import Path
from typing import Mapping, Optional, Sequence, Set, Tuple

import numpy as np

from evaluation.pedestrian_contacts import PedestrianContacts
from evaluation.verdict import collision
from headless_mission import NAVIGATION_CONFIG, EpisodeConditions
from laboratory.tasks.task import COLLISION, FAILURE, SUCCESS, TIMEOUT, RunConditions, RunTrace
from laboratory.worlds.barn import score
from laboratory.worlds.source import Arena
from move_base_lite import Navigator, Status
from planar import Pose2, Scan, SettingsError, Twist2
from planar.config.yaml_table import Table
from planar.maps.places import parse_pose
from sim_bridge import Simulation, StepResult, robot_named
from sim_bridge.faults import FaultContext, FaultInjector
from sim_bridge.simulation import ROBOT_NAME


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
        drive = _GoalDrive(scenario, arena, seed, self)
        try:
            outcome, reason = drive.run(scenario.seconds)
        finally:
            drive.close()
        track, collisions = np.array(drive.trajectory), sorted(drive.collisions)
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
            drive.pedestrians.track,
            drive.pedestrians.people_at_fault,
        )

    def required_poses(self, arena: Arena) -> Sequence[Pose2]:
        return ()

    def reference_length(self, scenario: RunConditions, arena: Arena) -> Optional[float]:
        return arena.reference_length

    def files(self) -> Tuple[Path, ...]:
        return ()

    def launch_files(self, arena: Arena, seed: int, folder: Path) -> Mapping[str, Path]:
        raise SettingsError("the task reach runs in one process only, not over ROS")


class _GoalDrive:
    """One run: it ends at the goal, at the first collision, or when navigation fails."""

    def __init__(self, scenario: RunConditions, arena: Arena, seed: int, task: OdomGoalTask):
        settings = EpisodeConditions(scenario.planner, scenario.parameters).navigation(
            navigation_config(scenario.robot)
        )
        self._navigator = Navigator(settings)
        self._faults = FaultInjector(scenario.faults, seed)
        self._simulation = Simulation(
            arena.world,
            robot_named(scenario.robot),
            scenario.simulation,
            seed,
            scenario.start,
            self._faults.wrappers,
        )
        self.pedestrians = PedestrianContacts(self._simulation)
        self._steps = round(1.0 / settings.move_base.controller_frequency / self._simulation.step_seconds)
        self._task, self._goal = task, scenario.start @ task.goal
        self.trajectory: list = []
        self.collisions: Set[str] = set()

    def run(self, seconds: float) -> Tuple[str, str]:
        """Drive to the goal; return outcome and reason. The time limit [s] starts with the goal."""
        observation = self._first_scan()
        scan = observation.scan
        start_stamp = observation.stamp
        self._navigator.set_goal(self._task.goal)
        while observation.stamp - start_stamp < seconds:
            base_in_odom = observation.odometry.base_in_odom
            decision = self._navigator.tick(
                observation.stamp, base_in_odom, base_in_odom, observation.odometry.twist, scan
            )
            if decision.status.is_final and decision.status is not Status.SUCCEEDED:
                return FAILURE, decision.text
            observation, scan = self._advance(decision.command)
            self._record(observation, start_stamp)
            cause = collision(sorted(self.collisions))
            if cause:
                place = observation.base_in_world
                return COLLISION, f"{cause} at {place.x:.2f}, {place.y:.2f}"
            if observation.base_in_world.distance_to(self._goal) <= self._task.radius:
                return SUCCESS, "reached the goal"
        return TIMEOUT, f"not done within {seconds:g} simulated seconds"

    def close(self) -> None:
        self._simulation.close()

    def _first_scan(self) -> StepResult:
        while True:
            observation = self._simulation.step()
            if observation.scan is not None:
                self._record(observation, observation.stamp)
                return observation

    def _advance(self, command: Optional[Twist2]) -> Tuple[StepResult, Optional[Scan]]:
        """Simulate one control period; return the last step and the scan measured during it."""
        scan = None
        for _ in range(self._steps):
            observation = self._simulation.step(command)
            command, scan = None, observation.scan or scan
            self.collisions.update(self.pedestrians.robot_collisions(observation))
            place = FaultContext(self._simulation.scene, ROBOT_NAME, observation.base_in_world)
            self._faults.update(observation.stamp, place)
        return observation, scan

    def _record(self, observation: StepResult, start_stamp: float) -> None:
        truth = observation.base_in_world
        self.trajectory.append((observation.stamp - start_stamp, truth.x, truth.y, truth.yaw))
        self.pedestrians.record()


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
