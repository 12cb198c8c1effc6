"""Reading of regular files with a size limit; pipes and devices are refused, as reading them may block."""

import errno
import io
import os
import stat
import zipfile
from pathlib import Path
from typing import Dict

import numpy as np

MAX_BYTES = 256 << 20
# Size of the arrays of one file after decompression.
MAX_UNPACKED_BYTES = 1 << 30


def read_bytes(path, most: int = MAX_BYTES) -> bytes:
    """Return the content of a regular file.

    Args:
        path: File.
        most: Size limit [bytes].

    Raises:
        OSError: If it cannot be read; ``strerror`` states the reason.
    """
    if "\0" in str(path):
        raise OSError(errno.EINVAL, "not a valid file name", str(path))
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
    """Return the text of a regular file in UTF-8. Raises OSError or UnicodeDecodeError."""
    return read_bytes(path, most).decode("utf-8", errors).replace("\r\n", "\n")


def exists(path: Path) -> bool:
    """Return whether there is such a file or folder; False for invalid names."""
    try:
        return path.exists()
    except (OSError, ValueError):
        return False


def is_file(path: Path) -> bool:
    """Return whether there is such a regular file."""
    return exists(path) and path.is_file()


def read_arrays(path) -> Dict[str, np.ndarray]:
    """Return the arrays of an .npz file, without objects. Raises OSError or, for bad content, ValueError."""
    content = io.BytesIO(read_bytes(path))
    try:
        with zipfile.ZipFile(content) as archive:
            unpacked = sum(member.file_size for member in archive.infolist())
        if unpacked > MAX_UNPACKED_BYTES:
            raise ValueError(f"{unpacked >> 20} MB when unpacked")
        with np.load(content, allow_pickle=False) as file:
            arrays = dict(file)
        for name, array in arrays.items():
            if not isinstance(array, np.ndarray):  # numpy returns other members as bytes
                raise ValueError(f"{name} is not an array")
        return arrays
    except Exception as error:  # errors of zipfile, zlib and numpy have no common class
        raise ValueError(str(error) or type(error).__name__) from None


def read_array(path) -> np.ndarray:
    """Return the array of an .npy file, without objects. Raises OSError or, for bad content, ValueError."""
    content = io.BytesIO(read_bytes(path))
    try:
        return np.asarray(np.lib.format.read_array(content, allow_pickle=False))
    except Exception as error:  # as above
        raise ValueError(str(error) or type(error).__name__) from None
