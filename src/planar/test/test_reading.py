"""Only regular files are read, with a size limit."""

import os
import struct
import zipfile
import zlib

import numpy as np
import pytest

from planar import MapFileError, SettingsError, load_map
from planar.config.yaml_table import read_table
from planar.files.reading import exists, read_arrays, read_bytes
from planar.maps.map_file import cells_from_image


@pytest.fixture
def pipe(tmp_path):
    """A pipe without a writer; reading it would block."""
    os.mkfifo(str(tmp_path / "pipe"))
    return tmp_path / "pipe"


def test_a_pipe_is_refused_without_blocking(pipe):
    with pytest.raises(OSError, match="not a regular file"):
        read_bytes(pipe)
    with pytest.raises(SettingsError, match="not a regular file"):
        read_table(pipe)


@pytest.mark.parametrize("device", ["/dev/zero", "/dev/tty"])
def test_a_device_is_refused(device):
    with pytest.raises(OSError):
        read_bytes(device)


def test_a_file_above_the_limit_is_refused(tmp_path):
    path = tmp_path / "large"
    with path.open("wb") as file:
        file.truncate(11)
    assert len(read_bytes(path, 11)) == 11
    with pytest.raises(OSError, match="larger than"):
        read_bytes(path, 10)


def test_an_invalid_file_name_does_not_exist(tmp_path):
    assert not exists(tmp_path / ("x" * 300))


def test_a_decompression_bomb_is_refused(tmp_path):
    path = tmp_path / "bomb.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        header = (
            b"\x93NUMPY\x01\x00\x76\x00" + b"{'descr': '|u1', 'fortran_order': False, 'shape': (2147483648,)}"
        )
        with archive.open("a.npy", "w", force_zip64=True) as member:
            member.write(header.ljust(128))
            for _ in range(1100):
                member.write(bytes(1 << 20))
    with pytest.raises(ValueError, match="MB when unpacked"):
        read_arrays(path)


def test_object_arrays_are_not_unpickled(tmp_path):
    np.savez(tmp_path / "objects.npz", a=np.array([{}], dtype=object))
    with pytest.raises(ValueError, match="pickle"):
        read_arrays(tmp_path / "objects.npz")


def test_a_member_that_is_not_an_array_is_refused(tmp_path):
    with zipfile.ZipFile(tmp_path / "text.npz", "w") as archive:
        archive.writestr("poses.npy", "no array")
    with pytest.raises(ValueError, match="poses is not an array"):
        read_arrays(tmp_path / "text.npz")


def png_that_claims(width, height):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(bytes(80)))


@pytest.mark.parametrize("size", [(13000, 13000), (65000, 65000), (2**31 - 1, 2**31 - 1)])
def test_an_image_that_claims_a_huge_size_is_refused(tmp_path, size):
    path = tmp_path / "huge.png"
    path.write_bytes(png_that_claims(*size))
    with pytest.raises(MapFileError, match="not a readable image"):
        cells_from_image(path)


@pytest.mark.parametrize("key", ["resolution: 1" + 400 * "0", "resolution: 1e300", "origin: [1e300, 0, 0]"])
def test_a_map_with_invalid_numbers_is_refused_with_the_key(tmp_path, key):
    (tmp_path / "map.png").write_bytes(png_that_claims(8, 8))
    rest = {"resolution": "0.05", "origin": "[0, 0, 0]"}
    rest.pop(key.partition(":")[0])
    lines = [key, *(f"{name}: {value}" for name, value in rest.items())]
    text = "\n".join(["image: map.png", "negate: 0", "occupied_thresh: 0.65", "free_thresh: 0.2", *lines])
    (tmp_path / "map.yaml").write_text(text)
    with pytest.raises(MapFileError, match=key.partition(":")[0]):
        load_map(tmp_path / "map.yaml")
