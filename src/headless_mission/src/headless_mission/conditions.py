"""Conditions of an episode: what differs from the defaults."""

import json
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any, Mapping, Optional, Sequence

from headless_mission.encoding import Encoding, ExactValues
from move_base_lite import NavigatorSettings, load_settings
from move_base_lite.control import check_local_planner
from move_base_lite.navigator.zones import Zones
from planar import Pose2
from sim_bridge import SimulationSettings
from sim_bridge.faults import Fault


@dataclass(frozen=True)
class EpisodeConditions:
    """Deviations of an episode from the defaults.

    Attributes:
        planner: Local planner instead of the preset's; empty: the preset's.
        parameters: Parameters of move_base that override those of the preset.
        faults: Faults to inject.
        simulation: Noise and rates of the simulation.
        start: Initial pose of the robot in the world, which is also the initial estimate.
        mission_start: Simulated time from which on the mission may start [s], as over ROS, where nodes
            connect first; None: as soon as the robot is localized and a client could have connected.
        encoding: Precision of the values that pass between components.
        zones: Keep-out and speed zones.
    """

    planner: str = ""
    parameters: Mapping[str, Any] = field(default_factory=dict)
    faults: Sequence[Fault] = ()
    simulation: SimulationSettings = SimulationSettings()
    start: Pose2 = Pose2()
    mission_start: Optional[float] = None
    encoding: Encoding = ExactValues()
    zones: Zones = Zones()

    def navigation(self, config: Path) -> NavigatorSettings:
        """Read a preset and apply these conditions to it.

        Args:
            config: YAML file of move_base's parameters.

        Raises:
            SettingsError: If a parameter or the planner is not valid.
        """
        if self.planner:
            check_local_planner(self.planner)
        planner = {"base_local_planner": self.planner} if self.planner else {}
        return _navigation(config, json.dumps({**self.parameters, **planner}))


@lru_cache(maxsize=8)
def _navigation(config: Path, chosen: str) -> NavigatorSettings:
    """Read the settings once for each set of parameters (``chosen``, as JSON)."""
    return load_settings(config, **json.loads(chosen))
