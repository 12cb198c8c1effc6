"""rtabmap's command line as slam_lite's: its map under its topic, its frames by its parameters."""

from typing import Callable, List

# rtabmap's parameters by slam_lite's.
FRAMES = {"base_frame": "frame_id", "odom_frame": "odom_frame_id"}
GRID = "grid_map"


def slam_lite_arguments(arguments: List[str], parameter: Callable[[str, str], str]) -> List[str]:
    """slam_lite's arguments for rtabmap's: without its options, with its frames, its map called as its grid.

    ``parameter``: the value of a private parameter of the node, or what is given for it.
    """
    remappings = [word for word in arguments if ":=" in word]
    grid = next((word.split(":=", 1)[1] for word in remappings if word.startswith(f"{GRID}:=")), GRID)
    frames = [(ours, parameter(theirs, "").lstrip("/")) for ours, theirs in FRAMES.items()]
    return [*remappings, f"map:={grid}", *(f"_{name}:={frame}" for name, frame in frames if frame)]
