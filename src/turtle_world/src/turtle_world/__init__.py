"""turtlesim's world on PyBullet, independent of ROS; the node is ``turtle_world.ros.node``."""

from turtle_world.canvas import Pen
from turtle_world.world import TurtleError, TurtleState, TurtleVelocity, TurtleWorld

__all__ = ["Pen", "TurtleError", "TurtleState", "TurtleVelocity", "TurtleWorld"]
