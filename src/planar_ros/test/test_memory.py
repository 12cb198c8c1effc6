"""Pages of the compiler are dropped only where they are unchanged copies of its file."""

import multiprocessing
import subprocess
import sys

import numba

from planar_ros.node.memory import _unchanged_mappings, release_compiler

SMAPS = """\
7f00-7f10 r-xp 00000000 00:00 1 /usr/lib/libllvmlite.so
Rss:                  64 kB
Shared_Dirty:          0 kB
Private_Dirty:         0 kB
Anonymous:             0 kB
Swap:                  0 kB
7f10-7f20 r--p 00000000 00:00 1 /usr/lib/libllvmlite.so
Shared_Dirty:          4 kB
Private_Dirty:         0 kB
Anonymous:             4 kB
Swap:                  0 kB
7f20-7f28 r--p 00000000 00:00 1 /usr/lib/libllvmlite.so
Anonymous:             0 kB
Swap:                  4 kB
7f28-7f30 rw-p 00000000 00:00 1 /usr/lib/libllvmlite.so
Anonymous:             0 kB
Swap:                  0 kB
7f30-7f40 r-xp 00000000 00:00 2 /usr/lib/libc.so
Anonymous:             0 kB
7f40-7f50 rw-p 00000000 00:00 0
Anonymous:             0 kB
"""


def test_only_unchanged_read_only_mappings_of_the_compiler_are_dropped():
    assert list(_unchanged_mappings(SMAPS)) == [(0x7F00, 0x10)]


def test_a_forked_process_can_release_the_compiler_and_compile():
    numba.njit(lambda value: value + 1)(1)
    process = multiprocessing.get_context("fork").Process(target=_release_and_compile)
    process.start()
    process.join(60.0)
    assert process.exitcode == 0


def _release_and_compile():
    release_compiler()
    assert numba.njit(lambda value: 3 * value)(2) == 6


def test_kernels_run_and_are_compiled_after_the_compiler_is_released():
    twice = numba.njit(lambda value: 2 * value)
    assert twice(2) == 4
    assert release_compiler() > 0
    assert twice(2) == 4
    assert twice(1.5) == 3.0


WITHOUT_BLAS = """
import sys
import numba, numpy as np
from planar_ros.node.memory import load_numba_without_blas
load_numba_without_blas()
assert numba.njit(lambda values: values.sum())(np.ones(3)) == 3.0
assert "scipy.linalg" not in sys.modules
inverse = numba.njit(lambda matrix: np.linalg.inv(matrix) @ matrix)
assert inverse(np.eye(2)).tolist() == np.eye(2).tolist()
import scipy.linalg
"""


def test_kernels_load_linear_algebra_only_if_they_use_it():
    subprocess.run([sys.executable, "-c", WITHOUT_BLAS], check=True, timeout=120.0)
