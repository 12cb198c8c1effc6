"""SDF elements and Gazebo plugins that are supported, and those that are ignored without a warning.

Elements are listed by their parent element. All others are ignored with a warning.
"""

from typing import Dict, FrozenSet

from sim_bridge.sdf.element import Element


def _tags(text: str) -> FrozenSet[str]:
    return frozenset(text.split())


SUPPORTED: Dict[str, FrozenSet[str]] = {
    "world": _tags("model actor include frame state gravity physics"),
    "insertions": _tags("model include"),
    "physics": _tags("gravity"),
    "model": _tags("pose static link joint frame model include"),
    "actor": _tags("pose script"),
    "link": _tags("pose inertial collision visual gravity kinematic velocity_decay"),
    "inertial": _tags("pose mass inertia"),
    "collision": _tags("pose geometry surface laser_retro"),
    "surface": _tags("friction bounce"),
    "visual": _tags("pose geometry material"),
    "joint": _tags("pose parent child axis"),
    "axis": _tags("xyz limit dynamics use_parent_model_frame"),
    "include": _tags("uri name pose static placement_frame"),
}

# Scenery, settings of Gazebo's solver and editor, and details of visuals.
IGNORED: Dict[str, FrozenSet[str]] = {
    "world": _tags("light scene gui spherical_coordinates magnetic_field atmosphere audio wind"),
    "insertions": _tags("light"),
    "physics": _tags(
        "ode bullet simbody dart max_step_size real_time_factor real_time_update_rate max_contacts"
    ),
    "model": _tags("allow_auto_disable self_collide enable_wind"),
    "actor": _tags("skin animation static plugin"),
    "link": _tags("light self_collide enable_wind must_be_base_link"),
    "collision": _tags("max_contacts"),
    "surface": _tags("contact"),
    "visual": _tags("cast_shadows transparency laser_retro meta visibility_flags"),
    "joint": _tags("physics"),
    "axis": _tags("initial_position"),
}

DRIVES = ("gazebo_ros_diff_drive", "gazebo_ros_skid_steer_drive", "gazebo_ros_kobuki")

# World plugins whose work is done here without them: the ROS interface, colliding actors, a gripper.
REDUNDANT_PLUGINS = frozenset(
    "gazebo_ros_init gazebo_ros_factory gazebo_ros_api_plugin gazebo_ros_paths_plugin gazebo_ros_state "
    "gazebo_ros_properties gazebo_ros_force_system actor_collisions ActorCollisionsPlugin GrabPlugin".split()
)

# Plugin, of sim_bridge only, that makes a static model a dock which charges a Kobuki.
DOCK = "gazebo_ros_kobuki_dock"


def plugin_name(plugin: Element) -> str:
    """Return the library of a <plugin> without prefix and suffix, e.g. ``gazebo_ros_laser``."""
    name = plugin.attribute("filename").rsplit("/", 1)[-1]
    name = name[3:] if name.startswith("lib") else name
    return name[:-3] if name.endswith(".so") else name
