"""Preloaded process (forkserver) of which the nodes of a graph are forked: imports and numba kernels."""

from functools import lru_cache
from subprocess import Popen
from typing import Tuple

from supervision.fork_server import start_fork_server

NODES = (
    "sim_bridge.ros.node",
    "map_lite.ros.map_server",
    "amcl_lite.ros.node",
    "move_base_lite.ros.node",
    "pick_objects.ros.node",
    "add_markers.ros.node",
)


@lru_cache(maxsize=None)
def preload_nodes(prefix: Tuple[str, ...] = ()) -> "Popen[bytes]":
    """Start the preloaded process, unless it was started before; nodes started later are forked of it.

    Args:
        prefix: Words that precede its command, for one with other mounts.
    """
    preparations = [*NODES, "sim_bridge.views.section:warm_up", f"{__name__}:load_kernels"]
    return start_fork_server(preparations, prefix)


def load_kernels() -> None:
    """Load the kernels of localization and navigation from the cache, or compile them."""
    from amcl_lite import LocalizerSettings
    from amcl_lite.localizer import warm_up as warm_up_localizer
    from evaluation.presets import LOCALIZATION_CONFIG, NAVIGATION_CONFIG
    from move_base_lite import load_settings
    from move_base_lite.warmup import warm_up as warm_up_navigator
    from planar.config.parameters import settings_from_yaml

    warm_up_localizer(settings_from_yaml(LocalizerSettings, LOCALIZATION_CONFIG)[0])
    warm_up_navigator(load_settings(NAVIGATION_CONFIG))
