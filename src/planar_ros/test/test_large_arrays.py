"""Memory of large arrays in a replay, in a child process because mallopt applies to a whole process."""

import subprocess
import sys

FRAGMENTED = """
import numpy as np
from planar_ros.bags.offline_replay import unmap_large_arrays

def resident():
    return int(open("/proc/self/statm").read().split()[1]) * 4096

unmap_large_arrays()
before, kept = resident(), []
for _ in range(20):
    large = [np.ones(3 * 2**20 // 8) for _ in range(5)]
    kept.append([np.ones(2000) for _ in range(5)])
    large.insert(0, np.ones(3 * 2**20 // 8))
    kept.append(np.ones(2000))
    del large
print(resident() - before)
"""


def test_memory_of_temporary_large_arrays_is_returned():
    done = subprocess.run([sys.executable, "-c", FRAGMENTED], stdout=subprocess.PIPE, check=True)
    assert int(done.stdout) < 4e6
