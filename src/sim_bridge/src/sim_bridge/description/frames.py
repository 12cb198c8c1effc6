"""A robot's description for one robot of several, each with frames of its own."""

import xml.etree.ElementTree as ElementTree

import defusedxml.ElementTree


def with_frames_of(name: str, urdf: str) -> str:
    """A URDF whose links, and thereby frames, have ``name``/ before their names.

    For a robot_state_publisher: Debian 11's (1.15.1) knows no ``tf_prefix``.
    """
    robot = defusedxml.ElementTree.fromstring(urdf, forbid_dtd=False)
    for path, attribute in (("link", "name"), ("joint/parent", "link"), ("joint/child", "link")):
        for element in robot.findall(path):
            element.set(attribute, f"{name}/{element.get(attribute)}")
    return ElementTree.tostring(robot, encoding="unicode")
