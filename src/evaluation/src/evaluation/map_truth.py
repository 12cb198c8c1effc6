"""Quality of a map, by the world that it was made in."""

from typing import Optional

from evaluation.verdict import ARRIVAL_TOLERANCE, Verdict
from planar import OccupancyGrid
from planar.maps.map_score import MapScore, score_map
from sim_bridge import RobotProfile
from sim_bridge.views.true_map import true_map
from sim_bridge.world import World

LEAST_RECALL = LEAST_PRECISION = 0.95
FINE_RESOLUTION = 0.01


def score_against_world(grid: OccupancyGrid, world: World, robot: RobotProfile) -> MapScore:
    """Compare a map with what the laser could have measured of the world from where the robot can drive."""
    height = float(robot.laser.pose_in_base[2, 3])
    truth, fine_truth = (true_map(world, height, resolution) for resolution in (0.05, FINE_RESOLUTION))
    return score_map(
        grid, truth, robot_radius=robot.radius, sensor_range=robot.laser.sight, fine_truth=fine_truth
    )


def judge_map(
    score: MapScore, distance_to_start: float, failure: Optional[str], collision: Optional[str]
) -> Verdict:
    """Judge a mapping run.

    Args:
        score: Score of the map.
        distance_to_start: True distance of the robot from its start [m].
        failure: Why the run was cut short, if so.
        collision: What the robot collided with, if anything.

    Returns:
        Success if the map is good and the robot is back at its start without a collision.
    """
    is_away = distance_to_start > ARRIVAL_TOLERANCE
    failures = (
        failure,
        f"the robot truly stands {distance_to_start:.2f} m from where it started" if is_away else None,
        f"recall below {LEAST_RECALL}" if score.recall < LEAST_RECALL else None,
        f"precision below {LEAST_PRECISION}" if score.precision < LEAST_PRECISION else None,
        "walls are doubled" if score.doubled_walls > 0 else None,
        collision,
    )
    figures = (
        f"recall {score.recall:.3f}, precision {score.precision:.3f}, {score.doubled_walls} doubled walls, "
        f"back {distance_to_start:.2f} m from the start"
    )
    reasons = "; ".join(filter(None, failures))
    return Verdict(not reasons, f"{reasons} ({figures})" if reasons else figures)
