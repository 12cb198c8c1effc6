#!/usr/bin/env bash
# numba 0.57.1 to 0.60.0: a tuple of five arrays is typed again at each call, and the memory for that is kept.
#
# Guess:  a compiled function finds the version for its arguments by a short key of their types; one more array in a
#         tuple makes the key a little longer, and the call some tenths of a microsecond slower.
# Is:     the key of five arrays no longer fits into the first buffer of 40 bytes. Its beginning is not copied into the
#         next one, so it starts with what that memory held before. As soon as a program uses memory of this size
#         between two calls, as most do, the key is a new one: the types are determined in Python, some 50 times as
#         slowly, and each key is remembered for good. numba 0.61.2 does not do this.
# Means:  a kernel that is called thousands of times a second takes its arrays one by one, or in tuples of at most four.
#
# Installs numba into a temporary folder and runs it alone. Exit code 1 if it behaves differently.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf -- "$folder"' EXIT
cat >"$folder/calls.py" <<'PYTHON'
import ctypes
import os
import resource
import sys
import timeit

import numba
import numpy as np

CALLS = 4000
libc = ctypes.CDLL(None)
libc.malloc.restype, libc.malloc.argtypes = ctypes.c_void_p, [ctypes.c_size_t]
libc.free.argtypes = [ctypes.c_void_p]


@numba.njit
def first(arrays):
    return arrays[0][0, 0]


def use_memory():
    """Use and free a piece of memory, as any other code of a program does."""
    piece = libc.malloc(161)
    ctypes.memmove(piece, os.urandom(161), 161)
    libc.free(piece)


def call(arrays):
    use_memory()
    first(arrays)


def measured(count):
    """Time of a call with a tuple of so many arrays [us], and growth of the process in a call [bytes]."""
    arrays = tuple(np.zeros((2, 2)) for _ in range(count))
    first(arrays)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    calls, alone = (timeit.timeit(each, number=CALLS) for each in (lambda: call(arrays), use_memory))
    growth = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before
    return (calls - alone) / CALLS * 1e6, growth * 1024 / CALLS


print(f"numba {numba.__version__}:")
found = {count: measured(count) for count in (3, 4, 5, 6)}
for count, (time, growth) in found.items():
    print(f"  {count} arrays: {time:5.1f} us, {growth:4.0f} bytes more at each call")
is_slow = found[5][0] > 8.0 * found[4][0]
sys.exit(is_slow != (sys.argv[1] == "slow"))
PYTHON
python3 -m venv "$folder/venv"
check() { # VERSION EXPECTED
    "$folder/venv/bin/pip" install --quiet --only-binary :all: "numba==$1" "numpy==1.24.4"
    "$folder/venv/bin/python" "$folder/calls.py" "$2" || { echo "changed: numba $1 is not $2" && exit 1; }
}
check 0.58.1 slow
check 0.60.0 slow
check 0.61.2 fast
echo "as described"
