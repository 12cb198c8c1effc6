"""The animation of a docking: dock, field, robot and estimate from above."""

import math
from pathlib import Path
from typing import List, Tuple

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from auto_docking_lite import DockController
from headless_mission.docking import DockingHooks
from planar import Pose2
from planar.geometry.dock_field import ROBOT_FRONT, DockField
from run_report.picture import save_animation
from sim_bridge import Episode, EpisodeHooks, Simulation, StepResult
from sim_bridge.docks import with_dock
from sim_bridge.geometry.shapes import Plane
from sim_bridge.simulation import box_on_floor
from sim_bridge.world import Body, Collision, World

SCALE, SIZE, ORIGIN = 190, (620, 480), (70, 250)
START = Pose2(2.2, 1.0, 1.2)
BOX = Pose2(1.85, -0.15, 0.4)
# Control ticks between two frames.
TICKS = 4
FONT = ImageFont.load_default()


def save_docking(path: Path) -> None:
    """Write the animation, or as a PNG file the frame at two thirds of it."""
    frames = _frames()
    if path.suffix == ".gif":
        save_animation(path, frames, seconds=9.0)
    else:
        frames[2 * len(frames) // 3].save(path)


def _frames() -> List[Image.Image]:
    floor = Body("floor::link", np.eye(4), (Collision(Plane(), np.eye(4)),))
    wall = box_on_floor("wall", (0.1, 4.0, 1.0), Pose2(-0.13, 0.0))
    box = box_on_floor("box", (0.3, 0.3, 0.5), BOX)
    simulation = Simulation(
        with_dock(World("room", (floor, wall, box)), Pose2()), base_in_world=START, seed=1
    )
    controller, frames, trail = DockController(), [], []
    hooks = DockingHooks(controller)

    class Camera(EpisodeHooks):
        number = 0

        def at_tick(self, episode: Episode, step: StepResult) -> None:
            self.number += 1
            trail.append(_pixel(step.base_in_world))
            if self.number % TICKS and hooks.decision.result is None:
                return
            estimate = controller.estimate()
            dock = None if estimate is None else START @ estimate.dock_in_odom
            frames.append(_frame(step, hooks, dock, trail))

    episode = Episode(simulation, 0.1, 0.1, hooks=(hooks, Camera()))
    controller.start(0.0)
    episode.run(lambda: hooks.decision.result is not None)
    simulation.close()
    return frames


def _pixel(pose: Pose2) -> Tuple[float, float]:
    return ORIGIN[0] + SCALE * pose.x, ORIGIN[1] - SCALE * pose.y


def _frame(step: StepResult, hooks: DockingHooks, dock, trail) -> Image.Image:
    image = Image.new("RGB", SIZE, "white")
    draw = ImageDraw.Draw(image)
    _draw_field(draw, DockField())
    x, y = _pixel(Pose2())
    draw.rectangle((x - 0.18 * SCALE, 0, x - 0.08 * SCALE, SIZE[1]), fill="#707070")
    draw.rectangle((x - 0.07 * SCALE, y - 0.11 * SCALE, x, y + 0.11 * SCALE), fill="#202020")
    corners = [BOX @ Pose2(a, b) for a, b in ((-0.15, -0.15), (0.15, -0.15), (0.15, 0.15), (-0.15, 0.15))]
    draw.polygon([_pixel(corner) for corner in corners], fill="#a08050")
    if len(trail) > 1:
        draw.line(trail, fill="#3070c0", width=2)
    if dock is not None:
        at, ahead = _pixel(dock), _pixel(dock @ Pose2(0.25))
        draw.ellipse((at[0] - 5, at[1] - 5, at[0] + 5, at[1] + 5), outline="#d02020", width=2)
        draw.line((at, ahead), fill="#d02020", width=2)
    base = step.base_in_world
    (x, y), radius = _pixel(base), ROBOT_FRONT * SCALE
    draw.ellipse((x - radius, y - radius, x + radius, y + radius), fill="#303848", outline="black")
    draw.line((_pixel(base), _pixel(base @ Pose2(ROBOT_FRONT))), fill="#ffd040", width=4)
    power, decision = step.power, hooks.decision
    charging = "charging" if power and step.kobuki and step.kobuki.power.charger else "discharging"
    lines = (f"{step.stamp:5.1f} s  {decision.state.value}", decision.text, charging)
    draw.multiline_text((330, 400), "\n".join(lines), fill="black", font=FONT)
    return image


def _draw_field(draw: ImageDraw.ImageDraw, field: DockField) -> None:
    """Draw the fans: right, left and centre, far and near."""
    inner, outer = field.dock_centre_half_angle, field.dock_side_half_angle
    fans = (
        (inner, outer, "#e8f4e8", "#d4ecd4"),
        (-outer, -inner, "#f4ece4", "#ecdccc"),
        (-inner, inner, "#fff4b0", "#ffe880"),
    )
    for first, last, far, near in fans:
        for distance, colour in ((field.dock_far_range, far), (field.dock_near_range, near)):
            rim = [first + (last - first) * number / 20 for number in range(21)]
            points = [Pose2(distance * math.cos(angle), distance * math.sin(angle)) for angle in rim]
            draw.polygon([_pixel(Pose2()), *map(_pixel, points)], fill=colour)
