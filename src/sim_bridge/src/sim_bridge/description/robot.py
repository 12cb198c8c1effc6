"""Reads robot profiles from URDF and SDF."""

import xml.etree.ElementTree as ElementTree
from typing import List, Tuple

import numpy as np

from sim_bridge.description.plugins import read_plugins
from sim_bridge.description.profile import RobotProfile
from sim_bridge.description.sdf import read_sdf
from sim_bridge.description.structure import GazeboElements, RobotStructure
from sim_bridge.description.urdf import FindFile, no_file, read_urdf
from sim_bridge.errors import NoDriveError, RobotError, WorldError
from sim_bridge.sdf.supported import DRIVES
from sim_bridge.world import Body, DrivenModel, World


def read_urdf_robot(text: str, where: str, find_file: FindFile = no_file) -> RobotProfile:
    """Read a robot from a URDF text.

    Args:
        text: The URDF.
        where: Name of the text in errors, e.g. its file.
        find_file: Finds the files of package:// and model:// URIs.

    Raises:
        NoDriveError: No plugin drives it.
        RobotError: The description cannot be used.
    """
    structure, elements, warnings = read_urdf(text, where, find_file)
    return _profile(structure, elements, warnings, text, where)


def read_sdf_robot(model: DrivenModel) -> Tuple[RobotProfile, np.ndarray]:
    """Read a robot from a driven model of a world.

    Args:
        model: The model.

    Returns:
        The robot, and the pose (4, 4) of its base in the world.

    Raises:
        RobotError: The description cannot be used.
    """
    structure, elements, base_in_world = read_sdf(model)
    text = ElementTree.tostring(model.element.xml, encoding="unicode")
    return _profile(structure, elements, [], text, model.element.file), base_in_world


def read_prop(text: str, name: str, pose: np.ndarray, find_file: FindFile = no_file) -> World:
    """Return a world with one model: the object that a URDF text describes, with its joints fixed.

    Args:
        text: The URDF.
        name: Name of the model.
        pose: Pose (4, 4) in the world.
        find_file: Finds the files of package:// and model:// URIs.

    Raises:
        RobotError: The description cannot be used.
    """
    structure, _, warnings = read_urdf(text, name, find_file)
    base = structure.assemble(()).base
    body = Body(f"{name}::{base.name}", pose, base.collisions, base.mass)
    return World(name, (body,), warnings=tuple(warnings))


def _profile(
    structure: RobotStructure, elements: GazeboElements, warnings: List[str], text: str, where: str
) -> RobotProfile:
    try:
        profiles = read_plugins(structure, elements)
    except WorldError as error:
        raise RobotError(str(error)) from None
    if profiles.drive is None:
        plugins = ", ".join(f"lib{name}.so" for name in DRIVES)
        raise NoDriveError(f"{where}: robot {structure.name} has no drive (a <gazebo> plugin of {plugins})")
    return RobotProfile(
        name=structure.name,
        text=text,
        model=structure.assemble(profiles.drive.joints),
        drive=profiles.drive,
        odometry=profiles.odometry,
        sensors=tuple(profiles.sensors),
        joint_states=profiles.joint_states,
        namespace=profiles.namespace,
        battery=profiles.battery,
        warnings=(*warnings, *profiles.warnings),
    )
