"""Reads <state> elements: poses and scales of models when Gazebo saved the world."""

from dataclasses import dataclass, field
from typing import Dict, Iterable, Optional, Tuple

import numpy as np

from sim_bridge.sdf.element import Element


@dataclass
class ModelState:
    """Saved state of a model, which overrides its description.

    Attributes:
        pose: Pose (4, 4) in the world.
        scale: Scale factors of its shapes along their axes.
        links: Poses (4, 4) in the world of links, by name.
        models: States of nested models, by name.
    """

    pose: Optional[np.ndarray] = None
    scale: Tuple[float, ...] = (1.0, 1.0, 1.0)
    links: Dict[str, np.ndarray] = field(default_factory=dict)
    models: Dict[str, "ModelState"] = field(default_factory=dict)


def read_states(parents: Iterable[Element]) -> Dict[str, ModelState]:
    """Return the states of the models below ``parents``, by name; the last one of a name counts.

    All poses are in the world frame, as Gazebo saves them.
    """
    states: Dict[str, ModelState] = {}
    for parent in parents:
        for model in parent.children("model"):
            scale = model.child("scale")
            links = ((link.name, link.raw_pose()) for link in model.children("link"))
            states[model.name] = ModelState(
                pose=model.raw_pose(),
                scale=scale.lengths(3) if scale is not None else (1.0, 1.0, 1.0),
                links={name: pose for name, pose in links if pose is not None},
                models=read_states([model]),
            )
    return states
