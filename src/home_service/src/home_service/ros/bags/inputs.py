"""What localization or mapping can use of a recording: the scans and the frames."""

from dataclasses import dataclass
from typing import Dict, Tuple

from planar_ros.bags.bag_reader import LASER_SCAN, TF, TF_STATIC, BagError
from planar_ros.bags.frames import BagFrames, find_frames, read_tree
from planar_ros.bags.recording import Recording
from planar_ros.bags.scan_log import NoResultError
from planar_ros.messages.conversion import frame_name

# Names as in the launch files of localization and mapping.
ODOM, BASE, SCAN = "odom", "base_footprint", "/scan"


@dataclass(frozen=True)
class ReplayInputs:
    """Inputs of a replay.

    Attributes:
        scan_topic: Topic of the scans.
        laser: Frame of the scans.
        frames: Frames of odometry and base.
        is_mounted: Whether the pose of the laser in the base frame was recorded.
    """

    scan_topic: str
    laser: str
    frames: BagFrames
    is_mounted: bool

    def __str__(self) -> str:
        """What is taken for what, for messages to people."""
        frames = self.frames
        mounting = "" if self.is_mounted else f", taken for mounted at the origin of {frames.base}"
        odometry = f"odometry {frames.odom} -> {frames.base}" if frames.has_odometry else "no odometry"
        return f"scans of {self.scan_topic} ({self.laser}{mounting}), {odometry}"

    @property
    def assumed(self) -> Tuple[Tuple[str, str], ...]:
        """Parent and child of transforms that were not recorded and are taken for the identity."""
        frames = self.frames
        odometry = () if frames.has_odometry else ((frames.odom, frames.base),)
        return odometry if self.is_mounted else (*odometry, (frames.base, self.laser))

    def launch_arguments(self) -> Dict[str, str]:
        """Return the arguments of replay.launch for these inputs."""
        return {
            "scan_topic": self.scan_topic,
            "odom_frame": self.frames.odom,
            "base_frame": self.frames.base,
            "assumed": " ".join(f"{parent}>{child}" for parent, child in self.assumed),
        }


def find_inputs(recording: Recording) -> ReplayInputs:
    """Find the inputs of a recording.

    Raises:
        NoResultError: There are no scans, or several topics with scans and none is /scan.
        BagError: The bag is broken before its first scan, or the base is one of several moving frames.
    """
    path, topics = recording.paths[0], recording.topics_of(LASER_SCAN)
    if len(topics) > 1 and SCAN in topics:
        topics = [SCAN]
    if len(topics) != 1:
        names = ", ".join(topics or sorted(recording.types)) or "none"
        what = f"several topics with scans and none is {SCAN}" if topics else "no laser scans; topics"
        raise NoResultError(f"{path}: {what}: {names}")
    laser = ""
    for played in recording.messages(topics):
        laser = frame_name(played.message.header.frame_id)
        break
    frames = find_frames(recording, ODOM, BASE, laser)
    tree = read_tree(recording, [TF_STATIC, TF], lambda read: frames.base in read.frames_from(laser))
    if not laser:
        raise BagError(f"{path}: the scans of {topics[0]} have no frame_id")
    return ReplayInputs(topics[0], laser, frames, frames.base in tree.frames_from(laser))
