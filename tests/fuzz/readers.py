"""All file readers, with their names and example files."""

import io
import json
import tempfile
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any, Callable, Dict, List, Tuple
from unittest.mock import patch

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
CORPUS = Path(__file__).resolve().parent / "corpus"
MESHES = "meshes"
# Largest seed [bytes]: many small files reach more code than few large ones.
SEED_BYTES = 6000


@dataclass(frozen=True)
class Reader:
    """A function that reads a file; for an invalid file it may raise a PlanarError and nothing else.

    Attributes:
        name: Name of the reader.
        file_name: Name of the file that it is given.
        read: The function; the files to which its file refers are in the same folder.
        examples: Returns valid files.
    """

    name: str
    file_name: str
    read: Callable[[Path], object]
    examples: Callable[[], List[bytes]]

    @property
    def seeds(self) -> List[bytes]:
        """Examples and earlier findings that are small."""
        known = [*self.examples(), *(path.read_bytes() for path in self.findings)]
        return [data for data in known if len(data) <= SEED_BYTES] or known

    @property
    def findings(self) -> List[Path]:
        """Files that once caused a fault."""
        return sorted((CORPUS / self.name).glob("*"))


def prepare(folder: Path) -> None:
    """Write the files to which the examples refer."""
    (folder / "home.pgm").write_bytes(PGM)
    (folder / MESHES).mkdir()


def _files(*names: str) -> Callable[[], List[bytes]]:
    return lambda: [(ROOT / name).read_bytes() for name in names]


def _texts(*texts: str) -> Callable[[], List[bytes]]:
    return lambda: [text.encode() for text in texts]


def _map(path: Path) -> object:
    from planar import load_map

    return load_map(path)


def _map_image(path: Path) -> object:
    """Read with a lower pixel limit: a few bytes can encode a hundred million pixels, which take a second."""
    from planar.maps import map_file

    with patch.object(map_file, "MAX_PIXELS", 1_000_000):
        return map_file.cells_from_image(path)


PGM = b"P5\n# 0.05 m/pix\n4 3\n255\n" + bytes(range(12))


def _small_images() -> List[bytes]:
    from PIL import Image

    found = [PGM, b"P2\n2 2\n255\n0 205 254 255\n"]
    for kind in ("PNG", "BMP", "GIF", "TIFF", "PPM"):
        file = io.BytesIO()
        Image.fromarray(np.arange(48, dtype=np.uint8).reshape(4, 4, 3)).save(file, kind)
        found.append(file.getvalue())
    return found


def _places(path: Path) -> object:
    from planar.maps.places import load_places

    return load_places(path)


def _semantic_map(path: Path) -> object:
    from planar.maps.semantic_map import load_semantic_map

    return load_semantic_map(path)


def _objects(path: Path) -> object:
    from planar.maps.semantic_map import load_objects

    return load_objects(path)


def _mission(path: Path) -> object:
    from pick_objects import load_mission

    return load_mission(path, _known_places())


@lru_cache(maxsize=None)
def _known_places() -> Dict[str, Any]:
    from planar.maps.places import load_places

    return load_places(ROOT / "map/zones.yaml")


def _faults(path: Path) -> object:
    from sim_bridge.faults import load_faults

    return load_faults(path)


def _zones(path: Path) -> object:
    from move_base_lite.navigator.zones import load_zones

    return load_zones(path)


def _inputs(path: Path) -> object:
    from sim_bridge.driving.mux import read_inputs

    return read_inputs(path)


def _scenario(path: Path) -> object:
    from laboratory.scenario.reader import read_scenario

    return read_scenario(path).digest()


def _move_base(path: Path) -> object:
    from move_base_lite import load_settings

    return load_settings(path)


def _amcl(path: Path) -> object:
    from amcl_lite import LocalizerSettings
    from planar.config.parameters import settings_from_yaml

    return settings_from_yaml(LocalizerSettings, path)


def _world(path: Path) -> object:
    from sim_bridge import load_world

    return load_world(path)


def _model(path: Path) -> object:
    from sim_bridge.sdf.reader import read_model

    return read_model(path.read_bytes(), "object", np.eye(4))


MODEL = """<sdf version='1.6'><model name='box'><link name='l'><pose>0 0 1 0 0 0.5</pose>
<inertial><mass>2</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>
<collision name='c'><geometry><box><size>1 2 3</size></box></geometry>
<surface><friction><ode><mu>0.5</mu></ode></friction></surface></collision>
<visual name='v'><geometry><cylinder><radius>0.2</radius><length>1</length></cylinder></geometry></visual>
</link><link name='m'/><joint name='j' type='revolute'><parent>l</parent><child>m</child>
<axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper></limit></axis></joint></model></sdf>
"""


def _robot(path: Path) -> object:
    from sim_bridge.description import read_urdf_robot

    return read_urdf_robot(path.read_bytes().decode("utf-8", "replace"), path.name)


def _prop(path: Path) -> object:
    from sim_bridge.description.robot import read_prop

    return read_prop(path.read_bytes().decode("utf-8", "replace"), "object", np.eye(4))


PROP = """<robot name='box'><link name='base'><inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1'
ixy='0' ixz='0' iyz='0'/></inertial><collision>
<origin xyz='0 0 1' rpy='0 0 0.3'/><geometry><box size='1 2 3'/>
</geometry></collision></link><link name='arm'>
<collision><geometry><sphere radius='0.1'/></geometry></collision>
</link><joint name='j' type='continuous'>
<parent link='base'/><child link='arm'/><axis xyz='0 1 0'/></joint></robot>
"""


def _mesh(path: Path) -> object:
    from sim_bridge.geometry.meshes import load_mesh
    from sim_bridge.geometry.shapes import MeshFile

    cache = path.parent / MESHES
    try:
        return load_mesh(MeshFile(path), cache)
    finally:
        for kept in cache.iterdir():
            kept.unlink()


def _meshes(kind: str) -> Callable[[], List[bytes]]:
    def make() -> List[bytes]:
        import trimesh

        made = trimesh.creation.box().export(file_type=kind)
        return [made.encode() if isinstance(made, str) else made]

    return make


DAE = """<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries>
<geometry id="g"><mesh>
<source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v">
<input semantic="POSITION" source="#p"/></vertices><triangles count="1"><input semantic="VERTEX" source="#v"
offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes>
<visual_scene id="s"><node id="n"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
"""


def _state(path: Path) -> object:
    from slam_lite.state import load_state

    return load_state(path)


def _states() -> List[bytes]:
    """A state of two keyframes without compression, so that mutations reach its numbers."""
    file = io.BytesIO()
    floats = {
        "points_xy": (4, 2),
        "normals_xy": (4, 2),
        "ends_xy": (6, 2),
        "lasers_xy": (2, 2),
        "poses": (2, 3),
    }
    edges = {
        "edge_nodes": np.array([[0, 1]]),
        "edge_measured": np.zeros((1, 3)),
        "edge_information": np.eye(3)[None],
        "edge_is_loop": np.zeros(1, dtype=bool),
    }
    np.savez(
        file,
        format="slam_lite state",
        version=2,
        point_counts=[2, 2],
        beam_counts=[3, 3],
        marks=np.zeros(6, dtype=bool),
        base_in_map=np.zeros(3),
        **{name: np.ones(shape) for name, shape in floats.items()},
        **edges,
    )
    return [file.getvalue()]


def _particles(path: Path) -> object:
    from amcl_lite.belief import load_particles

    return load_particles(path)


def _particle_sets() -> List[bytes]:
    file = io.BytesIO()
    np.save(file, np.array([[1.0, 2.0, 0.5, 0.25], [1.5, 2.0, -3.0, 0.75]]))
    return [file.getvalue()]


def _record(path: Path) -> object:
    from run_report.record import load_record

    return load_record(path.parent)


def _records() -> List[bytes]:
    from planar import OccupancyGrid
    from run_report.record import CollisionEvent, RunRecord, StateEvent, save_record

    grid = OccupancyGrid(np.zeros((2, 3), dtype=np.int8), 0.05)
    record = RunRecord(
        truth=np.ones((2, 4)),
        states=[StateEvent(0.0, "x")],
        collisions=[CollisionEvent(1.0, "wall")],
        grid=grid,
    )
    with tempfile.TemporaryDirectory() as folder:
        save_record(Path(folder), record)
        return [path.read_bytes() for path in Path(folder).iterdir()]


def _result(path: Path) -> object:
    from run_report.comparison import load_run

    return load_run(path.parent)


def _repeated(path: Path) -> object:
    from home_service.reproducing import read_result

    return read_result(path.parent)


RESULT = json.dumps(
    {
        "command": "home_service",
        "success": True,
        "reason": "delivered",
        "arguments": ["--seed", "3"],
        "hash": "a77",
        "versions": {"numpy": "1.24.4", "commit": "abc"},
        "simulated_seconds": 26.2,
        "position_errors": {"pickup": 0.06},
        "collisions": [],
        "restarts": [{"node": "amcl", "reason": "was ended"}],
    }
)


def _bag(path: Path) -> object:
    from planar_ros.bags.bag_reader import BagReader

    bag = BagReader(path)
    return [played for topic in bag.types for played in bag.messages([topic])]


def _bags() -> List[bytes]:
    import rosbag
    import rospy
    from nav_msgs.msg import Odometry
    from sensor_msgs.msg import LaserScan

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "a.bag"
        with rosbag.Bag(str(path), "w") as bag:
            for number in range(3):
                bag.write("/scan", LaserScan(ranges=[1.0, 2.0]), rospy.Time(number + 1))
                bag.write("/odom", Odometry(), rospy.Time(number + 1))
        return [path.read_bytes()]


def _deaths(path: Path) -> object:
    from supervision.node_exits import NodeExits

    deaths = NodeExits(path.parent, ["amcl"])
    for line in path.read_bytes().decode("utf-8", "replace").splitlines(keepends=True):
        deaths.read(line)
    return deaths


DEATH = """[/amcl] error: no map
[amcl-3] process has died [pid 12, exit code -9, cmd /x].
REQUIRED process [sim_bridge-2] has died!
process has died [pid 7, exit code 1, cmd /y].
"""
_MISSIONS = _files("tests/fuzz/examples/mission.yaml")
_MOVE_BASES = ("src/move_base_lite/config/turtlebot.yaml", "tests/fuzz/examples/move_base.yaml")
_WORLDS = ("map/home.world", "tests/cockpit/doors.world", "tests/fuzz/examples/small.world")
_URDF = _files(*(f"src/sim_bridge/src/sim_bridge/urdf/{name}.urdf" for name in ("turtlebot2", "jackal")))
_FAULTS = (
    "faults:\n  - {kind: scan_late, start: 8, end: 12.5, strength: 0.5, seed: 3}\n  - {kind: kidnapped}\n"
)
_SEMANTIC_MAP = """\
rooms: {kitchen: {kind: kitchen}}
furniture:
  counter: {kind: kitchen, room: kitchen, x: 1.0, y: 2.0, yaw: 0.1, size: [2.0, 0.6], height: 0.9}
objects: {cup: {on: {kitchen: 3, table: 1}, in: {kitchen: 2}}}
"""
_OBJECTS = ["keys: {x: 1.0, y: 2.0, z: 0.4}\n"]
_ZONES = "slow: {kind: speed, corners: [[0, 0], [1, 0], [1, 1]], max_speed: 0.2, enabled: false}\n"
_INPUTS = "subscribers:\n  - {name: navi, topic: input/navi, timeout: 1.0, priority: 5}\npublisher: out\n"
_ALL: Tuple[Reader, ...] = (
    Reader("map", "home.yaml", _map, _files("map/home.yaml")),
    Reader("map_image", "image.pgm", _map_image, _small_images),
    Reader("places", "places.yaml", _places, _files("map/zones.yaml")),
    Reader("mission", "mission.yaml", _mission, _MISSIONS),
    Reader("semantic_map", "semantic_map.yaml", _semantic_map, _texts(_SEMANTIC_MAP)),
    Reader("objects", "objects.yaml", _objects, _texts(*_OBJECTS)),
    Reader("faults", "faults.yaml", _faults, _texts(_FAULTS)),
    Reader("zones", "keep_out.yaml", _zones, _texts(_ZONES)),
    Reader("inputs", "mux.yaml", _inputs, _texts(_INPUTS)),
    Reader("scenario", "scenario.yaml", _scenario, lambda: _contents(ROOT / "scenarios", "*.yaml")),
    Reader("move_base", "move_base.yaml", _move_base, _files(*_MOVE_BASES)),
    Reader("amcl", "amcl.yaml", _amcl, _files("src/amcl_lite/config/turtlebot.yaml")),
    Reader("world", "home.world", _world, _files(*_WORLDS)),
    Reader("model", "model.sdf", _model, _texts(MODEL)),
    Reader("robot", "robot.urdf", _robot, _URDF),
    Reader("prop", "prop.urdf", _prop, _texts(PROP)),
    Reader("stl", "mesh.stl", _mesh, _meshes("stl")),
    Reader("obj", "mesh.obj", _mesh, _meshes("obj")),
    Reader("dae", "mesh.dae", _mesh, _texts(DAE)),
    Reader("state", "map.npz", _state, _states),
    Reader("particles", "amcl.kept", _particles, _particle_sets),
    Reader("record", "record.json", _record, _records),
    Reader("result", "result.json", _result, _texts(RESULT)),
    Reader("repeated", "result.json", _repeated, _texts(RESULT)),
    Reader("bag", "run.bag", _bag, _bags),
    Reader("deaths", "roslaunch.log", _deaths, _texts(DEATH)),
)
READERS: Dict[str, Reader] = {reader.name: reader for reader in _ALL}


def _contents(folder: Path, pattern: str) -> List[bytes]:
    return [path.read_bytes() for path in sorted(folder.glob(pattern))]
