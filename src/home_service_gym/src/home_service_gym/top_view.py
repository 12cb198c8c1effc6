"""Top view images of an episode."""

from dataclasses import replace
from typing import List, Tuple

import numpy as np
from PIL import Image, ImageDraw

from home_service_gym.episode_simulation import EpisodeSimulation, EpisodeState, static_world_of
from home_service_gym.task import Overlay
from sim_bridge.views.true_map import outlines_of

# Length of the longer side [pixels], and margin around the world [m].
IMAGE_SIZE, MARGIN = 480, 0.5
# Metres: height of the cross section, radius of the robot and of scan points.
HEIGHT, ROBOT, DOT = 0.2, 0.2, 0.03
FLOOR, UNSEEN, SOLID, MOVING = (255, 255, 255), (205, 205, 205), (70, 70, 70), (210, 120, 30)
GOAL, BEAMS, BODY, HEADING_COLOUR = (60, 170, 80), (220, 60, 60), (50, 90, 200), (255, 255, 255)


class TopView:
    """Top view of one simulation; static bodies are drawn once."""

    def __init__(self, simulation: EpisodeSimulation):
        self.simulation = simulation
        world = simulation.arena.world
        static_bodies = [body for body in world.bodies if body.is_static]
        outlines = outlines_of(replace(world, bodies=tuple(static_bodies)), HEIGHT, HEIGHT)
        start = simulation.start
        corners = np.vstack([*outlines, [(start.x, start.y)]])
        self._low, high = corners.min(axis=0) - MARGIN, corners.max(axis=0) + MARGIN
        self._scale = IMAGE_SIZE / float((high - self._low).max())
        width, height = (int(round(float(side) * self._scale)) for side in high - self._low)
        self._static_image = Image.new("RGB", (width, height), FLOOR)
        pen = ImageDraw.Draw(self._static_image)
        for outline in outlines:
            if len(outline) > 2:
                pen.polygon(self._pixels(outline), fill=SOLID)
        self._sizes = {
            body.name: float(np.ptp(outline, axis=0).max()) / 2.0
            for body in world.bodies
            if not body.is_static
            for outline in outlines_of(static_world_of(world, body), HEIGHT, HEIGHT)
        }

    def draw(self, state: EpisodeState, overlay: Overlay) -> np.ndarray:
        """Return the image (H, W, 3), uint8, with y upwards."""
        image = self._static_image.copy()
        if overlay.explored is not None:
            self._hide_unknown(image, overlay.explored)
        pen, base = ImageDraw.Draw(image), state.base_in_world
        if overlay.goal is not None:
            goal, radius = overlay.goal
            self._disc(pen, (goal.x, goal.y), radius, GOAL)
        for trajectory in overlay.trajectories:
            self._disc(pen, trajectory.at(state.stamp), self._sizes.get(trajectory.link, ROBOT), MOVING)
        for x, y, _, _, radius in state.people.tolist():
            self._disc(pen, (x, y), radius, MOVING)
        for point in base.transform_points(state.scan.hit_points_in_base()):
            self._disc(pen, (point[0], point[1]), DOT, BEAMS)
        self._disc(pen, (base.x, base.y), ROBOT, BODY)
        heading_line = base.transform_points(np.array([[0.0, 0.0], [ROBOT, 0.0]]))
        pen.line(self._pixels(heading_line), fill=HEADING_COLOUR, width=2)
        return np.asarray(image)

    def _pixels(self, points_xy: np.ndarray) -> List[Tuple[float, float]]:
        return [
            ((x - self._low[0]) * self._scale, self._static_image.height - (y - self._low[1]) * self._scale)
            for x, y in points_xy.tolist()
        ]

    def _disc(self, pen: ImageDraw.ImageDraw, at: Tuple[float, float], radius: float, colour) -> None:
        ((x, y),) = self._pixels(np.array([at]))
        size = max(radius * self._scale, 1.0)
        pen.ellipse((x - size, y - size, x + size, y + size), fill=colour)

    def _hide_unknown(self, image: Image.Image, explored: np.ndarray) -> None:
        """Paint unexplored cells grey."""
        grid = self.simulation.traversable_space.grid
        side = grid.resolution * self._scale
        size = (round(explored.shape[1] * side), round(explored.shape[0] * side))
        mask = Image.fromarray(np.where(explored[::-1], 0, 255).astype(np.uint8)).resize(size)
        ((x, y),) = self._pixels(np.array([(grid.origin.x, grid.origin.y)]))
        image.paste(UNSEEN, (round(x), round(y) - size[1]), mask)
