#!/usr/bin/env bash
# numpy 1.24.4 and 1.26.4: exp (in 1.24.4 also sin) of a column has other last bits if the result lies behind the array.
#
# Guess:  np.exp(poses[:, 2]) is a function of the numbers in the column; where in memory the result is put, which the
#         allocator chooses, does not matter as long as the two do not overlap.
# Is:     on a processor with AVX-512, vector code computes it, unless the check for overlap answers yes. That check takes
#         the view to be one stride longer than it is, so a result that starts right behind the array counts as
#         overlapping, and the C library computes it; the two round differently. numpy 2.0.2 has the right bound (PR 26972).
# Means:  two runs of one process with one seed differ by some 1e-16 whenever malloc happens to place a result behind
#         its argument; filters and physics amplify that. Compute such functions of contiguous copies.
#
# Installs numpy into temporary folders and runs it alone. Exit code 1 if it behaves differently, 77 without AVX-512.
set -euo pipefail
grep -qw avx512dq /proc/cpuinfo || { echo "skipped: the processor has no AVX-512" && exit 77; }
folder=$(mktemp -d)
trap 'rm -rf -- "$folder"' EXIT
cat >"$folder/functions.py" <<'PYTHON'
import sys

import numpy as np

COUNT = 400


def results(function, gap):
    """Function of the last column of an array; the result starts ``gap`` numbers behind the array."""
    memory = np.zeros(4 * COUNT + gap)
    poses = memory[: 3 * COUNT].reshape(COUNT, 3)
    poses[:, 2] = np.random.default_rng(1).uniform(-3.1, 3.1, COUNT)
    result = memory[3 * COUNT + gap :]
    assert not np.shares_memory(poses, result)
    return function(poses[:, 2], out=result).copy()


def different(function):
    """Count of numbers that differ from those with the result far away, by the gap."""
    return {gap: int((results(function, gap) != results(function, 64)).sum()) for gap in (0, 1, 2, 8)}


counts = {function.__name__: different(function) for function in (np.sin, np.exp)}
print(f"numpy {np.__version__}: numbers of {COUNT} that differ, by the gap behind the array: {counts}")
inexact = [name for name, count in counts.items() if any(count.values())]
sys.exit(inexact != sys.argv[1:])
PYTHON
check() { # VERSION [FUNCTION...]: those whose results depend on where they are put
    python3 -m venv "$folder/$1"
    "$folder/$1/bin/pip" install --quiet --only-binary :all: "numpy==$1"
    "$folder/$1/bin/python" "$folder/functions.py" "${@:2}" || { echo "changed: numpy $1" && exit 1; }
}
check 1.24.4 sin exp
check 1.26.4 exp
check 2.0.2
echo "as described"
