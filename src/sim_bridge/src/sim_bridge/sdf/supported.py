"""Gazebo plugins that are supported, and elements that need no notice if nothing reads them.

Elements that nothing reads have no effect; they are reported unless they are listed here by their parent
element: scenery, settings of Gazebo's solver, editor and window, and values that ask for what happens anyway.
"""

from typing import Dict, FrozenSet, Tuple

from sim_bridge.sdf.element import Element


def _tags(text: str) -> FrozenSet[str]:
    return frozenset(text.split())


# All content of these elements.
IRRELEVANT = _tags("material lighting meta transmission author description gazebo_material")

IGNORED: Dict[str, FrozenSet[str]] = {
    "sdf": _tags("light actor"),
    "world": _tags("light scene gui spherical_coordinates magnetic_field atmosphere audio wind"),
    "insertions": _tags("light"),
    "state": _tags("sim_time wall_time real_time iterations light"),
    "physics": _tags(
        "ode bullet simbody dart max_step_size real_time_factor real_time_update_rate max_contacts"
    ),
    "model": _tags("allow_auto_disable enable_wind"),
    "actor": _tags("skin animation static plugin link"),
    "script": _tags("auto_start"),
    "trajectory": _tags("tension interpolate_x"),
    "link": _tags(
        "visual light must_be_base_link enable_wind projector audio_source audio_sink "
        "velocity acceleration wrench"  # of a saved <state>
    ),
    "collision": _tags("max_contacts verbose"),
    "contact": _tags("ode bullet poissons_ratio elastic_modulus collide_without_contact_bitmask"),
    "surface": _tags("soft_contact"),
    "friction": _tags("bullet"),
    "torsional": _tags("coefficient use_patch_radius ode"),
    "plane": _tags("size"),
    "visual": _tags("cast_shadows transparency laser_retro visibility_flags plugin verbose"),
    "joint": _tags("physics"),
    "axis": _tags("initial_position"),
    "limit": _tags("stiffness dissipation"),
    "sensor": _tags("always_on visualize topic enable_metrics"),
    "range": _tags("resolution"),
    "camera": _tags("save visibility_mask"),
    "image": _tags("format"),
    # <gazebo> elements of URDF.
    "gazebo": _tags(
        "kp kd minDepth maxVel maxContacts max_contacts visual implicitSpringDamper provideFeedback stopCfm "
        "stopErp preserveFixedJoint disableFixedJointLumping canonicalBody light"
    ),
}

# Values, by parent and tag, that ask for what happens anyway: SDF's defaults.
DEFAULTS: Dict[str, Dict[str, Tuple[str, ...]]] = {
    "model": {"self_collide": ("0",)},
    "link": {"self_collide": ("0",)},
    "ode": {"fdir1": ("0 0 0",), "slip1": ("0",), "slip2": ("0",)},
    "torsional": {"patch_radius": ("0",), "surface_radius": ("0",)},
    "contact": {
        "collide_without_contact": ("0",),
        "collide_bitmask": ("65535", "255"),
        "category_bitmask": ("65535", "255"),
    },
    "limit": {"velocity": ("-1", "1e16", "1.79769e308")},
    "dynamics": {"spring_reference": ("0",), "spring_stiffness": ("0",)},
    "gazebo": {
        "selfCollide": ("0",),
        "self_collide": ("0",),
        "turnGravityOff": ("0",),
        "gravity": ("1",),
        "static": ("0",),
        "dampingFactor": ("0",),
        "fdir1": ("0 0 0", "1 0 0"),
        "laserRetro": ("0",),
    },
    "distortion": {key: ("0",) for key in ("k1", "k2", "k3", "p1", "p2")},
}

DRIVES = (
    "gazebo_ros_diff_drive",
    "gazebo_ros_skid_steer_drive",
    "gazebo_ros_kobuki",
    "gazebo_ros_planar_move",
)

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
