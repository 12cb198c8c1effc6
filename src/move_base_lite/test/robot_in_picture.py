"""A kinematic robot with a laser in simple rooms, for tests."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from move_base_lite import NavigatorInputs, RobotState, Status, load_settings
from move_base_lite.costmap import observation_from_scan
from planar import OCCUPIED, OccupancyGrid, Pose2, Scan, Twist2, wrap
from planar.geometry.ray_casting import cast_rays

PRESET = Path(__file__).parents[1] / "config" / "turtlebot.yaml"
SETTINGS = load_settings(PRESET)
BODY_RADIUS = 0.178
PERIOD = 0.1
PERSON_RADIUS = 0.2


def room(width, height):
    """An empty room with walls; width and height in metres."""
    cells = np.zeros((round(height / 0.05), round(width / 0.05)), dtype=np.int8)
    cells[:2], cells[-2:], cells[:, :2], cells[:, -2:] = (OCCUPIED,) * 4
    return OccupancyGrid(cells, 0.05)


def with_block(grid, x_min, y_min, x_max, y_max, value=OCCUPIED):
    cells = grid.cells.copy()
    rows, cols = (
        slice(round(y_min / 0.05), round(y_max / 0.05)),
        slice(round(x_min / 0.05), round(x_max / 0.05)),
    )
    cells[rows, cols] = value
    return replace(grid, cells=cells)


def two_rooms(door):
    """Two rooms of 3 m by 4 m, side by side, with a door of width ``door`` [m] between them."""
    return with_block(
        with_block(room(6.1, 4.0), 3.0, 0.0, 3.1, 4.0), 3.0, 2.0 - door / 2, 3.1, 2.0 + door / 2, 0
    )


class Robot:
    """A unicycle with limited acceleration, a rotated odometry frame and a laser of 180 beams."""

    ODOM_IN_MAP = Pose2(0.4, -0.3, 0.8)

    def __init__(self, true_grid, pose):
        self.grid, self.pose, self.twist, self.now, self.clearance = true_grid, pose, Twist2(), 0.0, math.inf
        self.has_laser = True
        self.turns_too_fast_by = 1.0
        self.turn_acceleration = 5.0

    def scan(self):
        angles = 2.0 * math.pi / 180 * np.arange(180)
        ranges = cast_rays(self.grid, self.pose, angles, 8.0)
        return Scan(self.now, 0.0, 2.0 * math.pi / 180, np.where(ranges >= 8.0, np.inf, ranges), 0.1, 8.0)

    def tick(self, navigator):
        state = RobotState(self.now, self.pose, self.ODOM_IN_MAP.inverse() @ self.pose, self.twist)
        topic = navigator.settings.scan_topic
        observations = [observation_from_scan(topic, self.scan())] if self.has_laser else []
        decision = navigator.tick(state, NavigatorInputs(observations))
        self.drive(decision.command or Twist2())
        return decision

    def drive(self, command):
        self.now += PERIOD
        v = self.twist.v + np.clip(command.v - self.twist.v, -0.2, 0.2)
        change, target = self.turn_acceleration * PERIOD, self.turns_too_fast_by * command.omega
        omega = self.twist.omega + np.clip(target - self.twist.omega, -change, change)
        self.twist = Twist2(float(v), float(omega))
        angle = self.twist.omega * PERIOD
        self.pose = self.pose @ Pose2(
            v * PERIOD * math.cos(angle / 2), v * PERIOD * math.sin(angle / 2), angle
        )
        obstacles_xy = self.grid.points_of(np.argwhere(self.grid.cells == OCCUPIED))
        gaps = np.maximum(np.abs(obstacles_xy - (self.pose.x, self.pose.y)) - self.grid.resolution / 2, 0.0)
        self.clearance = min(self.clearance, float(np.hypot(*gaps.T).min()) - BODY_RADIUS)


def scan_with_people(grid, base, stamp, people_xy, rng, radius=PERSON_RADIUS):
    """A scan of 360 beams with 1 cm of noise in a room with people (cylinders)."""
    beams, reach = 360, 8.0
    angles = 2.0 * math.pi / beams * np.arange(beams)
    ranges = cast_rays(grid, base, angles, reach)
    directions = np.column_stack((np.cos(angles + base.yaw), np.sin(angles + base.yaw)))
    for person_xy in people_xy:
        offset = np.array(person_xy) - (base.x, base.y)
        along = directions @ offset
        inside = radius**2 - (offset @ offset - along**2)
        hit = (inside > 0.0) & (along > 0.0)
        ranges[hit] = np.minimum(ranges[hit], along[hit] - np.sqrt(inside[hit]))
    ranges = np.where(ranges >= reach, np.inf, ranges + rng.normal(0.0, 0.01, beams))
    return Scan(stamp, 0.0, 2.0 * math.pi / beams, ranges, 0.1, reach)


def drive_to_end(robot, navigator, seconds=90.0):
    """All decisions until the goal ends."""
    decisions = []
    while robot.now < seconds:
        decisions.append(robot.tick(navigator))
        if decisions[-1].status.is_final:
            return decisions
    raise AssertionError(f"the goal did not end within {seconds} s: {decisions[-1]}")


def assert_arrived(robot, decisions, goal):
    assert decisions[-1].status is Status.SUCCEEDED, decisions[-1].text
    assert decisions[-1].text == "Goal reached."
    assert decisions[-1].command == Twist2()
    assert robot.pose.distance_to(goal) <= SETTINGS.controller.xy_goal_tolerance + 0.05
    assert abs(wrap(robot.pose.yaw - goal.yaw)) <= SETTINGS.controller.yaw_goal_tolerance + 0.05
    assert robot.clearance > 0.0
