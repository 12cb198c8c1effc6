"""The world of turtlesim on PyBullet, without ROS; the node is in ``turtle_world.ros.node``."""

from turtle_world.canvas import Pen
from turtle_world.world import Command, TurtleError, TurtleState, TurtleWorld

__all__ = ["Command", "Pen", "TurtleError", "TurtleState", "TurtleWorld"]
