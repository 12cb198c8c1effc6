"""The robot is at fault for what it drives into, not for pedestrians that walk into it."""

from types import SimpleNamespace

import numpy as np
import pytest

from evaluation.pedestrian_contacts import PedestrianContacts
from planar import Pose2, Twist2


def met(robot_v, person_v, yaw=0.0):
    """A robot at the origin that touches a person on its x axis; velocities along x. The names held
    against it, and those of pedestrians at fault."""
    rows = np.array([[0.38, 0.0, person_v, 0.0, 0.2]])
    crowd = SimpleNamespace(links=("anna::link",), rows=rows)
    pedestrians = PedestrianContacts(SimpleNamespace(scene=SimpleNamespace(crowd=crowd)))
    moving = SimpleNamespace(base_in_world=Pose2(0.0, 0.0, yaw), twist=Twist2(robot_v, 0.0), contacts=())
    touching = SimpleNamespace(
        **{**vars(moving), "twist": Twist2(), "contacts": ("anna::link", "wall::link")}
    )
    pedestrians.robot_collisions(moving)
    held = pedestrians.robot_collisions(touching)
    pedestrians.record()
    assert pedestrians.track.shape == (1, 1, 5)
    return list(held), pedestrians.people_at_fault


@pytest.mark.parametrize(
    ("robot_v", "person_v", "yaw", "is_robot_at_fault"),
    [
        (0.3, 0.0, 0.0, True),
        (0.0, -1.0, 0.0, False),
        (0.3, -1.0, 0.0, False),
        (0.5, -0.2, 0.0, True),
        (0.3, 0.5, 0.0, True),
        (0.3, -0.2, np.pi, False),
        (-0.3, -0.2, np.pi, True),
    ],
    ids=(
        *("drives into who stands", "stands", "is slower than who comes", "is faster than who comes"),
        *("catches up", "flees", "backs into"),
    ),
)
def test_the_faster_of_the_two_is_at_fault(robot_v, person_v, yaw, is_robot_at_fault):
    held, people_at_fault = met(robot_v, person_v, yaw)
    assert held == (["anna::link", "wall::link"] if is_robot_at_fault else ["wall::link"])
    assert people_at_fault == ([] if is_robot_at_fault else ["anna::link"])
