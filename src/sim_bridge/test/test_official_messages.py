"""The message packages are interchangeable with the official ones."""

from pathlib import Path

import pytest

genmsg = pytest.importorskip("genmsg")
from genmsg import gentools, msg_loader  # noqa: E402

COMPAT = Path(__file__).resolve().parents[2] / "compat"
OFFICIAL = dict(
    line.split() for line in (Path(__file__).parent / "official_md5.txt").read_text().splitlines()
)
NEEDED = ("std_msgs", "geometry_msgs", "sensor_msgs", "trajectory_msgs")
SHARES = [Path("/usr/share"), *Path("/opt/ros").glob("*/share")]
HAS_DEFINITIONS = any((share / "std_msgs/msg/Header.msg").exists() for share in SHARES)


def md5(package, file):
    context = msg_loader.MsgContext.create_default()
    search = {name: [str(share / name / "msg") for share in SHARES] for name in NEEDED}
    search[package] = [str(COMPAT / package / "msg")]
    load = msg_loader.load_srv_from_file if file.suffix == ".srv" else msg_loader.load_msg_from_file
    spec = load(context, str(file), f"{package}/{file.stem}")
    msg_loader.load_depends(context, spec, search)
    return gentools.compute_md5(context, spec)


@pytest.mark.skipif(
    not HAS_DEFINITIONS, reason="the messages' definitions are not installed, as in the image"
)
@pytest.mark.parametrize("package", ["gazebo_msgs", "gazebo_ros_link_attacher", "kobuki_msgs"])
def test_types_have_the_md5_of_the_official_ones(package):
    files = [file for kind in ("msg", "srv") for file in sorted((COMPAT / package / kind).glob("*"))]
    assert {f"{package}/{file.stem}": md5(package, file) for file in files} == {
        name: value for name, value in OFFICIAL.items() if name.startswith(f"{package}/")
    }
