"""Reads Gazebo's world files (SDF 1.4 to 1.7) as far as a wheeled robot meets or sees them. Pure."""

from sim_bridge.sdf.reader import load_world, read_model

__all__ = ["load_world", "read_model"]
