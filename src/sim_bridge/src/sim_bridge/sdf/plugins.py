"""Names of Gazebo's plugins."""

from sim_bridge.sdf.element import Element

DRIVES = ("gazebo_ros_diff_drive", "gazebo_ros_skid_steer_drive", "gazebo_ros_kobuki")


def plugin_name(plugin: Element) -> str:
    """What a <plugin> loads, without what differs between systems: ``gazebo_ros_laser``."""
    name = plugin.attribute("filename").rsplit("/", 1)[-1]
    name = name[3:] if name.startswith("lib") else name
    return name[:-3] if name.endswith(".so") else name
