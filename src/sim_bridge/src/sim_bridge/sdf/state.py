"""The <state> block: where Gazebo's models stood when the world was saved."""

from dataclasses import dataclass, field
from typing import Dict, Iterable, Optional

import numpy as np

from sim_bridge.sdf.element import Element


@dataclass
class ModelState:
    """Poses (4, 4) in the world that override those of a model, its links and nested models."""

    pose: Optional[np.ndarray] = None
    links: Dict[str, np.ndarray] = field(default_factory=dict)
    models: Dict[str, "ModelState"] = field(default_factory=dict)


def read_states(parents: Iterable[Element]) -> Dict[str, ModelState]:
    """The states of the models below ``parents``, by name; the last one written counts.

    The poses of models and links are all given in the world frame, as Gazebo saves them.
    """
    states: Dict[str, ModelState] = {}
    for parent in parents:
        for model in parent.children("model"):
            states[model.name] = ModelState(
                pose=model.pose() if model.child("pose") else None,
                links={link.name: link.pose() for link in model.children("link") if link.child("pose")},
                models=read_states([model]),
            )
    return states
