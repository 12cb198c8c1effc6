"""Names of Gazebo's plugins."""

from sim_bridge.sdf.element import Element

DRIVES = ("gazebo_ros_diff_drive", "gazebo_ros_skid_steer_drive", "gazebo_ros_kobuki")

# Plugins of worlds whose work is done here without them: ROS's interface, colliding actors, a gripper.
NEEDLESS = frozenset(
    "gazebo_ros_init gazebo_ros_factory gazebo_ros_api_plugin gazebo_ros_paths_plugin gazebo_ros_state "
    "gazebo_ros_properties gazebo_ros_force_system actor_collisions ActorCollisionsPlugin GrabPlugin".split()
)


def plugin_name(plugin: Element) -> str:
    """What a <plugin> loads, without what differs between systems: ``gazebo_ros_laser``."""
    name = plugin.attribute("filename").rsplit("/", 1)[-1]
    name = name[3:] if name.startswith("lib") else name
    return name[:-3] if name.endswith(".so") else name
