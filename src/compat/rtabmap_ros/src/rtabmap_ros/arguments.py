"""Translation of rtabmap's command line and parameters to those of slam_lite."""

from typing import Callable, List

# Parameter of slam_lite -> parameter of rtabmap.
FRAMES = {"base_frame": "frame_id", "odom_frame": "odom_frame_id"}
GRID = "grid_map"


def slam_lite_arguments(arguments: List[str], parameter: Callable[[str, str], str]) -> List[str]:
    """Translate rtabmap's arguments: options are dropped, ``map`` is published as rtabmap's ``grid_map``.

    Args:
        arguments: Arguments of rtabmap.
        parameter: Returns a private parameter of the node by name and default.

    Returns:
        Remappings and private parameters for slam_lite.
    """
    remappings = [word for word in arguments if ":=" in word]
    grid = next((word.split(":=", 1)[1] for word in remappings if word.startswith(f"{GRID}:=")), GRID)
    frames = [(ours, parameter(theirs, "").lstrip("/")) for ours, theirs in FRAMES.items()]
    return [*remappings, f"map:={grid}", *(f"_{name}:={frame}" for name, frame in frames if frame)]
