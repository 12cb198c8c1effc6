"""Map of a run with trajectories, goals and objects, as SVG in metres."""

import math
from html import escape
from typing import List, Sequence, Tuple

import numpy as np

from planar import OccupancyGrid
from run_report.grid_image import data_uri, grid_image, view_of
from run_report.record import RunRecord

MAX_POINTS = 1500
WALL, FREE, UNKNOWN = (38, 42, 51, 255), (0, 0, 0, 0), (128, 134, 148, 70)


def map_svg(record: RunRecord, above: str = "") -> str:
    """Return an SVG element of class ``map``; y coordinates are negated, so that y points up.

    Args:
        record: Record of the run.
        above: SVG drawn on top.
    """
    points_xy = np.concatenate([record.truth[:, 1:3], record.estimate[:, 1:3], _zone_corners(record)])
    grid = record.grid or OccupancyGrid(np.full((1, 1), -1, dtype=np.int8), 0.05)
    x_min, y_min, x_max, y_max = view_of(grid, points_xy)
    unit = (x_max - x_min) / 100.0
    layers = [
        _map_image(grid) if record.grid else "",
        *(_path(plan, "plan") for plan in record.plans),
        *_zones(record, unit),
        _path(record.odometry[:, 1:3], "odometry"),
        _path(record.truth[:, 1:3], "truth"),
        _path(record.estimate[:, 1:3], "estimate"),
        *_goals(record, unit),
        *_collisions(record, unit),
        _robot(record, unit),
        *_objects(record, unit),
        above,
    ]
    view = f"{x_min:.3f} {-y_max:.3f} {x_max - x_min:.3f} {y_max - y_min:.3f}"
    style = f"font-size:{2.6 * unit:.3f}px"
    drawn = "".join(layers)
    return f'<svg class="map" viewBox="{view}" style="{style}" role="img" aria-label="Map">{drawn}</svg>'


def thinned(rows: np.ndarray, most: int = MAX_POINTS) -> np.ndarray:
    """Return at most ``most`` rows, evenly spaced, including the first and the last."""
    if len(rows) <= most:
        return rows
    return rows[np.linspace(0, len(rows) - 1, most).round().astype(int)]


def _zone_corners(record: RunRecord) -> np.ndarray:
    corners = [
        (zone.x + sign * zone.radius, zone.y + sign * zone.radius)
        for zone in record.zones
        for sign in (-1, 1)
    ]
    return np.array(corners).reshape(-1, 2)


def _map_image(grid: OccupancyGrid) -> str:
    width, height = grid.cols * grid.resolution, grid.rows * grid.resolution
    origin = grid.origin
    turn = f"translate({origin.x:.4f} {-origin.y:.4f}) rotate({-math.degrees(origin.yaw):.3f})"
    return (
        f'<image class="walls" transform="{turn}" y="{-height:.4f}" width="{width:.4f}" '
        f'height="{height:.4f}" href="{data_uri(grid_image(grid, WALL, FREE, UNKNOWN))}"/>'
    )


def _path(points_xy: np.ndarray, kind: str) -> str:
    if len(points_xy) < 2:
        return ""
    points = " ".join(f"{x:.3f},{-y:.3f}" for x, y in thinned(points_xy))
    return f'<polyline class="path {kind}" points="{points}"/>'


def _zones(record: RunRecord, unit: float) -> List[str]:
    return [
        f'<g class="zone"><circle cx="{zone.x:.3f}" cy="{-zone.y:.3f}" r="{zone.radius:.3f}"/>'
        f'<text x="{zone.x:.3f}" y="{-(zone.y + zone.radius) - unit:.3f}">{escape(zone.name)}</text></g>'
        for zone in record.zones
    ]


def _goals(record: RunRecord, unit: float) -> List[str]:
    return [
        _arrow("goal", goal.x, goal.y, goal.yaw, 2.2 * unit, f"goal {number}")
        for number, goal in enumerate(record.goals, 1)
    ]


def _arrow(kind: str, x: float, y: float, yaw: float, size: float, title: str) -> str:
    shape = _polygon([(1.0, 0.0), (-0.6, 0.6), (-0.25, 0.0), (-0.6, -0.6)], size)
    place = f"translate({x:.3f} {-y:.3f}) rotate({-math.degrees(yaw):.2f})"
    return (
        f'<g class="{kind}" transform="{place}"><title>{escape(title)}</title><polygon points="{shape}"/></g>'
    )


def _polygon(corners: Sequence[Tuple[float, float]], size: float) -> str:
    return " ".join(f"{x * size:.3f},{y * size:.3f}" for x, y in corners)


def _collisions(record: RunRecord, unit: float) -> List[str]:
    marks = []
    cross = f"M{-unit:.3f} {-unit:.3f}L{unit:.3f} {unit:.3f}M{-unit:.3f} {unit:.3f}L{unit:.3f} {-unit:.3f}"
    for collision in record.collisions:
        if len(record.truth):
            row = record.truth[np.argmin(np.abs(record.truth[:, 0] - collision.stamp))]
            x, y = row[1], -row[2]
            marks.append(
                f'<g class="collision" transform="translate({x:.3f} {y:.3f})">'
                f"<title>{escape(collision.name)} at {collision.stamp:.1f} s</title>"
                f'<path d="{cross}"/></g>'
            )
    return marks


def _robot(record: RunRecord, unit: float) -> str:
    """Return the robot at its last pose; the script moves it."""
    if not len(record.truth):
        return ""
    _, x, y, yaw = record.truth[-1]
    return _arrow("robot", x, y, yaw, 2.6 * unit, "robot")


def _objects(record: RunRecord, unit: float) -> List[str]:
    """Return every object that was shown by a marker at its last pose; the script moves them."""
    latest = {marking.name: marking for marking in record.markings}
    return [
        f'<rect class="object" data-name="{escape(marking.name)}" x="{-unit:.3f}" y="{-unit:.3f}" '
        f'width="{2 * unit:.3f}" height="{2 * unit:.3f}" rx="{unit / 3:.3f}" '
        f'transform="translate({marking.x:.3f} {-marking.y:.3f})" '
        f'visibility="{"visible" if marking.is_shown else "hidden"}"/>'
        for marking in latest.values()
    ]
