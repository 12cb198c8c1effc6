"""Memory of a node that has loaded its kernels."""

import contextlib
import ctypes
import importlib
import sys
from pathlib import Path
from typing import Iterator, Optional, Tuple

# LLVM, through which numba compiles and loads kernels.
COMPILER = "libllvmlite"
MADV_DONTNEED = 4
# Module of numba that looks for a BLAS on import, and the package in which it looks.
NUMBA_ARRAYS, LINEAR_ALGEBRA = "numba.np.arraymath", "scipy.linalg"


def load_numba_without_blas() -> None:
    """Load numba's array functions without SciPy's linear algebra, 10 MiB that small kernels do not use.

    A kernel with matrix products or decompositions loads it when it is compiled.
    """
    if NUMBA_ARRAYS in sys.modules or LINEAR_ALGEBRA in sys.modules:
        return
    sys.modules[LINEAR_ALGEBRA] = None  # type: ignore[assignment]  # importing it fails at once
    try:
        with contextlib.suppress(ImportError):
            importlib.import_module(NUMBA_ARRAYS)
    finally:
        del sys.modules[LINEAR_ALGEBRA]


def release_compiler() -> int:
    """Drop the resident pages of the compiler that are unchanged copies of its file.

    A node needs them only while kernels are compiled or loaded; Linux reads them again when they are used.

    Returns:
        Number of bytes of address space whose pages were dropped; 0 on systems without /proc.
    """
    try:
        mappings = list(_unchanged_mappings(Path("/proc/self/smaps").read_text(errors="replace")))
        advise = ctypes.CDLL(None).madvise
    except (OSError, AttributeError):
        return 0
    released = 0
    for start, size in mappings:
        if advise(ctypes.c_void_p(start), ctypes.c_size_t(size), MADV_DONTNEED) == 0:
            released += size
    return released


def _unchanged_mappings(smaps: str) -> Iterator[Tuple[int, int]]:
    """Start and size of the compiler's read-only mappings that have no page but those of its file.

    Relocated pages are anonymous copies, in memory or swapped (proc(5), smaps); after a fork they are shared,
    so that the numbers of dirty pages do not show them.
    """
    mapping: Optional[Tuple[int, int]] = None
    copies = 0
    for line in [*smaps.splitlines(), "0-0 end"]:
        words = line.split()
        if not words[0].endswith(":"):
            if mapping is not None and copies == 0:
                yield mapping
            first, end = (int(word, 16) for word in words[0].split("-"))
            is_compiler = COMPILER in words[-1] and "w" not in words[1]
            mapping, copies = ((first, end - first) if is_compiler else None), 0
        elif words[0] in ("Anonymous:", "Swap:"):
            copies += int(words[1])
