"""Pictures of an episode from above."""

from dataclasses import replace
from typing import List, Tuple

import numpy as np
from PIL import Image, ImageDraw

from home_service_gym.playground import Moment, Playground, standing
from home_service_gym.task import Marks
from sim_bridge.views.true_map import outlines_of

# Pixels of the longer side, and metres around what there is.
SIZE, MARGIN = 480, 0.5
# Metres: the height that solids are cut at, the radii of what is drawn as a disc.
HEIGHT, ROBOT, DOT = 0.2, 0.2, 0.03
FLOOR, UNSEEN, SOLID, MOVING = (255, 255, 255), (205, 205, 205), (70, 70, 70), (210, 120, 30)
GOAL, BEAMS, BODY, NOSE = (60, 170, 80), (220, 60, 60), (50, 90, 200), (255, 255, 255)


class Picture:
    """Of one playground; what keeps still is drawn once."""

    def __init__(self, playground: Playground):
        self.playground = playground
        world = playground.arena.world
        still = [body for body in world.bodies if body.is_static]
        outlines = outlines_of(replace(world, bodies=tuple(still)), HEIGHT, HEIGHT)
        start = playground.start
        corners = np.vstack([*outlines, [(start.x, start.y)]])
        self._low, high = corners.min(axis=0) - MARGIN, corners.max(axis=0) + MARGIN
        self._scale = SIZE / float((high - self._low).max())
        width, height = (int(round(float(side) * self._scale)) for side in high - self._low)
        self._still = Image.new("RGB", (width, height), FLOOR)
        pen = ImageDraw.Draw(self._still)
        for outline in outlines:
            if len(outline) > 2:
                pen.polygon(self._pixels(outline), fill=SOLID)
        self._sizes = {
            body.name: float(np.ptp(outline, axis=0).max()) / 2.0
            for body in world.bodies
            if not body.is_static
            for outline in outlines_of(standing(world, body), HEIGHT, HEIGHT)
        }

    def draw(self, moment: Moment, marks: Marks) -> np.ndarray:
        """(H, W, 3), uint8; y upwards."""
        image = self._still.copy()
        if marks.known is not None:
            self._hide_unknown(image, marks.known)
        pen, base = ImageDraw.Draw(image), moment.base_in_world
        if marks.goal is not None:
            goal, radius = marks.goal
            self._disc(pen, (goal.x, goal.y), radius, GOAL)
        for course in marks.trajectories:
            self._disc(pen, course.at(moment.stamp), self._sizes.get(course.link, ROBOT), MOVING)
        for x, y, _, _, radius in moment.people.tolist():
            self._disc(pen, (x, y), radius, MOVING)
        for point in base.transform_points(moment.scan.hit_points_in_base()):
            self._disc(pen, (point[0], point[1]), DOT, BEAMS)
        self._disc(pen, (base.x, base.y), ROBOT, BODY)
        nose = base.transform_points(np.array([[0.0, 0.0], [ROBOT, 0.0]]))
        pen.line(self._pixels(nose), fill=NOSE, width=2)
        return np.asarray(image)

    def _pixels(self, points_xy: np.ndarray) -> List[Tuple[float, float]]:
        return [
            ((x - self._low[0]) * self._scale, self._still.height - (y - self._low[1]) * self._scale)
            for x, y in points_xy.tolist()
        ]

    def _disc(self, pen: ImageDraw.ImageDraw, at: Tuple[float, float], radius: float, colour) -> None:
        ((x, y),) = self._pixels(np.array([at]))
        size = max(radius * self._scale, 1.0)
        pen.ellipse((x - size, y - size, x + size, y + size), fill=colour)

    def _hide_unknown(self, image: Image.Image, known: np.ndarray) -> None:
        """Greys what has not been seen."""
        grid = self.playground.ground.grid
        side = grid.resolution * self._scale
        size = (round(known.shape[1] * side), round(known.shape[0] * side))
        mask = Image.fromarray(np.where(known[::-1], 0, 255).astype(np.uint8)).resize(size)
        ((x, y),) = self._pixels(np.array([(grid.origin.x, grid.origin.y)]))
        image.paste(UNSEEN, (round(x), round(y) - size[1]), mask)
