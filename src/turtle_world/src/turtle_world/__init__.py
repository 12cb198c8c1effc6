"""The world of turtlesim on PyBullet, without ROS; the node is in ``turtle_world.ros.node``."""

from turtle_world.canvas import Pen
from turtle_world.world import TurtleError, TurtleState, TurtleVelocity, TurtleWorld

__all__ = ["Pen", "TurtleError", "TurtleState", "TurtleVelocity", "TurtleWorld"]
