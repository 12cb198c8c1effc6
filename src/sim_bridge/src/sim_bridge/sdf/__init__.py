"""Reads Gazebo worlds and models (SDF 1.4 to 1.7), as far as they matter to a wheeled robot."""

from sim_bridge.sdf.reader import load_world, read_model

__all__ = ["load_world", "read_model"]
