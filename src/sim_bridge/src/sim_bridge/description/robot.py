"""Whole robots from the texts that describe them."""

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
    """The robot of a URDF text; ``where`` names the text in errors.

    Raises RobotError; NoDriveError if nothing drives it.
    """
    structure, blocks, warnings = read_urdf(text, where, find_file)
    return _profile(structure, blocks, warnings, text, where)


def read_sdf_robot(model: DrivenModel) -> Tuple[RobotProfile, np.ndarray]:
    """The robot of a model in a world, and where its base stands, (4, 4). Raises RobotError."""
    structure, blocks, base_in_world = read_sdf(model)
    text = ElementTree.tostring(model.element.xml, encoding="unicode")
    return _profile(structure, blocks, [], text, model.element.file), base_in_world


def read_prop(text: str, name: str, pose: np.ndarray, find_file: FindFile = no_file) -> World:
    """A world of the one thing that a URDF text describes, called ``name``; its joints are held as they are.

    Raises RobotError.
    """
    structure, _, warnings = read_urdf(text, name, find_file)
    base = structure.assemble(()).base
    body = Body(f"{name}::{base.name}", pose, base.collisions, base.mass)
    return World(name, (body,), warnings=tuple(warnings))


def _profile(
    structure: RobotStructure, blocks: GazeboElements, warnings: List[str], text: str, where: str
) -> RobotProfile:
    try:
        equipment = read_plugins(structure, blocks)
    except WorldError as error:
        raise RobotError(str(error)) from None
    if equipment.drive is None:
        plugins = ", ".join(f"lib{name}.so" for name in DRIVES)
        raise NoDriveError(f"{where}: robot {structure.name} has no drive (a <gazebo> plugin of {plugins})")
    return RobotProfile(
        name=structure.name,
        text=text,
        model=structure.assemble(equipment.drive.joints),
        drive=equipment.drive,
        odometry=equipment.odometry,
        sensors=tuple(equipment.sensors),
        joint_states=equipment.joint_states,
        namespace=equipment.namespace,
        warnings=(*warnings, *equipment.warnings),
    )
