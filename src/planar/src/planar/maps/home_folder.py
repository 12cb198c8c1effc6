"""A home as one folder: world, map, zones and mission, tied by the hashes in its manifest."""

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Dict, Mapping, Optional

import yaml

from planar.config.yaml_table import Table, read_table
from planar.errors import SettingsError
from planar.files.reading import is_file, read_bytes
from planar.maps.semantic_map import OBJECTS, SEMANTIC_MAP

MANIFEST, PLAN = "manifest.yaml", "plan.yaml"
WORLD, MAP, IMAGE, ZONES, MISSION = "home.world", "home.yaml", "home.pgm", "zones.yaml", "mission.yaml"
NAVIGATION_ZONES, PICTURE = "navigation_zones.yaml", "home.png"
# What each part is made from; the others are made from the plan.
SOURCES = {MAP: WORLD, IMAGE: WORLD, PICTURE: WORLD}
# Parts that a robot drives by: changed ones do not belong to the others any more. Zones and missions may be
# edited, as they are checked against the map whenever they are read.
FIXED = (WORLD, MAP, IMAGE)
VERSION = 1


@dataclass(frozen=True)
class HomeFolder:
    """The files of a home.

    Attributes:
        folder: The folder.
        world: SDF world.
        map: YAML file of its map.
        zones: YAML file of its places.
        mission: Mission file; None if it has none.
        navigation_zones: YAML file of keep-out and speed zones; None if it has none.
        semantic_map: YAML file of what is usually where; None if it has none.
        objects: YAML file of where objects truly are; None if it has none.
    """

    folder: Path
    world: Path
    map: Path
    zones: Path
    mission: Optional[Path]
    navigation_zones: Optional[Path]
    semantic_map: Optional[Path] = None
    objects: Optional[Path] = None


def manifest_text(name: str, contents: Mapping[str, bytes]) -> str:
    """Return the manifest of a home.

    Args:
        name: Name of the home.
        contents: Content of each of its files by name.
    """
    files = {file: hash_of(content) for file, content in sorted(contents.items())}
    head = "# Ties the files of this home by their SHA-256; ./scripts/build_home.sh FOLDER writes it.\n"
    text = yaml.safe_dump({"name": name, "version": VERSION, "files": files}, sort_keys=False)
    return head + text


def hash_of(content: bytes) -> str:
    """Return the SHA-256 of a file's content, hexadecimal."""
    return hashlib.sha256(content).hexdigest()


def load_hashes(folder: Path) -> Dict[str, str]:
    """Return the hash of each file in the manifest of a home. Raises SettingsError."""
    if not is_file(folder / MANIFEST):
        raise SettingsError(
            f"{folder}: is no home, as it has no {MANIFEST}; "
            f"./scripts/build_home.sh FILE --output {folder} makes one"
        )
    table = read_table(folder / MANIFEST)
    table.check(table.count("version") == VERSION, "version", f"{VERSION}, that of this program")
    return _hashes(table.table("files"))


def _hashes(files: Table) -> Dict[str, str]:
    for name in files:
        files.check(Path(name).name == name, name, "a file of the folder itself")
    return {name: files.text(name) for name in files}


def load_home(folder: Path) -> HomeFolder:
    """Return the files of a home, checked against its manifest.

    Args:
        folder: Folder of the home.

    Raises:
        SettingsError: A part is missing, stale, or belongs to another home.
    """
    hashes = load_hashes(folder)
    for part in (WORLD, MAP, IMAGE, ZONES):
        if part not in hashes:
            raise SettingsError(f"{folder / MANIFEST}: lists no {part}; {_again(folder)}")
    present = {name: _hash_of_file(folder / name) for name in hashes}
    if PLAN in hashes and present[PLAN] != hashes[PLAN]:
        made = f"{WORLD}, {IMAGE} and {ZONES} were made from it"
        raise SettingsError(f"{folder / PLAN}: was changed after {made}; {_again(folder)}")
    for part in FIXED:
        if present[part] != hashes[part]:
            raise SettingsError(f"{folder / part}: {_complaint(part)}; {_again(folder)}")
    names = (MISSION, NAVIGATION_ZONES, SEMANTIC_MAP, OBJECTS)
    optional = (folder / name if name in hashes else None for name in names)
    return HomeFolder(folder, folder / WORLD, folder / MAP, folder / ZONES, *optional)


def changed_files(folder: Path) -> Dict[str, bytes]:
    """Return the files of a home that were edited since it was built, with their content.

    Raises:
        SettingsError: The manifest or a file cannot be read.
    """
    hashes = load_hashes(folder)
    contents = {name: _content(folder / name) for name in hashes if is_file(folder / name)}
    return {name: content for name, content in contents.items() if hash_of(content) != hashes[name]}


def _complaint(part: str) -> str:
    source = SOURCES.get(part)
    if source is None:
        return f"was changed after {IMAGE} was rendered from it"
    return f"does not belong to this home: it is not the one that was made from {source}"


def _again(folder: Path) -> str:
    return f"./scripts/build_home.sh {folder} builds the home again from its plan"


def _hash_of_file(path: Path) -> str:
    return hash_of(_content(path))


def _content(path: Path) -> bytes:
    try:
        return read_bytes(path)
    except FileNotFoundError:
        raise SettingsError(f"{path}: is missing; {_again(path.parent)}") from None
    except OSError as error:
        raise SettingsError(f"{path}: cannot be read ({error.strerror})") from None
