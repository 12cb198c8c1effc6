"""Pages of the compiler are dropped only where they are unchanged copies of its file."""

import numba

from planar_ros.node.memory import _unchanged_mappings, release_compiler

SMAPS = """\
7f00-7f10 r-xp 00000000 00:00 1 /usr/lib/libllvmlite.so
Rss:                  64 kB
Private_Dirty:         0 kB
7f10-7f20 r--p 00000000 00:00 1 /usr/lib/libllvmlite.so
Private_Dirty:         4 kB
7f20-7f30 rw-p 00000000 00:00 1 /usr/lib/libllvmlite.so
Private_Dirty:         0 kB
7f30-7f40 r-xp 00000000 00:00 2 /usr/lib/libc.so
Private_Dirty:         0 kB
7f40-7f50 rw-p 00000000 00:00 0
Private_Dirty:         0 kB
"""


def test_only_unchanged_read_only_mappings_of_the_compiler_are_dropped():
    assert list(_unchanged_mappings(SMAPS)) == [(0x7F00, 0x10)]


def test_kernels_run_and_are_compiled_after_the_compiler_is_released():
    twice = numba.njit(lambda value: 2 * value)
    assert twice(2) == 4
    assert release_compiler() > 0
    assert twice(2) == 4
    assert twice(1.5) == 3.0
