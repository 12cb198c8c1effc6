"""How good a map is, by the world that it was made in."""

from planar import OccupancyGrid
from planar.maps.map_score import MapScore, score_map
from sim_bridge import RobotProfile
from sim_bridge.views.true_map import true_map
from sim_bridge.world import World

LEAST_RECALL = LEAST_PRECISION = 0.95
FINE_RESOLUTION = 0.01


def score_against_world(grid: OccupancyGrid, world: World, robot: RobotProfile) -> MapScore:
    """A map against what the robot's laser could have seen of the world from where the robot can get."""
    height = float(robot.laser.pose_in_base[2, 3])
    truth, fine_truth = (true_map(world, height, resolution) for resolution in (0.05, FINE_RESOLUTION))
    return score_map(grid, truth, robot_radius=robot.radius, sight=robot.laser.sight, fine_truth=fine_truth)
