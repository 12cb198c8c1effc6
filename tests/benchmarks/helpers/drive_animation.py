"""The end of a drive among moving obstacles as an animation: what was true, seen and intended."""

from pathlib import Path
from typing import List, NamedTuple, Sequence, Tuple

import numpy as np
from PIL import Image, ImageDraw

from helpers.timed_navigation import TimedNavigation
from laboratory.results.avoidance import TrueObstacles
from move_base_lite import NavigatorSettings
from planar import Pose2
from run_report.picture import FAINT, INK, PAPER, TRUTH, WALL, save_animation
from sim_bridge import Episode, StepResult

# Shown time [s], half side of the shown square [m], its pixels, and how much slower than in reality.
SECONDS, HALF_SIDE, PIXELS, SLOWER = 3.0, 3.5, 420, 3.0
SEEN, INTENDED = (193, 21, 22, 255), (124, 58, 237, 255)
ARROW_SECONDS = 0.5


class Moment(NamedTuple):
    """One control tick; all in the world.

    Attributes:
        stamp: Simulated time [s].
        base: True pose of the robot.
        seen: (N, 5), tracked obstacles: x, y, vx, vy, radius [m, m/s].
        intended_xy: (N, 2), predicted positions of the robot [m].
    """

    stamp: float
    base: Pose2
    seen: np.ndarray
    intended_xy: np.ndarray


class FilmedNavigation(TimedNavigation):
    """Remembers the latest ticks.

    Attributes:
        moments: The ticks of the last seconds.
    """

    def __init__(self, settings: NavigatorSettings):
        super().__init__(settings)
        self.moments: List[Moment] = []

    def at_tick(self, episode: Episode, step: StepResult) -> None:
        super().at_tick(episode, step)
        base_in_odom, intended = self.poses.base_in_odom(), self.result.decision.trajectory
        if base_in_odom is None:
            return
        odom_in_world = step.base_in_world @ base_in_odom.inverse()
        seen = np.array(self.move_base.navigator.dynamic_obstacles_at(step.stamp)).reshape(-1, 5)
        seen[:, :2] = odom_in_world.transform_points(seen[:, :2])
        seen[:, 2:4] = Pose2(0.0, 0.0, odom_in_world.yaw).transform_points(seen[:, 2:4])
        path = np.zeros((0, 2)) if intended is None else odom_in_world.transform_points(intended[:, :2])
        self.moments.append(Moment(step.stamp, step.base_in_world, seen, path))
        while self.moments[-1].stamp - self.moments[0].stamp > SECONDS:
            self.moments.pop(0)


def save_end(path: Path, moments: Sequence[Moment], obstacles: TrueObstacles, outline: Tuple[float, float]):
    """Write the animation of the last seconds as a GIF.

    Args:
        path: File.
        moments: The ticks.
        obstacles: The true obstacles.
        outline: Half length and half width of the robot [m].
    """
    centre = np.array([moments[-1].base.x, moments[-1].base.y])
    frames = [_frame(moment, moments[-1].stamp, obstacles, outline, centre) for moment in moments]
    save_animation(path, frames, SLOWER * SECONDS)


def _frame(moment: Moment, end: float, obstacles: TrueObstacles, outline, centre: np.ndarray) -> Image.Image:
    image, scale = Image.new("RGBA", (PIXELS, PIXELS), PAPER), PIXELS / (2.0 * HALF_SIDE)
    draw = ImageDraw.Draw(image)

    def pixels(points_xy):
        off = (np.asarray(points_xy) - centre) * (scale, -scale) + PIXELS / 2
        return [tuple(map(float, point)) for point in off.reshape(-1, 2)]

    def disc(x, y, radius, **colours):
        ((u, v),) = pixels((x, y))
        draw.ellipse(
            (u - radius * scale, v - radius * scale, u + radius * scale, v + radius * scale), **colours
        )

    for low_x, high_x, low_y, high_y in obstacles.boxes:
        (left, bottom), (right, top) = pixels([(low_x, low_y), (high_x, high_y)])
        draw.rectangle((left, top, right, bottom), fill=WALL)
    for trajectory, radius in obstacles.circles:
        disc(*trajectory.at(moment.stamp), radius, fill=FAINT)
    for x, y, v_x, v_y, radius in moment.seen:
        disc(x, y, radius, outline=SEEN, width=2)
        draw.line(pixels([(x, y), (x + ARROW_SECONDS * v_x, y + ARROW_SECONDS * v_y)]), fill=SEEN, width=2)
    if len(moment.intended_xy) > 1:
        draw.line(pixels(moment.intended_xy), fill=INTENDED, width=2)
    length, width = outline
    corners = np.array([(length, width), (length, -width), (-length, -width), (-length, width)])
    draw.polygon(pixels(moment.base.transform_points(corners)), fill=TRUTH)
    draw.text((8, 8), f"{moment.stamp - end:+.2f} s", fill=INK)
    return image.convert("RGB")
