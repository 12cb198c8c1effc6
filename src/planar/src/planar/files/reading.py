"""Files read with limits: regular ones only, so that no reader waits for a pipe, and none too large."""

import errno
import io
import os
import stat
import zipfile
from pathlib import Path
from typing import Dict

import numpy as np

MAX_BYTES = 256 << 20
# Of arrays when they are unpacked.
MAX_UNPACKED_BYTES = 1 << 30


def read_bytes(path, most: int = MAX_BYTES) -> bytes:
    """The content of a regular file. Raises OSError, whose ``strerror`` says what is wrong."""
    if "\0" in str(path):
        raise OSError(errno.EINVAL, "no name that a file can have", str(path))
    descriptor = os.open(str(path), os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC)
    with os.fdopen(descriptor, "rb") as file:
        status = os.fstat(descriptor)
        if stat.S_ISDIR(status.st_mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        if not stat.S_ISREG(status.st_mode):
            raise OSError(errno.EINVAL, "not a regular file", str(path))
        content = file.read(most + 1) if status.st_size <= most else b""
    if max(status.st_size, len(content)) > most:
        raise OSError(errno.EFBIG, f"larger than {most >> 20} MB", str(path))
    return content


def read_text(path, most: int = MAX_BYTES, errors: str = "strict") -> str:
    """The text of a regular file in UTF-8. Raises OSError, or UnicodeDecodeError."""
    return read_bytes(path, most).decode("utf-8", errors).replace("\r\n", "\n")


def exists(path: Path) -> bool:
    """Whether there is such a file or folder; a name that no file can have is none."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def is_file(path: Path) -> bool:
    """Whether there is such a regular file."""
    return exists(path) and path.is_file()


def read_arrays(path) -> Dict[str, np.ndarray]:
    """The arrays of an .npz file, without objects. Raises OSError, or ValueError for what is none."""
    content = io.BytesIO(read_bytes(path))
    try:
        with zipfile.ZipFile(content) as archive:
            unpacked = sum(member.file_size for member in archive.infolist())
        if unpacked > MAX_UNPACKED_BYTES:
            raise ValueError(f"{unpacked >> 20} MB when unpacked")
        with np.load(content, allow_pickle=False) as file:
            arrays = dict(file)
        for name, array in arrays.items():
            if not isinstance(array, np.ndarray):  # numpy gives the bytes of what is none
                raise ValueError(f"{name} is no array")
        return arrays
    except Exception as error:  # what zipfile, zlib and numpy raise for broken files has no common class
        raise ValueError(str(error) or type(error).__name__) from None


def read_array(path) -> np.ndarray:
    """The array of an .npy file, without objects. Raises OSError, or ValueError for what is none."""
    content = io.BytesIO(read_bytes(path))
    try:
        return np.asarray(np.lib.format.read_array(content, allow_pickle=False))
    except Exception as error:  # as above
        raise ValueError(str(error) or type(error).__name__) from None
